//! Fuzz target: whatever is in an MJCF file, it is refused, or it is built and moves until it diverges. `docs/testing.md`
//! says how to run more of it.
use roxmltree::{Document, Node};
use servobench_engine_rapier::Rapier;
use servobench_fuzz::{Splice, check, fuzz};
use servobench_plant::{
    Actuation, BodyState, Drive, Engine, Input, Mechanics, MechanicsError, MechanicsSetup, MjcfModel, Model, Refusal,
    RefusedAt,
};

const H: f64 = 1.0 / 16_000.0;

/// Every element and attribute of the subset is in one of them.
const FILES: [&str; 4] = [
    include_str!("../../../models/axes/swaying-load.xml"),
    r#"<mujoco model="arm"><compiler angle="degree" eulerseq="xyz"/><option gravity="0 0 -9.81"><flag contact="disable"/>
      </option><default><joint damping="0.1" armature="0.01"/><geom density="2700"/>
        <default class="soft"><joint stiffness="40" springref="5"/><geom type="box" size="0.1 0.1 0.1"/></default></default>
      <worldbody><geom type="plane" size="1 1 0.1"/>
        <body name="upper" pos="0 0 1" euler="10 0 20"><joint name="m" type="hinge" axis="0 1 0" frictionloss="0.02"/>
          <geom type="capsule" size="0.05" fromto="0 0 0 0 0 -0.4"/>
          <body name="lower" pos="0 0 -0.4" childclass="soft" quat="1 0 0.1 0"><joint name="load" pos="0 0 0.1" axis="0 1 0"/>
            <geom/><body name="tip" axisangle="0 0 1 30"><geom class="main" type="cylinder" size="0.02 0.1" mass="0.3"/>
          </body></body></body></worldbody>
      <actuator><motor name="u" joint="m" gear="2"/></actuator></mujoco>"#,
    r#"<mujoco><compiler angle="radian" inertiafromgeom="auto"/><option gravity="0 0 0"/>
      <worldbody><body name="a"><joint name="m" type="slide" axis="1 0 0" damping="3" stiffness="100" springref="0.1"/>
          <inertial pos="0.1 0.2 0.3" mass="20" fullinertia="0.05 0.06 0.07 0.01 -0.005 0.002"/></body>
        <body name="b" pos="0 1 0" xyaxes="1 0 0 0 1 0"><joint name="load" type="slide" axis="1 2 3"/>
          <geom type="sphere" size="0.1" pos="1 0 0"/></body>
        <body name="c" zaxis="0 0 1"><joint name="turn"/><geom type="ellipsoid" size="0.1 0.2 0.3" contype="0"
          conaffinity="0"/></body></worldbody>
      <tendon><fixed name="t" stiffness="6e3" damping="5" springlength="0.01"><joint joint="m" coef="1"/>
        <joint joint="load" coef="-1"/></fixed></tendon>
      <actuator><motor name="u" joint="m"/></actuator>
      <contact><exclude body1="a" body2="b"/></contact></mujoco>"#,
    r#"<mujoco><asset><material name="w"/></asset><visual/><worldbody><light/><body><joint name="m" type="slide"/>
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/><site name="s"/></body></worldbody><sensor/><keyframe/>
      <actuator><motor name="u" joint="m"/></actuator></mujoco>"#,
];

#[rustfmt::skip]
const WORDS: &[&str] = &[
    "<", ">", "/>", "</", "=", "\"", "'", "&", "&amp;", "&#0;", "<!--", "-->", "<![CDATA[", "]]>", "<?xml?>", " ", "\n",
    "<body>", "</body>", "<body name=\"q\">", "<joint/>", "<geom/>", "<geom size=\"0.1\"/>", "<default>", "</default>",
    "<joint name=\"q\" type=\"slide\" axis=\"1 0 0\"/>", "<inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 1\"/>",
    "<fixed stiffness=\"1\" springlength=\"0\"><joint joint=\"m\"/></fixed>", "<include file=\"x.xml\"/>", "<equality/>",
    "mass", "pos", "axis", "type", "size", "class", "childclass", "damping", "stiffness", "armature", "frictionloss",
    "springref", "density", "fromto", "quat", "euler", "mesh", "ball", "free", "hinge", "slide", "true", "false", "auto",
    "degree", "zyx", "XYZ", "main", "soft", "m", "load", "world",
    "0", "-0", "1", "-1", "2", "1e-3", "1e3", "1e12", "1e-12", "1e30", "1e-30", "1e150", "1e308", "5e-324", "nan", "inf",
    "1 0 0", "0 0 0", "1 1 1 1 1 1", "1e200 1e200 1e200", "0 0 0 0", "4294967296", "\u{1f600}", "\u{0}",
];

/// Names of the last motor and of its joint, and of the last joint in the world: the axis, if there is one.
fn axis_of(xml: &str) -> Option<MjcfModel> {
    let document = Document::parse(xml).ok()?;
    let last = |is_it: fn(&Node) -> bool| document.descendants().rfind(is_it);
    let motor = last(|node| node.has_tag_name("motor") && node.has_attribute("joint"))?;
    let in_body =
        |node: &Node| node.has_tag_name("joint") && node.parent().is_some_and(|body| body.has_tag_name("body"));
    let load = last(in_body)?;
    Some(model(xml, [motor.attribute("joint")?, load.attribute("name")?, motor.attribute("name")?]))
}

/// The axis of these names: joints of motor and load, actuator.
fn model(xml: &str, [motor_joint, load_joint, actuator]: [&str; 3]) -> MjcfModel {
    MjcfModel {
        xml: xml.into(),
        path: "fuzzed.xml".into(),
        motor_joint: motor_joint.into(),
        load_joint: load_joint.into(),
        actuator: actuator.into(),
        transmission: 1.0,
        axis: None,
        is_smooth: false,
    }
}

/// What is refused is said, at a line that the file has.
fn check_refusals(xml: &str, refusals: &[Refusal]) {
    assert!(!refusals.is_empty());
    for Refusal { place, message } in refusals {
        assert!(!message.is_empty());
        if let RefusedAt::Line(line) = place {
            assert!((1..=xml.split('\n').count()).contains(&(*line as usize)), "line {line}: {message}");
        }
    }
}

fn build(model: MjcfModel) -> Result<Box<dyn Mechanics>, MechanicsError> {
    let moving = BodyState { position: 0.1, velocity: -0.2 };
    // One joint may be both motor and load.
    let bodies = if model.motor_joint == model.load_joint { 1 } else { 2 };
    let initial = [moving, BodyState::default()][..bodies].to_vec();
    Rapier.build(&MechanicsSetup { model: Model::Mjcf(model), drive: Drive::Effort, step: H, initial })
}

/// Twenty ticks, or as many as there are until it diverges.
fn run(axis: &mut dyn Mechanics) {
    for k in 0..20 {
        let input = Input {
            actuation: Actuation::Effort(f64::from(k % 3) - 1.0),
            motor_disturbance: 0.5,
            load_disturbance: -0.5,
        };
        match axis.advance(&input) {
            Ok(()) => {
                let finite = |body: &BodyState| body.position.is_finite() && body.velocity.is_finite();
                assert!(axis.bodies().iter().all(finite), "{:?}", axis.bodies());
            }
            Err(MechanicsError::Diverged { .. }) => return,
            Err(other) => panic!("{other}"),
        }
    }
}

#[test]
fn mjcf_files() {
    fuzz(check!(), 1_000, Splice::text(&FILES, WORDS), |xml| {
        // Where there is no axis, that is one more thing to refuse.
        match build(axis_of(xml).unwrap_or_else(|| model(xml, ["m", "load", "u"]))) {
            Ok(mut axis) => run(&mut *axis),
            Err(MechanicsError::Refused { refusals, .. }) => check_refusals(xml, &refusals),
            Err(MechanicsError::Model { message, .. }) => assert!(message.starts_with("fuzzed.xml: "), "{message}"),
            Err(other) => panic!("{other}"),
        }
    });
}
