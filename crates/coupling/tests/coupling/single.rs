//! Algebraic loops of numbers of single precision.
use super::linear::{connect, member};
use super::oscillator::settings;
use servobench_coupling::{Block, CouplingError, Input, Iteration, Master, Method, Network, Order, Port, StepEnd};
use std::convert::Infallible;

/// y = gain·u + offset·(1 + t) in single precision, which it may keep to itself.
struct Single {
    gain: f64,
    offset: f64,
    time: f64,
    says_so: bool,
}

impl Block for Single {
    type Error = Infallible;

    fn saves_state(&self) -> bool {
        true
    }

    fn feeds_through(&self, _: usize, _: usize) -> bool {
        true
    }

    fn is_single_precision(&self) -> bool {
        self.says_so
    }

    fn step(&mut self, time: f64, length: f64, _: &[Input]) -> Result<StepEnd, Infallible> {
        self.time = time + length;
        Ok(StepEnd::Done)
    }

    #[expect(clippy::cast_possible_truncation, reason = "single precision is what this is about")]
    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), Infallible> {
        let u = inputs.map_or(0.0, |inputs| inputs[0]) as f32;
        outputs[0] = f64::from((self.gain * f64::from(u) + self.offset * (1.0 + self.time)) as f32);
        Ok(())
    }

    fn save(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    fn restore(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

fn ring(gain: f64, says_so: bool) -> Result<Master<Single>, CouplingError<Infallible>> {
    let block = |gain, offset| Single { gain, offset, time: 0.0, says_so };
    let network = Network {
        members: vec![member("a", block(gain, 1.0), 1, 1), member("b", block(1.0, 0.0), 1, 1)],
        connections: vec![connect((1, 0), (0, 0)), connect((0, 0), (1, 0))],
    };
    let mut settings = settings(Method::GaussSeidel(vec![0, 1]), Order::Linear, 8);
    settings.algebraic = Some(Iteration::default());
    Master::new(network, &settings)
}

/// Oracle: y = (1 + t)/(1 − gain), to a few roundings of single precision of what the loop adds up.
#[test]
fn loops_agree_as_far_as_single_precision_goes() {
    for gain in [-0.9, 0.5, 0.9, 0.99, -3.0, -10.0, 100.0, -1000.0, 1.7, 0.0] {
        let mut master = ring(gain, true).unwrap_or_else(|error| panic!("{gain}: {error}"));
        for _ in 0..500 {
            master.advance().unwrap_or_else(|error| panic!("{gain}: {error}"));
            let y = master.value(Port { block: 1, port: 0 }).unwrap();
            let exact = (1.0 + master.time()) / (1.0 - gain);
            assert!((y / exact - 1.0).abs() < 1e-4, "{gain}: {y} for {exact}");
        }
    }
}

/// The tolerance of double precision, which such a loop does not reach.
#[test]
fn it_is_the_declared_precision_that_counts() {
    let ends = |gain| {
        let mut master = ring(gain, false)?;
        (0..500).try_for_each(|_| master.advance().map(|_| ()))
    };
    assert!(matches!(ends(-0.9), Err(CouplingError::NotConverged { .. })));
}
