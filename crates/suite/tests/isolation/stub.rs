//! Fake workers: a shell script that sends messages a worker could send. Standard input is the socket; the script is not contained.
use super::*;

fn broken_by(script: &str, timeout: Duration) -> Box<Broken> {
    let broken = broken_in(&workers_of(script, timeout, GENEROUS), &slide(&[EngineName::Mujoco])[0]);
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
    assert!(
        said.contains("signal 9 (SIGKILL: ") && said.ends_with("its last words: mj_step: stack overflow"),
        "{said}"
    );
}

/// A pause of a tenth of a second is too long; the worker would sleep for an hour.
#[test]
fn a_worker_that_hangs_is_ended() {
    let hang = "exec sleep 3600";
    for hanging in [hang.to_owned(), format!("echo '{{\"progress\":0.5}}' >&0; {hang}"), format!("exec <&-; {hang}")] {
        let error = broken_by(&hanging, Duration::from_millis(100)).error;
        assert!(matches!(error, RunError::Worker(WorkerError::Stalled { .. })), "{hanging}: {error}");
        assert!(error.to_string().contains("no progress for 0.1 s"), "{error}");
    }
}

/// The reason is the worker's own report; warnings and colours on standard error are not part of it.
#[test]
fn the_reason_is_the_workers_last_word_alone() {
    let error = error_of(
        "echo 'a warning' >&2; read -r order; echo 'the library speaks' >&0; \
         echo '{\"end\":{\"failed\":\"at 0.1 s: too far\"}}' >&0; exit 3",
    );
    assert!(matches!(&error, RunError::Worker(WorkerError::Failed(why)) if why == "at 0.1 s: too far"), "{error}");
    assert_eq!(error.to_string(), "at 0.1 s: too far");
    let error = error_of("read -r order; echo '{\"end\":{\"input\":\"no joint `x`\"}}' >&0; exit 2");
    assert!(error.is_input() && error.to_string() == "no joint `x`", "{error}");
}

#[test]
fn done_without_a_recording_is_not_done() {
    for left in ["", "echo nonsense; "] {
        let error = error_of(&format!("read -r order; {left}echo '{{\"end\":\"done\"}}' >&0"));
        assert!(matches!(error, RunError::Worker(WorkerError::Recording(_))), "{error}");
    }
}

#[test]
fn a_program_that_is_not_there_is_named() {
    let (folder, _) = workers_of("", Duration::from_mins(1), GENEROUS);
    let (program, folder) = ("/no/such/program".into(), folder.path().to_owned());
    let workers = Workers::new(WorkerCommand { program, folder, timeout: Duration::from_mins(1), limits: GENEROUS });
    let broken = execute(&slide(&[EngineName::Mujoco])[0], &ENGINES, &workers, &mut |_| {}).unwrap_err();
    let said = broken.error.to_string();
    assert!(said.starts_with("cannot start the worker `/no/such/program`: "), "{said}");
}
