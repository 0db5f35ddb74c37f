//! The error against the exact solution falls with the order that the documentation promises; its table is made here:
//! `SERVOBENCH_WRITE_DOCS=1 cargo test -p servobench-coupling` writes it.
use super::linear::Linear;
use super::oscillator::{RATE, RESOLVED, TwoMasses, settings, state};
use servobench_coupling::{Acceleration, Iteration, Master, Method, Network, Order, Settings};
use std::fmt::Write as _;
use std::num::NonZeroU32;
use std::path::Path;

const WRITE_DOCS: &str = "SERVOBENCH_WRITE_DOCS";

/// Steps (base ticks): H from 1/256 s on, ω·H = 0.048, in three halvings.
const STEPS: [u32; 4] = [32, 16, 8, 4];
/// An error C·H^p·(1 + D·H) has over a halving of H the slope p + D·H/(2·ln 2). D is a time of the system, here at most a few
/// 1/ω: in the last halving, with ω·H = 0.012, 5·0.012/1.39 = 0.04.
const SLOPE: f64 = 0.04;

/// Greatest error of a state within 1 s, at eight times. Weighted with ω for displacements, so that they count like velocities.
fn error(masses: &TwoMasses, settings: &Settings, holds_mean: bool) -> f64 {
    let mut network = masses.network();
    for member in &mut network.members {
        member.block.holds_mean = holds_mean;
    }
    worst(network, masses, settings)
}

/// The same of a network of `masses`.
fn worst(network: Network<Linear>, masses: &TwoMasses, settings: &Settings) -> f64 {
    let mut master = Master::new(network, settings).unwrap();
    let mut worst = 0.0_f64;
    for eighth in 1..=8_u32 {
        while master.tick().0 < u64::from(eighth * RATE / 8) {
            master.advance().unwrap();
        }
        let exact = masses.exact(f64::from(eighth) / 8.0);
        for ((value, exact), weight) in state(&master).iter().zip(exact).zip([12.2, 1.0, 12.2, 1.0]) {
            worst = worst.max(weight * (value - exact).abs());
        }
    }
    worst
}

/// Error at the finest step, and the slope of the last halving. Slopes have to come nearer to `promised` with each halving.
fn measured(masses: &TwoMasses, method: &Method, order: Order, holds_mean: bool, promised: f64) -> f64 {
    let errors = STEPS.map(|ticks| error(masses, &settings(method.clone(), order, ticks), holds_mean));
    let slopes: Vec<f64> = errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect();
    let off: Vec<f64> = slopes.iter().map(|slope| (slope - promised).abs()).collect();
    assert!(off[2] < SLOPE, "{method:?}, {order:?}, mean {holds_mean}: {slopes:?} for {promised}, errors {errors:?}");
    // Halved with the step, or so small that rounding and the tolerance of the iteration (1e-13 of errors of 1e-8) show.
    assert!(
        off[2] < 0.75 * off[0] || off[2] < 2e-3,
        "{method:?}, {order:?}: {slopes:?} do not come nearer to {promised}"
    );
    slopes[2]
}

/// The methods with their names, and the order that each promises at most with extrapolations of order 0, 1, 2.
fn methods() -> [(&'static str, Method, [f64; 3]); 4] {
    let iteration =
        Iteration { absolute: 1e-13, relative: 1e-13, most: 50, acceleration: Acceleration::QuasiNewton(1.0) };
    [
        ("Jacobi", Method::Jacobi, [1.0, 2.0, 3.0]),
        ("Gauss–Seidel, mass first", Method::GaussSeidel(vec![0, 1]), [1.0, 2.0, 3.0]),
        ("Gauss–Seidel, spring first", Method::GaussSeidel(vec![1, 0]), [1.0, 2.0, 3.0]),
        ("iterated", Method::Iterated(iteration), [2.0, 2.0, 3.0]),
    ]
}

#[test]
fn errors_fall_with_the_promised_order() {
    // At rest, with a force that sets in smoothly; and moving from the start.
    let rest = RESOLVED;
    let moving = TwoMasses { force: (0.0, 8.0), v1: 1.0, ..RESOLVED };
    let mut table = String::from(
        "| method | order of the polynomial | from rest | moving at the start | from rest, inputs held at their mean |\n|---|---|---|---|---|\n",
    );
    for (name, method, promises) in methods() {
        for (order, promised) in Order::ALL.into_iter().zip(promises) {
            let iterated = matches!(method, Method::Iterated(_));
            let from_rest = measured(&rest, &method, order, false, promised);
            // An explicit method starts with what it knows: a first step of order 0, whose error of order 2 stays.
            let when_moving =
                measured(&moving, &method, order, false, if iterated { promised } else { promised.min(2.0) });
            let with_means = measured(&rest, &method, order, true, promised.min(2.0));
            writeln!(table, "| {name} | {} | {from_rest:.2} | {when_moving:.2} | {with_means:.2} |", order.degree())
                .unwrap();
        }
    }
    hold("orders", &table);
}

/// Blocks of one and of two communication steps: the constant is another, the order is not.
#[test]
fn different_steps_have_the_same_order() {
    for slow in 0..2 {
        for method in [Method::Jacobi, Method::GaussSeidel(vec![0, 1]), Method::GaussSeidel(vec![1, 0])] {
            for (order, promised) in Order::ALL.into_iter().zip([1.0, 2.0, 3.0]) {
                let errors = STEPS.map(|ticks| {
                    let mut network = RESOLVED.network();
                    network.members[slow].every = NonZeroU32::new(2).unwrap();
                    worst(network, &RESOLVED, &settings(method.clone(), order, ticks / 2))
                });
                let slope = (errors[2] / errors[3]).log2();
                assert!(
                    (slope - promised).abs() < SLOPE,
                    "slow {slow}, {method:?}, {order:?}: {slope}, errors {errors:?}"
                );
            }
        }
    }
}

/// Holds a section of the page against what it is made of, or writes it.
fn hold(section: &str, table: &str) {
    let (begin, end) = (format!("<!-- generated: {section} -->\n"), format!("<!-- end of generated {section} -->\n"));
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/coupling.md");
    let page = std::fs::read_to_string(&path).unwrap();
    let (before, rest) = page.split_once(&begin).unwrap();
    let (written, after) = rest.split_once(&end).unwrap();
    if std::env::var_os(WRITE_DOCS).is_some() {
        std::fs::write(&path, format!("{before}{begin}{table}{end}{after}")).unwrap();
    } else {
        assert!(written == table, "run the tests of this crate with {WRITE_DOCS}=1");
    }
}
