//! Requirements on a run in addition to its limits.
use servobench_metrics::{Expectation, Requirement, Tolerances};

/// Requirements on a run in addition to its limits: all except the lifted ones.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Requirements {
    /// Requirements that the scenario lifts, in the order of the file.
    pub lifted: Vec<Requirement>,
    /// Faults that belong to the run.
    pub expected: Vec<Expectation>,
    /// Allowed deviations of the axis from the request.
    pub tolerances: Tolerances,
}
