//! Moves to a target, from whatever state of motion the set-point is in.
use servobench_base::{Rate, Setpoint};
use servobench_motion::online::{DirectionalLimits, Effort, Target};
use servobench_motion::{Limits, Order};
use servobench_planner::{Plan, Replanning, Request, Way};

/// Generator of set-points for the command `target`: a rising edge of `execute` makes a move to `target`, jerk-limited, also
/// while another is under way.
#[derive(Debug, Clone)]
pub(crate) struct Mover {
    limits: DirectionalLimits,
    /// What is followed at present.
    now: Setpoint,
    /// The move under way: its plan, the tick at which it began and where.
    under_way: Option<(Plan, u64, f64)>,
    executed: bool,
}

impl Mover {
    /// At rest at `start`, with limits of velocity, acceleration and jerk (axis coordinate).
    pub(crate) fn new(start: f64, [velocity, acceleration, jerk]: [f64; 3]) -> Self {
        let limits = DirectionalLimits::from(Limits { velocity, acceleration, jerk, snap: f64::INFINITY });
        Self { limits, now: Setpoint::at_rest(start), under_way: None, executed: false }
    }

    /// The set-point at tick `k`.
    ///
    /// # Errors
    /// What the planner says of a move that it cannot plan.
    pub(crate) fn at(&mut self, k: u64, rate: Rate, execute: bool, target: f64) -> Result<Setpoint, String> {
        if let Some((plan, begun, from)) = &self.under_way {
            self.now = plan.at((k - begun) as f64 / f64::from(rate.hertz()));
            self.now.x += from;
        }
        if execute && !self.executed {
            let from = self.now.x;
            let way = Way::Replanning(Replanning {
                from: Setpoint { x: 0.0, s: 0.0, ..self.now },
                target: Target::Position { x: target - from, v: 0.0 },
                order: Order::Third,
                limits: self.limits,
                effort: Effort::Fast,
            });
            let plan = Request::new(way).plan().map_err(|error| error.to_string())?;
            self.under_way = Some((plan, k, from));
        }
        self.executed = execute;
        Ok(self.now)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: u32 = 1_000;

    /// Set-points of ticks 0 to `ticks`, with the target that `target` says, executed while it says so.
    fn positions(ticks: u64, target: impl Fn(u64) -> Option<f64>) -> Vec<Setpoint> {
        let mut mover = Mover::new(0.1, [1.0, 10.0, 200.0]);
        let rate = Rate::new(RATE).unwrap();
        let at = |k| mover.at(k, rate, target(k).is_some(), target(k).unwrap_or(f64::NAN)).unwrap();
        (0..ticks).map(at).collect()
    }

    /// Oracle: closed form. 0.5 m at 1 m/s, 10 m/s², 200 m/s³ takes 0.5/1 + 1/10 + 10/200 s = 0.65 s.
    #[test]
    fn a_move_begins_with_the_rising_edge_and_takes_as_long_as_the_limits_say() {
        let all = positions(800, |k| (k >= 100).then_some(0.6));
        assert!(all[..=100].iter().all(|now| *now == Setpoint::at_rest(0.1)), "nothing before");
        assert!((all[750].x - 0.6).abs() < 1e-12 && all[750].v.abs() < 1e-9, "{:?}", all[750]);
        assert!(all[740].x < 0.6 - 1e-6, "not before: {:?}", all[740]);
        assert!((all[425].v - 1.0).abs() < 1e-12, "the middle of the move: {:?}", all[425]);
    }

    /// Oracle: the limits themselves; position, velocity and acceleration go on where a move takes over from another.
    #[test]
    fn another_target_takes_over_without_a_jump() {
        let all = positions(2_000, |k| match k {
            0..300 => Some(0.6),
            300 => None,
            _ => Some(-0.2),
        });
        for pair in all.windows(2) {
            let [one, two] = pair else { unreachable!() };
            // Within a tick of 1 ms at 200 m/s³, and a rounding.
            assert!((two.a - one.a).abs() <= 0.2 + 1e-9, "{pair:?}");
            assert!(two.v.abs() <= 1.0 + 1e-9 && two.a.abs() <= 10.0 + 1e-9, "{two:?}");
        }
        assert!((all[1_999].x + 0.2).abs() < 1e-12 && all[1_999].v.abs() < 1e-9);
    }
}
