//! A position loop with a sampled controller and an encoder: what a servo axis exchanges is let be.
use super::linear::{Linear, Model, connect, member};
use super::oscillator::{RATE, settings};
use servobench_coupling::{Block, CouplingError, Input, Master, Method, Network, Order, StepEnd, value};
use std::convert::Infallible;
use std::num::NonZeroU32;

/// A count of the encoder (m).
const COUNT: f64 = 1e-6;
/// Where both poles of the loop would be without sampling (rad/s).
const BANDWIDTH: f64 = 60.0;

/// u = ω²·(r − x) + 2·ω·(ṙ − Δx/T) for a mass of 1 kg, once per step, with x in counts.
struct Controller {
    before: f64,
    force: f64,
}

/// A rest of 0.2 s, a move over 0.2 m by a polynomial of order 5 in 0.5 s, a rest.
fn reference(t: f64) -> [f64; 2] {
    let s = ((t - 0.2) / 0.5).clamp(0.0, 1.0);
    let (x, v) = (s.powi(3) * (10.0 - s * (15.0 - 6.0 * s)), 30.0 * s * s * (1.0 - s) * (1.0 - s));
    [0.2 * x, 0.2 / 0.5 * v]
}

impl Block for Controller {
    type Error = Infallible;

    fn saves_state(&self) -> bool {
        false
    }

    fn feeds_through(&self, _: usize, _: usize) -> bool {
        false
    }

    fn step(&mut self, time: f64, length: f64, inputs: &[Input]) -> Result<StepEnd, Infallible> {
        let x = (value(&inputs[0], 0.0) / COUNT).floor() * COUNT;
        let [r, v] = reference(time);
        self.force = BANDWIDTH * BANDWIDTH * (r - x) + 2.0 * BANDWIDTH * (v - (x - self.before) / length);
        self.before = x;
        Ok(StepEnd::Done)
    }

    fn read(&mut self, _: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), Infallible> {
        outputs[0] = self.force;
        Ok(())
    }

    fn save(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    fn restore(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

type Boxed = Box<dyn Block<Error = Infallible>>;

/// The position after 1 s, with a controller that is sampled every `every` communication steps of 8/8192 s and acts on the mass through
/// connections of `order`.
fn end(every: u32, method: Method, order: Order) -> Result<f64, CouplingError<Infallible>> {
    let mass = Model {
        a: vec![vec![0.0, 1.0], vec![0.0, 0.0]],
        b: vec![vec![0.0], vec![1.0]],
        c: vec![vec![1.0, 0.0]],
        d: vec![vec![0.0]],
    };
    let controller: Boxed = Box::new(Controller { before: 0.0, force: 0.0 });
    let mass: Boxed = Box::new(Linear::new(mass, &[0.0, 0.0]));
    let mut members = vec![member("controller", controller, 1, 1), member("mass", mass, 1, 1)];
    members[0].every = NonZeroU32::new(every).unwrap();
    let network = Network { members, connections: vec![connect((0, 0), (1, 0)), connect((1, 0), (0, 0))] };
    let mut master = Master::new(network, &settings(method, order, 8))?;
    while master.tick().0 < u64::from(RATE) {
        master.advance()?;
    }
    Ok(master.value(servobench_coupling::Port { block: 1, port: 0 }).unwrap())
}

/// 0.3 s after the move, e^(−60·0.3) of its errors are left, some counts, and as many of the encoder's own.
#[test]
fn a_sampled_position_loop_is_let_be() {
    for every in [1, 2, 4] {
        for method in [Method::Jacobi, Method::GaussSeidel(vec![0, 1]), Method::GaussSeidel(vec![1, 0])] {
            for order in [Order::Constant, Order::Linear] {
                let x = end(every, method.clone(), order);
                assert!(
                    x.as_ref().is_ok_and(|x| (x - 0.2).abs() < 1e-5),
                    "every {every}, {method:?}, {order:?}: {x:?}"
                );
            }
        }
    }
}
