//! What the instances of both versions can do.
use crate::slave::{Capabilities, LogLine, SlaveError, StepEnd};

/// Where a state is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Slot {
    /// What was saved for who uses the slave.
    Caller,
    /// What a step that is discarded is taken back to.
    Step,
}

impl Slot {
    pub(crate) const COUNT: usize = 2;
}

/// What a step has come to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Attempt {
    Came(StepEnd),
    /// The FMU discarded it, and is nowhere that a step can begin from. It may say to what time (s) within the step it would have
    /// come.
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

    /// Keeps the state, in place of the one that was kept there.
    fn save(&mut self, slot: Slot) -> Result<(), SlaveError>;

    /// Goes back to a state that was kept.
    fn restore(&mut self, slot: Slot) -> Result<(), SlaveError>;

    /// As [`crate::Slave::take_log`].
    fn take_log(&mut self) -> Vec<LogLine>;
}

/// The time (s) that a step is said to have come to, which has to be one of the step.
pub(super) fn reached(call: &'static str, time: f64, length: f64, at: f64) -> Result<f64, SlaveError> {
    let to = time + length;
    // What the FMU adds up by itself is rounded in another way.
    let rounding = 4.0 * f64::EPSILON * to.abs().max(time.abs()) + 1e-9 * length;
    if at >= time - rounding && at <= to + rounding {
        Ok(at.clamp(time, to))
    } else {
        Err(SlaveError::Astray { call: call.into(), from: time, to, at })
    }
}

/// A time that a discarded step is said to have come to, if that is within it.
pub(super) fn within(reached: Option<f64>, time: f64, length: f64) -> Option<f64> {
    reached.filter(|reached| *reached > time && *reached < time + length)
}
