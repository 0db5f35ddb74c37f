//! Moves through tables: as they are, or as a drive follows that is told velocities.
use crate::plan::{Plan, Told};
use crate::polynomials::{Between, Polynomials};
use servobench_base::Setpoint;
use servobench_motion::PlanError;
use servobench_motion::position_profile::{Command, Plateaus, Spline};
use servobench_motion::pvt::{Knot, Table, average, continuous, smooth};

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
}

impl TableMove {
    pub(crate) fn plan(&self) -> Result<Plan, PlanError> {
        let mut knots = self.knots.clone();
        let mut scratch = vec![0.0; knots.len()];
        let velocity = |knot: Option<&Knot>| knot.and_then(|knot| knot.v).unwrap_or(0.0);
        let (start, end) = (velocity(knots.first()), velocity(knots.last()));
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
                Ok(course(&knots, |t| cursor.piece(t), Told::Table))
            }
            Follow::Plateaus(alpha) => {
                let plateaus = Plateaus::solve(&mut knots, start, end, alpha, &mut scratch)?;
                let commands = plateaus.commands().collect();
                let mut cursor = plateaus.cursor();
                let knots = plateaus.knots();
                Ok(course(knots, |t| cursor.piece(t), Told::Commands { commands, error: 0.0 }))
            }
            Follow::Steps(rate) => {
                let stepped = Spline::solve(&mut knots, start, end, &mut scratch)?.stepped(rate)?;
                let commands: Vec<Command> = stepped.commands().collect();
                let error = stepped.largest_error();
                let (first, last) = (self.knots[0], self.knots[self.knots.len() - 1]);
                Ok(obeyed(commands, error, Setpoint { v: start, ..Setpoint::at_rest(first.x) }, first.t, last.t))
            }
        }
    }
}

fn course(knots: &[Knot], piece: impl FnMut(f64) -> servobench_motion::Piece, told: Told) -> Plan {
    let polynomials = Polynomials::collect(knots[0].t, knots[knots.len() - 1].t, piece);
    Plan::of(polynomials, told)
}

/// The way of a drive that obeys `commands` from `state` at `start` until `end` (s): a straight line of velocity after each.
fn obeyed(commands: Vec<Command>, error: f64, mut state: Setpoint, start: f64, end: f64) -> Plan {
    let untils = commands.iter().skip(1).map(|command| command.t).chain([end]);
    let mut parts = Vec::with_capacity(commands.len());
    for (command, until) in commands.iter().zip(untils) {
        let length = until - command.t;
        state.a = (command.velocity - state.v) / length;
        parts.push((command.t - start, state));
        state = Setpoint { v: command.velocity, ..state.after(length) };
    }
    state.a = 0.0;
    Plan::of(Polynomials::new(parts, Between::Polynomial, end - start, state), Told::Commands { commands, error })
}
