//! FMI 3.0. `three.c` refuses calls in the wrong mode and arrays of the wrong length.
use super::{Room, compiled, messages, port, setup, text};
use servobench_fmi::{Loaded, Setup, Slave, SlaveError, StepEnd, Value};
use std::fs;

const DESCRIPTION: &str = include_str!("three.xml");

fn room() -> Room {
    Room::new("three", &compiled("three"), DESCRIPTION)
}

fn loaded(mode: i128, inputs: &[&str], outputs: &[&str]) -> Loaded {
    room().load(&setup(&[("mode", Value::Integer(mode))], inputs, outputs)).unwrap()
}

#[test]
fn calls_come_in_the_order_of_the_standard() {
    let room = room();
    let path = room.notes();
    let start = [
        ("path", text(path.to_str().unwrap())),
        ("n", Value::Integer(2)),
        ("array", Value::List(vec![Value::Number(4.0), Value::Integer(5)])),
    ];
    let setup = Setup { tolerance: Some(1e-4), stop_time: Some(2.0), ..setup(&start, &["d"], &["sum"]) };
    let mut slave = room.load(&setup).unwrap();
    let calls = [
        "instantiate",
        "enter configuration",
        "exit configuration",
        "enter initialization 1 0.0001 0 1 2",
        "exit initialization",
        "update",
        "enter step",
    ];
    assert_eq!(messages(&mut slave), calls);
    let mut read = [0.0];
    slave.read(None, &mut read).unwrap();
    assert_eq!(read, [9.0]);
    slave.step(0.0, 0.1, &[[7.0, 0.0, 0.0]]).unwrap();
    assert_eq!(messages(&mut slave), ["enter event", "update", "enter step"], "a new discrete input is an event");
    slave.step(0.1, 0.1, &[[7.0, 0.0, 0.0]]).unwrap();
    assert_eq!(messages(&mut slave), [""; 0], "one that stays is none");
    slave.save().unwrap();
    drop(slave);
    let freed = "free state\nfree state\nterminate\nfree\n";
    assert_eq!(fs::read_to_string(&path).unwrap(), freed, "one that was saved, and that before a step");
}

#[test]
fn an_event_within_a_step_ends_it_early() {
    let mut slave = loaded(0, &["u"], &["y", "events"]);
    let mut read = [0.0; 2];
    slave.take_log();
    assert_eq!(slave.step(0.0, 1.0, &[[2.0, 0.0, 0.0]]), Ok(StepEnd::Until(0.25)));
    let said = slave.take_log();
    let calls: Vec<_> = said.iter().map(|line| line.message.as_str()).collect();
    assert_eq!(calls, ["enter event", "update", "update", "enter step"]);
    assert!(said.iter().all(|line| line.time == 0.25), "said where the event was: {said:?}");
    slave.read(None, &mut read).unwrap();
    assert_eq!(read, [0.5, 3.0], "of the two updates of the event and the one at the start");
    assert_eq!(slave.step(0.25, 0.75, &[[2.0, 0.0, 0.0]]), Ok(StepEnd::Done));
    slave.read(None, &mut read).unwrap();
    assert_eq!(read, [2.0, 3.0]);
    let mut on_the_event = loaded(0, &["u"], &["events"]);
    assert_eq!(on_the_event.step(0.0, 0.25, &[[0.0; 3]]), Ok(StepEnd::Done), "at the end of a step nothing is early");
    on_the_event.read(None, &mut read[..1]).unwrap();
    assert_eq!(read[0], 3.0);
}

/// An FMU with events at `first`, `first` + `period` and so on.
fn timed(description: &str, first: f64, period: f64) -> Loaded {
    let start = [("first", Value::Number(first)), ("period", Value::Number(period))];
    Room::new("three", &compiled("three"), description).load(&setup(&start, &["u", "d"], &["y"])).unwrap()
}

/// Steps like a master, to `end` by steps of `length`; returns the time reached and the output there.
fn driven(slave: &mut Loaded, length: f64, end: u32) -> (Vec<f64>, f64) {
    let mut stops = vec![];
    for step in 0..end {
        let (mut time, until) = (f64::from(step) * length, f64::from(step + 1) * length);
        let mut rest = length;
        while let StepEnd::Until(reached) = slave.step(time, rest, &[[0.0; 3]; 2]).unwrap() {
            stops.push(reached);
            (time, rest) = (reached, until - reached);
        }
    }
    let mut read = [0.0];
    slave.read(None, &mut read).unwrap();
    (stops, read[0])
}

/// Oracle: y' is the number of events so far, integrated by hand.
#[test]
fn an_event_that_is_announced_ends_the_step() {
    let mut slave = timed(DESCRIPTION, 0.375, 0.375);
    slave.take_log();
    let (stops, y) = driven(&mut slave, 0.5, 2);
    assert_eq!((stops, y), (vec![0.375, 0.75], 0.375 + 0.25 * 2.0));
    let calls = ["enter event", "update", "enter step"].repeat(3);
    assert_eq!(messages(&mut slave), calls, "the first discrete input and two events");

    let mut at_the_end = timed(DESCRIPTION, 0.5, 0.5);
    assert_eq!(driven(&mut at_the_end, 0.5, 4), (vec![], 0.5 * (1.0 + 2.0 + 3.0)), "nothing is cut there");
    let mut at_the_start = timed(DESCRIPTION, 0.0, 0.75);
    assert_eq!(driven(&mut at_the_start, 0.5, 2), (vec![0.75], 0.75 + 0.25 * 2.0));
}

/// Ten times 0.1 and the like are not multiples of 0.1 in binary: no event is early, late or handled twice because of that.
#[test]
fn events_and_steps_may_differ_by_roundings() {
    let mut slave = timed(DESCRIPTION, 0.3, 0.1);
    let (stops, y) = driven(&mut slave, 0.1, 50);
    // The sum of 1 to 47 tenths; fifty additions of numbers below 150.
    assert!(stops.is_empty() && (y - 0.1 * 47.0 * 48.0 / 2.0).abs() < 1e-12, "{stops:?} {y}");
}

#[test]
fn where_steps_have_one_length_events_are_at_communication_points() {
    let description = DESCRIPTION
        .replace("canHandleVariableCommunicationStepSize=\"true\"", "canHandleVariableCommunicationStepSize=\"false\"");
    let mut slave = timed(&description, 0.375, 0.375);
    // 0.375 s is known from 0.5 s on.
    assert_eq!(driven(&mut slave, 0.5, 2), (vec![], 0.5));
}

/// A new discrete input is an event too, after which the FMU announces the next one again.
#[test]
fn an_event_stays_announced_over_others_and_comes_back_with_a_state() {
    let mut slave = timed(DESCRIPTION, 0.375, 0.375);
    assert_eq!(slave.step(0.0, 0.25, &[[0.0; 3], [1.0, 0.0, 0.0]]), Ok(StepEnd::Done));
    slave.save().unwrap();
    for _ in 0..2 {
        assert_eq!(slave.step(0.25, 0.25, &[[0.0; 3], [1.0, 0.0, 0.0]]), Ok(StepEnd::Until(0.375)));
        assert_eq!(slave.step(0.375, 0.125, &[[0.0; 3], [1.0, 0.0, 0.0]]), Ok(StepEnd::Done));
        slave.restore().unwrap();
    }
}

#[test]
fn an_element_is_set_and_the_others_stay() {
    let room = room();
    let mut setup = setup(&[], &[], &["sum"]);
    setup.inputs = vec![port("array", 1), port("small", 0), port("u", 0)];
    setup.outputs.extend((0..3).map(|element| port("array", element)));
    let mut slave = room.load(&setup).unwrap();
    let mut read = [0.0; 4];
    slave.read(Some(&[10.0, 0.0, 0.0]), &mut read).unwrap();
    assert_eq!(read, [14.0, 1.0, 10.0, 3.0]);
    slave.step(0.0, 0.1, &[[20.0, 0.0, 0.0], [0.0; 3], [0.0; 3]]).unwrap();
    slave.read(None, &mut read).unwrap();
    assert_eq!(read, [24.0, 1.0, 20.0, 3.0]);
}

#[test]
fn feedthrough_is_asked_for_by_the_position_of_ports() {
    let room = room();
    let mut setup = setup(&[], &["u", "d"], &["y", "sum", "mode"]);
    setup.inputs.push(port("array", 2));
    let slave = room.load(&setup).unwrap();
    let by_output: Vec<_> = (0..3).map(|output| [0, 1, 2].map(|input| slave.feeds_through(output, input))).collect();
    // The structure is silent on `y` and on variables other than outputs; `sum` follows the array alone.
    assert_eq!(by_output, [[true; 3], [false, false, true], [true; 3]]);
}

#[test]
fn other_types_go_both_ways() {
    let mut slave = loaded(0, &["small", "flag", "d"], &["small", "flag", "d"]);
    let mut read = [0.0; 3];
    slave.read(Some(&[0.1, 1.0, -5.0]), &mut read).unwrap();
    // 0.1 in single precision.
    assert_eq!(read, [0.10000000149011612, 1.0, -5.0]);
    for (inputs, said) in [
        ([1e39, 0.0, 0.0], "`small` of the FMU takes finite numbers of single precision, got 1e39"),
        ([0.0, 0.0, 2147483648.0], "`d` of the FMU takes whole numbers of 32 bits, got 2147483648"),
        ([0.0, 0.0, 0.25], "`d` of the FMU takes whole numbers of 32 bits, got 0.25"),
    ] {
        let error = loaded(0, &["small", "flag", "d"], &[]).read(Some(&inputs), &mut []).unwrap_err();
        assert!(
            error.to_string().replace("1000000000000000000000000000000000000000", "1e39").starts_with(said),
            "{error}"
        );
    }
}

#[test]
fn ends_and_failures() {
    let step = |mode| loaded(mode, &[], &[]).step(0.3, 0.5, &[]);
    assert_eq!(step(1), Ok(StepEnd::Terminated(0.5)));
    let failed = |status: &'static str, message: &str| {
        let (call, status) = ("fmi3DoStep".into(), status.into());
        Err(SlaveError::Failed { call, time: 0.3, status, message: message.into() })
    };
    assert_eq!(step(3), failed("fmi3Error", "no root"));
    assert_eq!(step(4), failed("fmi3Fatal", "enter step"));
    assert_eq!(
        step(5),
        Err(SlaveError::Discarded { call: "fmi3DoStep".into(), time: 0.3, shortest: Some(0.5 / 1024.0) })
    );
    let room = room();
    for (mode, said) in [
        (2, "failed in fmi3UpdateDiscreteStates at 0 s (fmi3OK): its discrete states did not settle in 1000 updates"),
        (6, "failed in fmi3UpdateDiscreteStates at 0 s (fmi3OK): it wants to end at its start"),
    ] {
        let error = room.load(&setup(&[("mode", Value::Integer(mode))], &[], &[])).unwrap_err();
        assert!(error.to_string().ends_with(said), "{error}");
    }
}

/// y' = d, a discrete input: after going back it differs from the FMU's, and its event is repeated.
#[test]
fn a_step_in_parts_has_its_discrete_inputs() {
    let mut slave = loaded(7, &["d"], &["y", "d"]);
    let mut read = [0.0; 2];
    slave.step(0.0, 0.25, &[[1.0, 0.0, 0.0]]).unwrap();
    slave.save().unwrap();
    for _ in 0..2 {
        slave.read(Some(&[5.0]), &mut read).unwrap();
        assert_eq!(read, [0.25, 5.0]);
        assert_eq!(slave.step(0.25, 1.0, &[[7.0, 0.0, 0.0]]), Ok(StepEnd::Done));
        assert_eq!(slave.step(1.25, 1.0, &[[7.0, 0.0, 0.0]]), Ok(StepEnd::Done));
        slave.read(None, &mut read).unwrap();
        assert_eq!(read, [14.25, 7.0]);
        slave.restore().unwrap();
        slave.read(None, &mut read).unwrap();
        assert_eq!(read, [0.25, 1.0]);
    }
}

#[test]
fn a_saved_state_comes_back() {
    let mut slave = loaded(0, &["u"], &["y"]);
    let mut read = [0.0];
    slave.step(0.0, 0.1, &[[1.0, 0.0, 0.0]]).unwrap();
    slave.save().unwrap();
    slave.step(0.1, 1.0, &[[1.0, 0.0, 0.0]]).unwrap();
    slave.restore().unwrap();
    slave.read(None, &mut read).unwrap();
    assert_eq!(read, [0.1]);
}

/// FMI 3.0.1, §4.2.1: an early return is at a time within the step, its start included.
#[test]
fn an_early_return_is_within_its_step() {
    let step = |mode| loaded(mode, &["u"], &["y"]).step(1.0, 0.5, &[[0.0; 3]]);
    for (mode, at) in [(8, f64::NAN), (9, 2.0), (10, 0.5), (13, f64::NAN)] {
        match step(mode) {
            Err(SlaveError::Astray { call, from: 1.0, to: 1.5, at: found }) => {
                assert_eq!(call, "fmi3DoStep");
                assert_eq!(found.to_bits() << 1, at.to_bits() << 1, "{mode}: {found}");
            }
            other => panic!("{mode}: {other:?}"),
        }
    }
    assert_eq!(step(11), Ok(StepEnd::Done), "at the end of the step it is not early");
    assert_eq!(step(12), Ok(StepEnd::Until(1.0)));
}

/// The library counts calls, and returns an error for an event mode that was not agreed on.
#[test]
fn without_the_event_mode_no_event_is_dealt_with() {
    let setup = Setup { without_event_mode: true, stop_time: Some(2.0), ..setup(&[], &["u", "d"], &["y", "events"]) };
    let mut slave = room().load(&setup).unwrap();
    assert_eq!(messages(&mut slave), ["instantiate", "enter initialization 0 0 0 1 2", "exit initialization"]);
    let inputs = |d| [[2.0, 0.0, 0.0], [d, 0.0, 0.0]];
    assert_eq!(slave.step(0.0, 0.125, &inputs(7.0)), Ok(StepEnd::Done), "a new discrete input");
    assert_eq!(slave.step(0.125, 1.0, &inputs(8.0)), Ok(StepEnd::Until(0.25)), "it still may return early");
    assert_eq!(slave.step(0.25, 0.75, &inputs(8.0)), Ok(StepEnd::Done));
    let mut read = [0.0; 2];
    slave.read(None, &mut read).unwrap();
    assert_eq!((read, messages(&mut slave)), ([2.0, 0.0], vec![]));
}

#[test]
fn one_that_waits_is_started_with_its_inputs() {
    let setup = Setup { waits: true, ..setup(&[], &["u", "d", "array"], &["y", "events", "sum"]) };
    let mut slave = room().load(&setup).unwrap();
    assert_eq!(messages(&mut slave), ["instantiate", "enter initialization 0 0 0 0 0"]);
    let mut read = [0.0; 3];
    slave.read(Some(&[1.0, 7.0, 40.0]), &mut read).unwrap();
    assert_eq!(read[2], 45.0, "elements that nothing is wired to keep what they start with");
    slave.start(Some(&[2.0, 8.0, 10.0])).unwrap();
    assert_eq!(messages(&mut slave), ["exit initialization", "update", "enter step"]);
    slave.step(0.0, 0.125, &[[2.0, 0.0, 0.0], [8.0, 0.0, 0.0], [10.0, 0.0, 0.0]]).unwrap();
    assert_eq!(messages(&mut slave), [""; 0], "what was there at the start is not new");
    assert_eq!([0, 1, 2].map(|output| slave.is_discrete(output)), [false, true, false]);
}

/// No step is lengthened to reach an event at the stop time or beyond it.
#[test]
fn no_event_leads_beyond_the_stop_time() {
    let start = [("first", Value::Number(0.5_f64.next_up())), ("period", Value::Number(0.5))];
    let setup = Setup { stop_time: Some(0.5), ..setup(&start, &["u"], &["y"]) };
    let mut slave = room().load(&setup).unwrap();
    slave.take_log();
    assert_eq!(slave.step(0.0, 0.5, &[[0.0; 3]]), Ok(StepEnd::Done));
    assert_eq!(messages(&mut slave), [""; 0]);
}
