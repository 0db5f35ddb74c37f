//! A well-behaved FMU gives the same results as without isolation.
use super::*;
use servobench_fmi::{LogLine, Severity, StepEnd};

/// Outputs of a fixed sequence of calls.
fn life(slave: &mut dyn Slave) -> Vec<f64> {
    let (mut seen, mut outputs) = (Vec::new(), [0.0; 2]);
    let mut note = |outputs: &[f64; 2]| seen.extend(outputs);
    slave.read(None, &mut outputs).unwrap();
    note(&outputs);
    for k in 0..20 {
        let time = f64::from(k) * 0.1;
        assert_eq!(slave.step(time, 0.1, &[[0.3 * time, 0.01, -0.0]]), Ok(StepEnd::Done));
        slave.read(None, &mut outputs).unwrap();
        note(&outputs);
        slave.read(Some(&[0.7]), &mut outputs).unwrap();
        note(&outputs);
        slave.read(None, &mut outputs).unwrap();
        note(&outputs);
        match k {
            5 => slave.save().unwrap(),
            10 | 15 => slave.restore().unwrap(),
            _ => {}
        }
        slave.read(None, &mut outputs).unwrap();
        note(&outputs);
    }
    seen
}

/// To the bit: numbers are passed on unchanged.
#[test]
fn every_number_is_the_same_as_in_one_process() {
    let mut here = Bad::Nothing.load().unwrap();
    let mut there = start(&Bad::Nothing, Bounds::default()).unwrap();
    assert_eq!(here.capabilities(), there.capabilities());
    let (here, there) = (life(here.as_mut()), life(&mut there));
    assert!(here.iter().zip(&there).all(|(here, there)| here.to_bits() == there.to_bits()), "{here:?} {there:?}");
}

#[test]
fn a_step_that_ends_early_says_where() {
    let mut slave = start(&Bad::Early, Bounds::default()).unwrap();
    assert_eq!(slave.step(1.0, 0.2, &[[0.0; 3]]), Ok(StepEnd::Until(1.0 + 0.2 / 4.0)));
    assert_eq!(slave.step(1.05, 0.15, &[[0.0; 3]]), Ok(StepEnd::Terminated(1.05 + 0.15 / 2.0)));
}

#[test]
fn one_that_discards_a_step_goes_on() {
    let mut slave = start(&Bad::Discards, Bounds::default()).unwrap();
    for _ in 0..3 {
        assert_eq!(slave.step(0.0, 0.1, &[[0.0; 3]]), Ok(StepEnd::Done));
        let discarded = slave.step(0.1, 0.1, &[[0.0; 3]]);
        assert_eq!(discarded, Err(SlaveError::Discarded { call: "fmi3DoStep".into(), time: 0.1, shortest: None }));
    }
}

#[test]
fn what_it_fails_with_is_said_and_not_without_end() {
    let error = error_of_step(&Bad::Fails, Bounds::default());
    let SlaveError::Failed { call, time: 0.5, status, message } = error else { panic!("{error}") };
    assert_eq!((&*call, &*status), ("fmi3DoStep", "fmi3Error"));
    assert!(message.ends_with("x … (92000 bytes more)"));
}

/// The outputs are read with the step; an error in that is reported when they are requested.
#[test]
fn an_output_that_is_not_a_number_is_said_when_it_is_read() {
    let mut slave = start(&Bad::NaN, Bounds::default()).unwrap();
    assert_eq!(slave.step(0.0, 0.1, &[[0.0; 3]]), Ok(StepEnd::Done));
    let error = slave.read(None, &mut [0.0; 2]).unwrap_err();
    assert_eq!(error.to_string(), "the FMU's output `x` is NaN at 0.1 s");
}

#[test]
fn a_state_that_was_not_saved_is_not_restored() {
    let mut slave = start(&Bad::Nothing, Bounds::default()).unwrap();
    let restored = slave.restore();
    assert!(matches!(restored, Err(SlaveError::Unable { capability, .. }) if capability == "canGetAndSetFMUState"));
}

#[test]
fn what_it_logs_arrives_in_order_and_once() {
    let mut slave = start(&Bad::Log(3), Bounds::default()).unwrap();
    slave.take_log();
    slave.step(0.7, 0.1, &[[0.0; 3]]).unwrap();
    let line = |k| LogLine {
        time: 0.7,
        severity: Severity::Warning,
        category: "logStatusWarning".into(),
        message: format!("line {k}"),
    };
    assert_eq!(slave.take_log(), [line(0), line(1), line(2)]);
    assert_eq!(slave.take_log(), []);
}

#[test]
fn why_it_cannot_be_loaded_is_what_the_loader_says() {
    let error = start(&Bad::Refused("no binaries/x86_64-linux".into()), Bounds::default()).unwrap_err();
    assert!(matches!(error, IsolationError::Refused(_)));
    assert_eq!(error.to_string(), "no binaries/x86_64-linux");
}

#[test]
fn many_live_side_by_side_and_go_from_thread_to_thread() {
    let slaves: Vec<_> =
        std::thread::spawn(|| (0..8).map(|_| start(&Bad::Nothing, Bounds::default()).unwrap()).collect::<Vec<_>>())
            .join()
            .unwrap();
    let mut here = Bad::Nothing.load().unwrap();
    let expected = life(here.as_mut());
    let lives: Vec<_> = slaves.into_iter().map(|mut slave| std::thread::spawn(move || life(&mut slave))).collect();
    for life in lives {
        assert_eq!(life.join().unwrap(), expected);
    }
}
