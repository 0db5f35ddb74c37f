//! Moves through tables: as they are, or as a drive follows that is told velocities.
use crate::plan::{Plan, Told};
use crate::polynomials::{Between, Polynomials};
use servobench_base::{ParamError, Setpoint};
use servobench_motion::position_profile::{Command, Plateaus, Spline};
use servobench_motion::pvt::{Knot, Table, average, continuous, smooth};
use servobench_motion::{Course, PlanError};

/// A move through points.
#[derive(Debug, Clone, PartialEq)]
pub struct TableMove {
    /// The points; the move begins at the time of the first.
    pub knots: Vec<Knot>,
    /// How fast they are passed.
    pub velocities: Velocities,
    /// How they are followed.
    pub follow: Follow,
}

/// Where the velocities at the points come from. At the first and the last one they are what the table says, zero unless it
/// says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Velocities {
    /// The table's own; a point without one is approached linearly.
    Given,
    /// The mean of the segments before and behind.
    Average,
    /// The average rule, then so many passes of the formulas F2 and F1.
    Smooth(usize),
    /// Those of the cubic spline: continuous acceleration.
    Continuous,
}

/// How a table is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Follow {
    /// Along its cubic and linear segments.
    Segments,
    /// By profile velocities with a plateau in each segment, option 1; the share of a segment at either end in which
    /// velocity changes.
    Plateaus(f64),
    /// By profile velocities along its spline, option 2; commands per second.
    Steps(f64),
    /// The same with the lowest whole number of commands per second that keeps the drive so near to the spline (m or rad).
    Within(f64),
}

/// A difference below this part of the largest value is none.
const ROUNDING: f64 = 1e-9;
/// Commands at most that are kept of a move.
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
                    Velocities::Smooth(passes) => {
                        average(&mut knots, start, end)?;
                        smooth(&mut knots, passes)?;
                    }
                    Velocities::Continuous => continuous(&mut knots, start, end, &mut scratch)?,
                }
                let mut cursor = Table::new(&knots)?.cursor();
                let polynomials = Polynomials::collect(knots[0].t, knots[knots.len() - 1].t, |t| cursor.piece(t));
                let order = order(&polynomials, start);
                Ok(Plan::of(polynomials, Told::Table { order }))
            }
            Follow::Plateaus(alpha) => {
                let plateaus = Plateaus::solve(&mut knots, start, end, alpha, &mut scratch)?;
                let commands = plateaus.commands().collect();
                let mut cursor = plateaus.cursor();
                let knots = plateaus.knots();
                let polynomials = Polynomials::collect(knots[0].t, knots[knots.len() - 1].t, |t| cursor.piece(t));
                Ok(Plan::of(polynomials, Told::Commands { commands, error: 0.0, rate: None }))
            }
            Follow::Steps(rate) => {
                let bound = "low enough for at most 10 million commands";
                self.stepped(|_| Ok(rate), ParamError { name: "rate", value: rate, bound })
            }
            Follow::Within(error) => {
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

    /// The plan that follows the spline by as many commands per second as `choose` says, unless these are `too_many`.
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
        let told = Told::Commands { commands, error: stepped.largest_error(), rate: Some(rate) };
        Ok(Plan::of(Polynomials::new(parts, Between::Polynomial, last.t - first.t, end), told))
    }
}

/// The highest derivative that is no impulse, of a way that is entered at velocity `start`.
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

/// The way of a drive that obeys `commands` from `state` at `start` until `end` (s), a straight line of velocity after each:
/// set-points with the times from `start` (s) at which they begin, and where it ends.
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
