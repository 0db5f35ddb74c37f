//! Bus between master and drive, and its faults.
//!
//! Cycle n is due at n·cycle and happens at the first tick that is neither before `n·cycle + late(n)` nor at or before cycle n − 1; both
//! directions are carried by the same frame. Data sent at cycle n arrive at cycle n + delay, if that frame was not lost. A frame is lost
//! when it is sent: frames already on their way arrive.
//!
//! Everything is determined by the number of the cycle, so every run is the same: the jitter of a cycle is a hash of its number and the
//! seed.
//!
//! ```
//! use servobench_base::{Rate, Tick};
//! use servobench_cia402::{Actuals, Commands};
//! use servobench_fieldbus::bus::{self, BusFault, BusFaultKind, Params, State};
//!
//! let base = Rate::from_hertz(16e3)?;
//! let faults = [BusFault { kind: BusFaultKind::Lost, cycles: 2..3 }];
//! let params = Params::new(base.divider(Rate::from_hertz(1e3)?)?, 1, &faults)?;
//! let mut state = State::default();
//! let mut arrived = Vec::new();
//! for tick in 0..80 {
//!     if let Some(cycle) = bus::step(&params, &mut state, Tick(tick)) {
//!         let _actuals = state.to_master(&params, &cycle, Actuals::default());
//!         arrived.push(state.to_drive(&params, &cycle, Commands::default()).is_some());
//!     }
//! }
//! // The first frame takes a cycle, the third is lost.
//! assert_eq!(arrived, [false, true, true, false, true]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
mod pipe;

use crate::FieldbusError;
use core::ops::Range;
use pipe::Pipe;
use servobench_base::{Divider, Stateful, Tick};
use servobench_cia402::{Actuals, Commands};

/// A fault in some cycles.
#[derive(Debug, Clone, PartialEq)]
pub struct BusFault {
    /// Kind of fault.
    pub kind: BusFaultKind,
    /// Affected cycles, the first of the run is 0; up to `u64::MAX` if the fault does not end.
    pub cycles: Range<u64>,
}

servobench_config::choices! {
    /// Kind of a bus fault. A lost frame is lost in both directions; a silent drive still receives.
    pub enum BusFaultKind named BusFaultName {
        /// the frame does not arrive
        Lost = "lost",
        /// the frame arrives late
        Late {
            /// By how much (base ticks).
            by: u32,
        } = "late",
        /// each frame arrives late by a random time
        Jitter {
            /// By how much at most (base ticks).
            by: u32,
            /// Seed of the random numbers.
            seed: u32,
        } = "jitter",
        /// the motion task does not run
        MasterStopped = "master-stopped",
        /// the drive does not answer
        DriveSilent = "drive-silent",
        /// the fault input of the master is set
        ExternalFault = "external-fault",
    }
}

/// A bus, constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params<'a> {
    cycle: u64,
    delay: usize,
    faults: &'a [BusFault],
}

impl<'a> Params<'a> {
    /// Longest delay (bus cycles).
    pub const LONGEST_DELAY: u32 = 15;

    /// A bus with a frame every `cycle`, whose contents arrive `delay` cycles later in either direction.
    ///
    /// # Errors
    /// [`FieldbusError::Delay`] above [`LONGEST_DELAY`](Self::LONGEST_DELAY).
    pub const fn new(cycle: Divider, delay: u32, faults: &'a [BusFault]) -> Result<Self, FieldbusError> {
        if delay > Self::LONGEST_DELAY {
            return Err(FieldbusError::Delay { delay, highest: Self::LONGEST_DELAY });
        }
        Ok(Self { cycle: cycle.ticks() as u64, delay: delay as usize, faults })
    }

    /// Period of the bus (base ticks).
    #[must_use]
    pub const fn cycle(&self) -> u64 {
        self.cycle
    }

    /// The same bus with other faults.
    #[must_use]
    pub const fn with_faults<'b>(&self, faults: &'b [BusFault]) -> Params<'b> {
        Params { cycle: self.cycle, delay: self.delay, faults }
    }

    fn faults_of(&self, cycle: u64) -> impl Iterator<Item = BusFaultKind> + '_ {
        self.faults.iter().filter(move |fault| fault.cycles.contains(&cycle)).map(|fault| fault.kind)
    }

    /// Time of cycle `number`, regardless of the cycles before it (base ticks).
    fn time_of(&self, number: u64) -> u64 {
        let late = self.faults_of(number).map(|kind| match kind {
            BusFaultKind::Late { by } => u64::from(by),
            BusFaultKind::Jitter { by, seed } => below(u64::from(by) + 1, seed, number),
            _ => 0,
        });
        self.cycle * number + late.sum::<u64>()
    }
}

/// Frames on their way, and the time of the next cycle.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct State {
    next: Option<Tick>,
    number: u64,
    to_master: Pipe<Actuals>,
    to_drive: Pipe<Commands>,
}

/// A cycle of the bus.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "each is a separate fault, and any of them may come together")]
pub struct Cycle {
    /// Number, from 0.
    pub number: u64,
    /// Due tick. A master does not know that the cycle is late: it computes for this tick.
    pub due: Tick,
    /// True if the frame is lost.
    pub is_lost: bool,
    /// True if the drive does not answer.
    pub is_silent: bool,
    /// True if the motion task does not run.
    pub master_stopped: bool,
    /// The external fault signal.
    pub external_fault: bool,
}

/// Cycle that happens at this tick, if any; call it once at every tick.
#[inline]
pub fn step(params: &Params<'_>, state: &mut State, tick: Tick) -> Option<Cycle> {
    if state.next.is_some_and(|next| tick < next) {
        return None;
    }
    state.turn(params, tick)
}

impl State {
    /// Number of cycles so far.
    #[must_use]
    pub const fn cycles(&self) -> u64 {
        self.number
    }

    fn turn(&mut self, params: &Params<'_>, tick: Tick) -> Option<Cycle> {
        // The first cycle may be late, too.
        if self.next.is_none() && tick.0 < params.time_of(0) {
            self.next = Some(Tick(params.time_of(0)));
            return None;
        }
        let number = self.number;
        self.number += 1;
        self.next = Some(Tick(params.time_of(self.number)));
        let has = |kind| params.faults_of(number).any(|found| found == kind);
        Some(Cycle {
            number,
            due: Tick(number * params.cycle),
            is_lost: has(BusFaultKind::Lost),
            is_silent: has(BusFaultKind::DriveSilent),
            master_stopped: has(BusFaultKind::MasterStopped),
            external_fault: has(BusFaultKind::ExternalFault),
        })
    }

    /// Sends the drive's data of this cycle; returns those that arrive at the master.
    pub fn to_master(&mut self, params: &Params<'_>, cycle: &Cycle, actuals: Actuals) -> Option<Actuals> {
        let sent = (!cycle.is_lost && !cycle.is_silent).then_some(actuals);
        self.to_master.carry(sent, params.delay)
    }

    /// Sends the master's data of this cycle; returns those that arrive at the drive.
    pub fn to_drive(&mut self, params: &Params<'_>, cycle: &Cycle, commands: Commands) -> Option<Commands> {
        self.to_drive.carry((!cycle.is_lost).then_some(commands), params.delay)
    }
}

/// A number below `bound`, at most 2³², by seed and cycle: `SplitMix64` (Steele, Lea & Flood 2014).
pub(crate) fn below(bound: u64, seed: u32, cycle: u64) -> u64 {
    let z = (u64::from(seed) << 32).wrapping_add(cycle.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (((z ^ (z >> 31)) >> 32) * bound) >> 32
}
