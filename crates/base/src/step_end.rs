//! How far a step of a simulation has come.

use crate::state::Stateful;
/// How far a step of a simulation has come: that of an FMU, or of any other block of a co-simulation.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub enum StepEnd {
    /// To its end.
    Done,
    /// To this time (s) before its end: an event was met, or the step returned early. The rest is to be asked for.
    Until(f64),
    /// To this time (s), where the block wants the simulation to end.
    Terminated(f64),
}
