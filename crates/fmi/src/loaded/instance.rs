//! What the instances of both versions can do.
use crate::slave::{Capabilities, LogLine, Progress, SlaveError};

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
    Came(Progress),
    /// The FMU discarded it, and is nowhere that a step can begin from. It may say to what time (s) within the step it would have
    /// come.
    Discarded {
        call: &'static str,
        within: Option<f64>,
    },
}

/// An initialised instance.
pub(super) trait Instance: Send {
    fn capabilities(&self) -> Capabilities;

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

/// A time that a discarded step is said to have come to, if that is within it.
pub(super) fn within(reached: Option<f64>, time: f64, length: f64) -> Option<f64> {
    reached.filter(|reached| *reached > time && *reached < time + length)
}
