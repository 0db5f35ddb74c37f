//! FMI 2.0. `two.c` solves y' = u with the derivatives that it is given.
use super::{Room, compiled, messages, port, setup, text};
use servobench_fmi::{Loaded, Setup, Severity, Slave, SlaveError, StepEnd, Value};
use std::fs;

const DESCRIPTION: &str = include_str!("two.xml");

fn room() -> Room {
    Room::new("two", &compiled("two"), DESCRIPTION)
}

fn loaded(mode: &str, outputs: &[&str]) -> Loaded {
    room().load(&setup(&[("mode", text(mode))], &["u"], outputs)).unwrap()
}

#[test]
fn calls_come_in_the_order_of_the_standard() {
    let room = room();
    let path = room.notes();
    let setup = Setup {
        tolerance: Some(1e-4),
        start_time: 0.5,
        stop_time: Some(2.0),
        logging: true,
        ..setup(&[("path", text(path.to_str().unwrap()))], &["u"], &["y"])
    };
    let mut slave = room.load(&setup).unwrap();
    let calls = [
        "instantiate, logging of it at 0, 0",
        "setup 1 0.0001 0.5 1 2",
        "enter initialization of it at 0, 0",
        "exit initialization of it at 0, 0",
    ];
    assert_eq!(messages(&mut slave), calls, "format and arguments of the variadic logger");
    slave.save().unwrap();
    drop(slave);
    assert_eq!(fs::read_to_string(&path).unwrap(), "free state\nterminate\nfree\n");
}

#[test]
fn without_tolerance_and_end_it_says_so() {
    let mut slave = room().load(&setup(&[], &[], &[])).unwrap();
    assert_eq!(messages(&mut slave)[1], "setup 0 0 0 0 0");
}

/// Oracle: an input u + u'·t + u''·t²/2 over a step of 0.1 s has the integral u·h + u'·h²/2 + u''·h³/6, whether the FMU gets its mean or
/// its derivatives.
#[test]
fn inputs_over_a_step_have_the_right_integral() {
    let (input, h) = ([2.0, 3.0, 5.0], 0.1_f64);
    let exact = 2.0 * h + 3.0 * h * h / 2.0 + 5.0 * h * h * h / 6.0;
    for takes_derivatives in [false, true] {
        let description = DESCRIPTION
            .replace("canInterpolateInputs=\"false\"", &format!("canInterpolateInputs=\"{takes_derivatives}\""));
        let room = Room::new("two", &compiled("two"), &description);
        let mut slave = room.load(&setup(&[], &["u"], &["y", "u", "du", "ddu"])).unwrap();
        assert_eq!(slave.capabilities().interpolates_inputs, takes_derivatives);
        assert_eq!(slave.step(0.0, h, &[input]).unwrap(), StepEnd::Done);
        let mut read = [0.0; 4];
        slave.read(None, &mut read).unwrap();
        // Some roundings of numbers below 1.
        assert!((read[0] - exact).abs() < 1e-15, "{read:?}");
        assert_eq!(read[2..], if takes_derivatives { [3.0, 5.0] } else { [0.0, 0.0] });
    }
}

#[test]
fn a_saved_state_comes_back_as_often_as_wanted() {
    let mut slave = loaded("normal", &["y", "steps"]);
    let mut read = [0.0; 2];
    slave.step(0.0, 0.1, &[[1.0, 0.0, 0.0]]).unwrap();
    slave.save().unwrap();
    for _ in 0..2 {
        slave.step(0.1, 0.1, &[[5.0, 0.0, 0.0]]).unwrap();
        slave.restore().unwrap();
        slave.read(None, &mut read).unwrap();
        assert_eq!(read, [0.1, 1.0]);
    }
    let error = loaded("normal", &[]).restore().unwrap_err();
    assert!(matches!(error, SlaveError::Unable { .. }), "{error}");
}

#[test]
fn what_is_discarded_says_how_far_it_came() {
    let without = |capability: &str| DESCRIPTION.replace(&format!("{capability}=\"true\""), "");
    let descriptions =
        [DESCRIPTION, &without("canGetAndSetFMUstate"), &without("canHandleVariableCommunicationStepSize")];
    for (description, shortest) in descriptions.into_iter().zip([Some(0.125 / 1024.0), None, None]) {
        let room = Room::new("two", &compiled("two"), description);
        let load = |mode| room.load(&setup(&[("mode", text(mode))], &["u"], &[])).unwrap();
        let step = |mode| load(mode).step(1.0, 0.125, &[[0.0; 3]]);
        assert_eq!(step("refuse"), Err(SlaveError::Discarded { call: "fmi2DoStep".into(), time: 1.0, shortest }));
        assert_eq!(step("half"), Ok(StepEnd::Until(1.0625)));
        assert_eq!(step("end"), Ok(StepEnd::Terminated(1.03125)));
    }
    let mut slave = loaded("refuse", &["steps"]);
    slave.step(1.0, 0.1, &[[0.0; 3]]).unwrap_err();
    slave.read(None, &mut [0.0]).expect("it goes on");
}

/// An FMU that discards steps longer than 0.3 s, or beyond it.
fn discarding(mode: &str, outputs: &[&str]) -> Loaded {
    room().load(&setup(&[("mode", text(mode)), ("longest", Value::Number(0.3))], &["u"], outputs)).unwrap()
}

/// The input over a step of 1 s and the integral of 2 + 3·t + 4·t² up to `t`.
const INPUT: [f64; 3] = [2.0, 3.0, 8.0];
fn integral(t: f64) -> f64 {
    2.0 * t + 3.0 * t * t / 2.0 + 4.0 * t * t * t / 3.0
}

/// `two.c` leaves nonsense after a discarded step and fails if it is not taken back then.
#[test]
fn a_step_that_is_discarded_is_taken_in_halves() {
    let mut slave = discarding("coarse", &["y", "steps"]);
    let mut read = [0.0; 2];
    assert_eq!(slave.step(0.0, 1.0, &[INPUT]), Ok(StepEnd::Done));
    slave.read(None, &mut read).unwrap();
    assert_eq!(read[1], 4.0, "quarters");
    // The mean over each part is that of the parabola; four additions of numbers below 8.
    assert!((read[0] - integral(1.0)).abs() < 1e-14, "{read:?}");
}

#[test]
fn a_step_goes_to_where_the_fmu_says_that_it_comes() {
    let mut slave = discarding("telling", &["y", "steps"]);
    let mut read = [0.0; 2];
    assert_eq!(slave.step(0.0, 1.0, &[INPUT]), Ok(StepEnd::Until(0.3)));
    slave.read(None, &mut read).unwrap();
    assert_eq!(read[1], 1.0);
    assert!((read[0] - integral(0.3)).abs() < 1e-15, "{read:?}");
}

/// 614/1024 is the last part before 0.6.
#[test]
fn where_no_part_is_short_enough_it_says_how_far_it_came() {
    let start = [("mode", text("wall")), ("longest", Value::Number(0.6))];
    let mut slave = room().load(&setup(&start, &["u"], &["y"])).unwrap();
    let (time, shortest) = (614.0 / 1024.0, Some(1.0 / 1024.0));
    let error = slave.step(0.0, 1.0, &[INPUT]).unwrap_err();
    assert_eq!(error, SlaveError::Discarded { call: "fmi2DoStep".into(), time, shortest });
    let said = "the FMU discarded fmi2DoStep at 0.599609375 s, over 0.0009765625 s as over all longer steps";
    assert_eq!(error.to_string(), said);
    let mut read = [0.0];
    slave.read(None, &mut read).unwrap();
    assert!((read[0] - integral(time)).abs() < 1e-14, "{read:?}");
}

/// The state of an FMU is saved once in 64 steps; in `two.c` it holds the input and the sum.
#[test]
fn what_came_before_a_step_that_is_discarded_comes_again() {
    let mut slave = discarding("coarse", &["y", "u", "steps"]);
    let mut read = [0.0; 3];
    for step in 0..100 {
        let (time, input) = (f64::from(step) * 0.25, f64::from(step));
        slave.step(time, 0.25, &[[input, 0.0, 0.0]]).unwrap();
        slave.read(Some(&[-input]), &mut read).unwrap();
        assert_eq!(read[1], -input);
    }
    assert_eq!(slave.step(25.0, 1.0, &[[100.0, 0.0, 0.0]]), Ok(StepEnd::Done));
    slave.read(None, &mut read).unwrap();
    assert_eq!(read, [0.25 * 99.0 * 50.0 + 100.0, 100.0, 104.0]);
    for reading in 0..200 {
        slave.read(Some(&[f64::from(reading)]), &mut read).unwrap();
    }
    assert_eq!(slave.step(26.0, 1.0, &[[1.0, 0.0, 0.0]]), Ok(StepEnd::Done), "more calls than are kept");
}

#[test]
fn a_state_that_was_saved_stays_over_steps_in_parts() {
    let mut slave = discarding("coarse", &["y", "steps"]);
    let mut read = [0.0; 2];
    slave.step(0.0, 0.25, &[INPUT]).unwrap();
    slave.save().unwrap();
    for _ in 0..2 {
        slave.step(0.25, 1.0, &[INPUT]).unwrap();
        slave.step(1.25, 1.0, &[INPUT]).unwrap();
        slave.read(None, &mut read).unwrap();
        assert_eq!(read[1], 9.0);
        slave.restore().unwrap();
        slave.read(None, &mut read).unwrap();
        assert_eq!(read, [integral(0.25), 1.0]);
    }
}

#[test]
fn failures_have_the_status_and_what_was_logged_last() {
    for (mode, status, message) in [
        ("fail", "fmi2Error", "no root at 100%"),
        ("die", "fmi2Fatal", "exit initialization of it at 0, 0"),
        ("asynchronous", "fmi2Pending", "exit initialization of it at 0, 0"),
        ("unknown", "no status of FMI 2.0", "exit initialization of it at 0, 0"),
    ] {
        let error = loaded(mode, &[]).step(1.0, 0.1, &[[0.0; 3]]).unwrap_err();
        let message = message.to_owned();
        assert_eq!(
            error,
            SlaveError::Failed { call: "fmi2DoStep".into(), time: 1.0, status: status.into(), message },
            "{mode}"
        );
    }
    let room = room();
    let error = room.load(&setup(&[("mode", text("fail early"))], &[], &[])).unwrap_err();
    let expected = "the FMU `/two.fmu` cannot be initialised: the FMU failed in fmi2ExitInitializationMode at 0 s (fmi2Error): exit";
    assert!(room.said(&error).starts_with(expected), "{}", room.said(&error));
}

/// FMI 2.0.5, §2.1.3: after an error the instance may only be freed; after a fatal one, nothing may be called.
#[test]
fn what_has_failed_is_not_terminated_and_what_is_dead_not_freed() {
    for (mode, notes) in [("fail", "free state\nfree\n"), ("die", "")] {
        let room = room();
        let path = room.notes();
        let start = [("mode", text(mode)), ("path", text(path.to_str().unwrap()))];
        let mut slave = room.load(&setup(&start, &[], &[])).unwrap();
        slave.step(0.0, 0.1, &[]).unwrap_err();
        drop(slave);
        assert_eq!(fs::read_to_string(&path).unwrap_or_default(), notes, "{mode}");
    }
}

#[test]
fn what_is_no_number_is_refused_in_both_directions() {
    let mut slave = loaded("not a number", &["y"]);
    slave.read(None, &mut [0.0]).unwrap();
    slave.step(0.0, 0.1, &[[0.0; 3]]).unwrap();
    let error = slave.read(None, &mut [0.0]).unwrap_err();
    assert!(
        matches!(&error, SlaveError::NotFinite { variable, time, .. } if variable == "y" && *time == 0.1),
        "{error}"
    );
    let error = loaded("normal", &[]).step(0.0, 0.1, &[[f64::NAN, 0.0, 0.0]]).unwrap_err();
    assert!(
        matches!(&error, SlaveError::Value { variable, bound, .. } if variable == "u" && bound == "finite numbers"),
        "{error}"
    );
}

/// `y` depends on `u` alone; `double` is another name of it. Dependencies do not list parameters.
#[test]
fn variables_of_one_value_reference_feed_through_alike() {
    let description = DESCRIPTION
        .replace("<Unknown index=\"2\"/>", "<Unknown index=\"2\" dependencies=\"1\"/>")
        .replace(
            "</ModelVariables>",
            "<ScalarVariable name=\"double\" valueReference=\"2\"><Real/></ScalarVariable>
             <ScalarVariable name=\"gain\" valueReference=\"10\" causality=\"parameter\" variability=\"tunable\"><Real start=\"1\"/></ScalarVariable>
             </ModelVariables>",
        );
    let room = Room::new("two", &compiled("two"), &description);
    let slave = room.load(&setup(&[], &["u", "flag", "gain"], &["y", "double", "steps"])).unwrap();
    let by_output: Vec<_> = (0..3).map(|output| [0, 1, 2].map(|input| slave.feeds_through(output, input))).collect();
    assert_eq!(by_output, [[true, false, true], [true, false, true], [true; 3]]);
}

#[test]
fn a_boolean_is_0_or_1() {
    let mut slave = room().load(&setup(&[], &["flag"], &["flag"])).unwrap();
    let mut read = [0.5];
    slave.read(Some(&[1.0]), &mut read).unwrap();
    assert_eq!(read, [1.0], "whatever is not FALSE is TRUE");
    let error = slave.step(0.0, 0.1, &[[0.5, 0.0, 0.0]]).unwrap_err();
    assert!(error.to_string().starts_with("`flag` of the FMU takes 0 and 1, got 0.5"), "{error}");
}

#[test]
fn a_flood_of_messages_is_cut() {
    let mut slave = loaded("flood", &[]);
    slave.take_log();
    slave.step(0.0, 0.1, &[[0.0; 3]]).expect("a warning is no failure");
    let log = slave.take_log();
    assert_eq!(log.len(), 10_001);
    assert_eq!((log[0].severity, log[0].category.as_str()), (Severity::Info, "calls"));
    assert_eq!(log[10_000].message, "10000 more lines were not kept");
}

/// Time of a message: before the first step its start, within a step the start of the step.
#[test]
fn what_it_says_has_the_time_at_which_it_says_it() {
    let setup = Setup { start_time: 0.5, ..setup(&[("mode", text("flood"))], &["u"], &[]) };
    let mut slave = room().load(&setup).unwrap();
    let said = slave.take_log();
    assert!(said.len() == 4 && said.iter().all(|line| line.time == 0.5), "{said:?}");
    for time in [0.5, 0.75] {
        slave.step(time, 0.25, &[[0.0; 3]]).unwrap();
        assert!(slave.take_log().iter().all(|line| line.time == time));
    }
}

/// Instances of one FMU are independent.
#[test]
fn instances_are_apart() {
    let room = room();
    let setup = setup(&[], &["u"], &["y"]);
    let mut slaves = [room.load(&setup).unwrap(), room.load(&setup).unwrap()];
    for (at, slave) in slaves.iter_mut().enumerate() {
        slave.step(0.0, 1.0, &[[at as f64 + 1.0, 0.0, 0.0]]).unwrap();
    }
    let [first, second] = &mut slaves;
    let mut read = [0.0];
    first.read(None, &mut read).unwrap();
    assert_eq!(read, [1.0]);
    second.read(None, &mut read).unwrap();
    assert_eq!(read, [2.0]);
    assert_eq!(setup.outputs, [port("y", 0)]);
}

/// x(0) may follow u(0): inputs are set before the end of the initialization, as often as outputs are read for them.
#[test]
fn one_that_waits_is_started_with_its_inputs() {
    let waiting =
        |mode: &str| Setup { waits: true, ..setup(&[("mode", text(mode))], &["u", "flag"], &["y", "u", "steps"]) };
    let load = |mode| room().load(&waiting(mode)).unwrap();
    let mut slave = load("normal");
    assert!(slave.is_initialising());
    assert_eq!(messages(&mut slave).last().unwrap(), "enter initialization of it at 0, 0");
    let mut read = [9.0; 3];
    for input in [3.0, -1.0, 5.0] {
        slave.read(Some(&[input, 1.0]), &mut read).unwrap();
        // An input is neither an output nor an initial unknown, and is not read.
        assert_eq!(read, [0.0; 3]);
    }
    slave.start(Some(&[5.0, 1.0])).unwrap();
    assert!(!slave.is_initialising());
    assert_eq!(messages(&mut slave), ["exit initialization of it at 0, 5"]);
    slave.step(0.0, 0.5, &[[5.0, 0.0, 0.0], [1.0, 0.0, 0.0]]).unwrap();
    slave.read(None, &mut read).unwrap();
    assert_eq!(read, [2.5, 5.0, 1.0]);
    // An instance that is not started begins with the first step.
    let mut unasked = load("normal");
    unasked.step(0.0, 0.5, &[[5.0, 0.0, 0.0], [0.0; 3]]).unwrap();
    assert!(!unasked.is_initialising());
    let error = load("fail early").start(Some(&[0.0; 2])).unwrap_err();
    assert!(matches!(&error, SlaveError::Failed { call, .. } if call == "fmi2ExitInitializationMode"), "{error}");
}

#[test]
fn one_that_was_not_started_is_freed_and_not_terminated() {
    let room = room();
    let path = room.notes();
    let setup = Setup { waits: true, ..setup(&[("path", text(path.to_str().unwrap()))], &["u"], &["y"]) };
    let mut slave = room.load(&setup).unwrap();
    slave.end();
    assert_eq!(fs::read_to_string(&path).unwrap(), "free\n");
    drop(slave);
    assert_eq!(fs::read_to_string(&path).unwrap(), "free\n", "once");
}

#[test]
fn what_is_no_real_number_is_discrete() {
    let slave = loaded("normal", &["y", "steps"]);
    assert_eq!([slave.is_discrete(0), slave.is_discrete(1)], [false, true]);
}

/// 0.2 + 0.1 exceeds 0.3 by a rounding, which the FMU must not see: beyond the stop time it may return an error (FMI 2.0.4, §2.1.6).
#[test]
fn roundings_are_not_beyond_the_stop_time() {
    let setup = Setup { stop_time: Some(0.3), ..setup(&[("mode", text("strict"))], &["u"], &["y"]) };
    let mut slave = room().load(&setup).unwrap();
    assert_eq!(slave.step(0.2, 0.1, &[[1.0, 0.0, 0.0]]), Ok(StepEnd::Done));
    let mut read = [0.0];
    slave.read(None, &mut read).unwrap();
    assert!((read[0] - 0.1).abs() < 1e-15, "{read:?}");
    assert!(slave.step(0.25, 0.1, &[[1.0, 0.0, 0.0]]).is_err(), "what really goes beyond it is not hidden");
}

#[test]
fn an_end_beyond_the_step_is_none() {
    let error = loaded("beyond", &[]).step(1.0, 0.125, &[[0.0; 3]]).unwrap_err();
    assert_eq!(error, SlaveError::Astray { call: "fmi2DoStep".into(), from: 1.0, to: 1.125, at: 1.25 });
}
