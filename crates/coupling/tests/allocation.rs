//! A communication step allocates nothing, with any method.
use servobench_base::{Divider, Rate};
use servobench_coupling::{
    Acceleration, Block, Connection, Input, InputPort, Iteration, Master, Member, Method, Network, Order, Port,
    Settings, StepEnd, mean,
};
use servobench_testkit::CountingAllocator;
use std::convert::Infallible;
use std::num::NonZeroU32;

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

/// Two lags, of which the second output follows the second input at once: y₀ = x₀, y₁ = x₁ + 0.1·u₁.
struct Lags {
    x: [f64; 2],
    saved: [f64; 2],
    u: f64,
    events: u32,
}

impl Block for Lags {
    type Error = Infallible;

    fn saves_state(&self) -> bool {
        true
    }

    fn feeds_through(&self, output: usize, input: usize) -> bool {
        (output, input) == (1, 1)
    }

    fn step(&mut self, time: f64, length: f64, inputs: &[Input]) -> Result<StepEnd, Infallible> {
        for (x, input) in self.x.iter_mut().zip(inputs) {
            *x += length * (mean(input, length) - *x);
        }
        self.u = inputs[1][0];
        // Each tenth of a second has an event, in a step or between two.
        let event = (time * 10.0).floor() / 10.0 + 0.1;
        if event > time && event < time + length {
            self.events += 1;
            return Ok(StepEnd::Until(event));
        }
        Ok(StepEnd::Done)
    }

    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), Infallible> {
        outputs[0] = self.x[0];
        outputs[1] = self.x[1] + 0.1 * inputs.map_or(self.u, |inputs| inputs[1]);
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

/// Three blocks in two rings; the second ring is an algebraic loop.
fn master(method: Method, order: Order) -> Master<Lags> {
    let member = |block: usize| Member {
        name: format!("b{block}"),
        inputs: (0..2).map(|i| InputPort { name: format!("u{i}"), held: 0.0 }).collect(),
        outputs: vec!["y0".into(), "y1".into()],
        every: NonZeroU32::MIN,
        block: Lags { x: [1.0, block as f64], saved: [0.0; 2], u: 0.0, events: 0 },
    };
    let connection = |from: usize, to: usize, port: usize, gain: f64| Connection {
        from: Port { block: from, port },
        to: Port { block: to, port },
        gain,
        offset: 0.0,
        is_discrete: false,
    };
    let mut connections: Vec<_> =
        (0..3).flat_map(|b| (0..2).map(move |port| connection(b, (b + 1) % 3, port, 0.5))).collect();
    // A loop of the first two blocks, beside the rings.
    connections[0] = connection(0, 1, 0, 1.0);
    connections[4] = connection(1, 0, 0, -1.0);
    let settings = Settings {
        base_rate: Rate::new(1000).unwrap(),
        step: Divider::new(7).unwrap(),
        method,
        order,
        algebraic: Some(Iteration::default()),
        watch: true,
    };
    Master::new(Network { members: (0..3).map(member).collect(), connections }, &settings).unwrap()
}

#[test]
fn steps_allocate_nothing() {
    let iterated = |acceleration| Method::Iterated(Iteration { acceleration, ..Iteration::default() });
    for method in [
        Method::Jacobi,
        Method::GaussSeidel(vec![2, 0, 1]),
        iterated(Acceleration::QuasiNewton(1.0)),
        iterated(Acceleration::Aitken(0.5)),
    ] {
        for order in Order::ALL {
            let mut master = master(method.clone(), order);
            let before = CountingAllocator::count();
            for _ in 0..1000 {
                master.advance().unwrap();
            }
            assert_eq!(CountingAllocator::count() - before, 0, "{method:?}, {order:?}");
            assert!(master.block(0).events > 10);
        }
    }
}
