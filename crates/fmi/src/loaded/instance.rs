//! Functions common to the instances of both versions.
use crate::slave::{Capabilities, LogLine, SlaveError, StepEnd};

/// Slots for saved states.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Slot {
    /// State saved for the user of the slave.
    Caller,
    /// State to return to after a discarded step.
    Step,
}

impl Slot {
    pub(crate) const COUNT: usize = 2;
}

/// Result of an attempted step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Attempt {
    Came(StepEnd),
    /// The FMU discarded it and is not at a time from which a step can begin. It may report up to which time (s) within the step it would
    /// have succeeded.
    Discarded {
        call: &'static str,
        within: Option<f64>,
    },
}

/// An instance in its initialisation or after it.
pub(super) trait Instance: Send {
    fn capabilities(&self) -> Capabilities;

    /// As [`crate::Slave::start`].
    fn start(&mut self, inputs: Option<&[f64]>) -> Result<(), SlaveError>;

    /// As [`crate::Slave::end`].
    fn end(&mut self);

    /// As [`crate::Slave::step`].
    fn attempt(&mut self, time: f64, length: f64, inputs: &[[f64; 3]]) -> Result<Attempt, SlaveError>;

    /// As [`crate::Slave::read`].
    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), SlaveError>;

    /// Saves the state, in place of the one saved there before.
    fn save(&mut self, slot: Slot) -> Result<(), SlaveError>;

    /// Restores a saved state.
    fn restore(&mut self, slot: Slot) -> Result<(), SlaveError>;

    /// As [`crate::Slave::take_log`].
    fn take_log(&mut self) -> Vec<LogLine>;
}

/// The time (s) reported as reached by a step; an error if it is outside the step.
pub(super) fn reached(call: &'static str, time: f64, length: f64, at: f64) -> Result<f64, SlaveError> {
    let to = time + length;
    // The FMU's own sum of times is rounded differently.
    let rounding = 4.0 * f64::EPSILON * to.abs().max(time.abs()) + 1e-9 * length;
    if at >= time - rounding && at <= to + rounding {
        Ok(at.clamp(time, to))
    } else {
        Err(SlaveError::Astray { call: call.into(), from: time, to, at })
    }
}

/// The time reported as reached by a discarded step, if it is within the step.
pub(super) fn within(reached: Option<f64>, time: f64, length: f64) -> Option<f64> {
    reached.filter(|reached| *reached > time && *reached < time + length)
}
