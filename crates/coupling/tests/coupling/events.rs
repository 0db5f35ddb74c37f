//! Steps that end early, and simulations that do.
use super::linear::{connect, member};
use super::oscillator::{RATE, RESOLVED, settings, state};
use servobench_coupling::{Advance, Block, CouplingError, Input, Iteration, Master, Method, Network, Order, StepEnd};
use std::convert::Infallible;

/// Oracle: with polynomials as inputs, an exact block that is stepped in two parts comes to where one is that is stepped in one. Order
/// 0 and the iterated straight line do not depend on what a restart forgets; 1 s of rounding is left.
#[test]
fn the_rest_of_a_step_is_asked_for() {
    for (method, order) in [(Method::Jacobi, Order::Constant), (Method::Iterated(Iteration::default()), Order::Linear)]
    {
        let run = |event| {
            let mut network = RESOLVED.network();
            network.members[0].block.event = event;
            let mut master = Master::new(network, &settings(method.clone(), order, 32)).unwrap();
            while master.tick().0 < u64::from(RATE) {
                assert_eq!(master.advance().unwrap(), Advance::Done);
            }
            (state(&master), master.block(0).events, master.block(1).events)
        };
        let (whole, parts) = (run(None), run(Some(0.3)));
        assert_eq!((whole.1, whole.2, parts.2), (0, 0, 0));
        // Once, and once again in each repetition of that step.
        assert!(parts.1 == 1 || matches!(method, Method::Iterated(_)) && parts.1 > 1, "{method:?}: {}", parts.1);
        for (whole, parts) in whole.0.iter().zip(parts.0) {
            // The iteration's tolerance, 1e-9 of a force of 50 N, over 256 steps of 4 ms.
            assert!((whole - parts).abs() < 1e-7, "{method:?}: {whole} and {parts}");
        }
    }
}

/// A block that goes by a script, and takes down the slopes that it is stepped with.
#[derive(Default)]
struct Scripted {
    /// What the steps say, in their order; done after that.
    says: Vec<StepEnd>,
    steps: usize,
    output: f64,
    slopes: Vec<[f64; 2]>,
    parts: Vec<[f64; 2]>,
}

impl Block for Scripted {
    type Error = Infallible;

    fn saves_state(&self) -> bool {
        false
    }

    fn feeds_through(&self, _: usize, _: usize) -> bool {
        false
    }

    fn step(&mut self, time: f64, length: f64, inputs: &[Input]) -> Result<StepEnd, Infallible> {
        self.slopes.extend(inputs.iter().map(|input| [input[1], input[2]]));
        self.parts.push([time, length]);
        self.steps += 1;
        self.output = (self.steps * self.steps) as f64;
        Ok(self.says.get(self.steps - 1).copied().unwrap_or(StepEnd::Done))
    }

    fn read(&mut self, _: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), Infallible> {
        outputs.fill(self.output);
        Ok(())
    }

    fn save(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    fn restore(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

/// A source that goes by `says`, and what follows it, with steps of 1/8 s.
fn scripted(says: Vec<StepEnd>) -> Master<Scripted> {
    let source = Scripted { says, ..Scripted::default() };
    let members = vec![member("source", source, 0, 1), member("sink", Scripted::default(), 1, 0)];
    let network = Network { members, connections: vec![connect((0, 0), (1, 0))] };
    Master::new(network, &settings(Method::Jacobi, Order::Quadratic, RATE / 8)).unwrap()
}

#[test]
fn extrapolation_begins_again_after_an_event() {
    let mut master = scripted(vec![StepEnd::Done, StepEnd::Done, StepEnd::Done, StepEnd::Until(0.4)]);
    for _ in 0..7 {
        master.advance().unwrap();
    }
    let known: Vec<[bool; 2]> = master.block(1).slopes.iter().map(|slopes| slopes.map(|slope| slope != 0.0)).collect();
    // Orders 0, 1, 2, 2 as values come in; the fourth step of the source ends early, so 0, 1, 2 from the fifth on.
    let (none, slope, both) = ([false, false], [true, false], [true, true]);
    assert_eq!(known, [none, slope, both, both, none, slope, both]);
    // Parts of the fourth step, in seconds of times that are exact in binary but for 0.4.
    assert_eq!(master.block(0).parts[3..5], [[0.375, 0.125], [0.4, 0.5 - 0.4]]);
}

#[test]
fn a_block_ends_the_simulation() {
    let mut master = scripted(vec![StepEnd::Done, StepEnd::Terminated(0.2)]);
    assert_eq!(master.advance().unwrap(), Advance::Done);
    let ended = Advance::Terminated { block: 0, time: 0.2 };
    assert_eq!([master.advance().unwrap(), master.advance().unwrap()], [ended; 2]);
    assert_eq!((master.block(0).steps, master.time()), (2, 0.125));
}

#[test]
fn a_block_that_does_not_get_on_is_an_error() {
    for at in [-0.1, 0.2, f64::NAN] {
        match scripted(vec![StepEnd::Until(at)]).advance() {
            Err(CouplingError::Astray { block, parts: 1, .. }) => assert_eq!(block, "source"),
            other => panic!("{at}: {other:?}"),
        }
    }
    match scripted(vec![StepEnd::Until(0.0625); 2000]).advance() {
        Err(CouplingError::Astray { parts: 1001, .. }) => {}
        other => panic!("{other:?}"),
    }
}
