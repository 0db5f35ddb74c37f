//! The program of moves as a set-point over time.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
mod described;
mod fine;

use crate::error::{BuildError, check_length};
use described::kind;
use fine::Fine;
use servobench_base::{RequestKind, Setpoint, Stateful};
use servobench_cia402::interpolated::SubMode;
use servobench_cia402::units::Object;
use servobench_metrics::DisplayUnit;
use servobench_motion::PlanError;
use servobench_planner::{
    CommandCycle, Generator, Plan, PlanDetails, PointMove, PointTimes, Positioning, Reader, Request,
};
use servobench_scenario::{Bus, BusMode, MoveStep, Scenario, Step};
use servobench_trace::Move;

/// Fraction of its largest velocity that counts as rounding at the end of a move.
const ROUNDING: f64 = 1e-9;

/// A planned move with its start and end: later than its plan if a velocity is held, earlier if it is aborted.
#[derive(Debug, Clone)]
struct Planned {
    start: f64,
    end: f64,
    from: f64,
    plan: Plan,
    /// Its request, if its target is a position of the axis and it can be replanned on the way.
    request: Option<Request>,
    /// Deviation of the path through its points from the move (m or rad), if it is sent as points.
    deviation: Option<f64>,
    /// True if the next move takes over from it.
    is_aborted: bool,
    /// True if its plan ends at rest.
    ends_at_rest: bool,
    /// Its kind, in a word or two.
    kind: &'static str,
}

/// Moves and pauses, one after the other, as received by the drive.
#[derive(Debug, Clone, Stateful)]
pub struct Program {
    course: Course,
    #[state(constant)]
    end: f64,
    /// Interpolation between the task and the drive.
    #[state(fixed)]
    fine: Option<Fine>,
    /// The moves as requested by the task, if the set-point is interpolated and thus delayed; otherwise the set-point is the request.
    #[state(fixed)]
    requested: Option<Course>,
    /// Unit in which its positions are shown.
    #[state(constant)]
    unit: DisplayUnit,
}

/// Moves one after the other.
#[derive(Debug, Clone, Stateful)]
struct Course {
    #[state(constant)]
    moves: Vec<Planned>,
    now: Now,
}

/// Result of the last query; the next one is most likely the same.
#[derive(Debug, Clone, Stateful)]
struct Now {
    /// Index of the move, its start (s) and start position; the move is over when the next one starts (s).
    index: usize,
    start: f64,
    from: f64,
    next_start: f64,
    /// End of its plan (s), and the request from then on.
    plan_end: f64,
    then: RequestKind,
    reader: Reader,
}

impl Program {
    /// Plans every move of `scenario`.
    ///
    /// # Errors
    /// [`BuildError::Plan`], [`BuildError::NothingToAbort`] and [`BuildError::TooLong`] name the step.
    pub fn new(scenario: &Scenario) -> Result<Self, BuildError> {
        let tick = scenario.base_rate.period();
        // In profile velocity the drive follows commands that the motion task sends, once per cycle and in whole units.
        let by_velocity = scenario.bus.as_ref().filter(|bus| bus.mode == BusMode::ProfileVelocity);
        let cycle = by_velocity.map(|bus| CommandCycle {
            period: f64::from(bus.cycle.saturating_mul(bus.motion_every)) * tick,
            first: 0.0,
            unit: bus.units.axis.abs() / f64::from(bus.units.drive),
        });
        let mut program = Self::plan(&scenario.program, cycle, scenario.bus.as_ref().and_then(point_times))?;
        program.unit = scenario.units.plain(0);
        if let Some(interpolation) = &scenario.interpolation {
            let fine = Fine::new(interpolation, scenario.base_rate)?;
            program.end += fine.delay();
            program.fine = Some(fine);
            program.requested = Some(program.course.clone());
            check_length(None, program.end)?;
        }
        Ok(program)
    }

    /// A program without moves.
    pub(crate) fn standing() -> Self {
        Self::of(Vec::new(), 0.0)
    }

    /// A program of `moves`, which ends at `end` (s).
    fn of(moves: Vec<Planned>, end: f64) -> Self {
        let next_start = if moves.is_empty() { f64::INFINITY } else { f64::NEG_INFINITY };
        let (plan_end, then) = (f64::NEG_INFINITY, RequestKind::Stand);
        let now = Now { index: 0, start: 0.0, from: 0.0, next_start, plan_end, then, reader: Reader::default() };
        Self { course: Course { moves, now }, end, fine: None, requested: None, unit: DisplayUnit::plain("m", 0) }
    }

    /// Plans every move; velocity commands are sent in `cycle`, whose times count from the start, and all moves but tables as `points`.
    fn plan(steps: &[Step], cycle: Option<CommandCycle>, points: Option<PointTimes>) -> Result<Self, BuildError> {
        let (mut moves, mut end, mut state) = (Vec::<Planned>::new(), 0.0, Setpoint::default());
        for (index, step) in steps.iter().enumerate() {
            match step {
                Step::Wait(length) => end += length,
                Step::Move(step) => {
                    let request = begun_anywhere(step).filter(|_| points.is_none());
                    let kept = step.aborts_after.and_then(|after| moves.last()?.rest_for(request?, after));
                    if let (Some(after), Some(last)) = (step.aborts_after, moves.last_mut()) {
                        (end, state) = last.abort(after, index)?;
                    }
                    let cycle = cycle.map(|cycle| CommandCycle { first: cycle.first - end % cycle.period, ..cycle });
                    let planned = || {
                        let begun = step.request.begun_in(&state, step.positioning)?;
                        followed(Request { commands: cycle, ..begun }.plan()?, points)
                    };
                    let plan = kept.map_or_else(planned, |rest| Ok((rest, None)));
                    let (plan, deviation) = plan.map_err(|error| BuildError::Plan { index, error })?;
                    let (start, from, length) = (end, state.x, plan.duration() + step.hold);
                    end += length;
                    state = plan.at(length);
                    state.x += from;
                    moves.push(Planned {
                        start,
                        end,
                        from,
                        ends_at_rest: ends_at_rest(&plan),
                        plan,
                        request: request.cloned(),
                        deviation,
                        is_aborted: false,
                        kind: kind(&step.request.generator),
                    });
                }
            }
            check_length(Some(index), end)?;
        }
        Ok(Self::of(moves, end))
    }

    /// End of the last step (s).
    #[must_use]
    pub const fn end(&self) -> f64 {
        self.end
    }

    /// Set-point at `t` (s), the time of a tick. Queries go from tick to tick if the program is interpolated, and otherwise must
    /// not go back in time.
    #[inline(always)]
    pub fn at(&mut self, t: f64) -> Setpoint {
        let Self { course, fine, .. } = self;
        let Some(fine) = fine else { return course.at(t) };
        // As numbers, so that a set-point that is not interpolated stays in registers.
        let [x, v, a, j, s] = interpolated(fine, course, t);
        Setpoint { x, v, a, j, s }
    }

    /// Request of the task at `t` (s), at which the set-point is `setpoint`, and its kind. Queries must not go back
    /// in time.
    #[inline(always)]
    pub(crate) fn request_at(&mut self, t: f64, setpoint: Setpoint) -> (Setpoint, RequestKind) {
        match (&mut self.requested, &self.fine) {
            (Some(course), Some(fine)) => {
                let t = (t - fine.delay()).max(0.0);
                (course.at(t), course.kind(t))
            }
            _ => (setpoint, self.course.kind(t)),
        }
    }

    /// Duration of each move (s).
    pub fn durations(&self) -> impl Iterator<Item = f64> {
        self.course.moves.iter().map(|planned| planned.end - planned.start)
    }

    /// Largest deviation of each move in position (m or rad): that announced by [`PlanDetails::Commands`], or that of the path through its
    /// points; `None` for a move that is sent neither as velocity commands nor as separate points.
    #[must_use]
    pub fn announced(&self) -> Vec<Option<f64>> {
        let error = |planned: &Planned| match planned.plan.details() {
            PlanDetails::Commands { error, .. } => Some(*error),
            _ => planned.deviation,
        };
        self.course.moves.iter().map(error).collect()
    }

    /// Start (s), start position and plan of each move.
    pub(crate) fn plans(&self) -> impl Iterator<Item = (f64, f64, &Plan)> {
        self.course.moves.iter().map(|planned| (planned.start, planned.from, &planned.plan))
    }

    /// The moves for a recording, with texts in the unit of the scenario.
    pub fn moves(&self) -> impl Iterator<Item = Move> {
        let delay = self.fine.as_ref().map_or(0.0, Fine::delay);
        self.course.moves.iter().map(move |planned| planned.describe(&self.unit, delay))
    }
}

/// The set-point at `t` (s) interpolated by `fine`: position and its derivatives.
#[inline(never)]
fn interpolated(fine: &mut Fine, course: &mut Course, t: f64) -> [f64; 5] {
    let Setpoint { x, v, a, j, s } = fine.next(|| course.at(t));
    [x, v, a, j, s]
}

impl Course {
    /// Set-point at `t` (s). Queries must not go back in time.
    #[inline(always)]
    fn at(&mut self, t: f64) -> Setpoint {
        if t >= self.now.next_start || !self.now.reader.holds(t - self.now.start) {
            self.look_up(t);
        }
        let mut setpoint = self.now.reader.at(t - self.now.start);
        setpoint.x += self.now.from;
        setpoint
    }

    /// The kind of request at `t` (s), at which the set-point was queried last.
    #[inline(always)]
    fn kind(&self, t: f64) -> RequestKind {
        if t < self.now.plan_end { RequestKind::Follow } else { self.now.then }
    }

    /// Finds the move that is active at `t` (s).
    #[cold]
    fn look_up(&mut self, t: f64) {
        let later = self.now.index + 1..self.moves.len();
        let index = later.take_while(|index| self.moves[*index].start <= t).last().unwrap_or(self.now.index);
        let Some(Planned { start, from, plan, ends_at_rest, .. }) = self.moves.get(index) else { return };
        let now = &mut self.now;
        (now.plan_end, now.then) = if t < *start {
            (f64::NEG_INFINITY, RequestKind::Stand)
        } else if *ends_at_rest {
            (start + plan.duration(), RequestKind::Rest)
        } else {
            (start + plan.duration(), RequestKind::Velocity)
        };
        now.reader.look_up(plan, t - start);
        (now.index, now.start, now.from) = (index, *start, *from);
        let next = self.moves.get(index + 1).map_or(f64::INFINITY, |next| next.start);
        now.next_start = if t < *start { *start } else { next };
    }
}

impl Planned {
    /// The rest of the plan from `after` (s) on, if `request` is that of this move and its target is still ahead: a move that is commanded
    /// again keeps its plan.
    fn rest_for(&self, request: &Request, after: f64) -> Option<Plan> {
        let is_same = self.request.as_ref() == Some(request) && after < self.plan.duration();
        is_same.then(|| self.plan.rest(after))
    }

    /// Ends the move `after` (s) after its start. Returns that time and the state of motion. `index` is the step that aborts it.
    fn abort(&mut self, after: f64, index: usize) -> Result<(f64, Setpoint), BuildError> {
        let lasts = self.end - self.start;
        if after >= lasts {
            return Err(BuildError::NothingToAbort { index, after, lasts });
        }
        (self.end, self.is_aborted) = (self.start + after, true);
        let mut state = self.plan.at(after);
        state.x += self.from;
        Ok((self.end, state))
    }
}

/// The request of `step`, if its target is a position of the axis and it is planned from any state.
fn begun_anywhere(step: &MoveStep) -> Option<&Request> {
    let is_absolute = step.positioning == Positioning::Absolute;
    (is_absolute && matches!(step.request.generator, Generator::Replanning(_))).then_some(&step.request)
}

/// True if a plan ends at rest: a sum of commanded velocities leaves its rounding.
fn ends_at_rest(plan: &Plan) -> bool {
    let velocity = plan.end().v.abs();
    // The peak of a long plan takes time.
    velocity <= 0.0 || velocity <= ROUNDING * plan.largest()[0]
}

/// The interpolation sub-mode.
const SUB_MODE: Object = Object { index: 0x60C0, subindex: 0 };

/// Times of the points of a move sent over `bus`; `None` if it is not sent as points.
fn point_times(bus: &Bus) -> Option<PointTimes> {
    if bus.mode != BusMode::InterpolatedPosition {
        return None;
    }
    let times = PointTimes::every(bus.point_time);
    // Drives with one time for all points use that time up to the last point.
    let sub_mode = bus.objects.iter().rev().find(|write| write.object == SUB_MODE);
    let sub_mode = sub_mode.and_then(|write| SubMode::from_code(i16::try_from(write.value).ok()?).ok());
    let has_one = sub_mode.is_some_and(SubMode::has_constant_time);
    Some(PointTimes { unit: if has_one { bus.point_time } else { times.unit }, ..times })
}

/// The path that a drive follows for `plan`, sent as `points` unless it is a table, and its deviation from the plan.
fn followed(plan: Plan, points: Option<PointTimes>) -> Result<(Plan, Option<f64>), PlanError> {
    match points {
        Some(times) if !matches!(plan.details(), PlanDetails::Table { .. }) => {
            let PointMove { way, deviation, .. } = plan.in_points(times)?;
            Ok((way, Some(deviation.distance)))
        }
        _ => Ok((plan, None)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_motion::online::Effort;
    use servobench_motion::online::{DirectionalLimits, Target};
    use servobench_motion::{Limits, Order};
    use servobench_planner::Method;
    use servobench_planner::{PointToPoint, Replanning};
    use servobench_testkit::Random;

    const LAMBRECHTS: Limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };

    fn step(distance: f64, positioning: Positioning, limits: Limits) -> Step {
        let (order, method) = (Order::Fourth, Method::Published);
        let generator = Generator::PointToPoint(PointToPoint { distance, order, limits, method, grid: None });
        let (request, metric_limits) = (Request::new(generator), Vec::new());
        Step::Move(MoveStep { request, positioning, hold: 0.0, aborts_after: None, metric_limits })
    }

    fn to(position: f64) -> Step {
        step(position, Positioning::Absolute, LAMBRECHTS)
    }

    fn by(distance: f64) -> Step {
        step(distance, Positioning::Relative, LAMBRECHTS)
    }

    #[test]
    fn moves_follow_each_other_and_pauses_hold_the_target() {
        let steps = [Step::Wait(0.1), to(1.0), Step::Wait(0.5), by(-1.0)];
        let mut program = Program::plan(&steps, None, None).unwrap();
        // Lambrechts' move lasts 1.35 s each way.
        assert!((program.end() - (0.1 + 1.35 + 0.5 + 1.35)).abs() < 1e-12);
        assert_eq!(program.at(0.05), Setpoint::at_rest(0.0));
        assert!((program.at(0.1 + 0.675).x - 0.5).abs() < 1e-12);
        assert_eq!(program.at(1.6), Setpoint::at_rest(1.0));
        assert!((program.at(1.95 + 0.675).x - 0.5).abs() < 1e-12);
        assert_eq!(program.at(9.0), Setpoint::at_rest(0.0));
        let cruise = program.moves().next().unwrap().cruise;
        assert!((cruise.0 - 0.45).abs() < 1e-12 && (cruise.1 - 0.65).abs() < 1e-12, "{cruise:?}");
        assert!(program.durations().all(|duration| (duration - 1.35).abs() < 1e-12));
        assert_eq!(program.durations().count(), 2);
    }

    /// Before, one that was repeated while it braked reversed beyond its target.
    #[test]
    fn a_move_repeated_on_its_way_arrives_when_it_would_have() {
        let mut random = Random::seeded(39);
        let count = std::env::var("SERVOBENCH_SWEEP").map_or(6, |size| size.parse().unwrap());
        for _ in 0..count {
            let [velocity, acceleration, jerk, snap] =
                [1.0, 5.0, 50.0, 1000.0].map(|value| value * random.decades(-0.3, 0.3));
            let limits = DirectionalLimits::from(Limits { velocity, acceleration, jerk, snap });
            let x = random.signed();
            let end = if random.unit() < 0.3 { 0.0 } else { 0.9 * velocity * random.unit() * x.signum() };
            let order = random.one_of(&[Order::Second, Order::Third, Order::Fourth]);
            let (from, target, effort) = (Setpoint::default(), Target::Position { x, v: end }, Effort::Fast);
            let generator = Generator::Replanning(Replanning { from, target, order, limits, effort });
            let repeated = |aborts_after: Option<f64>| {
                let (request, metric_limits) = (Request::new(generator.clone()), Vec::new());
                let positioning = Positioning::Absolute;
                Step::Move(MoveStep { request, positioning, hold: 0.0, aborts_after, metric_limits })
            };
            let once = Program::plan(&[repeated(None)], None, None).unwrap();
            let every = once.end() / 301.0;
            let steps: Vec<_> = (0..301).map(|k| repeated((k > 0).then_some(every))).collect();
            let mut again = Program::plan(&steps, None, None).unwrap();
            assert!((again.end() - once.end()).abs() <= 1e-12 * once.end(), "{} {}", again.end(), once.end());
            let mut once = once;
            for k in 0..=1000 {
                let t = once.end() * f64::from(k) / 1000.0;
                let [one, other] = [once.at(t), again.at(t)];
                assert!((one.x - other.x).abs() <= 1e-12 && (one.v - other.v).abs() <= 1e-11, "{t}: {one:?} {other:?}");
            }
        }
    }

    #[test]
    fn a_label_shows_no_rounding() {
        let quarter = core::f64::consts::FRAC_PI_2;
        let steps = [0.1, 0.2, -0.3, quarter].map(by);
        let labels: Vec<_> = Program::plan(&steps, None, None).unwrap().moves().map(|made| made.label).collect();
        let ends = [("0", "0.1"), ("0.1", "0.3"), ("0.3", "0"), ("0", "1.5708")];
        assert_eq!(labels, ends.map(|(from, to)| format!("move from {from} m to {to} m, order 4")));
    }

    /// Oracle: each move's own set-point, looked up at every instant. Moves without a pause between them, one of zero
    /// distance, and queries that skip whole moves.
    #[test]
    fn what_is_kept_from_query_to_query_is_what_a_look_up_finds() {
        let steps = [to(0.3), to(0.3), to(-0.2), Step::Wait(0.05), to(1.0)];
        for skip in [1, 7, 5_000, 12_000] {
            let mut program = Program::plan(&steps, None, None).unwrap();
            for k in (0..60_000_u32).step_by(skip) {
                let t = f64::from(k) / 16e3;
                let made = program.course.moves.iter().take_while(|planned| planned.start <= t).last().unwrap();
                let mut expected = made.plan.at(t - made.start);
                expected.x += made.from;
                let bits = |Setpoint { x, v, a, j, s }| [x, v, a, j, s].map(f64::to_bits);
                assert_eq!(bits(program.at(t)), bits(expected), "every {skip} ticks, {t} s");
            }
        }
    }

    #[test]
    fn without_a_move_the_axis_is_to_stay() {
        let mut program = Program::plan(&[Step::Wait(0.5)], None, None).unwrap();
        assert!([0.0, 0.1, 7.0].iter().all(|t| program.at(*t) == Setpoint::at_rest(0.0)));
        assert!((program.end() - 0.5).abs() < 1e-15);
    }

    /// The moves have no length in the scenario file: their sum is known only here.
    #[test]
    fn a_program_that_never_ends_is_refused_at_its_step() {
        let slow = step(1.0, Positioning::Relative, Limits { velocity: 1e-9, ..LAMBRECHTS });
        for (steps, end) in [
            (vec![to(1.0), slow], "1000000001"),
            (vec![Step::Wait(0.5), Step::Wait(1e16)], "1000000000000000"),
            (vec![Step::Wait(0.5), Step::Wait(f64::INFINITY)], "inf"),
            (vec![Step::Wait(0.5), Step::Wait(f64::NAN)], "NaN"),
        ] {
            let message = Program::plan(&steps, None, None).unwrap_err().to_string();
            assert!(message.starts_with(&format!("program step 2 would end at {end}")), "{message}");
            assert!(message.contains("a run lasts 1000000 s at most"), "{message}");
        }
    }
}
