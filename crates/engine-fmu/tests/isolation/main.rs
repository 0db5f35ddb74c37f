//! Failures of an isolated FMU stay in its process, and are reported with their cause.
//!
//! The FMUs of these tests are slaves in Rust that do on purpose what native code does by mistake. Time limits are in real time: a minute
//! where nothing should take long, so that no slow machine fails, and a second where something hangs for good. No test measures time.
mod allocation;
mod bad;
mod crashes;
mod endings;
mod floods;
mod same;
mod sharing;

use bad::Bad;
use servobench_engine_fmu::{HostCommand, HostError, Isolated, IsolationError, Wires, serve};
use servobench_fmi::{Bounds, Severity, Slave, SlaveError};
use std::time::Duration;

/// Not a test: the process that the other tests start.
#[test]
#[ignore = "the process that the other tests start"]
fn host() {
    // The process that serves is forked from this thread: only it can report a panic.
    let served = std::panic::catch_unwind(|| serve(|bad: Bad| bad.load()));
    match served.unwrap_or_else(|_| std::process::exit(101)) {
        // A run of all ignored tests.
        Ok(()) | Err(HostError::NoPage) => {}
        Err(error) => panic!("{error}"),
    }
}

fn host_command() -> HostCommand {
    let args = ["--exact", "host", "--ignored", "--nocapture"];
    HostCommand { program: std::env::current_exe().unwrap(), args: args.map(Into::into).to_vec(), env: Vec::new() }
}

const WIRES: Wires = Wires { inputs: 1, outputs: 2 };

/// An FMU of one input and two outputs that behaves as `bad`.
fn start(bad: &Bad, bounds: Bounds) -> Result<Isolated, IsolationError> {
    Isolated::start(&host_command(), bad, WIRES, bounds)
}

fn impatient() -> Bounds {
    Bounds { call_timeout: Duration::from_secs(1), ..Bounds::default() }
}

/// The error of a step from 0.5 s.
fn error_of_step(bad: &Bad, bounds: Bounds) -> SlaveError {
    let mut slave = start(bad, bounds).unwrap_or_else(|error| panic!("{bad:?}: {error}"));
    let error = slave.step(0.5, 0.1, &[[0.0; 3]]).unwrap_err();
    assert_eq!(slave.step(0.6, 0.1, &[[0.0; 3]]), Err(error.clone()), "it stays so");
    error
}

/// The cause of a crash in a step from 0.5 s.
fn crash_of_step(bad: &Bad, bounds: Bounds) -> String {
    match error_of_step(bad, bounds) {
        SlaveError::Crashed { time: 0.5, how, .. } => how,
        other => panic!("{bad:?}: {other}"),
    }
}
