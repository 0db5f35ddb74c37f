//! What a run is held to beside its limits.
use servobench_metrics::{Expectation, Requirement, Tolerances};

/// What a run is held to beside its limits: every requirement but those that are lifted.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Requirements {
    /// Those that the scenario lifts, in the order of the file.
    pub lifted: Vec<Requirement>,
    /// The faults that belong to the run.
    pub expected: Vec<Expectation>,
    /// How far off the request the axis may be.
    pub tolerances: Tolerances,
}
