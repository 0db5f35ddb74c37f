//! Memory and time of a run.
use crate::size::memory;
use servobench_plant::EngineName;
use servobench_scenario::{AxisMechanics, Scenario};

/// Memory and time of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Cost {
    /// Base ticks.
    pub ticks: f64,
    /// Largest memory of the recording (bytes).
    pub memory: f64,
    /// Approximate duration on each engine (s); none with FMUs, whose cost is unknown.
    pub seconds: Vec<(EngineName, f64)>,
}

impl Cost {
    pub(super) fn of(scenario: &Scenario, length: f64, engines: &[EngineName]) -> Self {
        let ticks = (length * f64::from(scenario.base_rate.hertz())).floor() + 1.0;
        let memory = memory(scenario) as f64;
        let own_file = matches!(scenario.axis.mechanics, AxisMechanics::Mjcf(_));
        let seconds = engines.iter().filter(|_| scenario.fmus.is_empty()).filter_map(|engine| {
            let [of_bodies, of_file] = engine.capabilities().tick_time?;
            let nanoseconds = if own_file { of_file } else { of_bodies };
            Some((*engine, ticks * nanoseconds * 1e-9))
        });
        Self { ticks, memory, seconds: seconds.collect() }
    }
}
