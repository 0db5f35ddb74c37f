//! The moves of a program as a drive makes them by itself, in profile position, profile velocity or interpolated position.
//!
//! What the drive is sent stands in the plans of the moves: their targets, the commands of a position profile, or the points of
//! a table, which any other move has become in the program. Times count from the cycle in which the axis is powered.
use super::Step;
use super::program_cursor::ProgramCursor;
use super::targets::Targets;
use crate::error::BuildError;
use servobench_base::{Request, Stateful};
use servobench_cia402::interpolated::serial::Message;
use servobench_drive::device;
use servobench_fieldbus::trajectory::{PointEncoding, Stream, Timing, points};
use servobench_fieldbus::{AxisCommand, AxisFeedback, ProfileCommand, Task};
use servobench_motion::position_profile::Command;
use servobench_planner::PlanDetails;
use servobench_scenario::{Bus, BusMode};
use servobench_trace::Recorder;

/// How far before its time a cycle may be by rounding (s).
const ROUNDING: f64 = 1e-9;

/// A program of ways under way.
#[derive(Debug, Stateful)]
pub(super) struct DriveProfile {
    moves: ProgramCursor,
    orders: Orders,
    /// By how much later than the program the drive begins each move (s), where points wait in its buffer; empty where none do.
    #[state(constant)]
    lags: Vec<f64>,
    /// The ways of a drive that is told targets.
    #[state(constant)]
    targets: Option<Targets>,
}

/// What is sent.
#[derive(Debug, Stateful)]
#[state(fixed)]
enum Orders {
    /// Set-points: when, where to, and the largest velocity and acceleration.
    Positions {
        #[state(constant)]
        set_points: Vec<(f64, [f64; 3])>,
        sent: usize,
    },
    /// Velocities: when, and which.
    Velocities {
        #[state(constant)]
        commands: Vec<Command>,
        next: usize,
        now: Command,
    },
    /// Tables, point by point.
    Tables(Stream),
}

impl DriveProfile {
    /// The way of `moves` over `bus`, made by `drive`, which is told so late.
    ///
    /// # Errors
    /// [`BuildError`] names a point of a table that cannot be sent, or why none can, and a way that the drive cannot plan.
    pub(super) fn new(
        moves: ProgramCursor,
        bus: &Bus,
        drive: &device::Params,
        timing: Timing,
    ) -> Result<Self, BuildError> {
        let program = moves.program();
        let orders = match bus.mode {
            BusMode::ProfileVelocity => {
                let commands =
                    program.plans().flat_map(|(start, _, plan)| commands_of(start, plan.details(), plan.end().v));
                let now = Command { t: 0.0, velocity: 0.0, acceleration: 0.0 };
                Orders::Velocities { commands: commands.collect(), next: 0, now }
            }
            BusMode::InterpolatedPosition => {
                let encoding = PointEncoding::new(bus.point_transfer, drive.sub_mode, drive.segment)?;
                let counts = f64::from(bus.units.drive) / bus.units.axis;
                let tables = program.plans().map(|(start, from, plan)| {
                    let polynomials: Vec<_> = plan.spans().map(|span| (span.length, span.state)).collect();
                    Ok((start, points(polynomials, plan.end(), from, counts, encoding)?))
                });
                let stream = Stream::new(encoding, tables.collect::<Result<_, BuildError>>()?, timing);
                stream.check()?;
                Orders::Tables(stream)
            }
            BusMode::ProfilePosition | BusMode::CyclicPosition | BusMode::CyclicVelocity => {
                let set_points = program.plans().map(|(start, from, plan)| {
                    let [velocity, acceleration, ..] = plan.limits().map(|sides| sides.above);
                    (start, [from + plan.end().x, velocity, acceleration])
                });
                Orders::Positions { set_points: set_points.collect(), sent: 0 }
            }
        };
        let lags = match &orders {
            Orders::Tables(stream) => {
                let begun = stream.beginnings().into_iter();
                begun.zip(moves.program().plans()).map(|(begun, (start, ..))| begun - start).collect()
            }
            Orders::Positions { .. } | Orders::Velocities { .. } => Vec::new(),
        };
        let is_told = matches!(orders, Orders::Positions { .. });
        let targets = is_told.then(|| Targets::of(moves.program(), drive, timing.task)).transpose()?;
        Ok(Self { moves, orders, lags, targets })
    }

    pub(super) const fn moves(&self) -> &ProgramCursor {
        &self.moves
    }

    /// By how much later than the program the drive begins each move (s); empty where it begins with it.
    pub(super) const fn lags(&self) -> &[f64] {
        self.lags.as_slice()
    }

    /// Notes the moves as the drive makes them; they reach the axis `delay` (s) later.
    pub(super) fn note(&self, delay: f64, recorder: &mut Recorder) {
        let moves = self.moves.moves(delay);
        if let Some(targets) = &self.targets {
            targets.made(moves).for_each(|made| recorder.note_move(made));
        } else {
            let lags = self.lags.iter().copied().chain(core::iter::repeat(0.0));
            moves.zip(lags).for_each(|(made, lag)| recorder.note_move(made.later(lag)));
        }
    }

    /// The ways of a drive that is told targets.
    pub(super) const fn targets(&self) -> Option<&Targets> {
        self.targets.as_ref()
    }

    /// What goes over the serial interface of the drive in this cycle.
    pub(super) const fn message(&mut self) -> Option<Message> {
        match &mut self.orders {
            Orders::Tables(stream) => stream.message(),
            Orders::Positions { .. } | Orders::Velocities { .. } => None,
        }
    }

    /// One cycle.
    pub(super) fn cycle(&mut self, feedback: &AxisFeedback) -> Step {
        let now = self.moves.cycle(feedback);
        // Before the axis is powered nothing is due.
        let way = self.orders.way(now.map_or(f64::NEG_INFINITY, |now| now + ROUNDING), feedback);
        // In profile velocity the drive knows no position: the plan says where the axis is to be. In the other modes the drive's
        // own set-point does.
        let setpoint = matches!(self.orders, Orders::Velocities { .. }).then(|| self.moves.at(now.unwrap_or(0.0)));
        Step { command: AxisCommand::of(Task::Drive(way)), setpoint, request: Request::Nothing }
    }
}

/// The velocities of a move that begins at `start` (s) and ends at `end`.
fn commands_of(start: f64, details: &PlanDetails, end: f64) -> Vec<Command> {
    match details {
        PlanDetails::Commands { commands, .. } => {
            commands.iter().map(|command| Command { t: start + command.t, ..*command }).collect()
        }
        _ => vec![Command { t: start, velocity: end, acceleration: 0.0 }],
    }
}

impl Orders {
    /// What is sent at `now` (s).
    fn way(&mut self, now: f64, feedback: &AxisFeedback) -> ProfileCommand {
        match self {
            Self::Positions { set_points, sent } => {
                // The next one is asked for when its time has come and the drive has taken the last.
                let taken = feedback.profile.acknowledged as usize == *sent;
                if taken && set_points.get(*sent).is_some_and(|(start, _)| *start <= now) {
                    *sent += 1;
                }
                let asked = sent.checked_sub(1).and_then(|index| set_points.get(index));
                let [position, velocity, acceleration] =
                    asked.map_or([feedback.position, 0.0, 0.0], |(_, set_point)| *set_point);
                #[expect(clippy::cast_possible_truncation, reason = "a program has fewer steps")]
                ProfileCommand::Position { number: *sent as u32, position, velocity, acceleration }
            }
            Self::Velocities { commands, next, now: present } => {
                while let Some(command) = commands.get(*next).filter(|command| command.t <= now) {
                    *present = *command;
                    *next += 1;
                }
                let Command { velocity, acceleration, .. } = *present;
                ProfileCommand::Velocity { velocity, acceleration }
            }
            Self::Tables(stream) => stream.cycle(now, &feedback.profile),
        }
    }
}
