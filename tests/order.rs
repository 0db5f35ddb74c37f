//! Observed orders of convergence of every engine, against the matrix exponential.
use super::{body, build, effort, in_a_row, motion, state, viscous};
use nalgebra::{DMatrix, DVector};
use servobench_base::{Coordinate, Setpoint};
use servobench_plant::{Body, BodyState, Chain, Drive, Engine, Integrator, Link, MechanicsSetup, Model};
use servobench_tests::engines;
use std::f64::consts::TAU;

/// Length of the runs (s): not a multiple of a period of any mode here.
const END: f64 = 0.1237;

/// A base that starts anywhere and has all derivatives.
const STRONG: Setpoint = Setpoint { x: 0.2, v: -0.5, a: 30.0, j: -4e3, s: 2e5 };

/// A chain, what acts on it and where it begins.
struct Case {
    name: &'static str,
    chain: Chain,
    /// The motion of the base at t = 0, where it is prescribed.
    base: Option<Setpoint>,
    /// Length of the run (s).
    end: f64,
    /// Constant efforts on each body.
    efforts: Vec<f64>,
    initial: Vec<BodyState>,
}

impl Case {
    /// Position and velocity of each body at `t` (s): ẏ = A·y with y = (q, q̇, base derivatives, 1), by the matrix exponential.
    fn exact(&self, t: f64) -> Vec<BodyState> {
        let (bodies, links) = (self.chain.bodies(), self.chain.links());
        let n = bodies.len();
        let one = 2 * n + 3;
        let mut a = DMatrix::<f64>::zeros(one + 1, one + 1);
        for (i, body) in bodies.iter().enumerate() {
            a[(i, n + i)] = 1.0;
            a[(n + i, n + i)] -= body.friction.viscous / body.inertia;
            a[(n + i, one)] = (self.efforts[i] - body.bias) / body.inertia;
        }
        for (l, link) in links.iter().enumerate() {
            for (i, side) in [(l, -1.0), (l + 1, 1.0)] {
                for (j, end) in [(l, 1.0), (l + 1, -1.0)] {
                    let factor = side * end * bodies[i].transmission * bodies[j].transmission / bodies[i].inertia;
                    a[(n + i, j)] += factor * link.stiffness;
                    a[(n + i, n + j)] += factor * link.damping;
                }
            }
        }
        let mut y = DVector::zeros(one + 1);
        for (i, state) in self.initial.iter().enumerate() {
            y[i] = state.position;
            y[n + i] = state.velocity;
        }
        y[one] = 1.0;
        if let Some(base) = self.base {
            let r = bodies[0].transmission;
            a.row_mut(n).fill(0.0);
            a[(n, 2 * n)] = 1.0;
            a[(2 * n, 2 * n + 1)] = 1.0;
            a[(2 * n + 1, 2 * n + 2)] = 1.0;
            (y[0], y[n]) = (base.x / r, base.v / r);
            (y[2 * n], y[2 * n + 1], y[2 * n + 2]) = (base.a / r, base.j / r, base.s / r);
        }
        let end = (a * t).exp() * y;
        (0..n).map(|i| state(end[i], end[n + i])).collect()
    }

    /// Largest errors of positions and of velocities at each eighth of the run, with ticks of END/`ticks`; of 1, or of what is larger.
    fn error(&self, engine: &dyn Engine, ticks: u32) -> [f64; 2] {
        let step = self.end / f64::from(ticks);
        let drive = if self.base.is_some() { Drive::Prescribed } else { Drive::Effort };
        let (model, initial) = (Model::Chain(self.chain.clone()), self.initial.clone());
        let mut axis = build(engine, &MechanicsSetup { model, drive, step, initial });
        let mut worst = [0.0_f64; 2];
        for k in 0..ticks {
            let moved = |base: Setpoint| motion(base.after(f64::from(k) * step));
            let mut input = self.base.map_or(effort(self.efforts[0]), moved);
            input.load_disturbance = self.efforts[self.efforts.len() - 1];
            axis.advance(&input).unwrap();
            if (k + 1) % (ticks / 8) == 0 {
                for (found, exact) in axis.bodies().iter().zip(self.exact(f64::from(k + 1) * step)) {
                    let off = |found: f64, exact: f64| (found - exact).abs() / exact.abs().max(1.0);
                    worst[0] = worst[0].max(off(found.position, exact.position));
                    worst[1] = worst[1].max(off(found.velocity, exact.velocity));
                }
            }
        }
        worst
    }
}

/// Undamped; dampers of a tenth of critical and more, with a rotary motor on a screw; the published slides; each under efforts and behind
/// a base.
fn cases() -> Vec<Case> {
    let r = 10e-3 / TAU;
    let link = |stiffness, damping| Link { stiffness, damping };
    let chain = |bodies: &[Body], links: &[Link]| in_a_row(bodies.to_vec(), links.to_vec());
    let undamped = chain(&[body(20.0), body(10.0)], &[link(6e5, 0.0)]);
    let slide = |mass| Body { friction: viscous(10.0), ..body(mass) };
    let lambrechts = chain(&[slide(20.0), slide(10.0)], &[link(6e5, 500.0)]);
    let motor = Body { transmission: r, friction: viscous(1e-3), bias: 0.02, ..body(6e-4) };
    let table = Body { friction: viscous(900.0), ..body(40.0) };
    let load = Body { bias: 3.0, ..body(25.0) };
    let damped = chain(&[motor, table, load], &[link(4e7, 1.2e4), link(2e6, 3e3)]);
    let rotor = Body { coordinate: Coordinate::Rotary, ..body(5e-3) };
    let load = Body { friction: viscous(0.02), ..rotor.clone() };
    let swaying = chain(&[rotor, load], &[link(700.0, 0.3)]);
    let base = Some(Setpoint { x: 0.0, v: 0.05, a: 3.0, j: -40.0, s: 700.0 });
    let case = |name, chain: &Chain, base, efforts: &[f64], initial: &[BodyState]| Case {
        name,
        chain: chain.clone(),
        base,
        end: END,
        efforts: efforts.to_vec(),
        initial: initial.to_vec(),
    };
    let begun = [state(0.0, 0.1), state(1e-3, -0.2)];
    vec![
        case("undamped", &undamped, None, &[80.0, -30.0], &begun),
        case("lambrechts", &lambrechts, None, &[80.0, -30.0], &begun),
        case("damped", &damped, None, &[1.0, 0.0, -20.0], &[state(0.0, 30.0), state(1e-4, 0.0), state(0.0, 0.02)]),
        Case {
            end: 0.02,
            ..case("damped load on a base", &swaying, Some(STRONG), &[0.0, 0.0], &[state(0.2, -0.5); 2])
        },
        case("undamped base", &undamped, base, &[0.0, -30.0], &[state(0.0, 0.05), state(1e-4, 0.05)]),
        case(
            "damped base",
            &damped,
            base,
            &[0.0, 0.0, -30.0],
            &[state(0.0, 0.05 / r), state(1e-4, 0.05), state(0.0, 0.05)],
        ),
    ]
}

/// Of `exact` only rounding is left. MuJoCo's order is the fourth, but between it and the second for dampers behind a base.
#[test]
fn errors_fall_with_the_order_of_the_integrator() {
    for (engine, case) in engines().into_iter().flat_map(|engine| cases().into_iter().map(move |case| (engine, case))) {
        // Two halvings of the tick, to 64 kHz or to 16 kHz.
        let (ticks, orders) = match engine.name().capabilities().integrator.unwrap() {
            Integrator::Exact => (1_976, None),
            // The next term of the error is (ω·h)² ≤ 1e-2 of the first.
            Integrator::Leapfrog => (1_976, Some(1.98..2.02)),
            // Of second order, and from 4 kHz on little of the fourth.
            Integrator::Rk4 if case.name == "damped load on a base" => (80, Some(1.9..2.3)),
            // Errors of both orders, which may differ in sign.
            Integrator::Rk4 if case.name == "damped base" => (512, Some(1.7..4.3)),
            // The next term is ω·h ≤ 0.26 of the first.
            Integrator::Rk4 => (512, Some(3.7..4.3)),
        };
        let errors = [1, 2, 4].map(|finer| case.error(engine, ticks * finer));
        let context = format!("{}, {}: {errors:?}", engine.name(), case.name);
        println!("{context}");
        let Some(orders) = orders else {
            assert!(errors.as_flattened().iter().all(|error| *error < 1e-11), "{context}");
            continue;
        };
        for (pair, i) in errors.windows(2).flat_map(|pair| [(pair, 0), (pair, 1)]) {
            let order = (pair[0][i] / pair[1][i]).log2();
            assert!(orders.contains(&order), "order {order} of {}, {context}", ["positions", "velocities"][i]);
        }
        // 64 kHz: (ω·h)²/24 ≤ 1e-5 per radian of a mode; 16 kHz: (ω·h)⁴/120 ≤ 2e-7, of stretches of up to a millimetre.
        let most = match case.name {
            // ζ·(ω·h)²/6 = 7e-6 of a stretch of 0.2 mm at 16 kHz.
            "damped load on a base" => 2e-9,
            _ if orders.end < 3.0 => 1e-6,
            _ => 1e-9,
        };
        assert!(errors[2][0] < most, "{context}");
    }
}
