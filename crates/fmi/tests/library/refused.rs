//! FMUs that cannot be loaded or wired, and their errors.
use super::{Room, compiled, port, setup, text};
use servobench_fmi::{Setup, Value};

const TWO: &str = include_str!("two.xml");
const THREE: &str = include_str!("three.xml");

fn said(room: &Room, setup: &Setup) -> String {
    room.said(&room.load(setup).unwrap_err())
}

#[test]
fn a_library_that_is_not_there_or_none() {
    let room = Room::new("two", b"", &TWO.replace("modelIdentifier=\"two\"", "modelIdentifier=\"three\""));
    let expected =
        "the FMU `/two.fmu` cannot be loaded: it has no `binaries/linux64/three.so`; it has those for linux64";
    assert_eq!(said(&room, &Setup::default()), expected);
    let room = Room::new("two", b"MZ", TWO);
    assert!(said(&room, &Setup::default()).contains("its library cannot be opened (dlopen failed: "));
}

#[test]
fn a_library_that_needs_python_says_how_to_start() {
    let room = Room::new("two", &compiled("python"), TWO);
    let message = said(&room, &Setup::default());
    assert!(message.contains("undefined symbol: Py_IsInitialized"), "{message}");
    assert!(message.contains("; it needs Python: start with LD_PRELOAD=<path of libpython3.so>"), "{message}");
}

#[test]
fn a_library_of_another_version_or_model() {
    let room = Room::new("three", &compiled("two"), THREE);
    assert!(said(&room, &Setup::default()).ends_with("its library has no function `fmi3GetVersion`"));
    let room = Room::new("two", &compiled("two"), &TWO.replace("{two}", "{other}"));
    let expected = "`fmi2Instantiate` gives no instance: the GUID is {other}, not {two}";
    assert!(said(&room, &Setup::default()).ends_with(expected), "{}", said(&room, &Setup::default()));
}

#[test]
fn ports_that_are_not_there() {
    let room = Room::new("three", &compiled("three"), THREE);
    let with = |inputs: &[(&str, usize)], outputs: &[(&str, usize)]| {
        let ports = |all: &[(&str, usize)]| all.iter().map(|(name, element)| port(name, *element)).collect();
        said(&room, &Setup { inputs: ports(inputs), outputs: ports(outputs), ..Setup::default() })
    };
    assert_eq!(
        with(&[], &[("Evnts", 0)]),
        "output `Evnts` of the FMU `/three.fmu`: there is no such variable; is it `events`?"
    );
    assert!(with(&[], &[("velocity of the load", 0)]).ends_with("there is no such variable"));
    assert!(with(&[("array", 3)], &[]).ends_with("it has no element 3; it has 3, counted from 0"));
    assert!(with(&[("u", 1)], &[]).ends_with("it has no element 1; it has 1, counted from 0"));
    assert!(with(&[("y", 0)], &[]).ends_with("it is output, continuous; inputs and tunable parameters can be set"));
    assert!(with(&[("u", 0), ("u", 0)], &[]).ends_with("element 0 is wired twice"));
    assert!(with(&[], &[("path", 0)]).ends_with("it is a `String`; numbers, booleans and enumerations can be wired"));
}

#[test]
fn start_values_that_do_not_fit() {
    let three = Room::new("three", &compiled("three"), THREE);
    let two = Room::new("two", &compiled("two"), TWO);
    let list = |numbers: &[f64]| Value::List(numbers.iter().map(|number| Value::Number(*number)).collect());
    for (room, name, value, expected) in [
        (&three, "y", Value::Number(1.0), "the FMU calculates it (output, continuous)"),
        (&three, "array", list(&[1.0]), "it has 3 elements, got 1"),
        (&three, "array", list(&[]), "a list without elements starts nothing"),
        (&three, "u", text("1"), "it is a `Float64`, got the text `1`"),
        (&three, "u", Value::Number(f64::NAN), "it is a `Float64`, got NaN"),
        (&three, "mode", Value::Number(0.5), "it is a `Int32`, got 0.5"),
        (&three, "mode", Value::Number(3e9), "it takes -2147483648 to 2147483647, got 3000000000"),
        (&three, "n", Value::Integer(9), "it takes -inf to 8, got 9"),
        (&three, "n", Value::Integer(0), "an extent of arrays is at least 1"),
        (&three, "flag", Value::Integer(1), "it is a `Boolean`, got 1"),
        (&three, "path", text("a\0"), "it is a `String`, got the text `a\\0`"),
        (&two, "mode", text("hlaf"), "it has no item `hlaf`; it has `normal`, `refuse`, `half`"),
    ] {
        let message = said(room, &setup(&[(name, value)], &[], &[]));
        let begin = format!("start value `{name}` of the FMU `/");
        assert!(message.starts_with(&begin) && message.contains(expected), "{message}");
    }
    let twice = setup(&[("u", Value::Number(0.0)), ("u", Value::Number(0.0))], &[], &[]);
    assert!(said(&three, &twice).ends_with("it is started twice"));
}
