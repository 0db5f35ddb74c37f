//! Position profiles for a drive on a bus: one command per cycle, in whole units of the drive.
use crate::plan::{Plan, PlanDetails, Sending};
use crate::polynomials::{Between, Polynomials};
use crate::table::{CommandRate, Follow, MOST_COMMANDS, TableMove, within};
use servobench_base::{ParamError, Setpoint, non_negative};
use servobench_motion::PlanError;
use servobench_motion::position_profile::{Clock, ClockedPlateaus, ClockedSpline, Command, Spline};
use servobench_motion::pvt::{Knot, Table};

/// Timing and resolution of velocity commands to a drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CommandCycle {
    /// Time between two instants at which a command can be sent (s).
    pub period: f64,
    /// One of those instants, from the start of the move (s).
    pub first: f64,
    /// Unit (m/s or rad/s) of the drive's velocities, whole multiples up to 2³¹ − 1, and per second of its accelerations, up to 2³² − 1;
    /// 0 for a drive that accepts any value.
    pub unit: f64,
}

/// Share of the time between two commands by which a ramp may miss the second and still count as ending there.
const NEAR: f64 = 1e-9;

/// Commands of a move as executed by a drive that changes to each velocity along a straight line.
struct Obeyed {
    /// Start of each straight line (s), and the set-point there.
    parts: Vec<(f64, Setpoint)>,
    /// End of the move (s).
    until: f64,
    end: Setpoint,
}

impl TableMove {
    /// True if a drive is sent velocities for it.
    pub(crate) const fn is_sent(&self) -> bool {
        !matches!(self.follow, Follow::Segments)
    }

    /// The same move in `factor` times the time.
    pub(crate) fn slowed(&self, factor: f64) -> Self {
        let start = self.knots.first().map_or(0.0, |knot| knot.t);
        let slowed =
            |knot: &Knot| Knot { t: start + factor * (knot.t - start), x: knot.x, v: knot.v.map(|v| v / factor) };
        let follow = match self.follow {
            Follow::Steps { rate: CommandRate::Given(rate) } => {
                Follow::Steps { rate: CommandRate::Given(rate / factor) }
            }
            follow => follow,
        };
        Self { knots: self.knots.iter().map(slowed).collect(), follow, ..*self }
    }

    /// The plan for a drive that receives its commands in `cycle`.
    pub(crate) fn plan_in(&self, cycle: &CommandCycle) -> Result<Plan, PlanError> {
        non_negative("command_unit", cycle.unit)?;
        let clock = Clock::new(self.knots.first().map_or(0.0, |knot| knot.t) + cycle.first, cycle.period)?;
        match self.follow {
            Follow::Segments => self.plan(),
            Follow::Plateaus { share } => {
                let (mut knots, mut scratch) = (self.knots.clone(), vec![0.0; self.knots.len()]);
                let (start, end) = self.ends();
                let plateaus = ClockedPlateaus::solve(&mut knots, start, end, share, clock, &mut scratch)?;
                let sending = Sending::Plateaus { share: plateaus.share() };
                let commands: Vec<_> = plateaus.commands().collect();
                within(&commands, start, share)?;
                let commands = rounded(commands.into_iter(), start, cycle.unit)?;
                let obeyed = self.obeyed(&commands);
                let missed = |knot: &Knot| (obeyed.at(knot.t).x - knot.x).abs();
                let error = self.knots.iter().map(missed).fold(0.0, f64::max);
                Ok(self.plan_of(obeyed, PlanDetails::Commands { commands, error, sending }))
            }
            Follow::Steps { rate: CommandRate::Given(rate) } => self.stepped_in(rate, clock, cycle.unit),
            Follow::Steps { rate: CommandRate::LowestWithin(allowed) } => self.within(allowed, clock, cycle.unit),
        }
    }

    /// The plan that follows the spline with `rate` commands per second, or one at each instant if those are fewer.
    fn stepped_in(&self, rate: f64, clock: Clock, unit: f64) -> Result<Plan, PlanError> {
        let (mut knots, mut scratch) = (self.knots.clone(), vec![0.0; self.knots.len()]);
        let (start, end) = self.ends();
        let steps = ClockedSpline::solve(&mut knots, start, end, rate, clock, &mut scratch)?;
        let most = rate.min(1.0 / clock.period());
        if most * (self.knots[self.knots.len() - 1].t - self.knots[0].t) > MOST_COMMANDS {
            let bound = "low enough for at most 10 million commands";
            return Err(ParamError { name: "rate", value: rate, bound }.into());
        }
        let commands = rounded(steps.commands(), start, unit)?;
        let mut knots = self.knots.clone();
        let spline = Spline::solve(&mut knots, start, end, &mut scratch)?;
        let obeyed = self.obeyed(&commands);
        let error = obeyed.largest_difference(spline.table());
        Ok(self.plan_of(obeyed, PlanDetails::Commands { commands, error, sending: Sending::Rate(most) }))
    }

    /// The plan with the fewest whole commands per second whose error to the spline is at most `allowed`.
    fn within(&self, allowed: f64, clock: Clock, unit: f64) -> Result<Plan, PlanError> {
        let error = |plan: &Plan| match plan.details() {
            PlanDetails::Commands { error, .. } => *error,
            _ => f64::INFINITY,
        };
        let highest = (1.0 / clock.period()).ceil();
        let (mut enough, mut too_few) = (highest, 0.0);
        let mut best = self.stepped_in(enough, clock, unit)?;
        let lowest = error(&best);
        if lowest > allowed || allowed.is_nan() {
            let remedy = "allow a larger error, give the move more time, or send commands in a shorter cycle";
            return Err(PlanError::OutOfRange {
                name: "allowed",
                value: allowed,
                lowest,
                highest: f64::INFINITY,
                remedy,
            });
        }
        while enough - too_few > 1.0 {
            let middle = f64::midpoint(enough, too_few).floor();
            let plan = self.stepped_in(middle, clock, unit)?;
            if error(&plan) <= allowed {
                (enough, best) = (middle, plan);
            } else {
                too_few = middle;
            }
        }
        Ok(best)
    }

    fn obeyed(&self, commands: &[Command]) -> Obeyed {
        let (first, last) = (self.knots[0], self.knots[self.knots.len() - 1]);
        let state = Setpoint { v: self.ends().0, ..Setpoint::at_rest(first.x) };
        obeyed(commands, state, first.t, last.t)
    }

    fn plan_of(&self, obeyed: Obeyed, details: PlanDetails) -> Plan {
        let start = self.knots[0].t;
        let Obeyed { parts, until, end } = obeyed;
        let parts = parts.into_iter().map(|(t, state)| (t - start, state));
        Plan::of(Polynomials::new(parts, Between::Polynomial, until - start, end), details)
    }
}

/// The commands as accepted by a drive whose initial velocity is `before`: the nearest whole `unit` of each velocity, and of the
/// acceleration that reaches it in the same time, at least one.
///
/// # Errors
/// [`PlanError`] for a velocity or an acceleration that exceeds the range of the drive's objects.
fn rounded(commands: impl Iterator<Item = Command>, before: f64, unit: f64) -> Result<Vec<Command>, PlanError> {
    let (mut exact, mut taken) = (before, before);
    let round = |command: Command| {
        let way = (command.velocity - exact).abs();
        exact = command.velocity;
        if unit == 0.0 {
            return Ok(command);
        }
        let units = (command.velocity / unit + 0.5).floor();
        if units.abs() > f64::from(i32::MAX) {
            let bound = "at most 2³¹ − 1 velocity units of the drive: make the units of the bus coarser";
            return Err(ParamError { name: "velocity", value: command.velocity, bound }.into());
        }
        let velocity = unit * units;
        let length = way / command.acceleration;
        let step = (velocity - core::mem::replace(&mut taken, velocity)).abs();
        let acceleration = if length > 0.0 { step / length } else { 0.0 };
        let units = (acceleration / unit + 0.5).floor();
        if units > f64::from(u32::MAX) {
            let bound = "at most 2³² − 1 units of the drive per second: give the ramp more time, or make the units of the bus coarser";
            return Err(ParamError { name: "acceleration", value: acceleration, bound }.into());
        }
        let acceleration = unit * if acceleration > 0.0 { units.max(1.0) } else { 0.0 };
        Ok(Command { velocity, acceleration, ..command })
    };
    commands.map(round).collect()
}

/// Motion of a drive that executes `commands` from `state` at `start` until `until` (s).
fn obeyed(commands: &[Command], mut state: Setpoint, start: f64, until: f64) -> Obeyed {
    let (mut parts, mut t) = (Vec::with_capacity(2 * commands.len() + 1), start);
    let mut go = |state: &mut Setpoint, a: f64, to: f64| {
        if to > t {
            state.a = a;
            parts.push((t, *state));
            *state = Setpoint { a: 0.0, ..state.after(to - t) };
            t = to;
        }
    };
    let ends = commands.iter().skip(1).map(|command| command.t).chain([until]);
    for (command, end) in commands.iter().zip(ends) {
        go(&mut state, 0.0, command.t.min(until));
        let way = command.velocity - state.v;
        if way != 0.0 && command.acceleration > 0.0 {
            let reached = command.t + way.abs() / command.acceleration;
            let reached = if (reached - end).abs() <= NEAR * (end - command.t) { end } else { reached };
            go(&mut state, command.acceleration.copysign(way), reached.min(end));
            if reached <= end {
                state.v = command.velocity;
            }
        }
        go(&mut state, 0.0, end);
    }
    Obeyed { parts, until, end: state }
}

impl Obeyed {
    /// The set-point at `t` (s), in the time of the table.
    fn at(&self, t: f64) -> Setpoint {
        let part = self.parts.partition_point(|(begin, _)| *begin <= t).saturating_sub(1);
        match self.parts.get(part) {
            Some((begin, state)) if t < self.until => state.after(t - begin),
            _ => self.end,
        }
    }

    /// Largest difference of position from `table` at any time (m or rad), exact except for rounding.
    fn largest_difference(&self, table: Table<'_>) -> f64 {
        let knots = table.knots();
        let begins = self.parts.iter().map(|(begin, _)| *begin).chain(knots.iter().map(|knot| knot.t));
        let mut times: Vec<f64> = begins.chain([self.until]).collect();
        times.sort_by(f64::total_cmp);
        let mut largest = 0.0_f64;
        for pair in times.windows(2) {
            let [from, to] = [pair[0], pair[1]];
            let (own, spline) = (self.at(from), table.piece(from).at(from));
            let away = Setpoint { x: own.x - spline.x, v: own.v - spline.v, a: own.a - spline.a, j: -spline.j, s: 0.0 };
            for s in turns(&away).into_iter().chain([0.0, to - from]) {
                if s >= 0.0 && s <= to - from {
                    largest = largest.max(away.after(s).x.abs());
                }
            }
        }
        largest
    }
}

/// Zeros of the velocity (s): v + a·s + j/2·s² = 0, without cancellation.
fn turns(from: &Setpoint) -> [f64; 2] {
    let Setpoint { v, a, j, .. } = *from;
    let q = -(a + (a * a - 2.0 * j * v).sqrt().copysign(a));
    [q / j, 2.0 * v / q]
}
