//! Two masses with a spring and a damper between them, split into two FMUs by force and displacement: the orders that `docs/coupling.md`
//! promises hold with FMUs, instability is detected, and iterating stays stable there.
//!
//! The FMUs are loaded as a scenario loads them. Each is exact for its inputs: only the coupling's own error remains.
mod files;
mod masses;

use files::Files;
use masses::{Outcome, RATE, TwoMasses, settings, state};
use servobench_coupling::{Acceleration, CouplingError, Iteration, Method, Order, Settings};
use servobench_fmi::Isolation;
use std::time::Duration;

/// ω² = c·(1/m₁ + 1/m₂) = 150 s⁻², ω = 12.2 rad/s; from rest, with a force that sets in smoothly.
const RESOLVED: TwoMasses = TwoMasses { m1: 1.0, m2: 2.0, c: 100.0, d: 2.0, force: (50.0, 8.0), v1: 0.0 };
/// ω = √(4e6·1.5) = 2449 rad/s, damping ratio d/(2·√(c·μ)) = 0.06 with μ = 2/3 kg; with H = 8/8192 s, ω·H = 2.4.
const STIFF: TwoMasses = TwoMasses { m1: 1.0, m2: 2.0, c: 4e6, d: 200.0, force: (0.0, 8.0), v1: 1.0 };

/// Steps (base ticks): H from 1/256 s on, ω·H = 0.048, in three halvings.
const STEPS: [u32; 4] = [32, 16, 8, 4];
/// Over a halving of H an error C·H^p·(1 + D·H) has the slope p + D·H/(2·ln 2). D is a time of the system, here at most a few 1/ω: in the
/// last halving, with ω·H = 0.012, 5·0.012/1.39 = 0.04.
const SLOPE: f64 = 0.04;

fn iterated(tolerance: f64) -> Method {
    let acceleration = Acceleration::QuasiNewton(1.0);
    Method::Iterated(Iteration { absolute: tolerance, relative: tolerance, most: 50, acceleration })
}

fn explicit() -> [Method; 3] {
    [Method::Jacobi, Method::GaussSeidel(vec![0, 1]), Method::GaussSeidel(vec![1, 0])]
}

/// Each method and order, with the order of accuracy that it promises from rest.
fn promises() -> impl Iterator<Item = (Method, Order, f64)> {
    let explicit = explicit().into_iter().map(|method| (method, [1.0, 2.0, 3.0]));
    let all = explicit.chain([(iterated(1e-13), [2.0, 2.0, 3.0])]);
    all.flat_map(|(method, promised)| {
        Order::ALL.into_iter().zip(promised).map(move |(order, promised)| (method.clone(), order, promised))
    })
}

/// State of both at each eighth of a second, up to 1 s.
fn way(masses: &TwoMasses, files: &Files, isolation: Isolation, settings: &Settings) -> [[f64; 4]; 8] {
    let mut master = masses.coupled(files, isolation, settings).unwrap();
    [1, 2, 3, 4, 5, 6, 7, 8].map(|eighth| {
        while master.tick().0 < u64::from(eighth * RATE / 8) {
            master.advance().unwrap();
        }
        state(&master)
    })
}

/// Greatest error of a state over the run. Displacements are weighted with ω, so that they count like velocities.
fn error(masses: &TwoMasses, files: &Files, settings: &Settings) -> f64 {
    let way = way(masses, files, Isolation::None, settings);
    let errors = way.iter().zip(1..).flat_map(|(state, eighth)| {
        let exact = masses.exact(f64::from(eighth) / 8.0);
        [12.2, 1.0, 12.2, 1.0].into_iter().zip(state).zip(exact).map(|((w, value), exact)| w * (value - exact).abs())
    });
    errors.fold(0.0, f64::max)
}

/// Errors fall with the order that `promised` makes of the one from rest, and approach it with each halving.
fn hold_to(promised: impl Fn(&Method, f64) -> f64, masses: &TwoMasses, files: &Files) {
    for (method, order, from_rest) in promises() {
        let promised = promised(&method, from_rest);
        let errors = STEPS.map(|ticks| error(masses, files, &settings(method.clone(), order, ticks)));
        let slopes: Vec<f64> = errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect();
        let off: Vec<f64> = slopes.iter().map(|slope| (slope - promised).abs()).collect();
        println!("{method:?}, {order:?}: order {:.2} for {promised}, error {:.2e}", slopes[2], errors[3]);
        assert!(off[2] < SLOPE, "{method:?}, {order:?}: {slopes:?} for {promised}, errors {errors:?}");
        // Halved with the step, or so small that rounding and the tolerance of the iteration (1e-13 of errors of 1e-8) show.
        assert!(off[2] < 0.75 * off[0] || off[2] < 2e-3, "{method:?}, {order:?}: {slopes:?} for {promised}");
    }
}

#[test]
fn errors_fall_with_the_promised_order_from_rest() {
    hold_to(|_, promised| promised, &RESOLVED, &Files::new());
}

/// An explicit method starts from its initial values: a first step of order 0, whose error of order 2 stays.
#[test]
fn errors_fall_with_the_promised_order_when_moving_at_the_start() {
    let moving = TwoMasses { force: (0.0, 8.0), v1: 1.0, ..RESOLVED };
    let promised = |method: &Method, promised: f64| {
        if matches!(method, Method::Iterated(_)) { promised } else { promised.min(2.0) }
    };
    hold_to(promised, &moving, &Files::new());
}

/// Without `canInterpolateInputs` the mean is held over a step: at most order 2.
#[test]
fn fmus_that_take_no_derivatives_have_order_two_at_most() {
    hold_to(|_, promised| promised.min(2.0), &RESOLVED, &Files::that_hold());
}

/// So the orders are the same there.
#[test]
fn in_processes_of_their_own_all_is_the_same_to_the_bit() {
    for files in [Files::new(), Files::that_hold()] {
        for (method, order, _) in promises() {
            let way = |isolation| way(&RESOLVED, &files, isolation, &settings(method.clone(), order, STEPS[0]));
            assert_eq!(way(Isolation::None), way(super::isolated(Duration::from_mins(1))), "{method:?}, {order:?}");
        }
    }
}

/// The run over `seconds`, or the error that ended it.
fn run(files: &Files, settings: &Settings, seconds: u32) -> Outcome {
    let mut master = STIFF.coupled(files, super::isolated(Duration::from_mins(1)), settings)?;
    while master.tick().0 < u64::from(seconds * RATE) {
        master.advance()?;
    }
    Ok(master)
}

/// With ω·H = 2.4 and 1.2, within 60 exchanges, long before anything overflows.
#[test]
fn a_stiff_spring_is_too_much_for_jacobi_and_the_reason_says_where() {
    let files = Files::new();
    for (ticks, order) in [8, 4].into_iter().flat_map(|ticks| Order::ALL.map(|order| (ticks, order))) {
        let error = run(&files, &settings(Method::Jacobi, order, ticks), 2).err();
        let Some(CouplingError::Unstable { step, connection, growth, .. }) = &error else { panic!("{error:?}") };
        assert!(*step <= 60 && *growth >= 100.0, "{ticks}, {order:?}: {error:?}");
        assert!(["spring.f -> mass.f", "mass.v -> spring.v1"].contains(&&**connection), "{connection}");
        let text = error.as_ref().map(ToString::to_string).unwrap();
        assert!(text.starts_with(&format!("the coupling `{connection}` is unstable in communication step {step} (")));
        let length = f64::from(ticks) / f64::from(RATE);
        assert!(text.ends_with(&format!("take a smaller step than {length} s, iterate the loop, or cut it elsewhere")));
    }
}

/// After 2 s the vibration has died out (ζ·ω·t = 300) and both move with m₁/(m₁ + m₂) of the initial velocity of the first mass, plus an
/// error from the exchanges during the vibration. The mass gets a line for the force, whose second derivative within the step is c·x₂''
/// for the spring, which gets a line for x₁. A line is c·x₂''·H³/12 off in each step, together c·v₂·H²/12: relative to the momentum
/// c·H²/(12·(m₁ + m₂)), 11 % and 2.6 %. The bound is a quarter above, for terms of higher order in ω·H. The velocities agree within the
/// effect of the force's tolerance: 1e-9 of at most 1633 N (ω·μ·v) through 1e-3 s, and less.
#[test]
fn the_iterated_method_solves_what_jacobi_cannot() {
    let files = Files::new();
    for ticks in [8, 4] {
        let master = run(&files, &settings(iterated(1e-9), Order::Linear, ticks), 2).unwrap();
        let ([_, v1, _, v2], [_, exact, ..]) = (state(&master), STIFF.exact(2.0));
        let length = f64::from(ticks) / f64::from(RATE);
        let bound = 1.25 * STIFF.c * length * length / (12.0 * (STIFF.m1 + STIFF.m2));
        println!("H = {length} s: off by {:.4} of the velocity, allowed is {bound:.4}", v1 / exact - 1.0);
        assert!((v1 / exact - 1.0).abs() < bound, "{v1} for {exact}");
        assert!((v1 - v2).abs() < 2e-9, "{v1} and {v2}");
    }
}
