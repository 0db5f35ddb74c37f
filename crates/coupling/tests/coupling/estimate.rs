//! The estimated error of a coupling against theory and against the damping that it makes wrong.
use super::oscillator::{RATE, TwoMasses, settings, state};
use servobench_coupling::{Iteration, Master, Method, Order};
use std::f64::consts::TAU;

/// Two equal masses that move against each other at `exchanges` per period of 64 ticks each.
fn free(exchanges: f64) -> TwoMasses {
    let omega = TAU * f64::from(RATE) / (64.0 * exchanges);
    TwoMasses { m1: 1.0, m2: 1.0, c: omega * omega / 2.0, d: 0.0, force: (0.0, 1.0), v1: 1.0 }
}

fn estimated(masses: &TwoMasses, method: Method, order: Order) -> f64 {
    let mut master = Master::new(masses.network(), &settings(method, order, 64)).unwrap();
    for _ in 0..600 {
        master.advance().unwrap();
    }
    master.estimated_error().unwrap().error
}

/// Oracle: the errors of a sine, ωH/2 held and 5·(ωH)²/12 as a line, of the displacement; the first mass moves on, which the window
/// counts too, so that a half of it is the least.
#[test]
fn it_is_that_of_theory() {
    for exchanges in [40.0, 80.0, 160.0] {
        let (masses, step) = (free(exchanges), TAU / exchanges);
        for (order, theory) in [(Order::Constant, step / 2.0), (Order::Linear, 5.0 * step * step / 12.0)] {
            let found = estimated(&masses, Method::Jacobi, order);
            assert!(found > 0.9 * theory && found < 2.0 * theory, "{exchanges} {order:?}: {found} for {theory}");
        }
        let iterated = estimated(&masses, Method::Iterated(Iteration::default()), Order::Linear);
        let theory = step * step / 12.0;
        assert!(iterated > 0.9 * theory && iterated < 1.2 * theory, "{exchanges}: {iterated} for {theory}");
    }
}

/// At 20 exchanges per period it is more than 1 % by every method, with order 1 and below; at 100 with order 1 by none.
#[test]
fn one_per_cent_is_about_forty_exchanges_with_order_one() {
    for method in [Method::Jacobi, Method::GaussSeidel(vec![0, 1]), Method::GaussSeidel(vec![1, 0])] {
        for order in [Order::Constant, Order::Linear] {
            assert!(estimated(&free(20.0), method.clone(), order) > 0.01, "{method:?} {order:?}");
        }
        assert!(estimated(&free(100.0), method.clone(), Order::Linear) < 0.01, "{method:?}");
    }
}

/// Damping ratio that the coupling gives an undamped mode, over ten periods.
fn damping(exchanges: u32, method: Method, order: Order) -> f64 {
    let masses = free(f64::from(exchanges));
    let mut master = Master::new(masses.network(), &settings(method, order, 64)).unwrap();
    let omega = TAU * f64::from(RATE) / (64.0 * f64::from(exchanges));
    let mut size = || {
        let [x1, v1, x2, v2] = state(&master);
        let found = (omega * (x1 - x2)).hypot(v1 - v2);
        for _ in 0..10 * exchanges {
            master.advance().unwrap();
        }
        found
    };
    let (before, after) = (size(), size());
    -(after / before).ln() / (10.0 * TAU)
}

/// Theory: order 1 damps a mode wrongly by (ωH)³/6, to leading order, where one side knows the end of its step; by Jacobi by half as much
/// again. At 40 exchanges that is 2 % of a damping ratio of 0.03.
#[test]
fn the_default_order_keeps_the_damping_of_a_mode() {
    assert_eq!(Order::default(), Order::Linear);
    let jacobi = (Method::Jacobi, 1.5);
    for (method, factor) in [(Method::GaussSeidel(vec![0, 1]), 1.0), (Method::GaussSeidel(vec![1, 0]), 1.0), jacobi] {
        for exchanges in [20, 40, 80] {
            let most = factor * (TAU / f64::from(exchanges)).powi(3) / 6.0 * 1.15;
            let found = damping(exchanges, method.clone(), Order::default());
            assert!(found.abs() < most, "{method:?} {exchanges}: {found} for {most}");
        }
        // What held inputs do, of which the warning is about.
        assert!(damping(80, method.clone(), Order::Constant) < -5e-3, "{method:?}");
    }
}

/// Two masses that a slow force moves, by three orders slower than the exchange.
#[test]
fn a_motion_that_is_resolved_has_no_error() {
    let masses = TwoMasses { force: (1e-3, 0.5), v1: 0.0, c: 100.0, d: 20.0, m1: 1.0, m2: 2.0 };
    let mut master = Master::new(masses.network(), &settings(Method::Jacobi, Order::Linear, 8)).unwrap();
    assert_eq!(master.estimated_error(), None, "nothing is known before twenty exchanges");
    for _ in 0..2000 {
        master.advance().unwrap();
    }
    let error = master.estimated_error().unwrap().error;
    assert!(error < 1e-3, "{error}");
}
