//! Diagnostics of requirements and of expected faults.
use crate::calls::said;
use crate::{AXIS, mistakes, strings};
use servobench_metrics::{Expectation, Incident, Occasion, Requirement};
use servobench_scenario::parse;

/// The axis with `tables` at its end.
fn with(tables: &str) -> String {
    format!("{AXIS}{tables}\n")
}

/// Lines of `tables` count from 1.
fn mistakes_in(tables: &str) -> Vec<String> {
    let before = AXIS.matches('\n').count();
    let shift = |line: String| {
        let (number, rest) = line.split_once(':').unwrap();
        format!("{}:{rest}", number.parse::<usize>().unwrap() - before)
    };
    mistakes(&with(tables)).into_iter().map(shift).collect()
}

#[test]
fn requirements_are_lifted_by_name() {
    for (tables, lifted) in [
        ("", vec![]),
        ("[requirements]", vec![]),
        ("[requirements]\narrives = false\nbounded = true", vec![Requirement::Arrives]),
        ("[requirements]\nstable = false\nno_fault = false", vec![Requirement::Stable, Requirement::NoFault]),
    ] {
        let scenario = parse("axis.toml", &with(tables), None).unwrap_or_else(|error| panic!("{error}")).scenario;
        assert_eq!(scenario.requirements.lifted, lifted, "{tables}");
        assert_eq!(scenario.requirements.expected, []);
    }
}

#[test]
fn a_requirement_that_there_is_not_has_a_suggestion() {
    for (tables, expected) in [
        ("[requirements]\narives = false", "2:1: unknown requirement `arives`; did you mean `arrives`?"),
        ("[requirements]\nstable = \"no\"", "2:10: `stable` must be true or false, got \"no\""),
        ("[requirements]\nstable = 0", "2:10: `stable` must be true or false, got 0"),
    ] {
        assert_eq!(mistakes_in(tables), [expected]);
    }
}

#[test]
fn without_a_fieldbus_nothing_has_faults() {
    let help = "give a `[bus]`, or leave `[[expect]]` out";
    assert_eq!(
        mistakes_in("[[expect]]\nfault = \"8611h\"\nwho = \"drive\""),
        [format!("1:1: without a fieldbus axis, drive and link have no faults; {help}")]
    );
}

/// An expectation beside the calls of an axis on a bus, with the run lasting two seconds.
fn expecting(keys: &str) -> Vec<String> {
    let [errors, warnings] = said(&format!("[[expect]]\n{keys}\n"));
    assert_eq!(warnings, [""; 0]);
    errors
}

#[test]
fn an_expected_fault_is_one_that_there_can_be() {
    let drive = "write the error code of the drive (603Fh): four digits and an h, \"8611h\"";
    let axis = "the axis has one state of error: write \"ErrorStop\"";
    let block = "write the `ErrorID` of the block: four digits and an h, \"2002h\"";
    for (keys, expected) in [
        ("fault = \"8611h\"\nwho = \"drive\"", vec![]),
        ("fault = \"ErrorStop\"\nwho = \"axis\"\nfrom = \"0.2 s\"\nto = \"0.6 s\"", vec![]),
        ("fault = \"positive limit switch\"\nwho = \"link\"", vec![]),
        ("fault = \"2001h\"\nwho = \"power\"", vec![]),
        ("fault = \"8611\"\nwho = \"drive\"", vec![format!("2:9: \"8611\" is not a fault of `drive`; {drive}")]),
        (
            "fault = \"Standstill\"\nwho = \"axis\"",
            vec![format!("2:9: \"Standstill\" is not a fault of `axis`; {axis}")],
        ),
        ("fault = \"Error\"\nwho = \"power\"", vec![format!("2:9: \"Error\" is not a fault of `power`; {block}")]),
        (
            "fault = \"8611h\"\nwho = \"drives\"",
            vec!["3:7: unknown source of faults: `drives`; did you mean `drive`?".into()],
        ),
        (
            "fault = \"8611h\"\nwho = \"drive\"\nfrom = \"0.6 s\"\nto = \"0.2 s\"",
            vec!["5:6: `to` is 0.2 s and `from` 0.6 s: the interval is empty".into()],
        ),
        (
            "fault = \"8611h\"\nwho = \"drive\"\nfrom = \"2 s\"",
            vec!["4:8: the run is over by then: it lasts 2 s".into()],
        ),
        ("who = \"drive\"", vec!["1:1: missing `fault` in `expect`".into()]),
    ] {
        assert_eq!(expecting(keys), expected, "{keys}");
    }
}

#[test]
fn an_expectation_without_a_time_holds_for_the_whole_run() {
    let text = crate::calls::text("[[expect]]\nfault = \"8611h\"\nwho = \"drive\"\n");
    let scenario = parse("axis.toml", &text, None).unwrap_or_else(|error| panic!("{error}")).scenario;
    let on = Occasion::Fault { fault: "8611h".into(), who: "drive".into() };
    assert_eq!(scenario.requirements.expected, [Expectation { on, from: 0.0, to: f64::INFINITY }]);
}

#[test]
fn optional_calls_are_marked() {
    let text = crate::calls::text("[[call]]\nblock = \"MC_Reset\"\noptional = true\n");
    let scenario = parse("axis.toml", &text, None).unwrap_or_else(|error| panic!("{error}")).scenario;
    let optional: Vec<bool> = scenario.plc.unwrap().calls.iter().map(|call| call.is_optional).collect();
    assert_eq!(optional, [false, true]);
    let [errors, _] = said("[[call]]\nblock = \"MC_Reset\"\noptional = 1\n");
    assert_eq!(errors, strings(&["3:12: `optional` must be true or false, got 1"]));
}

#[test]
fn an_expected_event_is_one_of_the_list_that_the_axis_can_have() {
    let known = ["end_stop", "winding_temperature", "missing_point", "buffer_overflow", "buffer_underflow"];
    let bus = "[[expect]]\non = \"event\"\nevent = \"buffer_overflow\"\nfrom = \"0.1 s\"\nto = \"0.2 s\"\n";
    let text = crate::calls::text(bus);
    let scenario = parse("axis.toml", &text, None).unwrap_or_else(|error| panic!("{error}")).scenario;
    let on = Occasion::Event(Incident::BufferOverflow);
    assert_eq!(scenario.requirements.expected, [Expectation { on, from: 0.1, to: 0.2 }]);
    let ends = "1:1: `end_stop` cannot occur; give `[axis.end_stops]`, or leave `[[expect]]` out";
    let warmth = "1:1: `winding_temperature` cannot occur; give `[motor.thermal]`, or leave `[[expect]]` out";
    for (keys, expected) in [
        ("on = \"event\"\nevent = \"internal_limit\"", vec![]),
        ("on = \"fault\"\nfault = \"8611h\"\nwho = \"drive\"", vec![]),
        ("on = \"event\"\nevent = \"end_stop\"", vec![ends.to_owned()]),
        ("on = \"event\"\nevent = \"winding_temperature\"", vec![warmth.to_owned()]),
        ("on = \"event\"", vec!["1:1: missing `event` in `expect`".into()]),
        (
            "event = \"buffer_overflow\"",
            vec![
                "1:1: missing `fault` in `expect`".into(),
                "1:1: missing `who` in `expect`".into(),
                "2:9: `event` goes with `on = \"event\"`; leave it out, or change `on`".into(),
            ],
        ),
        (
            "on = \"event\"\nevent = \"buffer_overflow\"\nwho = \"drive\"",
            vec!["4:7: `who` goes with `on = \"fault\"`; leave it out, or change `on`".into()],
        ),
    ] {
        assert_eq!(expecting(keys), expected, "{keys}");
    }
    let [wrong] = &expecting("on = \"event\"\nevent = \"end_stops\"")[..] else { panic!() };
    assert!(wrong.contains("did you mean `end_stop`?"), "{wrong}");
    assert!(known.iter().all(|name| Incident::from_name(name).is_some()));
}
