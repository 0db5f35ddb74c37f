//! Against `MuJoCo` itself, by golden numbers: what the elements of the subset mean, all in one mechanism.
use super::{build, effort, state};

/// Hinges on a skew base, a slide on the second; solids, a full inertia, every rotation, classes, springs, a tendon.
const MECHANISM: &str = r#"<mujoco><option timestep="1" integrator="RK4"><flag contact="disable"/></option>
  <default><joint damping="0.4"/>
    <default class="c"><geom density="700"/><joint armature="0.01" stiffness="3" springref="30"/></default></default>
  <worldbody>
    <body name="base" pos="0 0 1" euler="20 30 -10">
      <body pos="0.1 0.2 0.3" axisangle="1 1 0 25">
        <joint name="m" type="hinge" axis="0 1 0.3" pos="0.05 0 0.1"/>
        <geom type="capsule" size="0.04" fromto="0 0 0 0.3 0.1 -0.2" mass="1.2"/>
        <body pos="0.3 0.1 -0.2" xyaxes="0 1 0 -1 0 0" childclass="c">
          <joint name="load" type="hinge" axis="1 0 0.2"/>
          <geom type="box" size="0.05 0.1 0.15" pos="0 0.1 0" euler="10 0 40"/>
          <geom type="cylinder" size="0.03 0.2" pos="0 0 0.1" quat="0.9 0.1 0.2 0.3"/>
          <body pos="0 0.1 0.2"><geom type="ellipsoid" size="0.05 0.06 0.1"/></body>
          <body pos="0 0.2 0" zaxis="1 1 1">
            <joint name="s" type="slide" axis="0 0 1" stiffness="400" springref="0.02" damping="3"/>
            <inertial pos="0.01 0.02 0.03" mass="0.7" fullinertia="0.01 0.012 0.011 0.001 -0.002 0.0005"/>
  </body></body></body></body></worldbody>
  <tendon><fixed stiffness="5" damping="0.2" springlength="0.1">
    <joint joint="m" coef="0.7"/><joint joint="load" coef="-1.3"/></fixed></tendon>
  <actuator><motor name="u" joint="m" gear="3"/></actuator></mujoco>"#;

/// Oracle: MuJoCo 3.17.0 with its RK4 at 128 kHz, one second from (0.4 rad, 0.1 rad/s) under 0.6 N·m on the motor joint
/// and −0.2 N·m (N) on the load joint; motor joint, then `load` or `s`. At 16 kHz it has the same eleven digits.
const GOLDEN: [(&str, [f64; 4]); 2] = [
    ("load", [-1.157483803404, 1.622552933944, -0.797361321779, 0.613474995883]),
    ("s", [-1.139929131413, 1.604603251746, 0.012750933775, -0.028387049045]),
];

#[test]
fn a_mechanism_of_everything_moves_as_in_mujoco() {
    // What hinge `m` counts in the load's coordinate: the cosine between it and hinge `load`, whose axis is (0 1 0.2) in
    // the body of `m`. The golden numbers and efforts are those of each joint alone.
    let cosine = 1.06 / f64::sqrt(1.09 * 1.04);
    for ((load, golden), share) in GOLDEN.into_iter().zip([cosine, 0.0]) {
        let errors = [16_000, 32_000].map(|rate| {
            let initial = vec![state(0.4, 0.1), state(share * 0.4, share * 0.1)];
            let mut axis = build(MECHANISM, load, 1.0 / f64::from(rate), initial);
            for _ in 0..rate {
                let mut input = effort(0.5);
                (input.motor_disturbance, input.load_disturbance) = (0.1 + share * 0.2, -0.2);
                axis.advance(&input).unwrap();
            }
            let [motor, other] = axis.bodies() else { panic!("two joints") };
            let alone = [other.position - share * motor.position, other.velocity - share * motor.velocity];
            let found = [motor.position, motor.velocity, alone[0], alone[1]];
            std::array::from_fn::<f64, 4, _>(|i| (found[i] - golden[i]).abs())
        });
        for i in 0..4 {
            // Hinges on a hinge, up to 5 rad/s: their Coriolis forces are of first order in the tick.
            let order = (errors[0][i] / errors[1][i]).log2();
            assert!((order - 1.0).abs() < 0.05, "{load}: order {order} of number {i}: {errors:?}");
            assert!(errors[0][i] < 4e-4, "{load}: {errors:?}");
        }
    }
}
