//! What files may say, and that it means what MuJoCo says it means.
use super::{H, build, effort, file, state, try_build, world};
use servobench_plant::{BodyState, Drive, MechanicsError, MjcfModel, chain_to_mjcf};

/// An axis of joint `m` alone.
fn built(xml: &str) -> Result<(), MechanicsError> {
    try_build(file(xml, "m"), H, vec![]).map(drop)
}

fn run(xml: &str, initial: Vec<BodyState>, ticks: u32) -> BodyState {
    let mut axis = build(xml, "m", H, initial);
    for _ in 0..ticks {
        axis.advance(&effort(0.0)).unwrap();
    }
    axis.bodies()[0]
}

/// Oracle: the same file with every default written out.
#[test]
fn defaults_are_those_of_the_class() {
    let with_defaults = r#"<mujoco><compiler angle="radian"/><option gravity="0 0 0"/>
        <default><joint damping="3"/><geom density="500"/>
          <default class="soft"><joint stiffness="40" springref="0.1"/><geom type="box" size="0.1 0.1 0.1"/></default></default>
        <worldbody><body childclass="soft"><joint name="m" type="slide" axis="1 0 0"/><geom/>
          <body><geom class="main" size="0.1" mass="2"/></body></body></worldbody>
        <actuator><motor name="u" joint="m"/></actuator></mujoco>"#;
    let written_out = world(
        r#"<body><joint name="m" type="slide" axis="1 0 0" damping="3" stiffness="40" springref="0.1"/>
             <geom type="box" size="0.1 0.1 0.1" density="500"/><body><geom size="0.1" mass="2"/></body></body>"#,
    );
    let found = run(with_defaults, vec![], 2_000);
    assert_eq!(found, run(&written_out, vec![], 2_000));
    assert!(found.position > 4e-3, "the spring moved it: {found:?}");
}

/// Oracle: a hinge with a spring rests at `springref`; in degrees unless the file says radians.
#[test]
fn angles_are_degrees_unless_the_file_says_radians() {
    let xml = world(
        r#"<body><joint name="m" axis="0 0 1" stiffness="2" springref="90" damping="0.4"/>
             <inertial pos="0 0 0" mass="1" diaginertia="0.02 0.02 0.02"/></body>"#,
    );
    let quarter = std::f64::consts::FRAC_PI_2;
    for degrees in [xml.replace(r#"<compiler angle="radian"/>"#, ""), xml.replace("radian", "degree")] {
        // Time constants of 0.1 s; e^-20 is left after 2 s.
        assert!((run(&degrees, vec![], 32_000).position - quarter).abs() < 1e-7);
    }
    assert!((run(&xml.replace("90", "1.5707963267948966"), vec![], 32_000).position - quarter).abs() < 1e-7);
}

/// Oracle: free fall along the joint, x = g·cos(60°)·t²/2; gravity is MuJoCo's unless the file says otherwise.
#[test]
fn gravity_and_frames_act_along_the_joint() {
    let body = r#"<body name="base" euler="0 1.0471975511965976 0"><body><joint name="m" type="slide" axis="0 0 1"/>
                    <inertial pos="0.1 0.2 0.3" mass="3" diaginertia="1 1 1"/></body></body>"#;
    for (option, g) in [("", -9.81), (r#"<option gravity="0 0 -1.62"/>"#, -1.62), (r#"<option timestep="1"/>"#, -9.81)]
    {
        let xml = world(body).replace(r#"<option gravity="0 0 0"/>"#, option);
        let found = run(&xml, vec![], 16_000);
        assert!((found.position - g / 4.0).abs() < 1e-10, "{option}: {found:?}");
        assert!((found.velocity - g / 2.0).abs() < 1e-10, "{option}: {found:?}");
    }
}

/// Oracle: two bodies on a tendon with coefficients 1 and −1 ring at √(c·(1/m1 + 1/m2)) about its spring length.
#[test]
fn a_tendon_is_a_spring_between_joints() {
    let body = |joint: &str, mass: u32| {
        format!(
            r#"<body><joint name="{joint}" type="slide" axis="1 0 0"/>
                 <inertial pos="0 0 0" mass="{mass}" diaginertia="1 1 1"/></body>"#
        )
    };
    let tendon = r#"<tendon><fixed stiffness="6e3" springlength="0.01"><joint joint="m"/><joint joint="load" coef="-1"/>
                      </fixed></tendon>"#;
    let xml = world(&(body("m", 20) + &body("load", 10))).replace("</mujoco>", &format!("{tendon}</mujoco>"));
    let mut axis = build(&xml, "load", H, vec![]);
    let omega = f64::sqrt(6e3 * (1.0 / 20.0 + 1.0 / 10.0));
    for k in 1..=16_000 {
        axis.advance(&effort(0.0)).unwrap();
        let [motor, load] = axis.bodies() else { panic!("two joints") };
        let exact = 0.01 * (1.0 - (omega * f64::from(k) * H).cos());
        // (ω·h)²/24·ω·t of phase: 5e-6 of a radian after a second.
        assert!((motor.position - load.position - exact).abs() < 1e-7, "tick {k}");
        assert!((20.0 * motor.position + 10.0 * load.position).abs() < 1e-12, "the centre of mass stays");
    }
}

/// Two geoms may touch in principle when nothing can come of it.
#[test]
fn geoms_that_cannot_touch_are_let_in() {
    let moving = r#"<body name="b"><joint name="m" type="slide" axis="1 0 0"/><geom name="g" size="0.1"/></body>"#;
    let floor = r#"<geom name="floor" type="plane" size="1 1 1"/>"#;
    assert!(built(&world(&format!("{floor}{moving}"))).is_err(), "floor and body could touch");
    let masked = floor.replace("/>", r#" contype="0" conaffinity="0"/>"#) + &moving.replace("/>", r#" contype="0"/>"#);
    // contype 0 on an attribute of every element of the body is too much of it: only the geom has one.
    let masked = masked.replace(r#"axis="1 0 0" contype="0""#, r#"axis="1 0 0""#);
    built(&world(&masked)).unwrap();
    let off = world(&format!("{floor}{moving}"))
        .replace(r#"<option gravity="0 0 0"/>"#, r#"<option><flag contact="disable"/></option>"#);
    built(&off).unwrap();
    let welded = r#"<body name="b"><joint name="m" type="slide" axis="1 0 0"/><geom size="0.1"/><body><geom size="0.1"/></body></body>"#;
    built(&world(welded)).unwrap();
    let child = moving.replace("</body>", r#"<body><joint axis="0 0 1"/><geom size="0.1"/></body></body>"#);
    built(&world(&child)).unwrap();
    let other = format!(r#"{moving}<body name="c"><joint axis="0 0 1"/><geom size="0.1"/></body>"#);
    assert!(built(&world(&other)).is_err(), "two bodies of the world could touch");
    let excluded = world(&other).replace("</mujoco>", r#"<contact><exclude body1="c" body2="b"/></contact></mujoco>"#);
    built(&excluded).unwrap();
}

#[test]
fn what_only_looks_good_or_measures_is_let_in() {
    let xml = r#"<mujoco model="seen"><visual><map znear="0.1"/></visual><statistic extent="1"/><size nkey="3"/>
        <custom><numeric name="n" data="1"/></custom>
        <asset><texture name="t" builtin="checker" width="8" height="8"/><material name="w" texture="t"/></asset>
        <option timestep="0.002" integrator="RK4" solver="Newton" iterations="50"/>
        <worldbody><light pos="0 0 1"/><camera name="c"/><site name="s"/>
          <body name="b" pos="0 0 1"><joint name="m" type="slide" group="2"/><geom size="0.1" material="w" rgba="1 0 0 1"/>
            <site name="tip" size="0.01"/></body></worldbody>
        <sensor><jointpos joint="m"/></sensor><keyframe><key qpos="0.3"/></keyframe>
        <actuator><motor name="u" joint="m" gear="2"/><motor name="idle" joint="m"/></actuator></mujoco>"#;
    let mut axis = build(xml, "m", H, vec![state(0.5, 0.0)]);
    axis.advance(&effort(0.0)).unwrap();
    assert!(axis.bodies()[0].velocity < 0.0, "it falls");
}

#[test]
fn the_mjcf_of_a_chain_is_in_the_subset() {
    use servobench_base::Coordinate;
    use servobench_plant::{Body, Chain, Friction, Link};
    let body = Body {
        name: "m",
        coordinate: Coordinate::Rotary,
        inertia: 1e-3,
        transmission: 1.0,
        friction: Friction { viscous: 0.1, ..Friction::NONE },
        bias: 0.0,
    };
    let load = Body { name: "load", coordinate: Coordinate::Linear, ..body.clone() };
    let chain = Chain::new(vec![body, load], vec![Link { stiffness: 1e3, damping: 1.0 }]).unwrap();
    let model = MjcfModel { actuator: "motor_effort".into(), ..file(&chain_to_mjcf(&chain, Drive::Effort, H), "load") };
    try_build(model, H, vec![]).unwrap();
}

/// The state at tick 0 is the one asked for, of each joint in its own coordinate.
#[test]
fn joints_start_where_they_are_told() {
    let xml = world(
        r#"<body><joint name="m" axis="0 0 1"/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
             <body pos="1 0 0"><joint name="load" type="slide" axis="1 0 0"/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
           </body></body>"#,
    );
    let initial = vec![state(7.5, 0.25), state(-0.3, 0.125)];
    let axis = try_build(file(&xml, "load"), H, initial.clone()).unwrap();
    assert_eq!(axis.bodies(), initial);
}
