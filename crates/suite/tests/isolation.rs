//! What goes wrong in one run stays there: a panic, a worker that is killed, hangs or speaks nonsense.
use servobench_plant::{BodyState, Engine, EngineName, Input, Mechanics, MechanicsError, MechanicsSetup};
use servobench_suite::{
    AtATime, Broken, Engines, Job, RunError, Source, WorkerCommand, WorkerError, execute, jobs, map_in_parallel,
};
use std::path::Path;
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

/// `exact` works, `rapier` panics, `mujoco` is isolated: what runs there is the worker's program.
const ENGINES: Engines = Engines {
    installed: &[&servobench_plant::Exact, &PanickingEngine(EngineName::Rapier), &PanickingEngine(EngineName::Mujoco)],
    ..Engines::NONE
};

fn slide(engines: &[EngineName]) -> Vec<Job> {
    let scenario = servobench_scenario::parse("slide", SLIDE, None).unwrap_or_else(|error| panic!("{error}")).scenario;
    jobs(vec![Source { scenario, text: SLIDE.into() }], engines)
}

fn worker(program: &Path, folder: &Path) -> WorkerCommand {
    WorkerCommand { program: program.to_owned(), folder: folder.to_owned(), timeout: Duration::from_mins(1) }
}

#[test]
fn an_engine_that_panics_costs_its_run_only() {
    let folder = tempfile::tempdir().unwrap();
    let worker = worker(Path::new("none"), folder.path());
    let jobs = slide(&[EngineName::Exact, EngineName::Rapier, EngineName::Exact]);
    let limit = AtATime { jobs: 2, memory: u64::MAX };
    let reports = map_in_parallel(&jobs, limit, Job::memory, |job| execute(job, &ENGINES, &worker, &mut |_| {}));
    for k in [0, 2] {
        let run = reports[k].as_ref().unwrap().as_ref().unwrap();
        assert!(run.verdict.passed() && run.recording.len() == 101);
    }
    assert_eq!(reports[1].as_ref().unwrap_err().words, "tick 50 is too much");
}

#[cfg(unix)]
mod stub {
    use super::*;

    /// What comes of a worker that does as this shell script says.
    fn broken_by(script: &str, timeout: Duration) -> Box<Broken> {
        let folder = tempfile::tempdir().unwrap();
        let program = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/stub/worker.sh");
        let command = WorkerCommand { timeout, ..worker(&program, folder.path()) };
        let mut job = slide(&[EngineName::Mujoco]).remove(0);
        job.text = script.into();
        let broken = execute(&job, &ENGINES, &command, &mut |_| {}).unwrap_err();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "nothing stays behind");
        assert!(broken.until_then.is_none());
        broken
    }

    fn error_of(script: &str) -> RunError {
        broken_by(script, Duration::from_mins(1)).error
    }

    #[test]
    fn a_worker_that_is_killed_is_reported_with_what_it_wrote_last() {
        let error = error_of("echo 'mj_step: stack overflow' >&2; kill -9 $$");
        assert!(matches!(error, RunError::Worker(WorkerError::Ended { .. })) && !error.is_input());
        let said = error.to_string();
        assert!(said.contains("signal: 9") && said.ends_with("its last words: mj_step: stack overflow"), "{said}");
    }

    /// A pause of a tenth of a second is too long; the worker would sleep for an hour.
    #[test]
    fn a_worker_that_hangs_is_ended() {
        for hanging in ["exec sleep 3600", "echo '{\"progress\":0.5}'; exec sleep 3600", "exec >&-; exec sleep 3600"] {
            let error = broken_by(hanging, Duration::from_millis(100)).error;
            assert!(matches!(error, RunError::Worker(WorkerError::Stalled { .. })), "{hanging}: {error}");
            assert!(error.to_string().contains("no progress for 0.1 s"), "{error}");
        }
    }

    /// The reason is what the worker says of itself; warnings and colours on standard error are not part of it.
    #[test]
    fn the_reason_is_the_workers_last_word_alone() {
        let error = error_of(
            "echo 'a warning' >&2; echo 'the library speaks'; echo '{\"end\":{\"failed\":\"at 0.1 s: too far\"}}'; exit 3",
        );
        assert!(matches!(&error, RunError::Worker(WorkerError::Failed(why)) if why == "at 0.1 s: too far"), "{error}");
        assert_eq!(error.to_string(), "at 0.1 s: too far");
        let error = error_of("echo '{\"end\":{\"input\":\"no joint `x`\"}}'; exit 2");
        assert!(error.is_input() && error.to_string() == "no joint `x`", "{error}");
    }

    #[test]
    fn done_without_a_recording_is_not_done() {
        let error = error_of("echo '{\"end\":\"done\"}'");
        assert!(matches!(error, RunError::Worker(WorkerError::Recording(_))), "{error}");
    }

    #[test]
    fn a_program_that_is_not_there_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let command = worker(Path::new("/no/such/program"), folder.path());
        let broken = execute(&slide(&[EngineName::Mujoco])[0], &ENGINES, &command, &mut |_| {}).unwrap_err();
        let said = broken.error.to_string();
        assert!(said.starts_with("cannot start the worker `/no/such/program`: "), "{said}");
    }
}
