//! What the tests of this folder share: runs of scenario texts on the engines of the build.
use servobench_metrics::{Metrics, Name, measure};
use servobench_plant::{Engine, Exact};
use servobench_scenario::Scenario;
use servobench_sim::Bench;
use servobench_trace::Recording;

/// Every engine of the build, `exact` first. All of them run in this process.
#[must_use]
pub fn engines() -> Vec<&'static dyn Engine> {
    vec![
        &Exact,
        &servobench_engine_rapier::Rapier,
        #[cfg(feature = "mujoco")]
        &servobench_engine_mujoco::Mujoco,
    ]
}

/// The scenario in `text`.
///
/// # Panics
/// With every mistake of the text.
#[must_use]
pub fn scenario(text: &str) -> Scenario {
    match servobench_scenario::parse("test", text, None) {
        Ok(loaded) => loaded.scenario,
        Err(error) => panic!("{error}"),
    }
}

/// The scenario file `name` of this repository's `scenarios/`.
///
/// # Panics
/// With every mistake of the file.
#[must_use]
pub fn scenario_file(name: &str) -> Scenario {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios").join(name);
    match servobench_scenario::load(&path) {
        Ok(loaded) => loaded.scenario,
        Err(error) => panic!("{error}"),
    }
}

/// The recording of `scenario` on `engine`.
///
/// # Panics
/// When it cannot be built or does not come to its end.
#[must_use]
pub fn run(scenario: &Scenario, engine: &dyn Engine) -> Recording {
    let bench = Bench::new(scenario, engine).unwrap_or_else(|error| panic!("{}: {error}", engine.name()));
    let outcome = bench.run(&mut |_| {});
    assert_eq!(outcome.failure, None, "{}", engine.name());
    outcome.recording
}

/// What is measured on `recording`, as `scenario` asks.
#[must_use]
pub fn measured(scenario: &Scenario, recording: &Recording) -> Metrics {
    measure(recording, &scenario.measure)
}

/// The value of `name`.
///
/// # Panics
/// With the reason when it could not be measured.
#[must_use]
pub fn value(metrics: &Metrics, name: Name) -> f64 {
    metrics.run.value(name).unwrap_or_else(|| panic!("{name}: {:?}", metrics.run.absence(name)))
}
