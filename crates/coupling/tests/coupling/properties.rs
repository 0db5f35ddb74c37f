//! Networks at random.
use super::linear::{Linear, Model, member};
use super::oscillator::settings;
use proptest::prelude::*;
use servobench_coupling::{Connection, CouplingError, Iteration, Master, Method, Network, Order, Port, Settings};
use std::num::NonZeroU32;

/// A block of one state with two inputs: its pole, its input factors, its feedthrough, the sources of its inputs, its step.
type Recipe = (f64, [f64; 2], [f64; 2], [Option<usize>; 2], u32);

fn recipe() -> impl Strategy<Value = Recipe> {
    let pair = || [-1.0..1.0_f64, -1.0..1.0_f64];
    let source = || proptest::option::of(0_usize..5);
    (-3.0..-0.5_f64, pair(), pair(), [source(), source()], 1_u32..4)
}

/// The blocks in the order of `places`. An output follows an input without a step only if that comes from a block of lower number, so
/// that there is no algebraic loop.
fn network(recipes: &[Recipe], places: &[usize]) -> Network<Linear> {
    let place = |block: usize| places.iter().position(|other| *other == block).unwrap();
    let mut connections = Vec::new();
    let members = places.iter().enumerate().map(|(here, number)| {
        let (pole, b, mut d, sources, every) = recipes[*number];
        for (port, source) in sources.iter().enumerate() {
            if let Some(source) = source {
                let from = Port { block: place(*source), port: 0 };
                connections.push(Connection {
                    from,
                    to: Port { block: here, port },
                    gain: 0.5,
                    offset: 0.125,
                    is_discrete: false,
                });
            }
            if source.is_none_or(|source| source >= *number) {
                d[port] = 0.0;
            }
        }
        let model = Model { a: vec![vec![pole]], b: vec![b.to_vec()], c: vec![vec![1.0]], d: vec![d.to_vec()] };
        let mut member = member(&format!("b{number}"), Linear::new(model, &[1.0 + *number as f64]), 2, 1);
        member.every = NonZeroU32::new(every).unwrap();
        member
    });
    Network { members: members.collect(), connections }
}

/// Bits of all outputs, by number of the block, through 40 exchanges.
fn bits(recipes: &[Recipe], places: &[usize], method: &Method, order: Order) -> Vec<Vec<u64>> {
    let mut master = Master::new(network(recipes, places), &settings(method.clone(), order, 800)).unwrap();
    let exchange = |master: &Master<Linear>| -> Vec<u64> {
        let place = |block: usize| places.iter().position(|other| *other == block).unwrap();
        (0..5).map(|block| master.value(Port { block: place(block), port: 0 }).unwrap().to_bits()).collect()
    };
    let mut seen = vec![exchange(&master)];
    for _ in 0..40 {
        master.advance().unwrap();
        seen.push(exchange(&master));
    }
    seen
}

fn order() -> impl Strategy<Value = Order> {
    proptest::sample::select(Order::ALL.to_vec())
}

proptest! {
    #[test]
    fn the_order_of_blocks_does_not_matter_to_jacobi(
        recipes in proptest::collection::vec(recipe(), 5),
        places in Just((0..5).collect::<Vec<usize>>()).prop_shuffle(),
        order in order(),
    ) {
        let ordered = bits(&recipes, &[0, 1, 2, 3, 4], &Method::Jacobi, order);
        prop_assert_eq!(ordered, bits(&recipes, &places, &Method::Jacobi, order));
    }

    /// With gains and steps at which about half of the networks grow. Growth goes on: 100-fold in at most 300 exchanges
    /// is at least 10-fold in 600, of a signal with an offset too, so that it comes to 10 times what it was before it was found.
    #[test]
    fn what_is_called_unstable_grows(
        recipes in proptest::collection::vec(recipe(), 5), order in order(), gain in 0.5..8.0_f64, ticks in 400_u32..8000
    ) {
        let master = |watch| {
            let mut network = network(&recipes, &[0, 1, 2, 3, 4]);
            network.connections.iter_mut().for_each(|connection| connection.gain = gain);
            Master::new(network, &Settings { watch, ..settings(Method::Jacobi, order, ticks) }).unwrap()
        };
        let greatest = |master: &Master<Linear>| {
            (0..5).map(|block| master.value(Port { block, port: 0 }).unwrap().abs()).fold(0.0, f64::max)
        };
        let mut watched = master(true);
        let found = (0..300).find_map(|_| match watched.advance() {
            Err(CouplingError::Unstable { step, .. }) => Some(step),
            _ => None,
        });
        if let Some(step) = found {
            let mut free = master(false);
            let (mut before, mut after) = (0.0_f64, 0.0_f64);
            for exchange in 0..step + 600 {
                match free.advance() {
                    Ok(_) if exchange < step => before = before.max(greatest(&free)),
                    Ok(_) => after = after.max(greatest(&free)),
                    Err(_) => after = f64::INFINITY,
                }
            }
            prop_assert!(after >= 10.0 * before, "found in step {}, {} after {}", step, after, before);
        }
    }

    /// With steps of one, so that any loop can be iterated.
    #[test]
    fn the_same_network_gives_the_same_bits(mut recipes in proptest::collection::vec(recipe(), 5), order in order()) {
        let ordered = [0, 1, 2, 3, 4];
        for recipe in &mut recipes {
            recipe.4 = 1;
        }
        for method in [Method::Jacobi, Method::GaussSeidel(vec![3, 1, 4, 0, 2]), Method::Iterated(Iteration::default())] {
            let first = bits(&recipes, &ordered, &method, order);
            prop_assert_eq!(first, bits(&recipes, &ordered, &method, order));
        }
    }

    /// What methods differ by vanishes with the step; with poles of at most 3 and a step of 0.1 s they agree to the order of the step's
    /// extrapolation error: 0.1 of signals of at most 6, for the held value.
    #[test]
    fn methods_agree_about_networks_that_are_resolved(mut recipes in proptest::collection::vec(recipe(), 5)) {
        for recipe in &mut recipes {
            recipe.4 = 1;
        }
        let last = |method: &Method| -> Vec<f64> {
            let seen = bits(&recipes, &[0, 1, 2, 3, 4], method, Order::Linear);
            seen[40].iter().map(|bits| f64::from_bits(*bits)).collect()
        };
        let jacobi = last(&Method::Jacobi);
        for method in [Method::GaussSeidel(vec![0, 1, 2, 3, 4]), Method::Iterated(Iteration::default())] {
            for (one, other) in jacobi.iter().zip(last(&method)) {
                prop_assert!((one - other).abs() < 0.6, "{:?}: {} and {}", method, one, other);
            }
        }
    }
}
