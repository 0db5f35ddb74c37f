//! The program of moves as a set-point over time.
use crate::error::BuildError;
use servobench_base::Setpoint;
use servobench_motion::{Limits, Order, Profile};
use servobench_scenario::{MoveStep, Step, Target};
use servobench_trace::Move;

/// A planned move and when it starts.
#[derive(Debug, Clone)]
struct Planned {
    start: f64,
    from: f64,
    profile: Profile,
    limits: [f64; 4],
}

/// Moves and pauses, one after the other.
#[derive(Debug, Clone, Default)]
pub struct Program {
    moves: Vec<Planned>,
    /// Index of the move that the last query was in or after.
    current: usize,
    end: f64,
}

impl Program {
    /// Plans every move.
    ///
    /// # Errors
    /// [`BuildError::Plan`] names the step.
    pub fn plan(steps: &[Step]) -> Result<Self, BuildError> {
        let mut program = Self::default();
        let mut position = 0.0;
        for (index, step) in steps.iter().enumerate() {
            match step {
                Step::Wait(length) => program.end += length,
                Step::Move(step) => {
                    let profile = plan_move(step, position).map_err(|error| BuildError::Plan { index, error })?;
                    let limits = step.limits;
                    program.moves.push(Planned { start: program.end, from: position, profile, limits });
                    position += profile.distance();
                    program.end += profile.duration();
                }
            }
        }
        Ok(program)
    }

    /// End of the last step (s).
    #[must_use]
    pub const fn end(&self) -> f64 {
        self.end
    }

    /// Set-point at `t` (s). Queries must not go back in time.
    pub fn at(&mut self, t: f64) -> Setpoint {
        while let Some(next) = self.moves.get(self.current + 1)
            && t >= next.start
        {
            self.current += 1;
        }
        let Some(planned) = self.moves.get(self.current) else { return Setpoint::default() };
        let mut setpoint = planned.profile.at(t - planned.start);
        setpoint.x += planned.from;
        setpoint
    }

    /// What a recording says of the moves; `unit` is the axis unit.
    pub fn moves(&self, unit: &str) -> impl Iterator<Item = Move> {
        self.moves.iter().map(move |planned| planned.describe(unit))
    }
}

impl Planned {
    fn describe(&self, unit: &str) -> Move {
        let (profile, order) = (&self.profile, self.profile.order().derivative());
        let (from, to) = (self.from, self.from + profile.distance());
        let peaks = profile.peaks();
        let cruise = profile.times().t_v;
        let mut limits = [None; 4];
        for (slot, limit) in limits.iter_mut().zip(self.limits).take(order) {
            *slot = limit.is_finite().then_some(limit);
        }
        Move {
            label: format!("move from {from} {unit} to {to} {unit}, order {order}"),
            start: self.start,
            end: self.start + profile.duration(),
            from,
            to,
            peaks: [peaks.velocity, peaks.acceleration, peaks.jerk, peaks.snap],
            limits,
            cruise: (self.start + (profile.duration() - cruise) / 2.0, cruise),
        }
    }
}

/// Plans `step` from `position`.
fn plan_move(step: &MoveStep, position: f64) -> Result<Profile, servobench_motion::PlanError> {
    let order = match step.order {
        2 => Order::Second,
        3 => Order::Third,
        _ => Order::Fourth,
    };
    let [velocity, acceleration, jerk, snap] = step.limits;
    let limits = Limits { velocity, acceleration, jerk, snap };
    let distance = match step.target {
        Target::Absolute(target) => target - position,
        Target::Relative(distance) => distance,
    };
    let profile = match step.sample_time {
        Some(sample_time) => Profile::plan_sampled(order, distance, &limits, sample_time),
        None => Profile::plan(order, distance, &limits),
    }?;
    step.duration.map_or(Ok(profile), |duration| profile.stretched_to(duration))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn to(target: Target) -> Step {
        let limits = [1.0, 5.0, 50.0, 1000.0];
        Step::Move(MoveStep { target, order: 4, limits, sample_time: None, duration: None })
    }

    #[test]
    fn moves_follow_each_other_and_pauses_hold_the_target() {
        let steps = [Step::Wait(0.1), to(Target::Absolute(1.0)), Step::Wait(0.5), to(Target::Relative(-1.0))];
        let mut program = Program::plan(&steps).unwrap();
        // Lambrechts' move lasts 1.35 s each way.
        assert!((program.end() - (0.1 + 1.35 + 0.5 + 1.35)).abs() < 1e-12);
        assert_eq!(program.at(0.05), Setpoint::at_rest(0.0));
        assert!((program.at(0.1 + 0.675).x - 0.5).abs() < 1e-12);
        assert_eq!(program.at(1.6), Setpoint::at_rest(1.0));
        assert!((program.at(1.95 + 0.675).x - 0.5).abs() < 1e-12);
        assert_eq!(program.at(9.0), Setpoint::at_rest(0.0));
        let cruise = program.moves("m").next().unwrap().cruise;
        assert!((cruise.0 - 0.45).abs() < 1e-12 && (cruise.1 - 0.65).abs() < 1e-12, "{cruise:?}");
    }
}
