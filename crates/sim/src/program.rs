//! The program of moves as a set-point over time.
use crate::error::{BuildError, check_length};
use servobench_base::Setpoint;
use servobench_motion::{Limits, Order, PlanError};
use servobench_planner::{Grid, Method, Plan, PointToPoint, Reader, Request, Way};
use servobench_scenario::{MoveStep, Step, Target};
use servobench_trace::Move;

/// A planned move and when it starts.
#[derive(Debug, Clone)]
struct Planned {
    start: f64,
    from: f64,
    plan: Plan,
}

/// Moves and pauses, one after the other.
#[derive(Debug, Clone)]
pub struct Program {
    moves: Vec<Planned>,
    end: f64,
    now: Now,
}

/// What the last query found; the next one is most likely the same.
#[derive(Debug, Clone)]
struct Now {
    /// Index of the move, its start (s) and where it starts from; the move is over when the next one starts (s).
    index: usize,
    start: f64,
    from: f64,
    next_start: f64,
    reader: Reader,
}

impl Program {
    /// Plans every move.
    ///
    /// # Errors
    /// [`BuildError::Plan`] and [`BuildError::TooLong`] name the step.
    pub fn plan(steps: &[Step]) -> Result<Self, BuildError> {
        let (mut moves, mut end, mut position) = (Vec::new(), 0.0, 0.0);
        for (index, step) in steps.iter().enumerate() {
            match step {
                Step::Wait(length) => end += length,
                Step::Move(step) => {
                    let plan = plan_move(step, position).map_err(|error| BuildError::Plan { index, error })?;
                    let (from, start) = (position, end);
                    position += plan.end().x;
                    end += plan.duration();
                    moves.push(Planned { start, from, plan });
                }
            }
            check_length(Some(index), end)?;
        }
        let next_start = if moves.is_empty() { f64::INFINITY } else { f64::NEG_INFINITY };
        let now = Now { index: 0, start: 0.0, from: 0.0, next_start, reader: Reader::default() };
        Ok(Self { moves, end, now })
    }

    /// End of the last step (s).
    #[must_use]
    pub const fn end(&self) -> f64 {
        self.end
    }

    /// Set-point at `t` (s). Queries must not go back in time.
    #[inline]
    pub fn at(&mut self, t: f64) -> Setpoint {
        if t >= self.now.next_start || !self.now.reader.holds(t - self.now.start) {
            self.look_up(t);
        }
        let mut setpoint = self.now.reader.at(t - self.now.start);
        setpoint.x += self.now.from;
        setpoint
    }

    /// Finds what holds at `t` (s).
    #[cold]
    fn look_up(&mut self, t: f64) {
        let later = self.now.index + 1..self.moves.len();
        let index = later.take_while(|index| self.moves[*index].start <= t).last().unwrap_or(self.now.index);
        let Some(Planned { start, from, plan }) = self.moves.get(index) else { return };
        let now = &mut self.now;
        now.reader.look_up(plan, t - start);
        (now.index, now.start, now.from) = (index, *start, *from);
        now.next_start = self.moves.get(index + 1).map_or(f64::INFINITY, |next| next.start);
    }

    /// How long each move lasts (s).
    pub fn durations(&self) -> impl Iterator<Item = f64> {
        self.moves.iter().map(|planned| planned.plan.duration())
    }

    /// What a recording says of the moves; `unit` is the axis unit.
    pub fn moves(&self, unit: &str) -> impl Iterator<Item = Move> {
        self.moves.iter().map(move |planned| planned.describe(unit))
    }
}

impl Planned {
    fn describe(&self, unit: &str) -> Move {
        let (plan, order) = (&self.plan, self.plan.order());
        let (from, to) = (self.from, self.from + plan.end().x);
        let (cruise_start, cruise) = plan.cruise();
        let limits =
            plan.limits().map(|sides| sides.below.max(sides.above)).map(|limit| limit.is_finite().then_some(limit));
        Move {
            label: format!("move from {} {unit} to {} {unit}, order {order}", six_digits(from), six_digits(to)),
            start: self.start,
            end: self.start + plan.duration(),
            from,
            to,
            peaks: plan.largest(),
            limits,
            cruise: (self.start + cruise_start, cruise),
        }
    }
}

/// A position (m or rad) to six significant digits and a picounit: a sum of targets shows its rounding otherwise.
fn six_digits(position: f64) -> f64 {
    let position = libm::round(position * 1e12) / 1e12;
    // Adding zero takes the sign from a zero.
    format!("{position:.5e}").parse::<f64>().unwrap_or(position) + 0.0
}

/// Plans `step` from `position`.
fn plan_move(step: &MoveStep, position: f64) -> Result<Plan, PlanError> {
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
    let (method, grid) = (Method::Published, step.sample_time.map(Grid::new));
    let way = Way::PointToPoint(PointToPoint { distance, order, limits, method, grid });
    Request { duration: step.duration, ..Request::new(way) }.plan()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one_metre() -> MoveStep {
        let (target, limits) = (Target::Relative(1.0), [1.0, 5.0, 50.0, 1000.0]);
        MoveStep { target, order: 4, limits, sample_time: None, duration: None, metric_limits: Vec::new() }
    }

    fn to(target: Target) -> Step {
        Step::Move(MoveStep { target, ..one_metre() })
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
        assert!(program.durations().all(|duration| (duration - 1.35).abs() < 1e-12));
        assert_eq!(program.durations().count(), 2);
    }

    #[test]
    fn a_label_shows_no_rounding() {
        let quarter = core::f64::consts::FRAC_PI_2;
        let steps = [0.1, 0.2, -0.3, quarter].map(|distance| to(Target::Relative(distance)));
        let labels: Vec<_> = Program::plan(&steps).unwrap().moves("m").map(|made| made.label).collect();
        let ends = [("0", "0.1"), ("0.1", "0.3"), ("0.3", "0"), ("0", "1.5708")];
        assert_eq!(labels, ends.map(|(from, to)| format!("move from {from} m to {to} m, order 4")));
    }

    /// Oracle: each move's own set-point, looked up at every instant. Moves without a pause between them, one of no
    /// distance, and queries that skip whole moves.
    #[test]
    fn what_is_kept_from_query_to_query_is_what_a_look_up_finds() {
        let to = |target| to(Target::Absolute(target));
        let steps = [to(0.3), to(0.3), to(-0.2), Step::Wait(0.05), to(1.0)];
        for skip in [1, 7, 5_000, 12_000] {
            let mut program = Program::plan(&steps).unwrap();
            for k in (0..60_000_u32).step_by(skip) {
                let t = f64::from(k) / 16e3;
                let made = program.moves.iter().take_while(|planned| planned.start <= t).last().unwrap();
                let mut expected = made.plan.at(t - made.start);
                expected.x += made.from;
                let bits = |Setpoint { x, v, a, j, s }| [x, v, a, j, s].map(f64::to_bits);
                assert_eq!(bits(program.at(t)), bits(expected), "every {skip} ticks, {t} s");
            }
        }
    }

    #[test]
    fn without_a_move_the_axis_is_to_stay() {
        let mut program = Program::plan(&[Step::Wait(0.5)]).unwrap();
        assert!([0.0, 0.1, 7.0].iter().all(|t| program.at(*t) == Setpoint::at_rest(0.0)));
        assert!((program.end() - 0.5).abs() < 1e-15);
    }

    /// The moves have no length in the scenario file: what they add up to is known here only.
    #[test]
    fn a_program_that_never_ends_is_refused_at_its_step() {
        let slow = MoveStep { limits: [1e-9, 5.0, 50.0, 1000.0], ..one_metre() };
        for (steps, end) in [
            (vec![to(Target::Absolute(1.0)), Step::Move(slow)], "1000000001"),
            (vec![Step::Wait(0.5), Step::Wait(1e16)], "1000000000000000"),
            (vec![Step::Wait(0.5), Step::Wait(f64::INFINITY)], "inf"),
            (vec![Step::Wait(0.5), Step::Wait(f64::NAN)], "NaN"),
        ] {
            let message = Program::plan(&steps).unwrap_err().to_string();
            assert!(message.starts_with(&format!("program step 2 would end at {end}")), "{message}");
            assert!(message.contains("a run lasts 1000000 s at most"), "{message}");
        }
    }
}
