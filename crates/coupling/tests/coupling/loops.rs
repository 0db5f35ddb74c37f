//! Algebraic loops, and loops that cannot be iterated.
use super::linear::{Linear, Model, connect, member};
use super::oscillator::{RESOLVED, settings};
use proptest::prelude::*;
use servobench_coupling::{
    Acceleration, Connection, CouplingError, Iteration, Master, Method, Network, NetworkError, Order, Port,
};
use std::num::NonZeroU32;

/// y = gain·u
fn gain(gain: f64) -> Linear {
    Linear::new(Model { d: vec![vec![gain]], c: vec![vec![]], ..Model::default() }, &[])
}

/// Gains in a ring, each with an offset on the way to the next.
fn ring(gains: &[(f64, f64)]) -> Network<Linear> {
    let count = gains.len();
    let members = gains.iter().enumerate().map(|(i, (g, _))| member(&format!("g{i}"), gain(*g), 1, 1)).collect();
    let connections = (0..count).map(|i| Connection { offset: gains[i].1, ..connect((i, 0), ((i + 1) % count, 0)) });
    Network { members, connections: connections.collect() }
}

#[test]
fn an_algebraic_loop_is_refused_by_the_names_in_it() {
    let settings = settings(Method::Jacobi, Order::Constant, 8);
    let error = Master::new(ring(&[(0.5, 1.0), (0.5, 0.0), (0.5, 0.0)]), &settings).err().unwrap();
    assert_eq!(
        error,
        CouplingError::Network(NetworkError::AlgebraicLoop { cycle: "g0.y0 -> g1.y0 -> g2.y0 -> g0.y0".into() })
    );
}

proptest! {
    /// Oracle: y₀ = Σ (products of the gains after each offset)/(1 − Π). Quasi-Newton does not care whether the loop's gain is above 1.
    /// The error is at most the tolerance by 1/|1 − Π|.
    #[test]
    fn a_loop_of_gains_comes_to_the_algebraic_solution(
        gains in proptest::collection::vec((-2.0..2.0_f64, -1.0..1.0_f64), 1..6)
    ) {
        let around: f64 = gains.iter().map(|(gain, _)| gain).product();
        prop_assume!((1.0 - around).abs() > 0.1);
        let mut settings = settings(Method::Jacobi, Order::Constant, 8);
        settings.algebraic = Some(Iteration { absolute: 1e-11, relative: 1e-11, ..Iteration::default() });
        let mut master = Master::new(ring(&gains), &settings).unwrap();
        // y_i = g_i·(y_{i−1} + o_{i−1}); once round, beginning with y_n−1 = 0.
        let (mut constant, last) = (0.0, gains.len() - 1);
        for (i, (gain, _)) in gains.iter().enumerate() {
            let before = gains[(i + last) % gains.len()].1;
            constant = gain * (constant + before);
        }
        let solution = constant / (1.0 - around);
        for _ in 0..3 {
            let y = master.value(Port { block: last, port: 0 }).unwrap();
            prop_assert!((y - solution).abs() < 1e-9 * (1.0 + solution.abs()), "{} for {}", y, solution);
            master.advance().unwrap();
        }
    }
}

/// Plain iterations of a loop with a gain of −3 cannot agree; the error says where and when.
#[test]
fn an_algebraic_loop_that_does_not_agree_says_so() {
    let mut settings = settings(Method::Jacobi, Order::Constant, 8);
    settings.algebraic = Some(Iteration { acceleration: Acceleration::Relaxed(1.0), ..Iteration::default() });
    match Master::new(ring(&[(-3.0, 1.0), (1.0, 0.0)]), &settings).err() {
        Some(CouplingError::NotConverged { cycle, step: 0, .. }) => assert_eq!(cycle, "g0.y0 -> g1.y0 -> g0.y0"),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_block_that_cannot_save_is_in_no_iterated_loop() {
    let settings = settings(Method::Iterated(Iteration::default()), Order::Linear, 8);
    let mut network = RESOLVED.network();
    network.members[1].block.can_save = false;
    let error = Master::new(network, &settings).err().unwrap();
    let expected = NetworkError::CannotRepeat { block: "second".into(), cycle: "first -> second -> first".into() };
    assert_eq!(error, CouplingError::Network(expected));
    // Outside of a loop it may be.
    let mut network = RESOLVED.network();
    network.members[1].block.can_save = false;
    network.connections.remove(0);
    Master::new(network, &settings).unwrap().advance().unwrap();
}

#[test]
fn blocks_of_an_iterated_loop_have_one_step() {
    let settings = settings(Method::Iterated(Iteration::default()), Order::Linear, 8);
    let mut network = RESOLVED.network();
    network.members[1].every = NonZeroU32::new(2).unwrap();
    let error = Master::new(network, &settings).err().unwrap();
    assert_eq!(error, CouplingError::Network(NetworkError::MixedSteps { cycle: "first -> second -> first".into() }));
}

#[test]
fn networks_that_are_none_are_refused() {
    let refused = |change: &dyn Fn(&mut Network<Linear>)| {
        let mut network = RESOLVED.network();
        change(&mut network);
        Master::new(network, &settings(Method::Jacobi, Order::Constant, 8)).err().unwrap().to_string()
    };
    assert_eq!(
        refused(&|network| network.connections[0].from.port = 1),
        "output 1 of block 1 does not exist: there are 2 blocks, and it has 1 of them"
    );
    assert_eq!(
        refused(&|network| network.connections.push(connect((0, 1), (0, 0)))),
        "`first.u0` has two connections; one can lead to it: add the signals in a block"
    );
    assert_eq!(
        refused(&|network| network.connections[0].gain = f64::NAN),
        "`gain` of `second.y0 -> first.u0` must be finite, got NaN"
    );
    let order = settings(Method::GaussSeidel(vec![0, 0]), Order::Constant, 8);
    let error = Master::new(RESOLVED.network(), &order).err().unwrap();
    assert_eq!(error.to_string(), "the order of blocks must name each of the 2 blocks once, got [0, 0]");
}
