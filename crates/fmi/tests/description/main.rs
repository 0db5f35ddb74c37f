//! Model descriptions written by hand, and mistakes in changed ones.
mod mistakes;

use servobench_fmi::{
    Causality, DataType, DependencyKind, Dimension, Exponents, Initial, IntervalVariability, ModelDescription, Ticks,
    Values, Variability, Version,
};

pub(crate) const TWO: &str = include_str!("drive2.xml");
pub(crate) const THREE: &str = include_str!("drive3.xml");

fn read(text: &str) -> ModelDescription {
    ModelDescription::read(text, "a.xml").unwrap()
}

#[test]
fn fmi_2_says_who_made_it_and_what_it_can() {
    let it = read(TWO);
    assert_eq!((it.version, it.fmi_version.as_str()), (Version::Two, "2.0"));
    assert_eq!(it.model_name, "Drive & load");
    assert_eq!(it.instantiation_token, "{8c4e810f-3df3-4a00-8276-176fa3c9f9e0}");
    assert_eq!(
        (it.author.as_str(), it.generation_tool.as_str(), it.copyright.as_str()),
        ("A. Nonymous", "by hand", "")
    );
    let can = &it.co_simulation;
    assert_eq!(can.model_identifier, "drive", "not that for model exchange");
    assert!(can.can_handle_variable_communication_step_size && can.can_interpolate_inputs && can.can_get_and_set_state);
    assert!(!can.can_serialize_state && !can.has_event_mode && !can.needs_execution_tool);
    assert_eq!(can.max_output_derivative_order, 2);
    let experiment = it.default_experiment;
    assert_eq!((experiment.start_time, experiment.stop_time), (Some(0.0), Some(2.5)));
    assert_eq!((experiment.tolerance, experiment.step_size), (Some(1e-6), Some(1e-3)));
    assert_eq!(it.log_categories[0].name, "logEvents");
}

#[test]
fn fmi_2_variables() {
    let it = read(TWO);
    assert_eq!(it.variables.len(), 11);
    let torque = it.variable("torque").unwrap();
    assert_eq!((torque.causality, torque.variability), (Causality::Input, Variability::Continuous));
    assert_eq!((torque.value_reference, torque.description.as_str()), (1, "Shaft torque"));
    let exponents = Exponents { kg: 1, m: 2, s: -2, ..Exponents::default() };
    assert_eq!(it.unit(torque).unwrap().base.unwrap().exponents, exponents);
    let speed = it.variable("speed").unwrap();
    assert_eq!((speed.min, speed.max), (Some(-6000.0), Some(3000.0)), "of the type, and its own");
    assert_eq!((speed.start.clone(), speed.initial), (Some(Values::Float(vec![-15.0])), Some(Initial::Exact)));
    assert_eq!((speed.quantity.as_str(), speed.display_unit.as_str()), ("AngularVelocity", "1/s"));
    // Oracle: 3000 rpm are 100π rad/s; the factor of the file has 17 digits.
    let si = it.unit(speed).unwrap().base.unwrap().to_si(3000.0, speed.is_relative);
    assert!((si - 100.0 * std::f64::consts::PI).abs() < 1e-12);
    assert_eq!(it.variable("der(speed)").unwrap().derivative_of, it.position("speed"));
    assert_eq!(it.variable("turns").unwrap().data_type, DataType::Int32);
    assert_eq!(it.variable("enable").unwrap().start, Some(Values::Boolean(vec![true])));
    assert_eq!(it.variable("table").unwrap().start, Some(Values::String(vec!["a < b.csv".into()])));
    let mode = it.variable("mode").unwrap();
    assert_eq!(mode.start, Some(Values::Integer(vec![2])));
    let items: Vec<_> =
        it.enumeration(mode).unwrap().items.iter().map(|item| (item.name.as_str(), item.value)).collect();
    assert_eq!(items, [("off", 1), ("torque", 2), ("speed", 5)]);
    assert_eq!(it.variable("velocity").unwrap().value_reference, speed.value_reference, "an alias of FMI 2.0");
    assert_eq!(it.remarks, ["the unit `furlong` is not defined in <UnitDefinitions>"]);
}

#[test]
fn fmi_2_structure() {
    let it = read(TWO);
    let at = |name| it.position(name).unwrap();
    let speed = &it.structure.outputs[0];
    let expected = vec![(at("torque"), DependencyKind::Dependent), (at("inertia"), DependencyKind::Fixed)];
    assert_eq!((speed.variable, speed.dependencies.clone()), (at("speed"), Some(expected)));
    assert!(it.structure.feeds_through(at("speed"), at("torque")));
    assert!(!it.structure.feeds_through(at("speed"), at("enable")));
    assert!(it.structure.feeds_through(at("winding"), at("enable")), "it does not say");
    assert!(!it.structure.feeds_through(at("turns"), at("torque")), "it says: on nothing");
    assert_eq!(it.structure.derivatives[0].variable, at("der(speed)"));
    assert_eq!(it.structure.initial_unknowns.len(), 1);
}

#[test]
fn fmi_3_variables() {
    let it = read(THREE);
    assert_eq!((it.version, it.variables.len()), (Version::Three, 14));
    assert!(it.co_simulation.has_event_mode && it.co_simulation.might_return_early_from_do_step);
    assert_eq!(it.co_simulation.fixed_internal_step_size, Some(1e-3));
    let targets = it.variable("targets").unwrap();
    assert_eq!(targets.dimensions, [Dimension::Structural(it.position("n").unwrap())]);
    assert_eq!((it.shape(targets), targets.max), (vec![3], Some(500.0)));
    assert_eq!(it.variable("set-points"), Some(targets), "an alias");
    assert_eq!(it.unit(targets).unwrap().display[0].name, "um");
    let gains = it.variable("gains").unwrap();
    assert_eq!((it.shape(gains), gains.start.clone()), (vec![2, 3], Some(Values::Float(vec![0.5]))));
    assert_eq!(gains.variability, Variability::Fixed, "a parameter that does not say");
    assert_eq!(it.variable("a").unwrap().start, Some(Values::Integer(vec![-128])));
    assert_eq!(it.variable("b").unwrap().start, Some(Values::Integer(vec![u64::MAX.into()])));
    assert_eq!(it.variable("flags").unwrap().start, Some(Values::Boolean(vec![true, false, false])));
    assert_eq!(it.variable("words").unwrap().start, Some(Values::String(vec!["one".into(), "t w o".into()])));
    assert_eq!(it.variable("blob").unwrap().start, Some(Values::Binary(vec![vec![0, 255, 160]])));
    let state = it.variable("state").unwrap();
    assert_eq!(it.enumeration(state).unwrap().items[1].value, i64::MAX);
    assert_eq!((state.variability, state.initial), (Variability::Discrete, Some(Initial::Calculated)));
    assert_eq!(it.variable("sampled").unwrap().clocks, [10]);
    let triggered = Ticks { variability: IntervalVariability::Triggered, interval: None, shift: 0.0 };
    assert_eq!(it.variable("tick").unwrap().ticks, Some(triggered));
    let text = THREE.replace(
        "causality=\"output\" intervalVariability=\"triggered\"",
        "causality=\"input\" intervalVariability=\"fixed\" intervalDecimal=\"2.5e-3\" shiftDecimal=\"1\"",
    );
    let fixed = Ticks { variability: IntervalVariability::Fixed, interval: Some(2.5e-3), shift: 1.0 };
    assert_eq!(read(&text).variable("tick").unwrap().ticks, Some(fixed));
    assert_eq!(it.variable("sampled").unwrap().start, Some(Values::Float(vec![f64::INFINITY])));
    assert_eq!(it.variable("der(x)").unwrap().derivative_of, it.position("x"));
    assert_eq!(it.remarks, [""; 0]);
}

#[test]
fn fmi_3_structure() {
    let it = read(THREE);
    let at = |name| it.position(name).unwrap();
    assert!(it.structure.feeds_through(at("sampled"), at("targets")));
    assert!(!it.structure.feeds_through(at("sampled"), at("flags")));
    assert!(!it.structure.feeds_through(at("state"), at("flags")));
    assert_eq!(it.structure.derivatives[0].variable, at("der(x)"));
}

/// Omissions of many tools have one meaning, and are remarked on.
#[test]
fn what_is_left_out_is_remarked() {
    let text = TWO
        .replace(r#"<Real start="0" unit="N.m"/>"#, "<Real/>")
        .replace("<Real start=\"0.002\" min=\"0\"/>", "<Real/>");
    let remarks = read(&text).remarks;
    let missing = |name| format!("`{name}` has no start value and should have one");
    assert_eq!(remarks[..2], [missing("torque"), missing("inertia")]);
    let text = TWO.replace("<Integer min=\"-10\" max=\"10\"/>", "<Integer start=\"1\"/>");
    assert_eq!(read(&text).remarks[0], "`turns` has a start value, which is not used: it is calculated");
}
