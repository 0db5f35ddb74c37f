//! Clocks of FMI 3.0: those that have to be ticked from outside are refused.
use super::{Room, compiled, messages, setup};
use servobench_fmi::{Loaded, Value};

const DESCRIPTION: &str = include_str!("three.xml");

/// The FMU with additional variables.
fn room(variables: &str) -> Room {
    let description = DESCRIPTION.replace("</ModelVariables>", &format!("{variables}</ModelVariables>"));
    Room::new("three", &compiled("three"), &description)
}

fn said(clock: &str) -> String {
    let room = room(&format!("<Clock name=\"c\" valueReference=\"20\" causality=\"input\" {clock}/>"));
    room.said(&room.load(&setup(&[], &[], &[])).unwrap_err())
}

#[test]
fn a_clock_that_is_to_be_ticked_by_time_is_refused() {
    let refused = "clock `c` of the FMU `/three.fmu`: it has to be ticked from outside, ";
    let help =
        ", which is not supported; export the model without input clocks by time, with events that it announces itself";
    for (clock, when) in [
        ("intervalVariability=\"constant\" intervalDecimal=\"0.01\"", "every 0.01 s"),
        (
            "intervalVariability=\"constant\" intervalDecimal=\"0.33\" shiftDecimal=\"0.7\" resolution=\"3\" intervalCounter=\"1\" shiftCounter=\"2\"",
            "every 0.3333333333333333 s from 0.6666666666666666 s after the start on",
        ),
        ("intervalVariability=\"fixed\"", "at times that it says itself (`fixed`)"),
        ("intervalVariability=\"countdown\"", "at times that it says itself (`countdown`)"),
    ] {
        assert_eq!(said(clock), format!("{refused}{when}{help}"));
    }
}

/// A triggered clock is never ticked, as if its event did not happen.
#[test]
fn what_a_clock_ticks_cannot_be_wired() {
    let room = room(
        "<Clock name=\"in\" valueReference=\"20\" causality=\"input\" intervalVariability=\"triggered\"/>
         <Clock name=\"out\" valueReference=\"21\" causality=\"output\" intervalVariability=\"triggered\"/>
         <Float64 name=\"x\" valueReference=\"22\" causality=\"input\" variability=\"discrete\" clocks=\"20\" start=\"0\"/>
         <Float64 name=\"z\" valueReference=\"23\" causality=\"output\" variability=\"discrete\" clocks=\"20 21\"/>",
    );
    let said = |inputs: &[&str], outputs: &[&str]| room.said(&room.load(&setup(&[], inputs, outputs)).unwrap_err());
    let expected = |what: &str, clocks: &str| {
        format!(
            "{what} of the FMU `/three.fmu`: it is there only while {clocks} ticks, and clocks are not supported; \
             wire a variable without clocks, or export the model without them"
        )
    };
    assert_eq!(said(&["x"], &[]), expected("input `x`", "the clock `in`"));
    assert_eq!(said(&[], &["z"]), expected("output `z`", "one of the clocks `in`, `out`"));
    assert!(said(&[], &["out"]).ends_with("it is a `Clock`; numbers, booleans and enumerations can be wired"));
    let start = [("u", Value::Number(1.0))];
    let mut slave: Loaded = room.load(&setup(&start, &["u"], &["y"])).expect("the rest of it is used");
    assert_eq!(messages(&mut slave).last().unwrap(), "enter step");
}
