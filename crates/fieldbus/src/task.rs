//! Schedule of a motion task, and its faults.
//!
//! Cycle n is due at `due(n) = due(n−1) + cycle − short(n−1)`, `due(0) = 0`, and runs at `due(n) + late(n)`, not before cycle n − 1. A
//! delayed task executes its pending cycles in a burst.
//!
//! Everything is determined by the number of the cycle, so every run is the same.
//!
//! ```
//! use servobench_base::{Rate, Tick};
//! use servobench_fieldbus::task::{self, Params, State, TaskFault, TaskFaultKind};
//!
//! let base = Rate::from_hertz(16e3)?;
//! let faults = [TaskFault { kind: TaskFaultKind::Late { by: 100 }, cycles: 1..2 }];
//! let params = Params::new(base.divider(Rate::from_hertz(250.0)?)?, &faults);
//! let mut state = State::default();
//! let mut ran = Vec::new();
//! for tick in 0..256 {
//!     while let Some(cycle) = task::step(&params, &mut state, Tick(tick)) {
//!         ran.push((tick, cycle.due.0));
//!     }
//! }
//! // The second cycle, 100 ticks late, delays the third one.
//! assert_eq!(ran, [(0, 0), (164, 64), (164, 128), (192, 192)]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
use crate::bus::below;
use core::ops::Range;
use servobench_base::{Divider, Stateful, Tick};

/// A fault in some cycles of the motion task.
#[derive(Debug, Clone, PartialEq)]
pub struct TaskFault {
    /// Kind of fault.
    pub kind: TaskFaultKind,
    /// Affected cycles, the first of the run is 0; up to `u64::MAX` if the fault does not end.
    pub cycles: Range<u64>,
}

servobench_config::choices! {
    /// Kind of a fault of the motion task. The cycle of a fast clock is a base tick at least.
    pub enum TaskFaultKind named TaskFaultName {
        /// the motion task runs late, and with it the cycles that it holds up
        Late {
            /// By how much (base ticks).
            by: u32,
        } = "task-late",
        /// each cycle of the motion task runs late by a random time
        Jitter {
            /// By how much at most (base ticks).
            by: u32,
            /// Seed of the random numbers.
            seed: u32,
        } = "task-jitter",
        /// the command of the motion task is lost
        Lost = "task-lost",
        /// the master reads the command while the motion task writes it
        Torn = "task-torn",
        /// the clock of the motion task runs fast: its cycles are too short
        Fast {
            /// By how much (base ticks).
            by: u32,
        } = "task-fast",
    }
}

/// A motion task, constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params<'a> {
    cycle: u64,
    faults: &'a [TaskFault],
}

impl<'a> Params<'a> {
    /// A task that runs every `cycle`.
    #[must_use]
    pub const fn new(cycle: Divider, faults: &'a [TaskFault]) -> Self {
        Self { cycle: cycle.ticks() as u64, faults }
    }

    /// Nominal period of the task (base ticks).
    #[must_use]
    pub const fn cycle(&self) -> u64 {
        self.cycle
    }

    /// The same task with other faults.
    #[must_use]
    pub const fn with_faults<'b>(&self, faults: &'b [TaskFault]) -> Params<'b> {
        Params { cycle: self.cycle, faults }
    }

    fn faults_of(&self, cycle: u64) -> impl Iterator<Item = TaskFaultKind> + '_ {
        self.faults.iter().filter(move |fault| fault.cycles.contains(&cycle)).map(|fault| fault.kind)
    }

    fn lateness_of(&self, cycle: u64) -> u64 {
        let late = self.faults_of(cycle).map(|kind| match kind {
            TaskFaultKind::Late { by } => u64::from(by),
            TaskFaultKind::Jitter { by, seed } => below(u64::from(by) + 1, seed, cycle),
            TaskFaultKind::Lost | TaskFaultKind::Fast { .. } | TaskFaultKind::Torn => 0,
        });
        late.sum()
    }

    fn length_of(&self, cycle: u64) -> u64 {
        let short = self.faults_of(cycle).map(|kind| match kind {
            TaskFaultKind::Fast { by } => u64::from(by),
            _ => 0,
        });
        self.cycle.saturating_sub(short.sum()).max(1)
    }
}

/// Next cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub struct State {
    number: u64,
    due: u64,
}

impl State {
    /// Number of cycles so far.
    #[must_use]
    pub const fn cycles(&self) -> u64 {
        self.number
    }
}

/// A cycle of the task.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cycle {
    /// Number, from 0.
    pub number: u64,
    /// Due tick, by the task's own clock. A task does not know that it is late: it computes for this tick.
    pub due: Tick,
    /// True if the command is lost.
    pub is_lost: bool,
    /// True if the link finds the command torn.
    pub is_torn: bool,
}

/// Next cycle that has run by `tick`, if any; call it until there is none.
#[inline]
pub fn step(params: &Params<'_>, state: &mut State, tick: Tick) -> Option<Cycle> {
    let State { number, due } = *state;
    if tick.0 < due || tick.0 < due + params.lateness_of(number) {
        return None;
    }
    *state = State { number: number + 1, due: due + params.length_of(number) };
    let has = |kind| params.faults_of(number).any(|found| found == kind);
    Some(Cycle { number, due: Tick(due), is_lost: has(TaskFaultKind::Lost), is_torn: has(TaskFaultKind::Torn) })
}
