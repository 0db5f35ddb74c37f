//! The delays that the master tells are those that a block sees.
use super::linear::{connect, member};
use super::oscillator::{RATE, settings};
use servobench_base::Rate;
use servobench_coupling::{Block, Input, Iteration, Master, Method, Network, Order, StepEnd, value};
use std::convert::Infallible;
use std::num::NonZeroU32;

/// Ticks of a communication step.
const TICKS: u32 = 8;

/// A number for a tick by which it is known again (Knuth's multiplicative hash).
fn mark(tick: u64) -> f64 {
    (tick.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40) as f64 / f64::from(1 << 24)
}

/// Marks its output with its time, or looks for the newest mark in what it is stepped with.
enum Probe {
    Source { tick: u64 },
    Destination { every: u32, oldest: u64 },
}

impl Block for Probe {
    type Error = Infallible;

    fn saves_state(&self) -> bool {
        false
    }

    fn feeds_through(&self, _: usize, _: usize) -> bool {
        false
    }

    fn step(&mut self, time: f64, length: f64, inputs: &[Input]) -> Result<StepEnd, Infallible> {
        let rate = Rate::new(RATE).unwrap();
        let (start, end) = (rate.tick_at(time).0, rate.tick_at(time + length).0);
        match self {
            Self::Source { tick } => *tick = end,
            Self::Destination { every, oldest } => {
                let grid = u64::from(*every * TICKS);
                let newest = (0..=end / grid + 1)
                    .rev()
                    .map(|multiple| multiple * grid)
                    .find(|tick| {
                        let after = (*tick as f64 - start as f64) / f64::from(RATE);
                        (value(&inputs[0], after) - mark(*tick)).abs() < 1e-9
                    })
                    .unwrap();
                *oldest = (*oldest).max(end.saturating_sub(newest));
            }
        }
        Ok(StepEnd::Done)
    }

    fn read(&mut self, _: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), Infallible> {
        if let Self::Source { tick } = self {
            outputs[0] = mark(*tick);
        }
        Ok(())
    }

    fn save(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    fn restore(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

#[test]
fn the_newest_value_of_a_step_is_as_old_as_is_told() {
    let methods = [
        Method::Jacobi,
        Method::GaussSeidel(vec![0, 1]),
        Method::GaussSeidel(vec![1, 0]),
        Method::Iterated(Iteration::default()),
    ];
    for method in methods {
        for order in Order::ALL {
            for source in 1..=6 {
                for destination in 1..=6 {
                    let mut members = vec![
                        member("source", Probe::Source { tick: 0 }, 0, 1),
                        member("destination", Probe::Destination { every: source, oldest: 0 }, 1, 0),
                    ];
                    members[0].every = NonZeroU32::new(source).unwrap();
                    members[1].every = NonZeroU32::new(destination).unwrap();
                    let network = Network { members, connections: vec![connect((0, 0), (1, 0))] };
                    let mut master = Master::new(network, &settings(method.clone(), order, TICKS)).unwrap();
                    for _ in 0..120 {
                        master.advance().unwrap();
                    }
                    let Probe::Destination { oldest, .. } = master.block(1) else { panic!() };
                    let told = master.delays()[0];
                    assert_eq!(told.ticks, *oldest, "{method:?}, {order:?}, {source} to {destination}");
                    assert_eq!(told.steps * u64::from(TICKS), told.ticks);
                    assert_eq!(told.extrapolated.is_none(), told.ticks == 0);
                }
            }
        }
    }
}

/// With one step for all: 1 with the values of the start, 0 where the end is known.
#[test]
fn with_one_step_the_delay_is_one_or_none() {
    let steps = |method, order| {
        let master = Master::new(super::oscillator::RESOLVED.network(), &settings(method, order, TICKS)).unwrap();
        master.delays().iter().map(|delay| delay.steps).collect::<Vec<_>>()
    };
    for order in Order::ALL {
        // Force to the mass, displacement and velocity to the spring.
        assert_eq!(steps(Method::Jacobi, order), [1, 1, 1]);
        assert_eq!(steps(Method::GaussSeidel(vec![0, 1]), order), [1, 0, 0]);
        assert_eq!(steps(Method::GaussSeidel(vec![1, 0]), order), [0, 1, 1]);
        assert_eq!(steps(Method::Iterated(Iteration::default()), order), [0, 0, 0]);
    }
}
