//! Models and files beside a scenario, and optional parts.
use super::*;

#[test]
fn what_the_scenario_says_displaces_what_the_model_says() {
    let own = SCREW
        .replace("encoder = { counts", "torque_constant = \"0.5 Nm/Apk\"\nmax_current = \"5 Apk\"\nencoder = { counts")
        .replace("load_encoder", "velocity.gain = \"0.2 Nm s/rad\"\nload_encoder");
    let scenario = scenario(&own);
    let (motor, _, current) = motor(&scenario);
    assert!(same(motor.flux_linkage, 0.5 / 6.0), "instead of the model's back-EMF");
    assert!(same(current.max_current, 5.0) && same(motor.resistance, 1.615));
    assert!(same(params(&scenario).velocity.k_p, 0.2), "instead of the model's bandwidth");
    assert_eq!(params(&scenario).velocity_rate().hertz(), 8_000, "the rest of the sub-table stays");
}

#[test]
fn models_beside_the_scenario_come_before_embedded_ones() {
    let folder = tempfile::tempdir().unwrap();
    let deep = folder.path().join("a/b");
    std::fs::create_dir_all(&deep).unwrap();
    std::fs::create_dir_all(folder.path().join("models/drives")).unwrap();
    // A project: files above it are out of the scenario's reach.
    std::fs::create_dir_all(folder.path().join(".git")).unwrap();
    let mine =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/drives/servo-16khz.toml"))
            .unwrap()
            .replace("560 V", "48 V");
    std::fs::write(folder.path().join("models/drives/servo-16khz.toml"), mine).unwrap();
    let loaded = parse("test.toml", SCREW, Some(&deep)).unwrap();
    assert!(same(motor(&loaded.scenario).1, 48.0));
    assert!(
        loaded.warnings.iter().any(|one| one.message.contains("the built-in model `servo-16khz`")),
        "{:?}",
        loaded.warnings
    );
    let names: Vec<_> = loaded.sources.ids().map(|id| loaded.sources.name(id).to_owned()).collect();
    assert_eq!(names.len(), 3, "the scenario, the motor, the drive: {names:?}");
    assert_eq!(names[1], "<embedded>/models/motors/wittenstein-premo-1f.toml");
    let paths: Vec<_> = loaded.scenario.made_of.iter().map(|file| file.path.as_str()).collect();
    assert_eq!(paths, ["test.toml", names[1].as_str(), "models/drives/servo-16khz.toml"]);
    std::fs::remove_dir(folder.path().join(".git")).unwrap();
    let loaded = parse("test.toml", SCREW, Some(&deep)).unwrap();
    assert!(same(motor(&loaded.scenario).1, 560.0), "without a project the folder above is outside");
}

const RING_DOWN: &str = r#"
[run]
base_rate = "16 kHz"
[axis]
model = "two-mass"
gear_ratio = 5
[motor]
model = "saarakkala-2.2kw"
[drive]
enabled = false
[initial]
load_position = "90 deg"
load_velocity = "60 rpm"
"#;

#[test]
fn a_drive_that_is_off_needs_no_loops() {
    let scenario = scenario(RING_DOWN);
    assert_eq!(scenario.actuator, Actuator::Off(None));
    assert!(same(scenario.initial.load_position, PI / 2.0) && same(scenario.initial.load_velocity, TAU));
    assert!(same(scenario.axis.transmission, 0.2));
    assert_eq!((scenario.duration, scenario.record.rate.hertz(), scenario.name.as_str()), (None, 16_000, "test"));
}

#[test]
fn a_prescribed_motor_needs_neither_drive_nor_inertia() {
    let scenario = scenario(
        "[run]\nbase_rate = \"16 kHz\"\n[axis]\nmotion = \"linear\"\n[axis.load]\nmass = \"10 kg\"\nstiffness = \"6e5 N/m\"\n\
         [motor]\nkind = \"prescribed\"\n",
    );
    assert_eq!((scenario.actuator, scenario.axis.motor_motion), (Actuator::Prescribed, Coordinate::Linear));
}

#[test]
fn a_users_own_mjcf_is_read_beside_the_file_that_names_it() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/own-mjcf.toml");
    let scenario = servobench_scenario::load(&path).unwrap().scenario;
    let AxisMechanics::Mjcf(mjcf) = &scenario.axis.mechanics else { panic!("MJCF") };
    assert!(
        mjcf.xml.contains("<mujoco model=\"swaying load\">") && mjcf.path.ends_with("models/axes/swaying-load.xml")
    );
    assert_eq!(
        (mjcf.motor_joint.as_str(), mjcf.load_joint.as_str(), mjcf.actuator.as_str()),
        ("carriage", "load", "force")
    );
    assert!(same(params(&scenario).velocity.k_p, 30.0 * TAU * 15.0), "from the estimate");
}

#[test]
fn a_move_has_limits_of_its_own_and_a_pause_has_none() {
    let file = |step: &str, limit: &str| {
        let setpoint = "[setpoint]\norder = 2\nvelocity = \"1 m/s\"\nacceleration = \"1 m/s2\"\n";
        format!("{SCREW}{setpoint}[[program]]\n{step}\n[program.limits]\n{limit}\n")
    };
    let band = "following_error_cruise_load = { min = \"0.8 mm\", max = \"0.9 mm\" }";
    let Some(Step::Move(MoveStep { metric_limits, .. })) = scenario(&file("move_to = \"1 m\"", band)).program.pop()
    else {
        panic!("a move")
    };
    let metric = Name::FollowingErrorCruiseLoad;
    assert_eq!(metric_limits, [Limit { metric, min: Some(0.8e-3), max: Some(0.9e-3) }]);
    for (step, limit, refusal) in [
        ("wait = \"1 s\"", band, "a pause has no `limits`"),
        ("move_to = \"1 m\"", "settling_time = \"1 s\"", "`settling_time` needs a settling window"),
        ("move_to = \"1 m\"", "following_error_cruise_load = { min = \"-1 mm\" }", "`min` must be zero or more"),
    ] {
        let found = servobench_scenario::parse("test", &file(step, limit), None).unwrap_err().to_string();
        assert!(found.contains(refusal), "{found}");
    }
}
