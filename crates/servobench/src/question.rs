//! Data of a scenario that its measurement needs beside the recording.
use crate::requirements::increment;
use servobench_metrics::Question;
use servobench_plant::Chain;
use servobench_scenario::Scenario;
use std::f64::consts::TAU;

/// Window, time and mode as the scenario gives them; lowest mode and increment as its axis has them.
pub(crate) fn question(scenario: &Scenario) -> Question {
    // A chain that cannot be built has been objected to.
    let chain = servobench_sim::Bench::chain(scenario).ok().flatten();
    Question {
        lowest_mode: chain.as_ref().and_then(lowest_mode),
        increment: increment(scenario),
        base_rate: Some(scenario.base_rate),
        ..scenario.measure
    }
}

/// Frequency of the slowest mode (Hz), that with the motor held; `None` of a rigid axis.
fn lowest_mode(chain: &Chain) -> Option<f64> {
    chain.modes(true).first().map(|mode| mode.omega / TAU)
}
