//! Moves through tables: along the table itself, or as followed by a drive that receives velocities.
use crate::plan::{Plan, PlanDetails, Sending};
use crate::polynomials::{Between, Polynomials};
use servobench_base::{ParamError, Setpoint};
use servobench_motion::position_profile::{Command, PlateauShare, Plateaus, Spline};
use servobench_motion::pvt::{Knot, Table, average, continuous, smooth};
use servobench_motion::{Course, PlanError};

/// A move through points.
#[derive(Debug, Clone, PartialEq)]
pub struct TableMove {
    /// The points; the move begins at the time of the first.
    pub knots: Vec<Knot>,
    /// Choice of the velocities at the points.
    pub velocities: Velocities,
    /// Method by which they are followed.
    pub follow: Follow,
}

servobench_config::choices! {
    /// Source of the velocities at the points. At the first and the last point they are those of the table, by default zero.
    pub enum Velocities named VelocitiesKind default Given {
        /// those of the table; a point without one is approached linearly
        Given = "given",
        /// the mean of the segments before and behind
        Average = "average",
        /// the average, then `passes` of smoothing
        Smooth {
            /// Passes of the formulas F2 and F1.
            passes: u32,
        } = "smooth",
        /// those with continuous acceleration: the cubic spline
        Continuous = "continuous",
    }
}

servobench_config::choices! {
    /// Method of following a table.
    pub enum Follow named FollowKind default Segments {
        /// along its cubic and linear segments (PVT, PT)
        Segments = "segments",
        /// by profile velocities with a plateau in each segment; hits every position
        Plateaus {
            /// Share of a segment at either end in which velocity changes.
            share: PlateauShare,
        } = "plateaus",
        /// by profile velocities along the cubic spline, sent at `command_rate`
        Steps {
            /// Commands per second.
            rate: CommandRate,
        } = "steps",
    }
}

/// Number of velocities sent per second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CommandRate {
    /// This many per second.
    Given(f64),
    /// The lowest whole number per second with at most this deviation of the drive from the spline (m or rad).
    LowestWithin(f64),
}

impl Velocities {
    /// Default number of passes: that in the source of the formulas.
    pub const PASSES: u32 = 2;
}

impl Follow {
    /// Default share of a segment in which velocity changes.
    pub const PLATEAU_SHARE: f64 = 0.25;
}

/// Relative tolerance: a smaller difference, relative to the largest value, counts as zero.
const ROUNDING: f64 = 1e-9;
/// Largest number of commands stored for a move.
pub(crate) const MOST_COMMANDS: f64 = 1e7;

impl TableMove {
    pub(crate) fn plan(&self) -> Result<Plan, PlanError> {
        let mut knots = self.knots.clone();
        let mut scratch = vec![0.0; knots.len()];
        let (start, end) = self.ends();
        match self.follow {
            Follow::Segments => {
                match self.velocities {
                    Velocities::Given => {}
                    Velocities::Average => average(&mut knots, start, end)?,
                    Velocities::Smooth { passes } => {
                        average(&mut knots, start, end)?;
                        smooth(&mut knots, passes as usize)?;
                    }
                    Velocities::Continuous => continuous(&mut knots, start, end, &mut scratch)?,
                }
                let mut cursor = Table::new(&knots)?.cursor();
                let polynomials = Polynomials::collect(knots[0].t, knots[knots.len() - 1].t, |t| cursor.piece(t));
                let order = order(&polynomials, start);
                Ok(Plan::of(polynomials, PlanDetails::Table { order }))
            }
            Follow::Plateaus { share } => {
                let plateaus = Plateaus::solve(&mut knots, start, end, share, &mut scratch)?;
                let commands: Vec<_> = plateaus.commands().collect();
                within(&commands, start, share)?;
                let sending = Sending::Plateaus { share: plateaus.share() };
                let mut cursor = plateaus.cursor();
                let knots = plateaus.knots();
                let polynomials = Polynomials::collect(knots[0].t, knots[knots.len() - 1].t, |t| cursor.piece(t));
                Ok(Plan::of(polynomials, PlanDetails::Commands { commands, error: 0.0, sending }))
            }
            Follow::Steps { rate: CommandRate::Given(rate) } => {
                let bound = "low enough for at most 10 million commands";
                self.stepped(|_| Ok(rate), ParamError { name: "rate", value: rate, bound })
            }
            Follow::Steps { rate: CommandRate::LowestWithin(error) } => {
                let bound = "large enough for at most 10 million commands";
                let too_many = ParamError { name: "allowed", value: error, bound };
                self.stepped(|spline| spline.lowest_rate(error).map(f64::from), too_many)
            }
        }
    }

    /// Velocities of the first and the last point.
    pub(crate) fn ends(&self) -> (f64, f64) {
        let velocity = |knot: Option<&Knot>| knot.and_then(|knot| knot.v).unwrap_or(0.0);
        (velocity(self.knots.first()), velocity(self.knots.last()))
    }

    /// The plan that follows the spline with the number of commands per second from `choose`; `too_many` is the error if that is excessive.
    fn stepped(
        &self,
        choose: impl FnOnce(Spline<'_>) -> Result<f64, PlanError>,
        too_many: ParamError,
    ) -> Result<Plan, PlanError> {
        let (mut knots, mut scratch) = (self.knots.clone(), vec![0.0; self.knots.len()]);
        let (start, end) = self.ends();
        let spline = Spline::solve(&mut knots, start, end, &mut scratch)?;
        let rate = choose(spline)?;
        let stepped = spline.stepped(rate)?;
        if rate * spline.table().duration() > MOST_COMMANDS {
            return Err(too_many.into());
        }
        let commands: Vec<Command> = stepped.commands().collect();
        let (first, last) = (self.knots[0], self.knots[self.knots.len() - 1]);
        let state = Setpoint { v: start, ..Setpoint::at_rest(first.x) };
        let (parts, end) = obeyed(&commands, state, first.t, last.t);
        let details = PlanDetails::Commands { commands, error: stepped.largest_error(), sending: Sending::Rate(rate) };
        Ok(Plan::of(Polynomials::new(parts, Between::Polynomial, last.t - first.t, end), details))
    }
}

/// Checks that `commands`, sent to a drive at velocity `start`, are within the limits of a share that is searched for.
pub(crate) fn within(commands: &[Command], start: f64, share: PlateauShare) -> Result<(), PlanError> {
    let PlateauShare::SmallestPartOf { velocity, acceleration } = share else { return Ok(()) };
    let most = |of: fn(&Command) -> f64, first: f64| commands.iter().map(of).fold(first, f64::max);
    let peaks = [
        ("velocity", most(|command| command.velocity.abs(), start.abs()), velocity),
        ("acceleration", most(|command| command.acceleration, 0.0), acceleration),
    ];
    match peaks.into_iter().find(|(_, peak, limit)| *peak > limit * (1.0 + ROUNDING)) {
        Some((quantity, peak, limit)) => Err(PlanError::TableTooFast { quantity, peak, limit }),
        None => Ok(()),
    }
}

/// The highest derivative without impulses, for a trajectory entered at velocity `start`.
fn order(way: &Polynomials, start: f64) -> usize {
    let (mut jumps, mut largest) = ([0.0_f64; 2], [0.0_f64; 2]);
    let mut before = Setpoint { v: start, ..Setpoint::default() };
    let end = Setpoint { a: 0.0, ..way.end() };
    for (now, next) in way.parts().map(|(part, length)| (part, part.after(length))).chain([(end, end)]) {
        let values = [(before.v, now.v), (before.a, now.a)];
        for ((before, now), (jump, largest)) in values.into_iter().zip(jumps.iter_mut().zip(&mut largest)) {
            *jump = jump.max((now - before).abs());
            *largest = largest.max(now.abs()).max(before.abs());
        }
        before = next;
    }
    let is_jump = |k: usize| jumps[k] > ROUNDING * largest[k];
    if is_jump(0) {
        1
    } else if is_jump(1) {
        2
    } else {
        3
    }
}

/// The motion of a drive that executes `commands` from `state` at `start` until `end` (s), each with a linear change of velocity:
/// set-points with the times from `start` (s) at which they begin, and the final state.
fn obeyed(commands: &[Command], mut state: Setpoint, start: f64, end: f64) -> (Vec<(f64, Setpoint)>, Setpoint) {
    let untils = commands.iter().skip(1).map(|command| command.t).chain([end]);
    let mut parts = Vec::with_capacity(commands.len());
    for (command, until) in commands.iter().zip(untils) {
        let length = until - command.t;
        state.a = (command.velocity - state.v) / length;
        parts.push((command.t - start, state));
        state = Setpoint { v: command.velocity, ..state.after(length) };
    }
    (parts, Setpoint { a: 0.0, ..state })
}
