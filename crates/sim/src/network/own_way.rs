//! The moves of a program as a drive makes them by itself, in profile position, profile velocity or interpolated position.
//!
//! What the drive is sent stands in the plans of the moves: their targets, the commands of a position profile, or the points of
//! a table. Times count from the cycle in which the axis is powered.
use super::Step;
use super::points::{Points, Unsendable};
use super::underway::Underway;
use servobench_drive::modes::interpolated::SegmentCommand;
use servobench_fieldbus::{AxisCommand, AxisFeedback, Task, Way};
use servobench_motion::position_profile::Command;
use servobench_planner::Told;
use servobench_scenario::{BusMode, DriveUnits};

/// How far before its time a cycle may be by rounding (s).
const ROUNDING: f64 = 1e-9;
/// Points that are in the buffer before they are followed, when there are so many.
const AHEAD: usize = 16;

/// A program of ways under way.
#[derive(Debug, Clone)]
pub(super) struct OwnWay {
    moves: Underway,
    orders: Orders,
}

/// What is sent.
#[derive(Debug, Clone)]
enum Orders {
    /// Set-points: when, where to, and the largest velocity and acceleration.
    Positions { set_points: Vec<(f64, [f64; 3])>, sent: usize },
    /// Velocities: when, and which.
    Velocities { commands: Vec<Command>, next: usize, now: Command },
    /// Tables: when, and the points of each.
    Tables { tables: Vec<(f64, Points)>, now: usize, is_following: bool, was_active: bool },
}

impl OwnWay {
    /// The way of `moves` in `mode`.
    ///
    /// # Errors
    /// [`Unsendable`] names a point of a table that 2010h does not hold.
    pub(super) fn new(moves: Underway, mode: BusMode, units: DriveUnits) -> Result<Self, Unsendable> {
        let program = moves.program();
        let orders = match mode {
            BusMode::ProfileVelocity => {
                let told = program.plans().flat_map(|(start, _, plan)| commands_of(start, plan.told(), plan.end().v));
                let now = Command { t: 0.0, velocity: 0.0, acceleration: 0.0 };
                Orders::Velocities { commands: told.collect(), next: 0, now }
            }
            BusMode::InterpolatedPosition => {
                let tables = program.plans().map(|(start, from, plan)| Ok((start, Points::of(plan, from, units)?)));
                let tables = tables.collect::<Result<_, _>>()?;
                Orders::Tables { tables, now: 0, is_following: false, was_active: false }
            }
            BusMode::ProfilePosition | BusMode::CyclicPosition | BusMode::CyclicVelocity => {
                let set_points = program.plans().map(|(start, from, plan)| {
                    let [velocity, acceleration, ..] = plan.limits().map(|sides| sides.above);
                    (start, [from + plan.end().x, velocity, acceleration])
                });
                Orders::Positions { set_points: set_points.collect(), sent: 0 }
            }
        };
        Ok(Self { moves, orders })
    }

    pub(super) const fn moves(&self) -> &Underway {
        &self.moves
    }

    /// One cycle.
    pub(super) fn cycle(&mut self, feedback: &AxisFeedback) -> Step {
        let now = self.moves.turn(feedback);
        // Before the axis is powered nothing is due.
        let way = self.orders.way(now.map_or(f64::NEG_INFINITY, |now| now + ROUNDING), feedback);
        // In profile velocity the drive knows no position: the plan says where the axis is to be. In the other modes the drive's
        // own set-point does.
        let setpoint = matches!(self.orders, Orders::Velocities { .. }).then(|| self.moves.at(now.unwrap_or(0.0)));
        Step { command: AxisCommand { power: true, reset: false, task: Task::Drive(way) }, setpoint }
    }
}

/// The velocities of a move that begins at `start` (s) and ends at `end`.
fn commands_of(start: f64, told: &Told, end: f64) -> Vec<Command> {
    match told {
        Told::Commands { commands, .. } => {
            commands.iter().map(|command| Command { t: start + command.t, ..*command }).collect()
        }
        _ => vec![Command { t: start, velocity: end, acceleration: 0.0 }],
    }
}

impl Orders {
    /// What is sent at `now` (s).
    fn way(&mut self, now: f64, feedback: &AxisFeedback) -> Way {
        match self {
            Self::Positions { set_points, sent } => {
                // The next one is asked for when its time has come and the drive has taken the last.
                let taken = feedback.way.acknowledged as usize == *sent;
                if taken && set_points.get(*sent).is_some_and(|(start, _)| *start <= now) {
                    *sent += 1;
                }
                let asked = sent.checked_sub(1).and_then(|index| set_points.get(index));
                let [position, velocity, acceleration] =
                    asked.map_or([feedback.position, 0.0, 0.0], |(_, set_point)| *set_point);
                #[expect(clippy::cast_possible_truncation, reason = "a program has fewer steps")]
                Way::Position { number: *sent as u32, position, velocity, acceleration }
            }
            Self::Velocities { commands, next, now: present } => {
                while let Some(command) = commands.get(*next).filter(|command| command.t <= now) {
                    *present = *command;
                    *next += 1;
                }
                let Command { velocity, acceleration, .. } = *present;
                Way::Velocity { velocity, acceleration }
            }
            Self::Tables { tables, now: index, is_following, was_active } => {
                let Some((_, points)) = tables.get_mut(*index).filter(|(start, _)| *start <= now) else {
                    return Way::Points { point: None, follow: *is_following };
                };
                // Between a frame and the answer that knows of it a few points are under way.
                let point = points.next(feedback.way.buffer_free).and_then(SegmentCommand::encode);
                *is_following |= points.sent() >= AHEAD || points.is_over();
                if *was_active && !feedback.way.is_active && points.is_over() {
                    (*is_following, *was_active) = (false, false);
                    *index += 1;
                } else {
                    *was_active |= feedback.way.is_active && *is_following;
                }
                Way::Points { point, follow: *is_following }
            }
        }
    }
}
