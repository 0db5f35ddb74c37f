//! Single changes, each with the resulting mistake and its place.
use super::{THREE, TWO};
use servobench_fmi::ModelDescription;

/// The error after one piece of the text, which occurs once, was replaced.
fn said(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "{from}");
    ModelDescription::read(&text.replace(from, to), "a.xml").unwrap_err().to_string()
}

fn place(text: &str, piece: &str) -> String {
    let before = &text[..text.find(piece).unwrap()];
    let column = before.len() - before.rfind('\n').map_or(0, |at| at + 1) + 1;
    format!("a.xml:{}:{column}: ", before.matches('\n').count() + 1)
}

#[test]
fn what_is_not_supported_is_refused_by_name() {
    for (from, to, expected) in [
        (
            "fmiVersion=\"2.0\"",
            "fmiVersion=\"1.0\"",
            "FMI 1.0 (`fmiVersion=\"1.0\"`) is not supported; export the model for FMI 2.0",
        ),
        (
            "fmiVersion=\"2.0\"",
            "fmiVersion=\"3.0-beta.2\"",
            "this version of FMI (`fmiVersion=\"3.0-beta.2\"`) is not supported",
        ),
        ("fmiVersion=\"2.0\"", "fmiVersion=\"4.0\"", "this version of FMI"),
        ("fmiVersion=\"2.0\"", "", "`<fmiModelDescription>` has no attribute `fmiVersion`"),
        (
            "<CoSimulation modelIdentifier=\"drive\"",
            "<CoSimulatio modelIdentifier=\"drive\"",
            "an FMU for model exchange alone (`<ModelExchange>`) is not supported",
        ),
    ] {
        let message = said(TWO, from, to);
        assert!(message.contains(expected), "{message}");
    }
    let scheduled = said(THREE, "<CoSimulation", "<ScheduledExecution");
    assert!(scheduled.contains("an FMU for scheduled execution alone (`<ScheduledExecution>`)"), "{scheduled}");
    let none = said(THREE, "<CoSimulation", "<Simulation");
    assert_eq!(none, "a.xml:2:1: `<fmiModelDescription>` has no element `<CoSimulation>`");
    for version in ["3.0.2", "3.0"] {
        ModelDescription::read(&THREE.replace("fmiVersion=\"3.0\"", &format!("fmiVersion=\"{version}\"")), "").unwrap();
    }
}

#[test]
fn attributes_of_fmi_2_have_their_place() {
    for (from, to, at, expected) in [
        (
            "modelIdentifier=\"drive\"",
            "modelIdentifier=\"../../lib\"",
            "modelIdentifier=\"drive\"",
            "expected an identifier of C",
        ),
        (
            "canInterpolateInputs=\"1\"",
            "canInterpolateInputs=\"yes\"",
            "canInterpolateInputs",
            "`canInterpolateInputs=\"yes\"` of `<CoSimulation>`: expected `true`, `false`, `1` or `0`",
        ),
        ("stopTime=\"2.5\"", "stopTime=\"nan\"", "stopTime", "expected a finite number"),
        ("stopTime=\"2.5\"", "stopTime=\"NaN\"", "stopTime", "expected a finite number"),
        ("K=\"1\"", "K=\"0.5\"", "K=\"1\"", "expected a whole number of 32 bits"),
        ("factor=\"0.10471975511965977\"", "factor=\"0\"", "factor=", "expected a finite number that is not zero"),
        (
            "<Unit name=\"degC\"",
            "<Unit name=\"rpm\"",
            "name=\"degC\"",
            "`name=\"rpm\"` of `<Unit>` stands for `another unit` already",
        ),
        ("max=\"3000\"", "max=\"-7000\"", "max=\"3000\"", "expected at least `min`, -6000"),
        ("start=\"-1.5e1\"", "start=\"-1,5\"", "start=\"-1.5e1\"", "expected a number"),
        ("start=\"-1.5e1\"", "start=\"inf\"", "start=\"-1.5e1\"", "expected a number"),
        ("start=\"-1.5e1\"", "start=\"1 2\"", "<ScalarVariable name=\"speed\"", "expected one value"),
        (
            "declaredType=\"Speed\"",
            "declaredType=\"Mode\"",
            "declaredType=\"Speed\"",
            "a type of <TypeDefinitions> that is `Float64`",
        ),
        ("declaredType=\"Mode\" ", "", "<Enumeration declaredType", "`<Enumeration>` has no attribute `declaredType`"),
        ("value=\"5\"", "value=\"1\"", "value=\"5\"", "stands for `off` already"),
        (
            "name=\"turns\"",
            "name=\"time\"",
            "name=\"turns\"",
            "`name=\"time\"` of `<ScalarVariable>` stands for `variable number 1` already",
        ),
        (
            "valueReference=\"7\"",
            "valueReference=\"-7\"",
            "valueReference=\"7\"",
            "expected a whole number of 32 bits without a sign",
        ),
        (
            "<Integer min=\"-10\" max=\"10\"/>",
            "<Float64/>",
            "<ScalarVariable name=\"turns\"",
            "`<ScalarVariable>` has no element `<Real>`, `<Integer>`",
        ),
        ("derivative=\"3\"", "derivative=\"12\"", "derivative", "position (FMI 2.0)"),
        ("index=\"6\"/>\n      ", "index=\"12\"/>\n", "index=\"6\"/>", "expected the position of a variable, 1 to 11"),
        ("index=\"6\"/>\n      ", "index=\"0\"/>\n", "index=\"6\"/>", "expected the position of a variable, 1 to 11"),
        ("dependencies=\"2 5\"", "dependencies=\"2 50\"", "dependencies=\"2 5\"", "of each number"),
        (
            "\"dependent fixed\"",
            "\"dependent\"",
            "dependenciesKind=\"dependent fixed\"",
            "a kind for each of the 2 dependencies",
        ),
        ("guid=", "gid=", "<fmiModelDescription", "`<fmiModelDescription>` has no attribute `guid`"),
    ] {
        let message = said(TWO, from, to);
        let place = place(TWO, at);
        assert!(message.starts_with(&place) && message.contains(expected), "{place} {expected}\n{message}");
    }
}

#[test]
fn attributes_of_fmi_3_have_their_place() {
    for (from, to, at, expected) in [
        (
            "fixedInternalStepSize=\"0.001\"",
            "fixedInternalStepSize=\"-1\"",
            "fixedInternalStepSize",
            "a positive number of seconds",
        ),
        ("start=\"-128\"", "start=\"-129\"", "start=\"-128\"", "a whole number from -128 to 127"),
        ("start=\"18446744073709551615\"", "start=\"18446744073709551616\"", "start=\"184467", "18446744073709551615"),
        ("start=\"true 0 false\"", "start=\"true 0\"", "start=\"true 0 false\"", "expected one value or 3, got 2"),
        (
            "start=\"3\" min",
            "start=\"0\" min",
            "valueReference=\"1\"/>\n      <Alias",
            "structural parameter of type `UInt64`, at least 1",
        ),
        (
            "<Dimension start=\"2\"/><Dimension v",
            "<Dimension start=\"0\"/><Dimension v",
            "start=\"2\"/><Dimension v",
            "a whole number, at least 1",
        ),
        (
            "<Dimension start=\"2\"/><Dimension v",
            "<Dimension/><Dimension v",
            "<Dimension start=\"2\"/><Dimension v",
            "no attribute `start` or `valueReference`",
        ),
        ("value=\"00fFa0\"", "value=\"00f\"", "value=\"00fFa0\"", "two hexadecimal digits"),
        ("name=\"set-points\"", "name=\"gains\"", "name=\"gains\"", "stands for `variable number 3` already"),
        (
            "valueReference=\"12\" causality",
            "valueReference=\"11\" causality",
            "valueReference=\"12\" c",
            "`valueReference=\"11\"` of `<Float64>` stands for",
        ),
        ("<Float64Type", "<Float16Type", "<Float64Type", "the element is `<Float16Type>`, expected `Float32`"),
        ("<Int8 ", "<Integer ", "<Int8 ", "the element is `<Integer>`, expected `Float32`"),
        (
            "<Output valueReference=\"10\"",
            "<Output valueReference=\"99\"",
            "valueReference=\"10\"/>",
            "the value reference of a variable",
        ),
        (
            "causality=\"output\" intervalVariability=\"triggered\"",
            "causality=\"output\"",
            "<Clock",
            "`<Clock>` has no attribute `intervalVariability`",
        ),
        (
            "causality=\"output\" intervalVariability=\"triggered\"",
            "causality=\"output\" intervalVariability=\"constant\" intervalDecimal=\"1\"",
            "intervalVariability",
            "`triggered` for a clock that is no input",
        ),
        (
            "causality=\"output\" intervalVariability=\"triggered\"",
            "causality=\"input\" intervalVariability=\"constant\"",
            "<Clock",
            "`<Clock>` has no attribute `intervalDecimal`",
        ),
        (
            "causality=\"output\" intervalVariability=\"triggered\"",
            "causality=\"output\" intervalVariability=\"periodic\"",
            "intervalVariability",
            "`constant`, `fixed`",
        ),
        (
            "causality=\"output\" intervalVariability=\"triggered\"",
            "causality=\"input\"  intervalDecimal=\"0\" intervalVariability=\"fixed\"",
            "intervalVariability",
            "more than 0 s",
        ),
        ("clocks=\"10\"", "clocks=\"10 9\"", "clocks=", "value references of variables of the type `Clock`"),
        ("value=\"9223372036854775807\"", "value=\"9223372036854775808\"", "value=\"922", "a whole number of 64 bits"),
    ] {
        let message = said(THREE, from, to);
        let place = place(THREE, at);
        assert!(message.starts_with(&place) && message.contains(expected), "{place} {expected}\n{message}");
    }
}

#[test]
fn combinations_that_the_standard_excludes_are_refused() {
    for (from, to, expected) in [
        (
            "name=\"inertia\" valueReference=\"4\" causality=\"parameter\" variability=\"fixed\"",
            "name=\"inertia\" valueReference=\"4\" causality=\"parameter\"",
            "variable `inertia`: causality `parameter`, variability `continuous`, type `Float64` are not allowed; the standard has `fixed` or `tunable`",
        ),
        (
            "causality=\"output\" variability=\"discrete\"",
            "causality=\"output\" variability=\"fixed\"",
            "variability `fixed`, type `Int32` are not allowed; the standard has `constant` or `discrete`",
        ),
        (
            "causality=\"output\" variability=\"discrete\"",
            "causality=\"output\" variability=\"continuous\"",
            "the standard has `constant` or `discrete`",
        ),
        (
            "causality=\"independent\" variability=\"continuous\"",
            "causality=\"independent\" variability=\"fixed\"",
            "the standard has `continuous` for this causality",
        ),
        (
            "valueReference=\"5\" causality=\"output\"",
            "valueReference=\"5\" causality=\"input\" initial=\"approx\"",
            "variable `winding`: initial `approx` is not allowed; the standard has `exact` for causality `input`",
        ),
        (
            "valueReference=\"3\">",
            "valueReference=\"3\" variability=\"fixed\" initial=\"exact\">",
            "`calculated` or `approx` for causality `local`",
        ),
    ] {
        let message = said(TWO, from, to);
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn what_is_no_xml_or_too_much_of_it_is_refused() {
    for (text, expected) in [
        ("", "a.xml:1:1: no well-formed XML"),
        ("<fmiModelDescription>", "no well-formed XML"),
        ("<a/>", "a.xml:1:1: the element is `<a>`, expected `<fmiModelDescription>`"),
        ("<!DOCTYPE x [<!ENTITY a \"b\">]><fmiModelDescription/>", "no well-formed XML: XML with DTD detected"),
        (&format!("<a>\n{}", "<b>".repeat(1000)), "a.xml:2:190: the depth of elements in each other is more than 64"),
        (&format!("<a {}/>", "b='' ".repeat(129)), "the number of attributes of an element is more than 128"),
        (
            "<fmiModelDescription fmiVersion=\"3.0\"><CoSimulation modelIdentifier=\"a\"/></fmiModelDescription>",
            "has no element `<ModelVariables>`",
        ),
    ] {
        let message = ModelDescription::read(text, "a.xml").unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }
    let huge = said(THREE, "<Dimension start=\"2\"/><Dimension v", "<Dimension start=\"4294967296\"/><Dimension v");
    assert!(huge.contains("the number of elements of the array is more than 16777216"), "{huge}");
}
