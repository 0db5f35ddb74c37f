//! What a communication step costs beyond the blocks' own calls: three blocks that do nothing, six connections.
//! `cargo bench -p servobench-coupling`.
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use servobench_base::{Divider, Rate};
use servobench_coupling::{
    Block, Connection, Input, InputPort, Iteration, Master, Member, Method, Network, Order, Port, Settings, StepEnd,
};
use std::convert::Infallible;
use std::num::NonZeroU32;

fn main() {
    divan::main();
}

/// Steps of one measurement.
const STEPS: usize = 10_000;

/// Cosine and sine of a turn: a Pythagorean triple, 0.9 degrees.
const TURN: [f64; 2] = [16383.0 / 16385.0, 256.0 / 16385.0];

/// Two inputs, two outputs that turn slowly; behind a pointer, as FMUs are.
struct Idle {
    x: [f64; 2],
    saved: [f64; 2],
    follows: bool,
}

impl Block for Idle {
    type Error = Infallible;

    fn saves_state(&self) -> bool {
        true
    }

    fn feeds_through(&self, _: usize, _: usize) -> bool {
        self.follows
    }

    fn step(&mut self, _: f64, _: f64, inputs: &[Input]) -> Result<StepEnd, Infallible> {
        black_box(inputs);
        let [x, y] = self.x;
        self.x = [TURN[0] * x - TURN[1] * y, TURN[1] * x + TURN[0] * y];
        Ok(StepEnd::Done)
    }

    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), Infallible> {
        black_box(inputs);
        outputs.copy_from_slice(&self.x);
        Ok(())
    }

    fn save(&mut self) -> Result<(), Infallible> {
        self.saved = self.x;
        Ok(())
    }

    fn restore(&mut self) -> Result<(), Infallible> {
        self.x = self.saved;
        Ok(())
    }
}

type Boxed = Box<dyn Block<Error = Infallible>>;

/// Each block leads to both others; the last one's outputs follow its inputs if `follows`.
fn master(method: Method, order: Order, follows: bool) -> Master<Boxed> {
    let member = |block: usize| Member::<Boxed> {
        name: format!("b{block}"),
        inputs: (0..2).map(|i| InputPort { name: format!("u{i}"), held: 0.0 }).collect(),
        outputs: vec!["y0".into(), "y1".into()],
        every: NonZeroU32::MIN,
        block: Box::new(Idle { x: [1.0, 0.0], saved: [0.0; 2], follows: follows && block == 2 }),
    };
    let connection = |from: usize, port: usize| Connection {
        from: Port { block: from, port },
        to: Port { block: (from + 1 + port) % 3, port },
        gain: 0.5,
        offset: 0.1,
        is_discrete: false,
    };
    let connections = (0..3).flat_map(|block| (0..2).map(move |port| connection(block, port))).collect();
    let settings = Settings {
        base_rate: Rate::new(16_000).unwrap(),
        step: Divider::new(16).unwrap(),
        method,
        order,
        algebraic: None,
        watch: true,
    };
    Master::new(Network { members: (0..3).map(member).collect(), connections }, &settings).unwrap()
}

fn steps(bencher: Bencher<'_, '_>, mut master: Master<Boxed>) {
    bencher.counter(ItemsCount::new(STEPS)).bench_local(|| {
        for _ in 0..STEPS {
            master.advance().unwrap();
        }
        master.time()
    });
}

#[divan::bench(args = Order::ALL)]
fn jacobi(bencher: Bencher<'_, '_>, order: Order) {
    steps(bencher, master(Method::Jacobi, order, false));
}

/// One block's outputs follow its inputs: it is read at the exchange with these.
#[divan::bench(args = Order::ALL)]
fn jacobi_with_feedthrough(bencher: Bencher<'_, '_>, order: Order) {
    steps(bencher, master(Method::Jacobi, order, true));
}

#[divan::bench(args = Order::ALL)]
fn gauss_seidel(bencher: Bencher<'_, '_>, order: Order) {
    steps(bencher, master(Method::GaussSeidel(vec![0, 1, 2]), order, false));
}

/// Blocks that do not follow their inputs agree in the second evaluation.
#[divan::bench(args = Order::ALL)]
fn iterated(bencher: Bencher<'_, '_>, order: Order) {
    steps(bencher, master(Method::Iterated(Iteration::default()), order, false));
}

/// The blocks' own calls, for comparison.
#[divan::bench]
fn blocks_alone(bencher: Bencher<'_, '_>) {
    let mut blocks: Vec<Boxed> =
        (0..3).map(|_| Box::new(Idle { x: [1.0, 0.0], saved: [0.0; 2], follows: false }) as Boxed).collect();
    bencher.counter(ItemsCount::new(STEPS)).bench_local(|| {
        let mut outputs = [0.0; 2];
        for _ in 0..STEPS {
            for block in &mut blocks {
                block.step(0.0, 1e-3, &[[0.0; 3]; 2]).unwrap();
                block.read(None, &mut outputs).unwrap();
                black_box(&mut outputs);
            }
        }
        outputs
    });
}
