//! Overrides of keys of a file.
use servobench_scenario::{Document, Key, LoadError, Loaded, Override, Scenario, differences, parse};
use servobench_sweep::Value;

const TEXT: &str = r#"
run.base_rate = "12 kHz"
[axis]
motion = "linear"
motor_side.mass = "21 kg"
[motor]
kind = "ideal-source"
[drive.velocity]
rate = "12 kHz"
bandwidth = "30 Hz"
[drive.position]
rate = "12 kHz"
bandwidth = "10 Hz"
[setpoint]
order = 2
velocity = "250 mm/s"
acceleration = "1 m/s2"
[[program]]
move_to = "10 mm"
[[program]]
wait = "1 s"
[record]
channels = ["load.position", "motor.position"]
"#;

fn overrides(all: &[&str]) -> Vec<Override> {
    all.iter().map(|one| one.parse().unwrap_or_else(|error| panic!("{one}: {error}"))).collect()
}

fn read(text: &str, all: &[&str]) -> Result<Loaded, LoadError> {
    Document::parse("a.toml", text, None, None)?.scenario(&overrides(all))
}

/// The scenario without the origins of its values.
fn meaning(loaded: Loaded) -> Scenario {
    let mut scenario = loaded.scenario;
    scenario.overrides.clear();
    scenario.made_of.clear();
    for parameter in &mut scenario.parameters {
        parameter.line = None;
    }
    scenario.parameters.sort_by(|one, other| one.key.cmp(&other.key));
    scenario
}

/// The mistakes, a line each.
fn mistakes(text: &str, all: &[&str]) -> Vec<String> {
    match read(text, all) {
        Err(LoadError::Invalid(invalid)) => invalid.lines(),
        other => panic!("{other:?}"),
    }
}

/// Oracle: a file with the same values.
#[test]
fn an_override_is_as_if_the_file_said_so() {
    for (one, from, to) in [
        ("setpoint.velocity=300 mm/s", "\"250 mm/s\"", "\"300 mm/s\""),
        (" setpoint . velocity = '300 mm/s' ", "\"250 mm/s\"", "\"300 mm/s\""),
        ("setpoint.order=3", "order = 2", "order = 3\njerk = \"1 m/s3\""),
        ("program[0].move_to=20 mm", "\"10 mm\"", "\"20 mm\""),
        ("program.1.wait=\"2 s\"", "wait = \"1 s\"", "wait = \"2 s\""),
        ("program[01].wait=2 s", "wait = \"1 s\"", "wait = \"2 s\""),
        ("limits.move_time=20 ms", "[record]", "[limits]\nmove_time = \"20 ms\"\n[record]"),
        ("limits.overshoot={ max = '1 um' }", "[record]", "[limits]\novershoot.max = \"1 um\"\n[record]"),
        ("record.channels[1]=load.velocity", "\"motor.position\"", "\"load.velocity\""),
        ("record.channels=[\"load.position\"]", ", \"motor.position\"", ""),
        ("'name'=fast", "run.base_rate", "name = \"fast\"\nrun.base_rate"),
        ("requirements.stable=false", "[record]", "[requirements]\nstable = false\n[record]"),
        ("drive.velocity.gain=3000 N s/m", "bandwidth = \"30 Hz\"", "gain = \"3000 N s/m\""),
    ] {
        assert!(TEXT.contains(from), "{from}");
        let others = if one.starts_with("setpoint.order") { &[one, "setpoint.jerk=1 m/s3"][..] } else { &[one] };
        let found = read(TEXT, others).unwrap_or_else(|error| panic!("{one}: {error}"));
        assert_eq!(found.scenario.overrides, overrides(others));
        let expected = parse("a.toml", &TEXT.replacen(from, to, 1), None).unwrap_or_else(|error| panic!("{error}"));
        let (mut found, mut expected) = (meaning(found), meaning(expected));
        if one.contains(".gain=") {
            // The overridden key is still in the file.
            found.parameters.clear();
            expected.parameters.clear();
        }
        assert_eq!(found, expected, "{one}");
    }
}

#[test]
fn without_overrides_nothing_is_other() {
    assert_eq!(read(TEXT, &[]).unwrap(), parse("a.toml", TEXT, None).unwrap());
}

#[test]
fn what_a_model_says_is_overridden_and_so_is_the_model() {
    let text = TEXT.replace("kind = \"ideal-source\"", "model = \"emps\"").replace("12 kHz", "10 kHz");
    let value = |loaded: &Loaded, key: &str| {
        let all = &loaded.scenario.parameters;
        all.iter().find(|one| one.key == key).map(|one| (one.value.clone(), one.line, one.is_of_model))
    };
    let plain = parse("a.toml", &text, None).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(value(&plain, "motor.gain"), Some(("35.1507 N/V".into(), None, true)));
    let found = read(&text, &["motor.gain=36 N/V"]).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(value(&found, "motor.gain"), Some(("36 N/V".into(), None, false)));
    let keys: Vec<_> = differences(&plain.scenario.parameters, &found.scenario.parameters);
    assert_eq!(keys.iter().map(|one| one.key.as_str()).collect::<Vec<_>>(), ["motor.gain"]);
    let said = mistakes(&text, &["motor.model=empms"]);
    assert_eq!(said, ["--set motor.model=empms: unknown model `empms` in `models/motors`; did you mean `emps`?"]);
}

#[test]
fn a_mistake_is_told_with_its_place_on_the_command_line() {
    for (one, expected) in [
        ("setpont.velocity=1 m/s", "unknown key `setpont`; did you mean `setpoint`?"),
        ("setpoint.velocty=1 m/s", "unknown key `velocty` in `setpoint`; did you mean `velocity`?"),
        ("setpoint.velocity=1", "`velocity` needs a unit, got the bare number 1; write \"1 m/s\""),
        ("setpoint.velocity.x=1", "`setpoint.velocity` is a string and has no parts"),
        ("program[2].wait=1 s", "`program[2]` does not exist; `program` has 2 elements, `program[0]` to `program[1]`"),
        ("program.wait=1 s", "`program` is a list; choose an element: `program[0].wait`"),
        (
            "call[0].velocity=1 m/s",
            "unknown list `call`; known here: `run`, `axis`, `motor`, `drive`, `setpoint`, `program`, `record`",
        ),
        ("progam[0].wait=1 s", "unknown list `progam`; did you mean `program`?"),
        ("setpoint[0]=1", "`setpoint` is a table, not a list"),
        (
            "record.channels[0]=load.positon",
            "\"load.positon\" is not a value of `channels`; did you mean `load.position`?",
        ),
    ] {
        let said = mistakes(TEXT, &[one]);
        let [said] = said.as_slice() else { panic!("{one}: {said:?}") };
        assert!(said.starts_with(&format!("--set {one}: {expected}")), "{one}: {said}");
    }
}

/// The place shown is that of the wrong part.
#[test]
fn the_place_is_the_part_that_is_wrong() {
    let place = |one: &str| match read(TEXT, &[one]) {
        Err(LoadError::Invalid(invalid)) => {
            let first = &invalid.diagnostics[0];
            invalid.sources.text(first.source)[first.span.clone()].to_owned()
        }
        other => panic!("{other:?}"),
    };
    assert_eq!(place("setpoint.velocty=1 m/s"), "velocty");
    assert_eq!(place("setpoint.velocity=1 kg"), "1 kg");
    assert_eq!(place("setpoint.velocity=1 mm/qs"), "qs");
    assert_eq!(place("setpoint.velocity='1 mm/qs'"), "qs");
    assert_eq!(place("record.channels=['load.position', \"ä\", 'x']"), "\"ä\"");
    assert_eq!(place("program[7].wait=1 s"), "[7]");
}

#[test]
fn a_key_is_set_once() {
    for (one, other) in [
        ("setpoint.velocity=1 m/s", "setpoint.velocity=2 m/s"),
        ("program[0].move_to=1 mm", "program.0.move_to=2 mm"),
        ("setpoint={ order = 2 }", "setpoint.velocity=2 m/s"),
        ("setpoint.velocity=2 m/s", "setpoint={ order = 2 }"),
    ] {
        let said = mistakes(TEXT, &[one, other]);
        let expected = format!("is set twice; the other is `--set {one}`");
        assert!(
            said.iter().any(|line| line.starts_with(&format!("--set {other}: ")) && line.ends_with(&expected)),
            "{said:?}"
        );
    }
}

#[test]
fn of_two_overrides_that_say_the_same_none_is_preferred() {
    let said = mistakes(TEXT, &["drive.velocity.gain=3000 N s/m", "drive.velocity.bandwidth=20 Hz"]);
    assert!(said[0].contains("give the same quantity"), "{said:?}");
}

/// The broken part of a file may contain the key that the override needs.
#[test]
fn in_a_file_with_wrong_syntax_nothing_is_missing() {
    let broken =
        TEXT.replace("[[program]]\nmove_to", "[[program]\nmove_to").replace("[[program]]\nwait", "[[program]\nwait");
    let said = mistakes(&broken, &["program[1].wait=2 s"]);
    assert!(said.iter().all(|line| line.starts_with("a.toml:")), "{said:?}");
}

#[test]
fn a_text_that_is_no_override_says_what_is_wrong() {
    for (text, expected) in [
        ("", "a key is missing"),
        ("=1", "a key is missing"),
        ("setpoint.jerk", "missing `=`"),
        ("setpoint.=1", "a key is missing"),
        (".x=1", "a key is missing"),
        ("setpoint jerk=1", "`j` cannot be in a key"),
        ("setpoint.jerk=", "missing value after `=`"),
        ("setpoint.jerk=  ", "missing value after `=`"),
        ("setpoint.jerk=\"1", "the value begins like TOML, but: "),
        ("engine=[exact]", "the value begins like TOML, but: "),
        ("setpoint.jerk='1' # x", "the value begins like TOML, but: there is more after it"),
        ("program[].wait=1", "by its number from 0 on"),
        ("program[-1].wait=1", "by its number from 0 on"),
        ("program[1.wait=1", "by its number from 0 on"),
        ("'a=1", "is not closed"),
        ("ä=1", "`ä` cannot begin a key"),
        ("a=1\nb=2", "it must be on one line"),
    ] {
        let error = text.parse::<Override>().expect_err(text).to_string();
        assert!(error.contains(expected), "{text:?}: {error}");
    }
}

#[test]
fn an_override_reads_back_as_it_is_written() {
    for text in ["a.'b c'[3].d=1", "x = [1, 2]", "x=200 m/s3", "x=-1", "x==", "x=a=b"] {
        let one: Override = text.parse().unwrap();
        assert_eq!((one.to_string().as_str(), &one.to_string().parse::<Override>().unwrap()), (text, &one));
    }
}

/// Oracle: the same value as text on a command line.
#[test]
fn a_number_with_a_unit_is_what_its_words_are() {
    let document = Document::parse("a.toml", TEXT, None, None).unwrap();
    let mut random = 1_u64;
    let mut next = || {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (random >> 11) as f64 / (1_u64 << 53) as f64
    };
    for (key, units) in [
        ("program[0].move_to", ["mm", "um", "m", "km"]),
        ("setpoint.velocity", ["mm/s", "m/min", "um/s", "km/h"]),
        ("axis.motor_side.mass", ["kg", "g", "t", "mg"]),
        ("drive.feedforward.velocity", ["", "%", "", "%"]),
    ] {
        for (unit, power) in units.into_iter().zip(-2..) {
            let number = (0.001 + next()) * 10_f64.powi(power);
            let (name, value) = (key.parse::<Key>().unwrap(), Value::Number(number, unit.to_owned()));
            let typed = Override::new(&name, &value).unwrap();
            let spoken: Override = format!("{key}={}", value.written()).parse().unwrap();
            let told = |one: Override| match document.scenario(&[one]) {
                Ok(loaded) => Ok(loaded.scenario),
                Err(error) => Err(error.to_string()),
            };
            assert_eq!(typed.to_string(), spoken.to_string());
            let same = |scenario: Scenario| Scenario { overrides: Vec::new(), ..scenario };
            assert_eq!(told(typed).map(same), told(spoken).map(same), "{key} {number} {unit}");
        }
    }
}

/// A wrong value is refused with the same message, at the same place.
#[test]
fn a_number_that_does_not_fit_is_refused_as_its_words_are() {
    let document = Document::parse("a.toml", TEXT, None, None).unwrap();
    for (key, number, unit) in [
        ("setpoint.velocity", 3.0, "kg"),
        ("setpoint.velocity", 3.0, ""),
        ("setpoint.velocity", -3.0, "m/s"),
        ("setpoint.velocity", f64::NAN, "m/s"),
        ("setpoint.velocity", 1e40, "m/s"),
        ("setpoint.velocity", 3.0, "m/sek"),
        ("setpoint.order", 2.5, ""),
        ("setpoint.order", 2.0, "m"),
        ("motor.kind", 1.0, "m"),
        ("axis.mjcf.file", 1.0, "m"),
        ("nothing.x", 1.0, "m"),
    ] {
        let value = Value::Number(number, unit.to_owned());
        let typed = Override::new(&key.parse().unwrap(), &value).unwrap();
        let spoken: Override = format!("{key}={}", value.written()).parse().unwrap();
        let told = |one: Override| document.scenario(&[one]).expect_err(key).to_string();
        assert_eq!(told(typed), told(spoken), "{key} {number} {unit}");
    }
}

#[test]
fn a_key_is_read_or_refused() {
    for (text, expected) in [
        ("", "a key is missing"),
        ("setpoint.jerk=1", "a key has no `=`"),
        ("program[x].wait", "by its number from 0 on"),
        ("a b", "cannot be in a key"),
        ("a\nb", "it must be on one line"),
    ] {
        let error = text.parse::<Key>().expect_err(text).to_string();
        assert!(error.contains(expected), "{text:?}: {error}");
    }
    for text in ["setpoint.jerk", "program[0].move_to", "fmu[1].parameters.'a b'"] {
        assert!(text.parse::<Key>().is_ok(), "{text}");
    }
}
