//! Failures stay within their run: a panic, a worker that crashes, hangs, takes all memory or sends nonsense.
#![cfg(target_os = "linux")]
mod native;
mod served;
mod stub;

use native::Native;
use servobench::size::memory;
use servobench::{Engines, Run};
use servobench_plant::{BodyState, Engine, EngineName, Input, Mechanics, MechanicsError, MechanicsSetup};
use servobench_scenario::TimeBound;
use servobench_suite::{
    AtATime, Broken, Job, RunError, RunLimits, Source, WorkerCommand, WorkerError, Workers, execute, jobs,
    map_in_parallel,
};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::time::Duration;

const SLIDE: &str = r#"
[run]
base_rate = "1 kHz"
duration = "0.1 s"
[axis]
motion = "linear"
[axis.motor_side]
mass = "20 kg"
[motor]
kind = "ideal-source"
[drive.velocity]
rate = "1 kHz"
bandwidth = "20 Hz"
[drive.position]
rate = "1 kHz"
gain = "20 1/s"
"#;

/// Moves nothing, and panics at its 50th tick.
struct Panicking(u32);

impl Mechanics for Panicking {
    fn bodies(&self) -> &[BodyState] {
        &[BodyState { position: 0.0, velocity: 0.0 }]
    }

    fn advance(&mut self, _: &Input) -> Result<(), MechanicsError> {
        self.0 += 1;
        assert!(self.0 < 50, "tick {} is too much", self.0);
        Ok(())
    }
}

struct PanickingEngine(EngineName);

impl Engine for PanickingEngine {
    fn name(&self) -> EngineName {
        self.0
    }

    fn build(&self, _: &MechanicsSetup) -> Result<Box<dyn Mechanics>, MechanicsError> {
        Ok(Box::new(Panicking(0)))
    }
}

/// `exact` works, `rapier` panics, `mujoco` has faults of native code, in a worker.
const ENGINES: Engines =
    Engines { installed: &[&servobench_plant::Exact, &PanickingEngine(EngineName::Rapier), &Native], ..Engines::NONE };

fn slide(engines: &[EngineName]) -> Vec<Job> {
    job_of("slide", SLIDE, engines)
}

fn job_of(name: &str, text: &str, engines: &[EngineName]) -> Vec<Job> {
    let mut scenario = servobench_scenario::parse(name, text, None).unwrap_or_else(|error| panic!("{error}")).scenario;
    scenario.name = name.into();
    jobs(vec![Source { scenario, text: text.into() }], engines)
}

const GENEROUS: RunLimits = RunLimits { time: None, memory: u64::MAX };

/// A folder with the program of a worker, which is this shell script, and workers of it.
fn workers_of(script: &str, timeout: Duration, limits: RunLimits) -> (tempfile::TempDir, Workers) {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("worker.sh");
    fs::write(&program, format!("#!/bin/sh\n{script}\n")).unwrap();
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    let command = WorkerCommand { program, folder: folder.path().to_owned(), timeout, limits };
    (folder, Workers::new(command))
}

/// Failure of a job that ends without a verdict; nothing stays in the folder.
fn broken_in((folder, workers): &(tempfile::TempDir, Workers), job: &Job) -> Box<Broken> {
    let broken = execute(job, &ENGINES, workers, &mut |_| {}).unwrap_err();
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing but the program is there");
    broken
}

#[test]
fn an_engine_that_panics_costs_its_run_only() {
    let jobs = slide(&[EngineName::Exact, EngineName::Rapier, EngineName::Exact]);
    let limit = AtATime { jobs: 2, memory: u64::MAX };
    let workers = Workers::none();
    let reports = map_in_parallel(
        &jobs,
        limit,
        |job| ((), memory(&job.scenario)),
        |job, ()| execute(job, &ENGINES, &workers, &mut |_| {}),
    );
    for k in [0, 2] {
        let run = reports[k].as_ref().unwrap().as_ref().unwrap();
        assert!(run.verdict.passed() && run.recording.len() == 101);
    }
    assert_eq!(reports[1].as_ref().unwrap_err().words, "tick 50 is too much");
}

#[test]
fn a_recording_that_is_too_large_is_refused_at_the_door() {
    let (_folder, workers) = workers_of("", Duration::from_mins(1), RunLimits { memory: 10_000, ..GENEROUS });
    let broken = execute(&slide(&[EngineName::Exact])[0], &ENGINES, &workers, &mut |_| {}).unwrap_err();
    let RunError::Memory { need, limit: 10_000 } = broken.error else { panic!("{}", broken.error) };
    assert!((101 * 8..100_000).contains(&need) && need > 10_000, "{need}");
    let said = broken.error.to_string();
    assert!(said.contains("the limit is 10 kB") && said.contains("`--memory-limit`"), "{said}");
}

/// In this process a run is stopped between two ticks.
#[test]
fn a_limit_of_time_holds_without_a_worker_too() {
    let endless = SLIDE.replace("0.1 s", "1e6 s") + "[record]\nrate = \"1 Hz\"\n";
    let run = |text: &str, time| {
        let (_folder, workers) = workers_of("", Duration::from_mins(1), RunLimits { time, ..GENEROUS });
        execute(&job_of("endless", text, &[EngineName::Exact])[0], &ENGINES, &workers, &mut |_| {}).unwrap_err()
    };
    let own = endless.replacen("[axis]", "time_limit = \"50 ms\"\n[axis]", 1);
    let longer = Some(TimeBound::AtMost(3600.0));
    for broken in [run(&endless, Some(TimeBound::AtMost(0.05))), run(&own, None), run(&own, longer)] {
        let RunError::TimeLimit { limit, reached, length, .. } = broken.error else { panic!("{}", broken.error) };
        assert_eq!((limit, length), (Duration::from_millis(50), 1e6));
        assert!((0.0..1e6).contains(&reached), "{reached}");
        let said = broken.error.to_string();
        assert!(
            said.starts_with("its limit of time, 0.05 s, was reached at ") && said.contains("`--time-limit`"),
            "{said}"
        );
        assert!(!broken.error.is_input() && broken.until_then.is_some());
    }
}
