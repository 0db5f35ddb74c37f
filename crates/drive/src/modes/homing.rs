//! Homing (hm, mode 6): the drive searches for its reference (IEC 61800-7-201, homing mode).
//!
//! The controlword's bit 4 starts the search with its rising edge and interrupts it when it is cleared; halt (bit 8) stops the axis on its
//! leg. Both stop within the homing acceleration, unless the drive itself stops the axis for a halt.
//!
//! | bit 13, homing error | bit 12, homing attained | bit 10, target reached | |
//! |---|---|---|---|
//! | 0 | 0 | 0 | searching, or being interrupted |
//! | 0 | 0 | 1 | not started, interrupted, or halted: the axis is at rest |
//! | 0 | 1 | 0 | the reference is found, the axis is being stopped |
//! | 0 | 1 | 1 | homed |
//! | 1 | 0 | 0 | failed, the axis is being stopped |
//! | 1 | 0 | 1 | failed, the axis is at rest |
//!
//! A search fails when the axis meets a limit switch that its method does not expect in that direction, and stays failed until
//! bit 4 rises again.
//!
//! An edge of a switch or a pulse counts only while the demand moves in the direction of the leg and the axis is not measured moving back,
//! so that the far edge of a narrow home switch, which the axis passes before it has reversed, is not mistaken for the near one. The
//! position of an edge is that of the first step that saw it, late by one period at the speed for zero; that of an index pulse is exact,
//! and a pulse in the same step as the edge before it does not count.
//!
//! The reference gets the home offset as its position. The profile may also be read the other way, with zero at the offset from the
//! reference: for such a drive the sign is the opposite.
//!
//! The legs of a method are a [table](Method), printed in `docs/homing.md`. Sources: the drawings of DSP 402 v2, homing mode, as manuals
//! print them (Control Techniques, *SM-EtherCAT User Guide*, issue 2, section 7.7; Brooks, *Homing methods 7 to 14*; Bonfiglioli, *Active
//! Cube, application manual Positioning*, 04/08, table 5.2, against which the tests check the methods).
mod leg;
mod method;
mod search;

use super::ramp::{Ramp, Steepness};
use super::{Answer, Moment};
use crate::Demand;
use search::{Finding, Search};
use servobench_base::{ParamError, Setpoint, Stateful, finite, positive};
use servobench_cia402::ControlBit;

pub use leg::{Direction, Event, Leg, Speed, Switch};
pub use method::{Method, Start, UnknownMethod};

/// Settings of the search for the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Homing method (6098h).
    pub method: Method,
    /// Speed during search for switch (6099h.1).
    pub switch_speed: f64,
    /// Speed during search for zero (6099h.2).
    pub zero_speed: f64,
    /// Homing acceleration (609Ah), also for stops.
    pub acceleration: f64,
    /// Jerk; without it the velocity is a trapezoid.
    pub jerk: Option<f64>,
    /// Position of the reference (607Ch).
    pub home_offset: f64,
}

impl Params {
    /// Checks the settings.
    ///
    /// # Errors
    /// [`ParamError`] names the first value that is not positive, or an offset that is not finite.
    pub fn check(&self) -> Result<(), ParamError> {
        positive("switch_speed", self.switch_speed)?;
        positive("zero_speed", self.zero_speed)?;
        self.steepness().check()?;
        finite("home_offset", self.home_offset)?;
        Ok(())
    }

    const fn steepness(&self) -> Steepness {
        Steepness { acceleration: self.acceleration, jerk: self.jerk }
    }
}

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct State {
    phase: Phase,
    /// Bit 4 of the last controlword.
    asked: bool,
    ramp: Ramp,
}

/// Cause of a failed search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Stateful)]
pub enum Failure {
    /// This limit switch was met.
    Limit(Switch),
    /// The previous demand on the loops, or the parameters, allow no motion.
    Motion,
}

#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
enum Phase {
    /// Not started, or interrupted.
    Idle,
    Searching(Search),
    /// The reference is found, the axis is being stopped.
    Found {
        reference: f64,
    },
    Homed,
    Failed(Failure),
}

impl State {
    /// Begins the mode: a bit 4 that is already set starts nothing.
    #[must_use]
    pub fn begin(now: &Moment) -> Self {
        Self { phase: Phase::Idle, asked: asks(now), ramp: Ramp::default() }
    }

    /// Continues after the drive has stopped the axis without calling the mode, as for a halt: switch events meanwhile were missed, so that
    /// the search restarts from the present position.
    pub fn resume(&mut self, now: &Moment) {
        if let Phase::Searching(search) = &mut self.phase {
            search.restart(&now.actual);
        }
    }

    /// True if the last search has found the reference, and the axis has stopped.
    #[must_use]
    pub const fn is_homed(&self) -> bool {
        matches!(self.phase, Phase::Homed)
    }

    /// Cause of the last search's failure, if it failed.
    #[must_use]
    pub const fn failure(&self) -> Option<Failure> {
        match self.phase {
            Phase::Failed(failure) => Some(failure),
            _ => None,
        }
    }
}

/// Output of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Output {
    /// Answer for the loops and the statusword, in the positions of this step.
    pub answer: Answer,
    /// Once the axis has been homed: shift of every position from the next step on, so that the reference is at the home offset. The caller
    /// adds it to its measurements and demands.
    pub shift: Option<f64>,
}

/// Continues the search.
///
/// The parameters must have passed [`Params::check`]; the method is taken from them when the search starts. No guard may keep the axis from
/// a limit switch, which some methods search for.
pub fn step(params: &Params, state: &mut State, moment: &Moment) -> Output {
    let asked = asks(moment);
    let was_asked = core::mem::replace(&mut state.asked, asked);
    if asked && !was_asked {
        state.phase = Phase::Searching(Search::begin(params.method, &moment.actual));
    }
    let mut velocity = 0.0;
    if let Phase::Searching(search) = &mut state.phase {
        match search.look(params, moment) {
            _ if !asked => state.phase = Phase::Idle,
            Finding::Leg(leg) => velocity = leg.direction.sign() * speed(params, leg),
            Finding::Reference(reference) => state.phase = Phase::Found { reference },
            Finding::Limit(switch) => state.phase = Phase::Failed(Failure::Limit(switch)),
        }
    }
    if moment.targets.controlword.has(ControlBit::Halt) {
        velocity = 0.0;
    }
    let setpoint = state.ramp.step(&params.steepness(), velocity, moment).unwrap_or_else(|_| {
        state.phase = Phase::Failed(Failure::Motion);
        Setpoint::at_rest(moment.demanded.x)
    });
    let is_at_rest = velocity == 0.0 && setpoint.v == 0.0 && setpoint.a == 0.0;
    let shift = match state.phase {
        Phase::Found { reference } if is_at_rest => {
            state.phase = Phase::Homed;
            Some(params.home_offset - reference)
        }
        _ => None,
    };
    let answer = Answer {
        demand: Demand::position(setpoint),
        target_reached: is_at_rest,
        bit_12: matches!(state.phase, Phase::Found { .. } | Phase::Homed),
        bit_13: matches!(state.phase, Phase::Failed(_)),
    };
    Output { answer, shift }
}

const fn asks(moment: &Moment) -> bool {
    moment.targets.controlword.has(ControlBit::ModeSpecific4)
}

const fn speed(params: &Params, leg: Leg) -> f64 {
    match leg.speed {
        Speed::Switch => params.switch_speed,
        Speed::Zero => params.zero_speed,
    }
}
