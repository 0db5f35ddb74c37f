//! A mass on a spring without mass, split by force and displacement: each method is a known integrator.
//!
//! ```text
//! held force (Jacobi, order 0):            x₊ = (2 − θ²/2)·x − (1 + θ²/2)·x₋            θ = ω·H
//! iterated, straight line:                 Newmark with β = 1/6, γ = 1/2: stable up to θ = 2·√3 = 3.46
//! iterated, held at the mean of the line:  Newmark with β = 1/4, γ = 1/2: stable for any θ
//! ```
//! Source: Newmark, "A method of computation for structural dynamics", J. Eng. Mech. Div. ASCE 85 (1959) 67.
use super::linear::{Linear, Model, connect, member};
use super::oscillator::{RATE, settings};
use servobench_coupling::{CouplingError, Iteration, Master, Method, Network, Order, Settings};

/// A mass of 1 kg at 1 m on a spring with θ = ω·H for steps of 8 ticks.
fn network(theta: f64, holds_mean: bool) -> Network<Linear> {
    let omega = theta * f64::from(RATE) / 8.0;
    let mass = Model {
        a: vec![vec![0.0, 1.0], vec![0.0, 0.0]],
        b: vec![vec![0.0], vec![1.0]],
        c: vec![vec![1.0, 0.0]],
        d: vec![vec![0.0]],
    };
    let spring = Model { d: vec![vec![-omega * omega]], c: vec![vec![]], ..Model::default() };
    let mut mass = Linear::new(mass, &[1.0, 0.0]);
    mass.holds_mean = holds_mean;
    Network {
        members: vec![member("mass", mass, 1, 1), member("spring", Linear::new(spring, &[]), 1, 1)],
        connections: vec![connect((1, 0), (0, 0)), connect((0, 0), (1, 0))],
    }
}

/// Displacements through `steps` exchanges.
fn displacements(
    network: Network<Linear>,
    method: Method,
    order: Order,
    steps: usize,
    watch: bool,
) -> Result<Vec<f64>, CouplingError<std::convert::Infallible>> {
    let mut master = Master::new(network, &Settings { watch, ..settings(method, order, 8) })?;
    let mut x = vec![master.block(0).x[0]];
    for _ in 0..steps {
        master.advance()?;
        x.push(master.block(0).x[0]);
    }
    Ok(x)
}

/// Oracle: the recurrence. Each step's rounding, some 1e-16 of the values, grows with them.
#[test]
fn a_held_force_is_the_recurrence_that_grows() {
    for theta in [0.05, 0.3, 1.0] {
        let x = displacements(network(theta, false), Method::Jacobi, Order::Constant, 50, false).unwrap();
        let half = theta * theta / 2.0;
        let greatest = x.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        for k in 1..50 {
            let expected = (2.0 - half) * x[k] - (1.0 + half) * x[k - 1];
            assert!((x[k + 1] - expected).abs() < 1e-12 * greatest, "θ = {theta}, step {k}");
        }
    }
}

/// Clear of the bound by 3 %: below it the displacement stays within what energy allows, beyond it |z| − 1 is some percent.
#[test]
fn a_straight_line_is_stable_up_to_newmarks_bound() {
    let iterated = || Method::Iterated(Iteration::default());
    let bound = 2.0 * 3.0_f64.sqrt();
    for theta in [0.1, 1.0, 3.0, 0.97 * bound] {
        let x = displacements(network(theta, false), iterated(), Order::Linear, 3000, true).unwrap();
        assert!(x.iter().all(|x| x.abs() < 1.001), "θ = {theta}");
    }
    match displacements(network(1.03 * bound, false), iterated(), Order::Linear, 3000, true) {
        Err(CouplingError::Unstable { step, help, .. }) => {
            assert!(step < 300 && help == "or cut the loop elsewhere", "{step}");
        }
        other => panic!("{:?}", other.map(|x| x.len())),
    }
}

#[test]
fn a_held_mean_is_stable_for_any_spring() {
    for theta in [0.1, 1.0, 10.0, 100.0] {
        let iterated = Method::Iterated(Iteration::default());
        let x = displacements(network(theta, true), iterated, Order::Linear, 3000, true).unwrap();
        assert!(x.iter().all(|x| x.abs() < 1.001), "θ = {theta}");
    }
}
