//! Moves to a target, from any state of motion of the set-point.
use servobench_base::{Rate, Setpoint, Stateful};
use servobench_motion::online::{DirectionalLimits, Effort, Target};
use servobench_motion::{Limits, Order, PlanError};
use servobench_planner::{Generator, Plan, Replanning, Request};

/// Generator of set-points for the command `target`: a rising edge of `execute` starts a jerk-limited move to `target`, also
/// while another is active. A new override replans the rest of the move, with the velocity limit scaled by it; at 0 the axis
/// stops until the override rises.
#[derive(Debug, Stateful)]
pub(crate) struct Mover {
    #[state(constant)]
    limits: [f64; 3],
    /// Current set-point.
    now: Setpoint,
    /// Target of the last move.
    goal: Option<f64>,
    under_way: Option<Move>,
    executed: bool,
    factor: f64,
}

/// An active move: its start, the tick of the start, and the plan from there.
#[derive(Debug)]
struct Move {
    start: Start,
    begun: u64,
    plan: Plan,
}

/// Start and goal of a move.
#[derive(Debug, Clone, Copy, Stateful)]
struct Start {
    from: Setpoint,
    goal: f64,
    factor: f64,
    limits: [f64; 3],
}

servobench_base::saved_as!(Move: (Start, u64), |one: &Move| (one.start, one.begun), |(start, begun)| Self::new(start, begun).ok());

impl Move {
    /// # Errors
    /// [`PlanError`] of a move that the planner cannot plan.
    fn new(start: Start, begun: u64) -> Result<Self, PlanError> {
        Ok(Self { plan: start.plan()?, start, begun })
    }
}

impl Start {
    /// The plan from here to the goal, or to rest.
    fn plan(&self) -> Result<Plan, PlanError> {
        let Self { from, goal, factor, limits: [velocity, acceleration, jerk] } = *self;
        let is_stop = factor == 0.0;
        let velocity = if is_stop { velocity } else { factor * velocity };
        let x = goal - from.x;
        let generator = Generator::Replanning(Replanning {
            from: Setpoint { x: 0.0, s: 0.0, ..from },
            target: if is_stop { Target::Velocity(0.0) } else { Target::Position { x, v: 0.0 } },
            order: Order::Third,
            limits: DirectionalLimits::from(Limits { velocity, acceleration, jerk, snap: f64::INFINITY }),
            effort: Effort::Fast,
        });
        Request::new(generator).plan()
    }
}

impl Mover {
    /// A mover at rest at `start`, with limits of velocity, acceleration and jerk (axis coordinate).
    pub(crate) fn new(start: f64, limits: [f64; 3]) -> Self {
        Self { limits, now: Setpoint::at_rest(start), goal: None, under_way: None, executed: false, factor: 1.0 }
    }

    /// The set-point at tick `k`, with the override `factor`.
    ///
    /// # Errors
    /// [`PlanError`] of a move that the planner cannot plan.
    pub(crate) fn at(
        &mut self,
        k: u64,
        rate: Rate,
        execute: bool,
        target: f64,
        factor: f64,
    ) -> Result<Setpoint, PlanError> {
        if let Some(Move { start, begun, plan }) = &self.under_way {
            self.now = plan.at((k - begun) as f64 / f64::from(rate.hertz()));
            self.now.x += start.from.x;
        }
        let is_new = execute && !self.executed;
        if is_new {
            self.goal = Some(target);
        }
        if let Some(goal) = self.goal
            && (is_new || factor.to_bits() != self.factor.to_bits())
        {
            self.under_way = Some(Move::new(Start { from: self.now, goal, factor, limits: self.limits }, k)?);
        }
        (self.executed, self.factor) = (execute, factor);
        Ok(self.now)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: u32 = 1_000;

    /// Set-points of ticks 0 to `ticks`, with the targets from `target`, executed while it returns one.
    fn positions(ticks: u64, target: impl Fn(u64) -> Option<f64>) -> Vec<Setpoint> {
        slowed(ticks, target, |_| 1.0)
    }

    /// Set-points with an override.
    fn slowed(ticks: u64, target: impl Fn(u64) -> Option<f64>, factor: impl Fn(u64) -> f64) -> Vec<Setpoint> {
        let mut mover = Mover::new(0.1, [1.0, 10.0, 200.0]);
        let rate = Rate::new(RATE).unwrap();
        let at = |k| mover.at(k, rate, target(k).is_some(), target(k).unwrap_or(f64::NAN), factor(k)).unwrap();
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

    /// Oracle: the limits themselves; position, velocity and acceleration are continuous where a move takes over from another.
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
    /// Oracle: the velocity limit times the override, at rest for 0; everything is continuous, and the target is reached all the same.
    #[test]
    fn an_override_changes_the_velocity_on_the_way() {
        let factor = |k| match k {
            300..600 => 0.5,
            600..1_000 => 0.0,
            1_000..1_200 => 1.5,
            _ => 1.0,
        };
        let all = slowed(3_000, |_| Some(1.2), factor);
        // 1 m/s less 0.5 m/s takes 0.1 s: 0.5/10 + 10/200 s.
        for (tick, velocity) in [(299, 1.0), (401, 0.5), (599, 0.5), (800, 0.0), (999, 0.0)] {
            assert!((all[tick].v - velocity).abs() < 1e-9, "tick {tick}: {:?}", all[tick]);
        }
        for pair in all.windows(2) {
            let [one, two] = pair else { unreachable!() };
            assert!((two.a - one.a).abs() <= 0.2 + 1e-9 && two.v.abs() <= 1.5 + 1e-9, "{pair:?}");
        }
        assert!((all[2_999].x - 1.2).abs() < 1e-12 && all[2_999].v.abs() < 1e-9, "{:?}", all[2_999]);
    }
}
