//! Joints that turn: pendulums, many revolutions.
use super::{H, build, effort, state, world};
use servobench_plant::BodyState;
use std::f64::consts::TAU;

/// 2 kg on an arm of 0.5 m under gravity, hinged about y; hangs down at zero.
fn pendulum() -> String {
    world(
        r#"<body pos="1 2 3"><joint name="m" type="hinge" axis="0 1 0"/>
             <inertial pos="0 0 -0.5" mass="2" diaginertia="0.04 0.03 0.02"/></body>"#,
    )
    .replace(r#"gravity="0 0 0""#, r#"gravity="0 0 -9.81""#)
}

/// The same in one number, m·g·l/(I + m·l²) (1/s²).
const OMEGA_SQUARED: f64 = 2.0 * 9.81 * 0.5 / (0.03 + 2.0 * 0.25);

/// Period of a pendulum that swings to ±`amplitude`: 2π/ω/agm(1, cos(amplitude/2)), Gauss.
fn period(amplitude: f64) -> f64 {
    let (mut a, mut b) = (1.0_f64, (amplitude / 2.0).cos());
    for _ in 0..10 {
        (a, b) = (f64::midpoint(a, b), (a * b).sqrt());
    }
    TAU / OMEGA_SQUARED.sqrt() / a
}

/// Oracle: after a whole period the pendulum is where it started; the error falls with the square of the tick.
#[test]
fn a_pendulum_has_its_nonlinear_period() {
    let amplitude = 2.5;
    let quarter = period(amplitude) / 4.0;
    // At a quarter it passes through zero, where an error in time shows most.
    let errors = [5_000, 10_000, 20_000].map(|ticks| {
        let mut axis = build(&pendulum(), "m", quarter / f64::from(ticks), vec![state(amplitude, 0.0)]);
        for _ in 0..ticks {
            axis.advance(&effort(0.0)).unwrap();
        }
        // Energy: v² = 2·ω²·(1 − cos amplitude).
        let speed = -(2.0 * OMEGA_SQUARED * (1.0 - amplitude.cos())).sqrt();
        [axis.bodies()[0].position.abs(), (axis.bodies()[0].velocity - speed).abs()]
    });
    assert!(errors[2][0] < 1e-8, "{errors:?}");
    for i in [0, 1] {
        for pair in errors.windows(2) {
            let order = (pair[0][i] / pair[1][i]).log2();
            assert!((order - 2.0).abs() < 0.05, "order {order}: {errors:?}");
        }
    }
}

/// Oracle: energy is kept, 280 swings long.
#[test]
fn a_pendulum_keeps_its_energy() {
    let mut axis = build(&pendulum(), "m", 1e-3, vec![state(1.0, 0.0)]);
    let energy = |at: BodyState| 0.5 * at.velocity * at.velocity + OMEGA_SQUARED * (1.0 - at.position.cos());
    let start = energy(axis.bodies()[0]);
    let mut worst = |ticks| {
        (0..ticks).fold(0.0_f64, |worst, _| {
            axis.advance(&effort(0.0)).unwrap();
            worst.max((energy(axis.bodies()[0]) / start - 1.0).abs())
        })
    };
    let (first, _, last) = (worst(20_000), worst(360_000), worst(20_000));
    // Within a swing it changes by less than (ω·h)² = 1.9e-5.
    assert!(first < 1.9e-5 && last < 1.01 * first, "{first:e} then {last:e}");
}

/// Oracle: θ = ω·t; nothing wraps and nothing is lost to the growth of the angle, 500 revolutions long.
#[test]
fn a_free_rotor_at_3000_rpm_keeps_its_angle() {
    let xml = world(
        r#"<body euler="0.3 0.2 0.1"><joint name="m" type="hinge" axis="1 1 0"/>
             <inertial pos="0 0 0" mass="1" diaginertia="2e-4 2e-4 2e-4"/></body>"#,
    );
    let fast = TAU * 50.0;
    let mut axis = build(&xml, "m", H, vec![state(0.0, fast)]);
    for k in 1..=160_000 {
        axis.advance(&effort(0.0)).unwrap();
        if k % 1_000 == 0 {
            let exact = fast * f64::from(k) * H;
            let found = axis.bodies()[0];
            assert!((found.position - exact).abs() < 1e-9, "tick {k}: {} against {exact}", found.position);
            assert!((found.velocity - fast).abs() < 1e-9, "tick {k}: {}", found.velocity);
        }
    }
}

/// Oracle: total energy of a double pendulum, whose Coriolis forces Rapier takes half a tick late: first order.
#[test]
fn coriolis_forces_are_of_first_order() {
    let xml = world(
        r#"<body><joint name="m" type="hinge" axis="0 1 0"/><inertial pos="0 0 -0.5" mass="2" diaginertia="1e-9 1e-9 1e-9"/>
             <body pos="0 0 -0.5"><joint name="load" type="hinge" axis="0 1 0"/>
               <inertial pos="0 0 -0.4" mass="1" diaginertia="1e-9 1e-9 1e-9"/></body></body>"#,
    )
    .replace(r#"gravity="0 0 0""#, r#"gravity="0 0 -9.81""#);
    let at_end = |ticks: u32| {
        let mut axis = build(&xml, "load", 0.5 / f64::from(ticks), vec![state(1.2, 0.0), state(0.5, 0.0)]);
        for _ in 0..ticks {
            axis.advance(&effort(0.0)).unwrap();
        }
        [axis.bodies()[0], axis.bodies()[1]]
    };
    // Energy 1/2·v² of both masses and their heights.
    let energy = |[first, second]: [BodyState; 2]| {
        let (a, b) = (first.position, second.position);
        let (va, vb) = (first.velocity, second.velocity);
        let across = 0.5 * va * a.cos() + 0.4 * vb * b.cos();
        let up = 0.5 * va * a.sin() + 0.4 * vb * b.sin();
        let heights = -2.0 * 0.5 * a.cos() - (0.5 * a.cos() + 0.4 * b.cos());
        0.5 * 2.0 * (0.5 * va).powi(2) + 0.5 * (across * across + up * up) + 9.81 * heights
    };
    let start = energy([state(1.2, 0.0), state(0.5, 0.0)]);
    let errors = [2_000, 4_000, 8_000].map(|ticks| (energy(at_end(ticks)) - start).abs());
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!(order > 0.95, "order {order}: {errors:?}");
    }
    assert!(errors[2] < 1e-3 * start.abs(), "{errors:?} of {start}");
}
