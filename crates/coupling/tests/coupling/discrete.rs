//! Signals that change at exchanges only.
use servobench_base::{Divider, Rate};
use servobench_coupling::{
    Block, Connection, Input, InputPort, Master, Member, Method, Network, Order, Port, Settings, StepEnd,
};
use std::convert::Infallible;
use std::num::NonZeroU32;

/// Counts its steps and keeps the inputs that it has had.
#[derive(Default)]
struct Counting {
    steps: u32,
    had: Vec<Input>,
    /// Says that its output changes at events only.
    is_discrete: bool,
}

impl Block for Counting {
    type Error = Infallible;

    fn saves_state(&self) -> bool {
        false
    }

    fn feeds_through(&self, _output: usize, _input: usize) -> bool {
        false
    }

    fn is_discrete(&self, _output: usize) -> bool {
        self.is_discrete
    }

    fn step(&mut self, _time: f64, _length: f64, inputs: &[Input]) -> Result<StepEnd, Infallible> {
        self.steps += 1;
        self.had.extend(inputs);
        Ok(StepEnd::Done)
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

/// Steps of the source, steps of the destination, and which of them comes first in the network.
fn held(method: Method, order: Order, [source, destination]: [u32; 2], source_is_first: bool) -> (Vec<Input>, u64) {
    let member = |name: &str, inputs: &[&str], every| Member {
        name: name.into(),
        inputs: inputs.iter().map(|name| InputPort { name: (*name).into(), held: 0.0 }).collect(),
        outputs: vec!["n".into()],
        every: NonZeroU32::new(every).unwrap(),
        block: Counting { is_discrete: true, ..Counting::default() },
    };
    let (from, to) = if source_is_first { (0, 1) } else { (1, 0) };
    let mut members = vec![member("source", &[], source), member("destination", &["u"], destination)];
    if !source_is_first {
        members.reverse();
    }
    let (from_port, to_port) = (Port { block: from, port: 0 }, Port { block: to, port: 0 });
    let connection = Connection { from: from_port, to: to_port, gain: 2.0, offset: -1.0, is_discrete: false };
    let network = Network { members, connections: vec![connection] };
    let (base_rate, step) = (Rate::new(1_000).unwrap(), Divider::new(1).unwrap());
    let settings = Settings { base_rate, step, method, order, algebraic: None, watch: true };
    let mut master = Master::new(network, &settings).unwrap();
    assert_eq!(master.delays()[0].extrapolated, Some(Order::Constant), "it is held");
    let steps = master.delays()[0].steps;
    for _ in 0..36 {
        master.advance().unwrap();
    }
    (master.block(to).had.clone(), steps)
}

/// Oracle: what the source has come to at or before the start of each step, whatever the method, the order, the steps and who comes
/// first: nobody knows an event before its time, and none is drawn out into a line. The age of it is that of the delay at most.
#[test]
fn what_a_block_calls_discrete_is_held() {
    let methods =
        [Method::Jacobi, Method::GaussSeidel(vec![0, 1]), Method::Iterated(servobench_coupling::Iteration::default())];
    for every in [[1, 1], [4, 1], [1, 4], [4, 6], [6, 4], [3, 2]] {
        for order in Order::ALL {
            for method in &methods {
                for source_is_first in [true, false] {
                    let (had, delay) = held(method.clone(), order, every, source_is_first);
                    let [source, destination] = every;
                    let mut oldest = 0;
                    for (step, input) in (0..).zip(&had) {
                        let start = step * destination;
                        let count = f64::from(start / source);
                        let expected = [2.0 * count * count - 1.0, 0.0, 0.0_f64];
                        let (input, expected) = (input.map(f64::to_bits), expected.map(f64::to_bits));
                        assert_eq!(input, expected, "{method:?}, {order:?}, {every:?}, {source_is_first}: step {step}");
                        oldest = oldest.max(u64::from(start % source + destination));
                    }
                    assert_eq!(delay, oldest, "{method:?}, {order:?}, {every:?}, {source_is_first}");
                }
            }
        }
    }
}
