//! Free and forced motion of chains.
use super::{STEP, efforts, free_omega, held_omega, motion, mujoco, order, setup, ticks, two_mass, unchecked};
use nalgebra::DMatrix;
use servobench_base::Coordinate;
use servobench_base::Setpoint;
use servobench_engine_mujoco::Mujoco;
use servobench_plant::{
    Body, BodyState, Chain, Distortion, Drive, Engine as _, Friction, Input, Integrator, Link, Mechanics,
};
use std::f64::consts::TAU;

/// Frequency (Hz) of `signal` from its upward zero crossings over `count` ticks.
fn frequency(mechanics: &mut dyn Mechanics, input: &Input, count: usize, signal: impl Fn(&[BodyState]) -> f64) -> f64 {
    let mut crossings = Vec::new();
    let mut before = signal(mechanics.bodies());
    for k in 0..count {
        mechanics.advance(input).unwrap();
        let after = signal(mechanics.bodies());
        if before < 0.0 && after >= 0.0 {
            crossings.push(STEP * (k as f64 + before / (before - after)));
        }
        before = after;
    }
    (crossings.len() - 1) as f64 / (crossings[crossings.len() - 1] - crossings[0])
}

/// Oracle: the eigenfrequency. A crossing is met to (ω·h)³/16 of 1/ω and there are 160 periods between the outer two:
/// 1e-8. RK4 itself: (ω·h)⁴/120 = 1e-8.
#[test]
fn free_ring_down_is_at_84_22_hz() {
    let initial = [(-0.001, 0.0), (0.001, 0.0)];
    let mut mechanics = mujoco(two_mass(), Drive::Effort, STEP, &initial);
    let stretch = |bodies: &[BodyState]| bodies[0].position - bodies[1].position;
    let measured = frequency(&mut *mechanics, &efforts(0.0, 0.0), ticks(2.0, STEP), stretch);
    let error = measured / (free_omega() / TAU) - 1.0;
    assert!(error.abs() < 1e-7, "relative error {error:e}");
}

#[test]
fn with_the_motor_held_it_is_59_55_hz() {
    let mut mechanics = mujoco(two_mass(), Drive::Prescribed, STEP, &[(0.0, 0.0), (0.001, 0.0)]);
    let hold = motion(Setpoint::at_rest(0.0));
    let measured = frequency(&mut *mechanics, &hold, ticks(2.0, STEP), |bodies| bodies[1].position);
    let error = measured / (held_omega() / TAU) - 1.0;
    assert!(error.abs() < 1e-7, "relative error {error:e}");
}

/// Damping ratio of the undamped axis, from its energy before and after one second.
fn numerical_damping(step: f64) -> f64 {
    let mut mechanics = mujoco(two_mass(), Drive::Effort, step, &[(-0.001, 0.0), (0.001, 0.0)]);
    let energy = |bodies: &[BodyState]| {
        let stretch = bodies[0].position - bodies[1].position;
        let kinetic: f64 = bodies.iter().map(|body| 0.005 * body.velocity * body.velocity).sum();
        f64::midpoint(700.0 * stretch * stretch, kinetic)
    };
    let start = energy(mechanics.bodies());
    for _ in 0..ticks(1.0, step) {
        mechanics.advance(&efforts(0.0, 0.0)).unwrap();
    }
    // E falls as exp(-2·ζ·ω·t).
    -(energy(mechanics.bodies()) / start).ln() / (2.0 * free_omega())
}

/// The bar is 1e-4 of critical damping. Theory for RK4: |R(iy)|² = 1 − y⁶/72 + …, so ζ = y⁵/144 with y = ω·h.
#[test]
fn numerical_damping_is_that_of_rk4() {
    assert!(numerical_damping(STEP).abs() < 1e-9, "{:e}", numerical_damping(STEP));
    let step = 1.0 / 2000.0;
    let theory = (free_omega() * step).powi(5) / 144.0;
    let measured = numerical_damping(step);
    assert!((measured / theory - 1.0).abs() < 0.02, "{measured:e}, next term y²/8 is 1 %: {theory:e}");
}

/// What is said of RK4 before a run is what MuJoCo does: a step scales the energy by |R(i·ω·h)|², whatever ω·h is.
#[test]
fn the_damping_that_is_foretold_is_that_of_mujoco() {
    for rate in [2000.0, 1000.0, 600.0] {
        let step = 1.0 / rate;
        let Distortion { damping, shift } = Integrator::Rk4.distortion(free_omega(), step).unwrap();
        let foretold = damping * (1.0 + shift) / (1.0 - damping * damping).sqrt();
        let measured = numerical_damping(step);
        // Rounding of the energies, 1e-14 of them, beside a loss of 0.9 % at 2 kHz.
        assert!((measured / foretold - 1.0).abs() < 1e-9, "{rate} Hz: {measured:e} {foretold:e}");
    }
}

/// Oracle: stretch = 2 mm·cos(ω·t).
#[test]
fn free_motion_converges_with_order_four() {
    let time = 0.05;
    let error = |step| {
        let initial = [(-0.001, 0.0), (0.001, 0.0)];
        let mut mechanics = mujoco(two_mass(), Drive::Effort, step, &initial);
        for _ in 0..ticks(time, step) {
            mechanics.advance(&efforts(0.0, 0.0)).unwrap();
        }
        let bodies = mechanics.bodies();
        let stretch = bodies[1].position - bodies[0].position;
        (stretch - 0.002 * (free_omega() * time).cos()).abs()
    };
    let order = order(error, 1.0 / 2000.0);
    assert!((order - 4.0).abs() < 0.1, "observed order {order}");
}

/// A ball-screw axis with everything linear in it. Oracle: the matrix exponential in the coordinates of the bodies,
/// written down from the equations in `plant::chain`.
#[test]
fn a_damped_screw_axis_follows_the_matrix_exponential() {
    let r = 0.01 / TAU;
    let lump = |name, coordinate, inertia, transmission, viscous, bias| Body {
        name,
        coordinate,
        inertia,
        transmission,
        friction: Friction { viscous, ..Friction::NONE },
        bias,
    };
    let motor = lump("motor", Coordinate::Rotary, 2e-4, r, 1e-3, 0.02);
    let table = lump("table", Coordinate::Linear, 40.0, 1.0, 120.0, 15.0);
    let load = lump("load", Coordinate::Linear, 10.0, 1.0, 0.0, 0.0);
    let screw = Link { stiffness: 2e7, damping: 3e3 };
    let flexure = Link { stiffness: 4e5, damping: 80.0 };
    let chain = Chain::new(vec![motor, table, load], vec![screw, flexure]).unwrap();

    // State: three positions, three velocities, one. Input 0.3 N·m on the motor, 7 N on the load.
    let mut a = DMatrix::<f64>::zeros(7, 7);
    for i in 0..3 {
        a[(i, 3 + i)] = 1.0;
    }
    let (c, d) = ([2e7, 4e5], [3e3, 80.0]);
    let (m, b) = ([2e-4, 40.0, 10.0], [1e-3, 120.0, 0.0]);
    let (scale, u) = ([r, 1.0, 1.0], [0.3 - 0.02, -15.0, 7.0]);
    for i in 0..3 {
        for link in 0..2 {
            let side = if link == i {
                -1.0
            } else if link + 1 == i {
                1.0
            } else {
                continue;
            };
            for (end, sign) in [(link, 1.0), (link + 1, -1.0)] {
                a[(3 + i, end)] += side * scale[i] * c[link] * sign * scale[end] / m[i];
                a[(3 + i, 3 + end)] += side * scale[i] * d[link] * sign * scale[end] / m[i];
            }
        }
        a[(3 + i, 3 + i)] -= b[i] / m[i];
        a[(3 + i, 6)] = u[i] / m[i];
    }
    let start = [0.5, 0.5 * r, 0.5 * r + 1e-4, 2.0, 2.0 * r, 0.01];
    let mut y = DMatrix::from_column_slice(7, 1, &[&start[..], &[1.0]].concat());

    let initial: Vec<(f64, f64)> = (0..3).map(|i| (start[i], start[3 + i])).collect();
    let mut mechanics = mujoco(chain, Drive::Effort, STEP, &initial);
    let time = 0.05;
    for _ in 0..ticks(time, STEP) {
        mechanics.advance(&efforts(0.3, 7.0)).unwrap();
    }
    y = (a * time).exp() * y;
    for (i, body) in mechanics.bodies().iter().enumerate() {
        // The fastest mode, 570 Hz, is damped out by then; the slow one (32 Hz, y = 0.013) is met to y⁴/120 per
        // radian, and 1e-10 of the travel of 1 mm or more is what is left of 16 digits after 800 steps.
        let position = (body.position / y[(i, 0)] - 1.0).abs();
        let velocity = (body.velocity / y[(3 + i, 0)] - 1.0).abs();
        assert!(position < 1e-9 && velocity < 1e-8, "body {i}: {position:e} {velocity:e}");
    }
}

/// Oracle: |R(i·y)| of RK4 is one at y = 2·√2. A user's own MJCF file is not checked, and shows what MuJoCo does with the
/// chain that is refused: a stretch of a millimetre falls below it, and grows above it.
#[test]
fn a_chain_that_rk4_blows_up_is_refused_and_no_other_is() {
    let stretch_after = |angle: f64| {
        let mut mechanics = unchecked(&two_mass(), angle / free_omega(), &[(-0.001, 0.0), (0.001, 0.0)]);
        for _ in 0..40 {
            mechanics.advance(&efforts(0.0, 0.0)).unwrap();
        }
        let [motor, load] = mechanics.bodies() else { panic!("two bodies") };
        (motor.position - load.position).abs().max((motor.velocity - load.velocity).abs() / free_omega())
    };
    for (angle, is_refused) in [(2.79, false), (2.87, true)] {
        let built = Mujoco.build(&setup(two_mass(), Drive::Effort, angle / free_omega(), &[]));
        let error = built.err().map(|error| error.to_string());
        assert_eq!(error.is_some(), is_refused, "{error:?}");
        assert!(error.is_none_or(|error| error.contains("a mode of 84 Hz") && error.contains("2.87")));
        assert_eq!(stretch_after(angle) > 2e-3, is_refused, "{angle}: {:e}", stretch_after(angle));
    }
}

/// Oracle: R of RK4 on the negative real axis, below one down to −2.785.
#[test]
fn a_damper_that_rk4_blows_up_is_refused() {
    for (rate, is_refused) in [(2.7, false), (2.9, true)] {
        let plain = two_mass().bodies()[0].clone();
        let braked = Body { friction: Friction { viscous: rate / STEP * plain.inertia, ..Friction::NONE }, ..plain };
        let chain = Chain::new(vec![braked], Vec::new()).unwrap();
        let built = Mujoco.build(&setup(chain, Drive::Effort, STEP, &[]));
        assert_eq!(built.is_err(), is_refused, "{rate}");
    }
}
