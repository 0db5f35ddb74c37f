//! Users' own MJCF files on the engines that read them: where the load is.
use servobench_plant::{
    Actuation, BodyState, Drive, Engine, EngineName, Input, Mechanics, MechanicsSetup, MjcfModel, Model, ModelKind,
};
use servobench_scenario::{Actuator, AxisMechanics, Initial};
use servobench_tests::{engines, run, scenario_file};

/// Tick length (s).
const H: f64 = 1.0 / 16_000.0;

/// What 4 000 ticks round away at 1.5 m and 20 m/s (or rad): 4e-15 and 3e-13 were found.
const POSITION: f64 = 1e-13;
const VELOCITY: f64 = 1e-11;

/// The joint of the base.
const SOFT: &str = r#"<joint type="KIND" axis="1 0 0" stiffness="4e6" damping="300"/>"#;

/// Motor body and load beside each other on a soft base, which carries both; their joints measure from it.
const BESIDE: &str = r#"<mujoco><compiler angle="radian"/><option gravity="0 0 0" integrator="RK4"/>
  <worldbody>
    <body><joint type="KIND" axis="1 0 0" stiffness="4e6" damping="300"/>
      <inertial pos="0 0 0" mass="50" diaginertia="50 50 50"/>
      <body><joint name="motor" type="KIND" axis="1 0 0" damping="10"/>
        <inertial pos="0 0 0" mass="MOTOR" diaginertia="MOTOR 1e3 1e3"/></body>
      <body><joint name="load" type="KIND" axis="1 0 0"/>
        <inertial pos="0 0 0" mass="10" diaginertia="10 10 10"/></body>
    </body>
  </worldbody>
  <tendon><fixed stiffness="6e5" damping="500" springlength="0">
    <joint joint="motor" coef="-COSINE"/><joint joint="load" coef="1"/></fixed></tendon>
  <actuator><motor name="drive" joint="motor"/></actuator></mujoco>"#;

/// The same mechanics with the load on the motor body: its joint measures the deflection.
const NESTED: &str = r#"<mujoco><compiler angle="radian"/><option gravity="0 0 0" integrator="RK4"/>
  <worldbody>
    <body><joint type="KIND" axis="1 0 0" stiffness="4e6" damping="300"/>
      <inertial pos="0 0 0" mass="50" diaginertia="50 50 50"/>
      <body><joint name="motor" type="KIND" axis="1 0 0" damping="10"/>
        <inertial pos="0 0 0" mass="20" diaginertia="20 20 20"/>
        <body TURNED><joint name="load" type="KIND" axis="AXIS"/>
          <inertial pos="0 0 0" mass="10" diaginertia="10 10 10"/></body>
      </body>
    </body>
  </worldbody>
  <tendon><fixed stiffness="6e5" damping="500" springlength="0"><joint joint="load" coef="1"/></fixed></tendon>
  <actuator><motor name="drive" joint="motor"/></actuator></mujoco>"#;

/// Those of the build that read MJCF.
fn mjcf_engines() -> impl Iterator<Item = &'static dyn Engine> {
    engines().into_iter().filter(|engine| engine.name().simulates(ModelKind::Mjcf))
}

fn build(engine: &dyn Engine, xml: &str, initial: &[BodyState]) -> Box<dyn Mechanics> {
    let model = Model::Mjcf(MjcfModel {
        xml: xml.into(),
        path: "axis.xml".into(),
        motor_joint: "motor".into(),
        load_joint: "load".into(),
        actuator: "drive".into(),
        transmission: 1.0,
        axis: None,
        is_smooth: false,
    });
    let setup = MechanicsSetup { model, drive: Drive::Effort, step: H, initial: initial.to_vec() };
    engine.build(&setup).unwrap_or_else(|error| panic!("{error}"))
}

fn state(position: f64, velocity: f64) -> BodyState {
    BodyState { position, velocity }
}

/// Largest differences of position (m or rad) and velocity between two axes, over 0.25 s in which everything acts: the
/// drive, a disturbance on each side, initial states. The coordinate of the second load points backwards when `sign`
/// is −1.
fn difference(one: (&dyn Engine, &str), other: &str, sign: f64) -> [f64; 2] {
    let (engine, one) = one;
    let mut one = build(engine, one, &[state(0.1, 0.3), state(0.099, -0.2)]);
    let mut other = build(engine, other, &[state(0.1, 0.3), state(sign * 0.099, sign * -0.2)]);
    let (mut difference, mut stretch) = ([0.0_f64; 2], 0.0_f64);
    for tick in 0..4_000 {
        let drive = Actuation::Effort(120.0 * (90.0 * f64::from(tick) * H).sin());
        let force = if tick > 1_000 { -4e3 } else { 1.5e3 };
        let input = |load_disturbance| Input { actuation: drive, motor_disturbance: 8.0, load_disturbance };
        one.advance(&input(force)).unwrap();
        other.advance(&input(sign * force)).unwrap();
        let ([motor, load], [other_motor, other_load]) = (one.bodies(), other.bodies()) else { panic!("two bodies") };
        stretch = stretch.max((motor.position - load.position).abs());
        for (a, b, sign) in [(motor, other_motor, 1.0), (load, other_load, sign)] {
            difference[0] = difference[0].max((a.position - sign * b.position).abs());
            difference[1] = difference[1].max((a.velocity - sign * b.velocity).abs());
        }
    }
    assert!(stretch > 1e-3, "the spring gave way by {stretch:e}: too little to tell");
    difference
}

/// Oracle: the same mechanics with joints beside each other. Slides and hinges; the load joint along the motor's, against
/// it, and turned together with its body.
#[test]
fn a_load_on_the_motor_is_where_a_load_beside_it_would_be() {
    let beside = BESIDE.replace("MOTOR", "20").replace("COSINE", "1");
    for engine in mjcf_engines() {
        for kind in ["slide", "hinge"] {
            let beside = beside.replace("KIND", kind);
            for (axis, turned, sign) in
                [("1 0 0", "", 1.0), ("-2 0 0", "", -1.0), ("0 1 0", r#"euler="0 0 -1.5707963267948966""#, 1.0)]
            {
                let nested = NESTED.replace("KIND", kind).replace("AXIS", axis).replace("TURNED", turned);
                let [position, velocity] = difference((engine, &beside), &nested, sign);
                let name = engine.name();
                assert!(position < POSITION && velocity < VELOCITY, "{name}, {kind} {axis}: {position:e} {velocity:e}");
            }
        }
    }
}

/// Oracle: with φ = 60° between the slides and a base at rest, T = ½·(m1 + m2·sin²φ)·q̇² + ½·m2·ẋ², and the spring feels
/// x − q·cosφ, where x is the way of the load along its slide: slides beside each other, of 27.5 kg and 10 kg.
#[test]
fn a_slide_at_an_angle_counts_by_its_cosine() {
    let on_the_ground = |xml: &str| xml.replace(SOFT, "").replace("KIND", "slide");
    let beside = on_the_ground(BESIDE).replace("MOTOR", "27.5").replace("COSINE", "0.5");
    let nested = on_the_ground(NESTED).replace("AXIS", "0.5 0.8660254037844386 0").replace("TURNED", "");
    for engine in mjcf_engines() {
        let [position, velocity] = difference((engine, &beside), &nested, 1.0);
        assert!(position < POSITION && velocity < VELOCITY, "{}: {position:e} {velocity:e}", engine.name());
    }
}

/// Two bodies, and one when one joint is both, start in the states that the scenario asks for.
#[test]
fn runs_start_where_the_scenario_says() {
    let mut scenario = scenario_file("own-mjcf.toml");
    scenario.actuator = Actuator::Off(None);
    scenario.duration = Some(1e-3);
    scenario.initial = Initial { load_position: 0.25, load_velocity: 0.5 };
    for (load, bodies, motor) in [("load", &["motor", "load"][..], 0.0), ("carriage", &["motor"], 0.25)] {
        let AxisMechanics::Mjcf(mjcf) = &mut scenario.axis.mechanics else { panic!("an MJCF file") };
        load.clone_into(&mut mjcf.load_joint);
        for engine in mjcf_engines() {
            let recording = run(&scenario, engine);
            assert_eq!(recording.about.bodies, bodies, "{}", engine.name());
            let first = |name: &str| recording.channel(name).unwrap()[0];
            let found = [first("motor.position"), first("load.position"), first("load.velocity")];
            assert_eq!(found.map(f64::to_bits), [motor, 0.25_f64, 0.5].map(f64::to_bits), "{}: {load}", engine.name());
        }
    }
}

/// Oracle: the recorded position. From the first tick beyond the end of the range to the first that is not, the joint is said to
/// be there, as an event of the mechanics.
#[test]
fn a_joint_at_the_end_of_its_range_is_an_event() {
    let mut scenario = scenario_file("own-mjcf.toml");
    scenario.duration = Some(1.1);
    let AxisMechanics::Mjcf(mjcf) = &mut scenario.axis.mechanics else { panic!("an MJCF file") };
    let free = r#"name="carriage" type="slide""#;
    assert!(mjcf.xml.contains(free));
    mjcf.xml = mjcf.xml.replace(free, &format!(r#"{free} limited="true" range="-1 0.37""#));
    for engine in mjcf_engines().filter(|engine| engine.name() == EngineName::Mujoco) {
        let recording = run(&scenario, engine);
        let position = recording.channel("motor.position").unwrap();
        let first = position.iter().position(|position| *position > 0.37).expect("the end is reached");
        let event = recording.events.iter().find(|event| event.source == "mechanics").expect("an event");
        assert_eq!(event.message, "joint `carriage` is at the upper end of its range, 0.37 m");
        assert_eq!(event.incident.as_ref().map(|mark| mark.name.as_str()), Some("end_stop"));
        assert!((event.start - first as f64 * H).abs() < H / 2.0, "{} {first}", event.start);
    }
}
