//! Observed order of convergence against the matrix exponential.
use super::{body, build, effort, lambrechts, motion, state, viscous};
use nalgebra::{DMatrix, DVector};
use servobench_base::Setpoint;
use servobench_plant::{Body, BodyState, Chain, Drive, Link};

/// Length of the runs (s): no multiple of a period of any mode here.
const END: f64 = 0.1237;

/// Position and velocity of each body after `END` under constant `efforts`, or behind a base with this motion at t = 0.
///
/// ẏ = A·y with y = (q, q̇, base derivatives, 1), by the matrix exponential.
fn exact(chain: &Chain, base: Option<Setpoint>, efforts: &[f64], initial: &[BodyState]) -> Vec<BodyState> {
    let n = chain.bodies().len();
    let one = 2 * n + 3;
    let mut a = DMatrix::<f64>::zeros(one + 1, one + 1);
    for (i, body) in chain.bodies().iter().enumerate() {
        a[(i, n + i)] = 1.0;
        a[(n + i, n + i)] -= body.friction.viscous / body.inertia;
        a[(n + i, one)] = (efforts[i] - body.bias) / body.inertia;
    }
    for (l, link) in chain.links().iter().enumerate() {
        for (i, side) in [(l, -1.0), (l + 1, 1.0)] {
            let body = &chain.bodies()[i];
            for (j, end) in [(l, 1.0), (l + 1, -1.0)] {
                let factor = side * end * body.transmission * chain.bodies()[j].transmission / body.inertia;
                a[(n + i, j)] += factor * link.stiffness;
                a[(n + i, n + j)] += factor * link.damping;
            }
        }
    }
    let mut y = DVector::zeros(one + 1);
    for (i, state) in initial.iter().enumerate() {
        y[i] = state.position;
        y[n + i] = state.velocity;
    }
    y[one] = 1.0;
    if let Some(base) = base {
        let r = chain.bodies()[0].transmission;
        a.row_mut(n).fill(0.0);
        a[(n, 2 * n)] = 1.0;
        a[(2 * n, 2 * n + 1)] = 1.0;
        a[(2 * n + 1, 2 * n + 2)] = 1.0;
        (y[0], y[n]) = (base.x / r, base.v / r);
        (y[2 * n], y[2 * n + 1], y[2 * n + 2]) = (base.a / r, base.j / r, base.s / r);
    }
    let end = (a * END).exp() * y;
    (0..n).map(|i| state(end[i], end[n + i])).collect()
}

/// Largest error of each position, then of each velocity, at `END` with a tick of END/`ticks`.
fn error(chain: &Chain, base: Option<Setpoint>, efforts: &[f64], initial: &[BodyState], ticks: u32) -> [f64; 2] {
    let step = END / f64::from(ticks);
    let drive = if base.is_some() { Drive::Prescribed } else { Drive::Effort };
    let mut axis = build(chain, drive, step, initial.to_vec());
    for k in 0..ticks {
        let mut input = base.map_or(effort(efforts[0]), |base| motion(base.after(f64::from(k) * step)));
        input.load_disturbance = efforts[efforts.len() - 1];
        axis.advance(&input).unwrap();
    }
    let mut worst = [0.0_f64; 2];
    for (found, exact) in axis.bodies().iter().zip(exact(chain, base, efforts, initial)) {
        worst[0] = worst[0].max((found.position - exact.position).abs());
        worst[1] = worst[1].max((found.velocity - exact.velocity).abs());
    }
    worst
}

fn assert_second_order(what: &str, chain: &Chain, base: Option<Setpoint>, efforts: &[f64], initial: &[BodyState]) {
    let [coarse, fine, finer] = [1_979, 3_958, 7_916].map(|ticks| error(chain, base, efforts, initial, ticks));
    for (quantity, i) in [("position", 0), ("velocity", 1)] {
        for (more, less) in [(coarse[i], fine[i]), (fine[i], finer[i])] {
            let order = (more / less).log2();
            // The next term of the error is (ω·h)² ≤ 1e-2 of the first.
            assert!((order - 2.0).abs() < 0.02, "{what}: {quantity} of order {order}: {more:e} then {less:e}");
        }
    }
}

fn undamped() -> Chain {
    Chain::new(vec![body(20.0), body(10.0)], vec![Link { stiffness: 6e5, damping: 0.0 }]).unwrap()
}

/// A rotary motor on a screw, a table, a load; dampers of a tenth of critical and more.
fn damped() -> Chain {
    let r = 10e-3 / (2.0 * std::f64::consts::PI);
    let motor = Body { transmission: r, friction: viscous(1e-3), bias: 0.02, ..body(6e-4) };
    let table = Body { friction: viscous(900.0), ..body(40.0) };
    let load = Body { bias: 3.0, ..body(25.0) };
    let link = |stiffness, damping| Link { stiffness, damping };
    Chain::new(vec![motor, table, load], vec![link(4e7, 1.2e4), link(2e6, 3e3)]).unwrap()
}

#[test]
fn constant_efforts_undamped() {
    let initial = [state(0.0, 0.1), state(1e-3, -0.2)];
    assert_second_order("undamped", &undamped(), None, &[80.0, -30.0], &initial);
}

#[test]
fn constant_efforts_damped() {
    let initial = [state(0.0, 30.0), state(1e-4, 0.0), state(0.0, 0.02)];
    assert_second_order("damped", &damped(), None, &[1.0, 0.0, -20.0], &initial);
    assert_second_order("lambrechts", &lambrechts(), None, &[80.0, -30.0], &[state(0.0, 0.1), state(1e-3, -0.2)]);
}

#[test]
fn a_prescribed_base() {
    let base = Setpoint { x: 0.0, v: 0.05, a: 3.0, j: -40.0, s: 700.0 };
    let r = 10e-3 / (2.0 * std::f64::consts::PI);
    let initial = [state(0.0, 0.05), state(1e-4, 0.05)];
    assert_second_order("undamped base", &undamped(), Some(base), &[0.0, -30.0], &initial);
    let initial = [state(0.0, 0.05 / r), state(1e-4, 0.05), state(0.0, 0.05)];
    assert_second_order("damped base", &damped(), Some(base), &[0.0, 0.0, -30.0], &initial);
}
