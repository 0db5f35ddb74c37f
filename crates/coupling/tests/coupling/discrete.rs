//! Signals that change at exchanges only.
use servobench_base::{Divider, Rate};
use servobench_coupling::{
    Block, Connection, Input, InputPort, Master, Member, Method, Network, Order, Port, Settings, Step,
};
use std::convert::Infallible;
use std::num::NonZeroU32;

/// Counts its steps and keeps the inputs that it has had.
#[derive(Default)]
struct Counting {
    steps: u32,
    had: Vec<Input>,
}

impl Block for Counting {
    type Error = Infallible;

    fn saves_state(&self) -> bool {
        false
    }

    fn feeds_through(&self, _output: usize, _input: usize) -> bool {
        false
    }

    fn step(&mut self, _time: f64, _length: f64, inputs: &[Input]) -> Result<Step, Infallible> {
        self.steps += 1;
        self.had.extend(inputs);
        Ok(Step::Done)
    }

    fn read(&mut self, _inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), Infallible> {
        outputs.fill(f64::from(self.steps).powi(2));
        Ok(())
    }

    fn save(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    fn restore(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

/// What the second of two blocks has had of the squares that the first counts.
fn had(method: Method, order: Order, is_discrete: bool) -> Vec<Input> {
    let member = |name: &str, inputs: &[&str]| Member {
        name: name.into(),
        inputs: inputs.iter().map(|name| InputPort { name: (*name).into(), held: 0.0 }).collect(),
        outputs: vec!["n".into()],
        every: NonZeroU32::MIN,
        block: Counting::default(),
    };
    let network = Network {
        members: vec![member("first", &[]), member("second", &["u"])],
        connections: vec![Connection {
            from: Port { block: 0, port: 0 },
            to: Port { block: 1, port: 0 },
            gain: 1.0,
            offset: 0.0,
            is_discrete,
        }],
        bonds: Vec::new(),
    };
    let (base_rate, step) = (Rate::new(1_000).unwrap(), Divider::new(1).unwrap());
    let settings = Settings { base_rate, step, method, order, algebraic: None, watch: false };
    let mut master = Master::new(network, &settings).unwrap();
    for _ in 0..4 {
        master.advance().unwrap();
    }
    master.block(1).had.clone()
}

/// Oracle: by hand. In sequence the second block sees what the first has just come to, side by side what it had before.
#[test]
fn the_newest_value_holds_whatever_the_order() {
    for order in Order::ALL {
        let in_sequence = had(Method::GaussSeidel(vec![0, 1]), order, true);
        assert_eq!(in_sequence, [[1.0, 0.0, 0.0], [4.0, 0.0, 0.0], [9.0, 0.0, 0.0], [16.0, 0.0, 0.0]], "{order:?}");
        let at_once = had(Method::Jacobi, order, true);
        assert_eq!(at_once, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [4.0, 0.0, 0.0], [9.0, 0.0, 0.0]], "{order:?}");
    }
    // A continuous signal is a line to the value that is known: from 9 to 16 within a millisecond.
    let continuous = had(Method::GaussSeidel(vec![0, 1]), Order::Constant, false);
    assert!((continuous[3][0] - 9.0).abs() < 1e-12 && (continuous[3][1] - 7_000.0).abs() < 1e-9, "{continuous:?}");
}
