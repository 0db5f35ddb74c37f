//! A user's own MJCF files.
use super::{STEP, efforts, free_omega, motion, ticks};
use servobench_base::Coordinate;
use servobench_base::Setpoint;
use servobench_engine_mujoco::Mujoco;
use servobench_plant::{
    BodyState, Drive, Engine as _, Mechanics, MechanicsError, MechanicsSetup, MjcfAxis, MjcfModel, Model, Refusal,
    RefusedAt,
};
use std::fs;
use std::path::Path;

/// The two-mass drive as a user may write it: hinges in degrees, a geared motor, a soft clutch as a tendon.
fn two_mass(actuator: &str) -> String {
    format!(
        r#"<mujoco model="two-mass">
  <option timestep="0.002" gravity="0 0 0" integrator="RK4"/>
  <worldbody>
    <body name="rotor">
      <joint name="shaft" type="hinge" axis="1 0 0"/>
      <inertial pos="0 0 0" mass="1" diaginertia="0.005 0.005 0.005"/>
    </body>
    <body name="disc" pos="0.1 0 0">
      <joint name="output" type="hinge" axis="1 0 0"/>
      <inertial pos="0 0 0" mass="1" diaginertia="0.005 0.005 0.005"/>
    </body>
    <body name="spectator" pos="1 0 0">
      <joint name="socket" type="ball"/>
      <inertial pos="0 0 0" mass="1" diaginertia="0.005 0.005 0.005"/>
    </body>
  </worldbody>
  <tendon>
    <fixed name="clutch" stiffness="700"><joint joint="shaft" coef="1"/><joint joint="output" coef="-1"/></fixed>
  </tendon>
  <actuator>{actuator}</actuator>
</mujoco>"#
    )
}

const MOTOR: &str = r#"<motor name="servo" joint="shaft" gear="20"/>"#;

fn model(xml: String) -> MjcfModel {
    MjcfModel {
        xml,
        path: "axis.xml".into(),
        motor_joint: "shaft".into(),
        load_joint: "output".into(),
        actuator: "servo".into(),
        transmission: 1.0,
        axis: None,
        is_smooth: false,
    }
}

fn build(model: MjcfModel, initial: Vec<BodyState>) -> Result<Box<dyn Mechanics>, MechanicsError> {
    let (model, drive) = (Model::Mjcf(model), Drive::Effort);
    Mujoco.build(&MechanicsSetup { model, drive, step: STEP, initial })
}

/// Oracle, from rest under a constant torque T on the shaft: the mean of both angles is T/(4·J)·t², their difference
/// T/(J·ω²)·(1 − cos(ω·t)).
#[test]
fn torque_and_time_step_are_those_of_the_bench() {
    let mut mechanics = build(model(two_mass(MOTOR)), vec![]).unwrap();
    let (torque, w, time) = (3.0, free_omega(), 0.01);
    for _ in 0..ticks(time, STEP) {
        mechanics.advance(&efforts(torque, 0.0)).unwrap();
    }
    let centre = torque / (4.0 * 0.005) * time * time;
    let stretch = torque / (0.005 * w * w) * (1.0 - (w * time).cos());
    let (shaft, output) = (mechanics.bodies()[0].position, mechanics.bodies()[1].position);
    // RK4: (ω·h)⁴/120 = 1e-8 per radian.
    assert!((f64::midpoint(shaft, output) / centre - 1.0).abs() < 1e-7, "{shaft} {output}");
    assert!(((shaft - output) / stretch - 1.0).abs() < 1e-6, "{shaft} {output} {stretch}");
}

#[test]
fn initial_states_and_disturbances_reach_the_named_joints() {
    let initial = [(0.1, 0.5), (0.2, -0.5)];
    let state = |(position, velocity)| BodyState { position, velocity };
    let mut mechanics = build(model(two_mass(MOTOR)), initial.map(state).to_vec()).unwrap();
    assert_eq!(mechanics.bodies(), initial.map(state));
    mechanics.advance(&efforts(0.0, 8.0)).unwrap();
    // Only the momentum of both is free of the clutch: J·Σv grows by T·h.
    let momentum: f64 = mechanics.bodies().iter().map(|body| 0.005 * body.velocity).sum();
    assert!((momentum - 8.0 * STEP).abs() < 1e-15, "{momentum:e}");
}

#[test]
fn one_joint_can_be_motor_and_load() {
    let one = MjcfModel { load_joint: "shaft".into(), ..model(two_mass(MOTOR)) };
    let mut mechanics = build(one, vec![]).unwrap();
    mechanics.advance(&efforts(1.0, 2.0)).unwrap();
    assert_eq!(mechanics.bodies().len(), 1);
    // The clutch takes (ω·h)²/6 of it within the first tick.
    let expected = 3.0 * STEP / 0.005;
    assert!((mechanics.bodies()[0].velocity / expected - 1.0).abs() < 1e-3);
}

#[test]
fn included_files_are_found_beside_the_model() {
    let folder = tempfile::tempdir().unwrap();
    let tail = two_mass(MOTOR);
    let (start, end) = (tail.find("<tendon>").unwrap(), tail.find("</mujoco>").unwrap());
    fs::create_dir(folder.path().join("parts")).unwrap();
    let part = format!("<mujoco>{}</mujoco>", &tail[start..end]);
    fs::write(folder.path().join("parts/clutch.xml"), part).unwrap();
    let xml = format!(r#"{}<include file="parts/clutch.xml"/></mujoco>"#, &tail[..start]);
    let path = folder.path().join("axis.xml");
    // The text counts, not what the file has become since it was read.
    fs::write(&path, "<mujoco/>").unwrap();
    let mechanics = build(MjcfModel { path, ..model(xml.clone()) }, vec![]);
    assert!(mechanics.is_ok(), "{:?}", mechanics.err());
    let elsewhere = Path::new("/nowhere/axis.xml").into();
    let error = build(MjcfModel { path: elsewhere, ..model(xml) }, vec![]).err().unwrap();
    // Twelve characters of a word of a file.
    assert!(error.to_string().contains("'parts/clutch…'"), "{error}");
}

#[test]
fn unknown_names_are_answered_with_the_known_ones() {
    let wrong = MjcfModel { motor_joint: "shatf".into(), ..model(two_mass(MOTOR)) };
    let error = build(wrong, vec![]).err().unwrap().to_string();
    let wanted = "axis.xml: there is no joint `shatf`; there is `shaft`, `output`, `socket`; change";
    assert!(error.contains(wanted), "{error}");
    let wrong = MjcfModel { load_joint: "socket".into(), actuator: "motor".into(), ..model(two_mass(MOTOR)) };
    let Some(MechanicsError::Refused { refusals, .. }) = build(wrong, vec![]).err() else { panic!("two mistakes") };
    let named = |name: &str, message: &str| Refusal { place: RefusedAt::Name(name.into()), message: message.into() };
    let load = named("socket", "joint `socket` has several degrees of freedom; name a slide or a hinge");
    assert_eq!(refusals, [load, named("motor", "there is no actuator `motor`; there is `servo`")]);
}

#[test]
fn what_cannot_be_the_axis_is_refused_with_the_way_out() {
    for (actuator, load_joint, wanted) in [
        (MOTOR, "socket", "joint `socket` has several degrees of freedom"),
        (r#"<motor name="servo" joint="output"/>"#, "output", "does not act on the motor joint"),
        (r#"<motor name="servo" tendon="clutch"/>"#, "output", "does not act on the motor joint"),
        (r#"<position name="servo" joint="shaft"/>"#, "output", "is more than a motor"),
        (r#"<motor name="servo" joint="shaft" gear="0"/>"#, "output", "its gear or gain is zero"),
    ] {
        let wrong = MjcfModel { load_joint: load_joint.into(), ..model(two_mass(actuator)) };
        let error = build(wrong, vec![]).err().unwrap();
        assert!(matches!(error, MechanicsError::Refused { .. }), "{error}");
        assert!(error.to_string().contains(wanted), "{error}");
    }
}

#[test]
fn an_effort_beyond_a_limit_of_the_model_is_not_clipped_in_silence() {
    for (limit, high) in
        [(r#"ctrllimited="true" ctrlrange="-0.5 0.2""#, 4.0), (r#"forcelimited="true" forcerange="-0.1 0.3""#, 6.0)]
    {
        let motor = format!(r#"<motor name="servo" joint="shaft" gear="20" {limit}/>"#);
        let mut mechanics = build(model(two_mass(&motor)), vec![]).unwrap();
        mechanics.advance(&efforts(high, 0.0)).unwrap();
        let error = mechanics.advance(&efforts(high + 0.1, 0.0)).unwrap_err().to_string();
        assert!(error.contains("actuator `servo`, which the model limits to"), "{error}");
    }
}

#[test]
fn a_prescribed_motion_of_a_file_is_refused() {
    let (model, drive) = (Model::Mjcf(model(two_mass(MOTOR))), Drive::Prescribed);
    let setup = MechanicsSetup { model, drive, step: STEP, initial: vec![] };
    let error = Mujoco.build(&setup).err().unwrap();
    assert!(matches!(error, MechanicsError::Unsupported { .. }), "{error}");
    let mut mechanics = build(super::mjcf::model(two_mass(MOTOR)), vec![]).unwrap();
    assert!(mechanics.advance(&motion(Setpoint::default())).is_err());
}

#[test]
fn a_mistake_in_the_file_is_reported_in_the_words_of_mujoco() {
    let xml = two_mass(MOTOR).replace(r#"type="ball""#, r#"tpye="ball""#);
    let error = build(model(xml), vec![]).err().unwrap();
    assert!(matches!(error, MechanicsError::Model { .. }), "{error}");
    let text = error.to_string();
    assert!(text.contains("tpye") && text.contains("line 13"), "{text}");
}

/// A slide of 2 kg between 0 and 0.3 m.
const WALLS: &str = r#"<mujoco><option gravity="0 0 0" integrator="RK4"/>
<worldbody><body><joint name="shaft" type="slide" axis="1 0 0" range="-0.01 0.3" limited="true" margin="0.004"/>
<inertial pos="0 0 0" mass="2" diaginertia="1 1 1"/></body></worldbody>
<actuator><motor name="servo" joint="shaft" ctrllimited="true" ctrlrange="-9 7"/></actuator></mujoco>"#;

#[test]
fn an_end_of_a_range_binds_while_the_joint_is_there() {
    let one = MjcfModel { load_joint: "shaft".into(), ..model(WALLS.into()) };
    let mut mechanics = build(one, vec![BodyState { position: 0.1, velocity: 0.0 }]).unwrap();
    let texts: Vec<_> = mechanics.joint_limits().iter().map(|limit| limit.text.clone()).collect();
    let end = |which, at| format!("joint `shaft` is at the {which} end of its range, {at} m");
    assert_eq!(texts, [end("lower", "-0.01"), end("upper", "0.3")]);
    for (effort, bound) in [(5.0, 1), (-5.0, 0)] {
        for _ in 0..ticks(1.0, STEP) {
            mechanics.advance(&efforts(effort, 0.0)).unwrap();
            // 4 mm before the end the limit begins to push.
            let position = mechanics.bodies()[0].position;
            let binds = [position < -0.01 + 0.004, position > 0.3 - 0.004];
            let found: Vec<bool> = mechanics.joint_limits().iter().map(|limit| limit.binds).collect();
            assert_eq!(found, binds, "{position}");
        }
        assert!(mechanics.joint_limits()[bound].binds, "{}", mechanics.bodies()[0].position);
    }
    let free = WALLS.replace("RK4\"/>", "RK4\"><flag limit=\"disable\"/></option>");
    let mechanics = build(MjcfModel { load_joint: "shaft".into(), ..model(free) }, vec![]).unwrap();
    assert_eq!(mechanics.joint_limits(), []);
}

#[test]
fn what_does_not_fit_the_axis_is_refused_before_the_run() {
    let axis = |motor, load, max_effort| Some(MjcfAxis { motor, load, max_effort });
    let refusals = |axis| {
        let one = MjcfModel { load_joint: "shaft".into(), axis, ..model(WALLS.into()) };
        match build(one, vec![]).err() {
            Some(MechanicsError::Refused { refusals, .. }) => refusals,
            None => Vec::new(),
            Some(error) => panic!("{error}"),
        }
    };
    assert_eq!(refusals(axis(Coordinate::Linear, Coordinate::Linear, 7.0)), []);
    let [Refusal { place: RefusedAt::Name(name), message }] =
        &refusals(axis(Coordinate::Linear, Coordinate::Linear, 8.5))[..]
    else {
        panic!("the drive is stronger than the actuator")
    };
    assert!(
        name == "servo" && message.contains("up to 8.5 N of actuator `servo`, and the model limits it to -9 … 7 N"),
        "{message}"
    );
    let [one] = &refusals(axis(Coordinate::Rotary, Coordinate::Linear, 7.0))[..] else {
        panic!("one joint, one refusal")
    };
    assert!(one.message.starts_with("joint `shaft` slides and the motor turns"), "{one}");
}
