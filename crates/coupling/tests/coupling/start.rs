//! Initial equations: what blocks with a start of their own come to before the first step.
use servobench_base::{Divider, Rate};
use servobench_coupling::{
    Block, Connection, CouplingError, Input, InputPort, Iteration, Master, Member, Method, Network, NetworkError,
    Order, Port, Settings, StepEnd,
};
use std::convert::Infallible;
use std::num::NonZeroU32;

/// x(0) = `gain`·u(0) + `level`, rounded if it is `whole`; y = x, which follows no input after that.
struct State {
    gain: f64,
    level: f64,
    whole: bool,
    x: f64,
    /// The inputs that it was started with.
    started: Vec<Vec<f64>>,
}

impl State {
    fn new(gain: f64, level: f64) -> Self {
        Self { gain, level, whole: false, x: level, started: Vec::new() }
    }

    fn solve(&mut self, inputs: &[f64]) {
        let x = self.gain * inputs.first().copied().unwrap_or(0.0) + self.level;
        self.x = if self.whole { x.round() } else { x };
    }
}

impl Block for State {
    type Error = Infallible;

    fn saves_state(&self) -> bool {
        false
    }

    fn feeds_through(&self, _output: usize, _input: usize) -> bool {
        false
    }

    fn is_discrete(&self, _output: usize) -> bool {
        self.whole
    }

    fn has_initial_equations(&self) -> bool {
        self.started.is_empty()
    }

    fn follows_at_start(&self, _output: usize, _input: usize) -> bool {
        self.gain != 0.0
    }

    fn start(&mut self, inputs: &[f64]) -> Result<(), Infallible> {
        self.solve(inputs);
        self.started.push(inputs.to_vec());
        Ok(())
    }

    fn step(&mut self, _time: f64, _length: f64, _inputs: &[Input]) -> Result<StepEnd, Infallible> {
        assert_eq!(self.started.len(), 1, "a step before the start, or a second start");
        Ok(StepEnd::Done)
    }

    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), Infallible> {
        if let Some(inputs) = inputs {
            assert!(self.started.is_empty(), "it follows nothing after the start");
            self.solve(inputs);
        }
        outputs.fill(self.x);
        Ok(())
    }

    fn save(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    fn restore(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

/// States in a row, or in a ring; each has the one before it as its input, in the order `of`.
fn coupled(
    blocks: Vec<State>,
    connections: &[(usize, usize)],
    algebraic: Option<Iteration>,
) -> Result<Master<State>, CouplingError<Infallible>> {
    let members = blocks.into_iter().enumerate().map(|(index, block)| Member {
        name: format!("x{index}"),
        inputs: vec![InputPort { name: "u".into(), held: 0.25 }],
        outputs: vec!["y".into()],
        every: NonZeroU32::MIN,
        block,
    });
    let port = |block| Port { block, port: 0 };
    let connect = |(from, to): &(usize, usize)| Connection {
        from: port(*from),
        to: port(*to),
        gain: 1.0,
        offset: 0.0,
        is_discrete: false,
    };
    let connections = connections.iter().map(connect).collect();
    let network = Network { members: members.collect(), connections };
    let (base_rate, step) = (Rate::new(1_000).unwrap(), Divider::new(1).unwrap());
    let settings = Settings { base_rate, step, method: Method::Jacobi, order: Order::Linear, algebraic, watch: true };
    Master::new(network, &settings)
}

fn value(master: &Master<State>, block: usize) -> f64 {
    master.value(Port { block, port: 0 }).unwrap()
}

/// Oracle: by hand, whatever the order of the blocks; an input without a connection has the value that it is held at.
#[test]
fn a_chain_begins_with_what_comes_through_its_wires() {
    for [first, second, third] in [[0, 1, 2], [2, 1, 0], [1, 2, 0]] {
        let mut blocks: Vec<Option<State>> = (0..3).map(|_| None).collect();
        blocks[first] = Some(State::new(1.0, 7.0));
        blocks[second] = Some(State::new(3.0, 0.0));
        blocks[third] = Some(State::new(-2.0, 0.5));
        let blocks = blocks.into_iter().flatten().collect();
        let mut master = coupled(blocks, &[(first, second), (second, third)], None).unwrap();
        for _ in 0..3 {
            let found = [first, second, third].map(|block| value(&master, block));
            assert_eq!(found.map(f64::to_bits), [7.25_f64, 21.75, -43.0].map(f64::to_bits));
            master.advance().unwrap();
        }
        assert_eq!(master.block(third).started, [[21.75]]);
    }
}

/// Oracle: x0 = a·x1 + b and x1 = c·x0 + d, so that x0 = (a·d + b)/(1 − a·c). With |a·c| > 1 no plain iteration comes there.
#[test]
fn a_ring_of_initial_equations_is_solved() {
    for (a, b, c, d) in [(0.5, 4.0, -3.0, 1.0), (0.25, 1.0, 0.5, -2.0), (-4.0, 1.0, 5.0, 2.0)] {
        let blocks = || vec![State::new(a, b), State::new(c, d)];
        let master = coupled(blocks(), &[(0, 1), (1, 0)], Some(Iteration::default())).unwrap();
        let x0 = (a * d + b) / (1.0 - a * c);
        let x1 = c * x0 + d;
        assert!((value(&master, 0) - x0).abs() < 1e-8 * (1.0 + x0.abs()), "{} of {x0}", value(&master, 0));
        assert!((value(&master, 1) - x1).abs() < 1e-8 * (1.0 + x1.abs()), "{} of {x1}", value(&master, 1));
        let refused = coupled(blocks(), &[(0, 1), (1, 0)], None).err().unwrap();
        assert!(matches!(refused, CouplingError::Network(NetworkError::AlgebraicLoop { .. })), "{refused}");
    }
}

/// Whole numbers in a ring are taken as they come: a way between them would be no number of theirs.
/// Oracle: n = round(0.4·x + 3) and x = n − 4 meet in n = 2, x = −2 (0.4·(−2) + 3 = 2.2).
#[test]
fn whole_numbers_in_a_ring_stay_whole() {
    let whole = State { whole: true, ..State::new(0.4, 3.0) };
    let master = coupled(vec![whole, State::new(1.0, -4.0)], &[(0, 1), (1, 0)], Some(Iteration::default())).unwrap();
    assert_eq!([0, 1].map(|block| value(&master, block).to_bits()), [2.0_f64, -2.0].map(f64::to_bits));
    // Both whole: nothing is left to accelerate. n = round(−0.4·m + 3), m = n: 2 = round(2.2).
    let both = [State::new(-0.4, 3.0), State::new(1.0, 0.0)].map(|state| State { whole: true, ..state });
    let master = coupled(both.into(), &[(0, 1), (1, 0)], Some(Iteration::default())).unwrap();
    assert_eq!([0, 1].map(|block| value(&master, block).to_bits()), [2.0_f64.to_bits(); 2]);
}
