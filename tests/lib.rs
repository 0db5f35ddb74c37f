//! What the tests of this folder share: runs of scenario texts on the engines of the build.
use servobench_metrics::{Metrics, Name, measure};
use servobench_plant::{Engine, Exact};
use servobench_scenario::Scenario;
use servobench_sim::Bench;
use servobench_trace::Recording;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

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
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios").join(name);
    match servobench_scenario::load(&path) {
        Ok(loaded) => loaded.scenario,
        Err(error) => panic!("{error}"),
    }
}

/// The scenario files of this repository's `scenarios/`, in the order of their paths.
///
/// # Panics
/// When a folder cannot be read.
#[must_use]
pub fn ready_scenarios() -> Vec<PathBuf> {
    fn below(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
            let path = entry.unwrap_or_else(|error| panic!("{}: {error}", folder.display())).path();
            let name = path.to_string_lossy();
            if path.is_dir() {
                below(&path, found);
            } else if name.ends_with(".toml") && !name.ends_with(".sweep.toml") {
                found.push(path);
            }
        }
    }
    let mut found = Vec::new();
    below(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios"), &mut found);
    found.sort();
    found
}

/// Faults that `fault` finds in all, by every processor.
///
/// # Panics
/// When `fault` does.
pub fn faults<T: Sync>(all: &[T], fault: impl Fn(&T) -> Option<String> + Sync) -> Vec<String> {
    let (next, found) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(2, usize::from) {
            scope.spawn(|| {
                while let Some(one) = all.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let fault = fault(one);
                    found.lock().unwrap_or_else(PoisonError::into_inner).extend(fault);
                }
            });
        }
    });
    found.into_inner().unwrap_or_else(PoisonError::into_inner)
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
