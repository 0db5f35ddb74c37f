//! `modelDescription.xml` of the table of variables.
use crate::ffi::CATEGORIES;
use crate::interface::{Choice, Kind, Role, Variable as Row};
use crate::machine::Model;
use crate::part::Part;
use crate::units::{self, NoUnit};
use servobench_fmi::{
    Causality, CoSimulation, DataType, DefaultExperiment, DependencyKind, Enumeration, Initial, Item, LogCategory,
    ModelDescription, ModelStructure, Unit, Unknown, Values, Variability, Variable, Version,
};

/// The description of `model` with this token, whose library has this file name.
///
/// # Errors
/// [`NoUnit`] for a unit that has no definition.
pub(crate) fn describe(
    model: &Model,
    version: Version,
    token: &str,
    identifier: &str,
) -> Result<ModelDescription, NoUnit> {
    let mut units: Vec<Unit> = vec![];
    let variables: Result<Vec<_>, _> =
        (0..).zip(&model.variables).map(|(at, row)| variable(at, row, &mut units)).collect();
    let scenario = &model.scenario;
    let mut description = ModelDescription::new(version, &scenario.name, token, variables?);
    let what = match model.part {
        Part::Axis => "a servo axis",
        Part::Drive => "the drive of a servo axis",
        Part::Mechanics => "the mechanics of a servo axis",
    };
    let overrides: Vec<String> = scenario.overrides.iter().map(ToString::to_string).collect();
    let with = if overrides.is_empty() { String::new() } else { format!(" with {}", overrides.join(", ")) };
    description.description = if scenario.description.is_empty() {
        format!("{what}{with}")
    } else {
        format!("{what}{with}: {}", scenario.description)
    };
    description.generation_tool = format!("servobench {}", env!("CARGO_PKG_VERSION"));
    let step = scenario.base_rate.period();
    description.co_simulation = CoSimulation {
        model_identifier: identifier.into(),
        can_handle_variable_communication_step_size: true,
        can_get_and_set_state: true,
        can_serialize_state: true,
        fixed_internal_step_size: Some(step),
        ..CoSimulation::default()
    };
    description.default_experiment = DefaultExperiment {
        start_time: Some(0.0),
        stop_time: Some(model.length),
        step_size: Some(step),
        tolerance: None,
    };
    let category =
        |(name, description): (&str, &str)| LogCategory { name: name.into(), description: description.into() };
    description.log_categories = CATEGORIES.map(category).into();
    description.units = units;
    description.enumerations = enumerations(model);
    description.structure = structure(model);
    Ok(description)
}

fn variable(at: u32, row: &Row, units: &mut Vec<Unit>) -> Result<Variable, NoUnit> {
    let (causality, initial) = match row.role {
        Role::Time => (Causality::Independent, None),
        Role::Input(_) => (Causality::Input, None),
        Role::Setting(_) => (Causality::Parameter, Some(Initial::Exact)),
        Role::Output(_) => (Causality::Output, Some(Initial::Calculated)),
    };
    let variability = match (row.role, row.kind) {
        (Role::Setting(_), _) => Variability::Fixed,
        (_, Kind::Real) => Variability::Continuous,
        _ => Variability::Discrete,
    };
    let unit = if row.unit.is_empty() { None } else { Some(position(units, units::definition(&row.unit)?)) };
    let (least, most) = row.range();
    let has_start = matches!(row.role, Role::Input(_) | Role::Setting(_));
    #[expect(clippy::cast_possible_truncation, reason = "an item of an enumeration or an integer of 32 bits")]
    let start = match row.kind {
        Kind::Real => Values::Float(vec![row.start]),
        Kind::Integer | Kind::Enumeration(_) => Values::Integer(vec![row.start as i128]),
        Kind::Boolean => Values::Boolean(vec![row.start != 0.0]),
        Kind::Text => Values::String(vec![String::new()]),
    };
    Ok(Variable {
        name: row.name.clone(),
        value_reference: at,
        description: row.description.clone(),
        causality,
        variability,
        initial,
        data_type: match row.kind {
            Kind::Real => DataType::Float64,
            Kind::Integer => DataType::Int32,
            Kind::Boolean => DataType::Boolean,
            Kind::Enumeration(_) => DataType::Enumeration,
            Kind::Text => DataType::String,
        },
        declared_type: match row.kind {
            Kind::Enumeration(choice) => choice.name().into(),
            _ => String::new(),
        },
        enumeration: None,
        dimensions: vec![],
        start: has_start.then_some(start),
        min: (row.kind == Kind::Real && least > f64::MIN).then_some(least),
        max: (row.kind == Kind::Real && most < f64::MAX).then_some(most),
        nominal: None,
        quantity: String::new(),
        unit,
        display_unit: unit.and_then(|at| units[at].display.first()).map(|one| one.name.clone()).unwrap_or_default(),
        is_relative: false,
        derivative_of: None,
        ticks: None,
        clocks: vec![],
        aliases: vec![],
    })
}

/// The position of `unit` in `units`, to which it is added if it is missing.
fn position(units: &mut Vec<Unit>, unit: Unit) -> usize {
    units.iter().position(|one| *one == unit).unwrap_or_else(|| {
        units.push(unit);
        units.len() - 1
    })
}

/// The enumerations used by variables.
fn enumerations(model: &Model) -> Vec<Enumeration> {
    let is_used = |choice: &Choice| model.variables.iter().any(|row| row.kind == Kind::Enumeration(*choice));
    let item = |(value, (name, description)): (i64, (&str, &str))| Item {
        name: name.into(),
        value,
        description: description.into(),
    };
    let all = [Choice::Command, Choice::DriveState, Choice::AxisState].into_iter().filter(is_used);
    all.map(|choice| Enumeration { name: choice.name().into(), items: (1..).zip(choice.items()).map(item).collect() })
        .collect()
}

/// Outputs are the result of a step, and follow no input directly; at the beginning they depend on the parameters.
fn structure(model: &Model) -> ModelStructure {
    let with_role = |is: fn(&Role) -> bool| {
        let all = model.variables.iter().enumerate();
        all.filter(move |(_, row)| is(&row.role)).map(|(at, _)| at)
    };
    let parameters: Vec<_> =
        with_role(|role| matches!(role, Role::Setting(_))).map(|at| (at, DependencyKind::Dependent)).collect();
    let unknowns = |dependencies: &[(usize, DependencyKind)]| {
        let outputs = with_role(|role| matches!(role, Role::Output(_)));
        outputs.map(|variable| Unknown { variable, dependencies: Some(dependencies.to_vec()) }).collect()
    };
    ModelStructure { outputs: unknowns(&[]), derivatives: vec![], initial_unknowns: unknowns(&parameters) }
}
