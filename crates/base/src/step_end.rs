//! Progress of a simulation step.

use crate::state::Stateful;
/// Progress of a simulation step of an FMU or of any other block of a co-simulation.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub enum StepEnd {
    /// Completed.
    Done,
    /// Completed up to this time (s): an event occurred, or the step returned early. The rest must be requested.
    Until(f64),
    /// Completed up to this time (s), at which the block requests the end of the simulation.
    Terminated(f64),
}
