//! What a run takes: memory and time.
use crate::job::Job;
use servobench_scenario::{AxisMechanics, EngineName, Scenario};

/// What a run takes.
#[derive(Debug, Clone, PartialEq)]
pub struct Cost {
    /// Base ticks.
    pub ticks: f64,
    /// Memory that the recording takes, at most (bytes).
    pub memory: f64,
    /// About how long it takes on each engine (s); `None` of an FMU, which takes what it takes.
    pub seconds: Vec<(EngineName, Option<f64>)>,
}

impl Cost {
    pub(super) fn of(scenario: &Scenario, length: f64, jobs: &[Job]) -> Self {
        let ticks = (length * f64::from(scenario.base_rate.hertz())).floor() + 1.0;
        let memory = jobs.first().map_or(0.0, |job| job.memory() as f64);
        let own_file = matches!(scenario.axis.mechanics, AxisMechanics::Mjcf(_));
        let seconds = jobs.iter().map(|job| {
            let per_tick = if scenario.fmus.is_empty() { per_tick(job.engine, own_file) } else { None };
            (job.engine, per_tick.map(|nanoseconds| ticks * nanoseconds * 1e-9))
        });
        Self { ticks, memory, seconds: seconds.collect() }
    }
}

/// About what a tick of the closed loop with its recording and measures takes (ns): processor time of `servobench run` for 30 s of
/// current control at 16 kHz on two bodies with every channel recorded, and of `own-mjcf.toml`, on a shared machine of two cores.
/// Right to a factor of two or three, and the same on every machine, so that a preview is.
const fn per_tick(engine: EngineName, own_file: bool) -> Option<f64> {
    match (engine, own_file) {
        (EngineName::Exact, _) => Some(450.0),
        (EngineName::Rapier, false) => Some(2_000.0),
        (EngineName::Mujoco, false) => Some(3_700.0),
        (EngineName::Rapier, true) => Some(3_500.0),
        (EngineName::Mujoco, true) => Some(4_800.0),
        (EngineName::Fmu, _) => None,
    }
}
