//! A coupling that cannot hold is found and named, one that can is let be, and iterations hold where it cannot.
use super::linear::Linear;
use super::oscillator::{RATE, RESOLVED, TwoMasses, settings, state};
use servobench_coupling::{Acceleration, CouplingError, Iteration, Master, Method, Order, Settings};
use std::convert::Infallible;

type Outcome = Result<Master<Linear>, CouplingError<Infallible>>;

/// The run over `seconds`, or what ended it.
fn run(masses: &TwoMasses, settings: &Settings, seconds: u32) -> Outcome {
    let mut master = Master::new(masses.network(), settings)?;
    while master.tick().0 < u64::from(seconds * RATE) {
        master.advance()?;
    }
    Ok(master)
}

/// A stiff spring: ω = √(4e6·1.5) = 2449 rad/s, damping ratio d/(2·√(c·μ)) = 0.06 with μ = 2/3 kg; with H = 8/8192 s, ω·H = 2.4.
const STIFF: TwoMasses = TwoMasses { m1: 1.0, m2: 2.0, c: 4e6, d: 200.0, force: (0.0, 8.0), v1: 1.0 };

fn iterated(acceleration: Acceleration) -> Method {
    Method::Iterated(Iteration { absolute: 1e-9, relative: 1e-9, most: 50, acceleration })
}

fn explicit() -> [Method; 3] {
    [Method::Jacobi, Method::GaussSeidel(vec![0, 1]), Method::GaussSeidel(vec![1, 0])]
}

/// Within 60 exchanges, long before anything overflows.
#[test]
fn a_stiff_spring_is_too_much_for_explicit_coupling() {
    for method in explicit() {
        for order in Order::ALL {
            match run(&STIFF, &settings(method.clone(), order, 8), 2).err() {
                Some(CouplingError::Unstable { step, connection, growth, .. }) => {
                    assert!(
                        step <= 60 && connection == "second.y0 -> first.u0" && growth >= 100.0,
                        "{method:?} {order:?}: {step}"
                    );
                }
                other => panic!("{method:?} {order:?}: {other:?}"),
            }
        }
    }
}

#[test]
fn the_reason_names_connection_step_and_way_out() {
    let error = run(&STIFF, &settings(Method::Jacobi, Order::Constant, 8), 2).err().unwrap();
    let text = error.to_string();
    assert!(text.starts_with("the coupling `second.y0 -> first.u0` is unstable in communication step "), "{text}");
    assert!(text.ends_with("take a smaller step than 0.0009765625 s, iterate the loop, or cut it elsewhere"), "{text}");
}

/// After 2 s the vibration has died out (ζ·ω·t = 300) and both masses move with m₁/(m₁ + m₂) of the velocity that the first began with.
/// What the first exchanges of the vibration, which they do not resolve, put into the common motion stays; it does not grow. The
/// velocities agree to what the tolerance of the force moves: 1e-9 of at most 1633 N (ω·μ·v) through 1e-3 s, and less.
#[test]
fn the_iterated_method_holds_where_explicit_coupling_cannot() {
    for acceleration in [Acceleration::QuasiNewton(1.0), Acceleration::Aitken(0.5)] {
        let master = run(&STIFF, &settings(iterated(acceleration), Order::Linear, 8), 2).unwrap();
        let [_, v1, _, v2] = state(&master);
        assert!((v1 - v2).abs() < 2e-9 && (v1 - 1.0 / 3.0).abs() < 0.05, "{v1} and {v2}");
    }
}

/// A plain fixed point multiplies its error by c·H²/(6·m₁) + d·H/(2·m₁) in each evaluation where the second mass hardly moves: with
/// H = 12/8192 s that is 1.43 + 0.15, and it diverges. The accelerated ones take three evaluations for the one signal that is looked
/// for, and one more where rounding shows.
#[test]
fn a_plain_fixed_point_diverges_where_accelerated_ones_do_not() {
    let masses = TwoMasses { m2: 200.0, ..STIFF };
    let settings = |acceleration| settings(iterated(acceleration), Order::Linear, 12);
    match run(&masses, &settings(Acceleration::Relaxed(1.0)), 1).err() {
        Some(CouplingError::NotConverged { step: 1, cycle, iterations: 50, .. }) => {
            assert_eq!(cycle, "first -> second -> first");
        }
        other => panic!("{other:?}"),
    }
    for acceleration in [Acceleration::QuasiNewton(1.0), Acceleration::Aitken(0.5), Acceleration::Relaxed(0.4)] {
        let master = run(&masses, &settings(acceleration), 1).unwrap();
        let most = if acceleration == Acceleration::Relaxed(0.4) { 25 } else { 4 };
        let taken = [0, 1].map(|block| master.block(block).most_evaluations);
        assert!(taken.iter().all(|taken| (2..=most).contains(taken)), "{acceleration:?}: {taken:?}");
    }
}

/// A growth that the model has: a damper that drives (d < 0) lets the amplitude grow by e^(0.75·|d|·t) (half of |d|/μ), here
/// e^(0.75·0.4·40) = 1.6e5. Coupled with a resolved exchange it is let be, and followed: what order 2 adds to
/// the growth at ω·H = 0.024 was 2 % of the amplitude over 78 turns, order 3 less.
#[test]
fn an_oscillation_that_the_model_drives_is_let_be() {
    let growing = TwoMasses { d: -0.4, force: (0.0, 8.0), v1: 1e-3, ..RESOLVED };
    for method in explicit().into_iter().chain([iterated(Acceleration::QuasiNewton(1.0))]) {
        for order in [Order::Linear, Order::Quadratic] {
            let master = run(&growing, &settings(method.clone(), order, 16), 40).unwrap();
            let (now, exact) = (state(&master), growing.exact(40.0));
            let most = exact.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
            for (now, exact) in now.iter().zip(exact) {
                assert!((now - exact).abs() < 0.03 * most, "{method:?} {order:?}: {now} for {exact} of {most}");
            }
        }
    }
}

/// What is stable stays so, with every method, over 100 s of swinging and of rest.
#[test]
fn a_stable_coupling_is_let_be() {
    for v1 in [0.0, 1.0] {
        let masses = TwoMasses { force: (if v1 == 0.0 { 0.0 } else { 50.0 }, 8.0), v1, ..RESOLVED };
        for method in explicit().into_iter().chain([iterated(Acceleration::QuasiNewton(1.0))]) {
            for order in Order::ALL {
                run(&masses, &settings(method.clone(), order, 32), 100).unwrap();
            }
        }
    }
}

/// Not a number ends the run in the exchange that it comes up in.
#[test]
fn not_a_number_ends_the_run_at_once() {
    let mut master = Master::new(RESOLVED.network(), &settings(Method::Jacobi, Order::Constant, 32)).unwrap();
    master.advance().unwrap();
    master.block_mut(1).x[0] = f64::NAN;
    match master.advance() {
        Err(CouplingError::NotFinite { output, step: 2, .. }) => assert_eq!(output, "second.y0"),
        other => panic!("{other:?}"),
    }
}
