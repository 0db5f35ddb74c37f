//! Requests as one line each: `ORDER P|V  x v a j  X V  v_below v_above  a_below a_above  J D`, in SI.
//!
//! `P` is a position X passed at V, `V` a velocity V wherever it is reached.
use servobench_base::Setpoint;
use servobench_motion::Order;
use servobench_motion::online::{DirectionalLimits, Effort, Sides, Target, Transition};

/// Request of one line.
#[derive(Debug)]
pub(crate) struct Request {
    pub(crate) order: Order,
    pub(crate) from: Setpoint,
    pub(crate) target: Target,
    pub(crate) limits: DirectionalLimits,
}

impl Request {
    pub(crate) fn parse(line: &str) -> Self {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [order, kind, numbers @ ..] = words.as_slice() else { panic!("`{line}` is no request") };
        let numbers: Vec<f64> = numbers.iter().map(|word| word.parse().unwrap()).collect();
        let &[x, v, a, j, to_x, to_v, v_below, v_above, a_below, a_above, jerk, snap] = numbers.as_slice() else {
            panic!("`{line}` has no 12 numbers")
        };
        Self {
            order: Order::from_derivative(order.parse().unwrap()).unwrap(),
            from: Setpoint { x, v, a, j, s: 0.0 },
            target: if *kind == "V" { Target::Velocity(to_v) } else { Target::Position { x: to_x, v: to_v } },
            limits: DirectionalLimits {
                velocity: Sides { below: v_below, above: v_above },
                acceleration: Sides { below: a_below, above: a_above },
                jerk,
                snap,
            },
        }
    }

    pub(crate) fn plan(&self, effort: Effort) -> Transition {
        Transition::plan(self.order, &self.from, &self.target, &self.limits, effort).unwrap()
    }
}

/// Difference between the end of the last polynomial and the target: position, velocity, acceleration, jerk.
pub(crate) fn jump(planned: &Transition) -> [f64; 4] {
    // At the end of its own length: before a day is over two instants are 1.5e-11 s apart.
    let before = planned.piece(planned.duration().next_down()).at(f64::MAX);
    let end = planned.at(planned.duration());
    [before.x - end.x, before.v - end.v, before.a - end.a, before.j - end.j].map(f64::abs)
}
