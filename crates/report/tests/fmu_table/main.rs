//! The table of what is inside an FMU.

use servobench_fmi::{Causality, DataType, Dimension, ModelDescription, Unit, Values, Variability, Variable, Version};
use servobench_report::{Style, fmu_table};

const TWO: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="Machine.Gantry" guid="{1}" description="Gantry with a flexible beam"
    author="A. Maker" version="1.4" license="BSD-3-Clause" generationTool="Toolbox 7.1"
    generationDateAndTime="2026-03-02T08:15:00Z">
  <CoSimulation modelIdentifier="gantry" canInterpolateInputs="true" maxOutputDerivativeOrder="1"
      canBeInstantiatedOnlyOncePerProcess="true" needsExecutionTool="true" canGetAndSetFMUstate="true"/>
  <UnitDefinitions><Unit name="N.m"/><Unit name="rad"/></UnitDefinitions>
  <TypeDefinitions>
    <SimpleType name="Brake"><Enumeration>
      <Item name="open" value="0" description="the axis moves freely"/><Item name="closed" value="1"/>
    </Enumeration></SimpleType>
  </TypeDefinitions>
  <DefaultExperiment startTime="0" stopTime="2.5" tolerance="1e-6" stepSize="0.00005"/>
  <ModelVariables>
    <ScalarVariable name="torque" valueReference="0" causality="input" description="of the motor">
      <Real unit="N.m" start="0" min="-12.5" max="12.5"/></ScalarVariable>
    <ScalarVariable name="brake" valueReference="0" causality="input" variability="discrete">
      <Enumeration declaredType="Brake" start="1"/></ScalarVariable>
    <ScalarVariable name="angle" valueReference="1" causality="output" description="of the shaft"><Real unit="rad"/></ScalarVariable>
    <ScalarVariable name="acceleration" valueReference="2" causality="output"><Real/></ScalarVariable>
    <ScalarVariable name="count" valueReference="1" causality="parameter" variability="tunable">
      <Integer min="1"/></ScalarVariable>
  </ModelVariables>
  <ModelStructure><Outputs><Unknown index="3" dependencies=""/><Unknown index="4" dependencies="1"/></Outputs></ModelStructure>
</fmiModelDescription>"#;

const THREE: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0.2" modelName="Filter" instantiationToken="2">
  <CoSimulation modelIdentifier="filter" canHandleVariableCommunicationStepSize="true" canSerializeFMUState="true"
      fixedInternalStepSize="0.001" hasEventMode="true" mightReturnEarlyFromDoStep="true"/>
  <ModelVariables>
    <UInt64 name="order" valueReference="1" causality="structuralParameter" variability="fixed" start="3"/>
    <Float64 name="gains" valueReference="2" causality="parameter" variability="tunable" start="1 2.5 1e-9">
      <Dimension valueReference="1"/></Float64>
    <Float32 name="samples" valueReference="3" causality="input" start="0"><Dimension start="2"/><Dimension start="4"/></Float32>
    <String name="file" valueReference="4" causality="parameter" variability="fixed"><Start value="table.csv"/></String>
    <Boolean name="ready" valueReference="5" causality="output"/>
    <Float64 name="filtered" valueReference="6" causality="output"><Alias name="result"/></Float64>
    <Float64 name="state" valueReference="7"/>
    <Float64 name="rate" valueReference="8" derivative="7"/>
    <Float64 name="time" valueReference="9" causality="independent"/>
  </ModelVariables>
  <ModelStructure><Output valueReference="5"/><Output valueReference="6"/></ModelStructure>
</fmiModelDescription>"#;

fn read(text: &str) -> ModelDescription {
    ModelDescription::read(text, "test.fmu/modelDescription.xml").unwrap()
}

fn files(names: &[&str]) -> Vec<String> {
    names.iter().map(ToString::to_string).collect()
}

/// The table, no line of which is wider than asked for.
fn table(description: &ModelDescription, files: &[String], width: usize) -> String {
    let table = fmu_table(description, files, Style { width, colour: false });
    for line in table.lines() {
        assert!(line.chars().count() <= width, "{} columns of {width}: {line}", line.chars().count());
        assert_eq!(line, line.trim_end());
    }
    table
}

fn variable(name: &str, value_reference: u32, causality: Causality) -> Variable {
    Variable {
        name: name.into(),
        value_reference,
        description: String::new(),
        causality,
        variability: Variability::Continuous,
        initial: None,
        data_type: DataType::Float64,
        declared_type: String::new(),
        enumeration: None,
        dimensions: vec![],
        start: Some(Values::Float(vec![0.0])),
        min: None,
        max: None,
        nominal: None,
        quantity: String::new(),
        unit: None,
        display_unit: String::new(),
        is_relative: false,
        derivative_of: None,
        ticks: None,
        clocks: vec![],
        aliases: vec![],
    }
}

#[test]
fn version_two() {
    let files = files(&["modelDescription.xml", "binaries/linux64/gantry.so", "binaries/win64/gantry.dll"]);
    insta::assert_snapshot!(table(&read(TWO), &files, 80));
}

#[test]
fn version_three() {
    let files = files(&["binaries/x86_64-windows/filter.dll", "sources/filter.c"]);
    insta::assert_snapshot!(table(&read(THREE), &files, 80));
}

#[test]
fn no_width_is_exceeded() {
    for width in [80, 100, 132] {
        table(&read(TWO), &[], width);
        table(&read(THREE), &[], width);
    }
}

/// A name is what a scenario maps by: it is never cut short.
#[test]
fn names_longer_than_the_column_are_complete() {
    let long = "machine.".repeat(4) + "position";
    let longest = "ß".repeat(200);
    let mut all = [variable(&long, 1, Causality::Input), variable(&longest, 2, Causality::Input)];
    all[0].description = "þ".repeat(120);
    let table = table(&ModelDescription::new(Version::Three, "Long", "t", all.to_vec()), &[], 80);
    assert!(table.lines().any(|line| line == long), "{table}");
    assert_eq!(table.matches('ß').count(), 200, "{table}");
    assert_eq!(table.matches('þ').count(), 120, "{table}");
}

/// What is longer than its column is told with the description, in full.
#[test]
fn no_text_of_a_column_is_lost() {
    let mut one = variable("one", 1, Causality::Parameter);
    one.variability = Variability::Tunable;
    one.data_type = DataType::Int32;
    (one.min, one.max) = (Some(-2_147_483_648.0), Some(2_147_483_647.0));
    one.start = Some(Values::Integer(vec![-1_000_000_007, 2, 3, 4]));
    let table = table(&ModelDescription::new(Version::Three, "Wide", "t", vec![one]), &[], 80);
    let words = table.split_whitespace().collect::<Vec<_>>().join(" ");
    let wanted = "one Int32 … … tunable; start -1000000007, 2, 3, …; range -2147483648 to 2147483647";
    assert!(words.ends_with(wanted), "{table}");
}

/// 24 + 14 + 9 + 12 + 17 characters and four spaces are the 80 columns: the description goes below.
#[test]
fn the_widest_columns_fill_the_line() {
    let mut one = variable(&"n".repeat(24), 1, Causality::Input);
    one.dimensions = vec![Dimension::Fixed(10), Dimension::Fixed(10)];
    one.start = Some(Values::Float(vec![-123_456.789_1]));
    (one.min, one.max) = (Some(-123_456.0), Some(123_456.0));
    one.unit = Some(0);
    one.description = "a matrix of energies".into();
    let mut description = ModelDescription::new(Version::Three, "Wide", "t", vec![one]);
    description.units = vec![Unit { name: "kg.m2.s-2".into(), base: None, display: vec![] }];
    let table = table(&description, &[], 80);
    let wanted =
        "nnnnnnnnnnnnnnnnnnnnnnnn Float64[10,10] kg.m2.s-2 -123456.7891 -123456 to 123456\n    a matrix of energies\n";
    assert!(table.ends_with(wanted), "{table}");
}

#[test]
fn without_variables() {
    let table = table(&ModelDescription::new(Version::Two, "Empty", "t", vec![]), &[], 80);
    assert!(table.ends_with("\nIt has no variables.\n"), "{table}");
    assert!(table.contains("platforms    none\n"), "{table}");
}

#[test]
fn of_two_hundred_variables_forty_are_shown() {
    let all = (0..200).map(|at| variable(&format!("local{at}"), at, Causality::Local)).collect();
    let table = table(&ModelDescription::new(Version::Three, "Many", "t", all), &[], 80);
    assert!(table.contains("\nLOCAL VARIABLES (200)\n"), "{table}");
    assert_eq!(table.lines().filter(|line| line.starts_with("local")).count(), 40);
    assert!(table.contains("… and 160 more; all: `unzip -p FILE modelDescription.xml`\n"), "{table}");
}

/// Folders of both versions are taken for Linux on x86-64, of either version: the loader does so.
#[test]
fn a_library_for_this_platform_is_looked_for() {
    for (file, is_there) in [
        ("binaries/linux64/gantry.so", true),
        ("binaries/x86_64-linux/gantry.so", true),
        ("binaries/linux64/other.so", false),
        ("binaries/linux32/gantry.so", false),
    ] {
        let table = table(&read(TWO), &files(&[file]), 80);
        assert_eq!(!table.contains("it has no `binaries/linux64/gantry.so`"), is_there, "{table}");
    }
}

#[test]
fn nothing_steers_the_terminal() {
    let hostile = TWO.replace("torque", "a\u{9b}2Jb").replace("Gantry with", "x\u{202e}y");
    let table = table(&read(&hostile), &files(&["binaries/\u{1b}[2J/x.so"]), 80);
    assert!(!table.contains(|c: char| c.is_control() && c != '\n'), "{table:?}");
    assert!(!table.contains('\u{202e}'), "{table:?}");
}
