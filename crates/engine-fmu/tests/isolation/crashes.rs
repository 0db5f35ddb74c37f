//! Ends of an FMU by itself, and calls that do not return.
use super::*;

#[test]
fn crashes_are_reported_with_signal_or_exit_code() {
    for (bad, says) in [
        (Bad::NullWrite, "signal 11 (SIGSEGV"),
        (Bad::Abort, "signal 6 (SIGABRT"),
        (Bad::Signal(libc::SIGFPE), "signal 8 (SIGFPE"),
        (Bad::Signal(libc::SIGKILL), "signal 9 (SIGKILL"),
        (Bad::StackOverflow, "signal 6 (SIGABRT"),
        (Bad::Exit(0), "exit code 0"),
        (Bad::Exit(3), "exit code 3"),
        (Bad::Panic, "exit code 101"),
        (Bad::ExitInThread, "exit code 5"),
        (Bad::HandleSignals, "exit code 77"),
    ] {
        let how = crash_of_step(&bad, Bounds::default());
        assert!(how.starts_with(says), "{bad:?}: {how}");
    }
}

#[test]
fn what_it_wrote_last_is_in_the_report() {
    let last = |bad| crash_of_step(&bad, Bounds::default());
    assert!(last(Bad::Abort).contains("its last words: solver: the Jacobian is singular"));
    assert!(last(Bad::Panic).contains("index out of bounds, as it were"));
    assert!(last(Bad::StackOverflow).contains("overflowed its stack"));
}

#[test]
fn what_it_logged_before_a_crash_is_not_lost() {
    let mut slave = start(&Bad::LogThenCrash, Bounds::default()).unwrap();
    slave.step(0.0, 0.1, &[[0.0; 3]]).unwrap();
    assert!(matches!(slave.step(0.1, 0.1, &[[0.0; 3]]), Err(SlaveError::Crashed { time: 0.1, .. })));
    assert!(slave.take_log().iter().any(|line| line.message == "stiff"));
}

#[test]
fn a_crash_or_a_hang_in_loading_is_one_too() {
    let crashed = start(&Bad::CrashInLoading, Bounds::default()).unwrap_err();
    let IsolationError::Slave(SlaveError::Crashed { how, .. }) = crashed else { panic!("{crashed}") };
    assert!(how.starts_with("signal 11"), "{how}");
    let hung = start(&Bad::HangInLoading, impatient()).unwrap_err();
    assert_eq!(
        hung.to_string(),
        "the FMU did not come back from loading and initialisation at 0 s within 1 s of real time; it was ended"
    );
}

#[test]
fn one_that_does_not_come_back_is_ended() {
    for bad in [Bad::Loop, Bad::Stop] {
        let error = error_of_step(&bad, impatient());
        assert_eq!(error, SlaveError::Hung { call: "its step".into(), time: 0.5, call_timeout: 1.0 }, "{bad:?}");
    }
}

#[test]
fn one_that_does_not_end_is_ended() {
    let mut slave = start(&Bad::HangInEnd, impatient()).unwrap();
    slave.step(0.0, 0.1, &[[0.0; 3]]).unwrap();
    drop(slave);
}

/// Whatever it writes, nothing is read out of bounds, and a doorbell that was rung and overwritten is not waited for.
#[test]
fn one_that_writes_over_what_is_shared_is_found_out() {
    for byte in [0x00, 0x01, 0x04, 0x7f, 0xff] {
        let mut slave = start(&Bad::Overwrite(byte), Bounds::default()).unwrap();
        let error = slave.step(0.5, 0.1, &[[0.0; 3]]).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the FMU's process ended at 0.5 s: it wrote over the memory through which it is spoken to",
            "{byte}"
        );
        assert!(slave.take_log().len() < 1000, "what is left of the log can be asked for");
    }
}

#[test]
fn one_that_closes_all_files_or_reads_input_goes_on() {
    let mut slave = start(&Bad::CloseFiles, Bounds::default()).unwrap();
    for k in 0..3 {
        slave.step(f64::from(k), 1.0, &[[1.0, 0.0, 0.0]]).unwrap();
    }
    let mut outputs = [0.0; 2];
    slave.read(None, &mut outputs).unwrap();
    assert_eq!(outputs.map(f64::to_bits), [3.0_f64.to_bits(); 2]);
    let mut slave = start(&Bad::ReadInput, Bounds::default()).unwrap();
    slave.step(0.0, 0.1, &[[0.0; 3]]).unwrap();
    assert!(slave.take_log().iter().any(|line| line.message == "0 bytes on standard input"));
}

/// The twin lacks the memory for answers, and ends as soon as it can; otherwise its sum would be received, or it would be waited for
/// without end.
#[test]
fn a_forked_twin_does_not_answer() {
    let mut slave = start(&Bad::ForkTwin, Bounds::default()).unwrap();
    for k in 0..3 {
        slave.step(f64::from(k), 1.0, &[[1.0, 0.0, 0.0]]).unwrap();
    }
    let mut outputs = [0.0; 2];
    slave.read(None, &mut outputs).unwrap();
    assert_eq!(outputs.map(f64::to_bits), [3.0_f64.to_bits(); 2]);
}

#[test]
fn a_program_that_is_no_host_is_reported() {
    let command = HostCommand { program: "/no/such/program".into(), args: Vec::new(), env: Vec::new() };
    let error = Isolated::start(&command, &Bad::Nothing, WIRES, Bounds::default()).unwrap_err();
    assert!(error.to_string().starts_with("cannot start the process of the FMU, `/no/such/program`: "), "{error}");
    let args = vec!["-c".into(), "echo $SAYS >&2; exit 2".into()];
    let command = HostCommand { program: "/bin/sh".into(), args, env: vec![("SAYS".into(), "what?".into())] };
    let error = Isolated::start(&command, &Bad::Nothing, WIRES, Bounds::default()).unwrap_err();
    let how = "exit code 2; its last words: what?".to_owned();
    assert!(matches!(&error, IsolationError::Slave(SlaveError::Crashed { how: is, .. }) if *is == how), "{error}");
}
