//! `MAM`: Rockwell's Motion Axis Move, as a block of this axis.
//!
//! It moves from rest to rest by the [two profiles](servobench_motion::rockwell) of that instruction, and begins at Standstill only:
//! the instruction's effects on an active motion (merging, a change of its dynamics) are left to the blocks of the standard. The
//! configured jerk of the axis is its limit of jerk.
//!
//! | output | TRUE |
//! |---|---|
//! | EN | while Execute is, and until the move is over |
//! | DN | from when the move has begun, until Execute rises again |
//! | ER | when the move was refused or has failed, until Execute rises again |
//! | IP, AC | while the move is under way |
//! | PC | at the target, until Execute rises again |
//!
//! A move from which another command takes the axis ends without PC and without ER, as that of the instruction does; CommandAborted
//! is then TRUE, as with the blocks of the standard.
//!
//! Source: Rockwell Automation, *Logix5000 Controllers Motion Instructions*, MOTION-RM002, "Motion Axis Move".
use super::execution::Report;
use super::outputs::FunctionBlock;
use super::profile::{Beyond, Call, Course, Leading};
use crate::axis::Axis;
use crate::blocks::{BlockName, Input};
use crate::command::{BufferMode, Ending};
use crate::error::{BlockError, ErrorId};
use crate::interface::{inputs, like, limit, optional, outputs, required};
use servobench_base::{Setpoint, Stateful};
use servobench_motion::rockwell::{Jerk, MaximumJerk, Move, Shape, ShapeKind};
use servobench_motion::{Limits, PlanError, Trajectory};

servobench_config::choices! {
    /// Meaning of the position of a move.
    #[derive(Stateful)]
    pub enum MoveType default Absolute {
        /// the position to move to
        Absolute = "absolute",
        /// the distance to move by
        Incremental = "incremental",
    }
}

/// Move from rest to rest by a trapezoid or an S-curve.
#[derive(Debug, Clone, PartialEq, Default, Stateful)]
pub struct AxisMove {
    leading: Leading,
    way: Way,
    last: AxisMoveOutputs,
    execute: bool,
}

inputs! {
    /// Inputs of [`AxisMove`].
    pub struct AxisMoveInputs on execute {
        /// Move type.
        move_type: MoveType = optional(Input::MoveType),
        /// Position: target or distance (m or rad).
        position: f64 = required(Input::Position),
        /// Speed (m/s or rad/s).
        velocity: f64 = limit(Input::Velocity),
        /// Accel rate (m/s² or rad/s²).
        acceleration: f64 = limit(Input::Acceleration),
        /// Decel rate (m/s² or rad/s²).
        deceleration: f64 = like(Input::Deceleration, Input::Acceleration),
        /// Profile.
        shape: ShapeKind = optional(Input::Shape),
        /// Accel jerk in units per second cubed (m/s³ or rad/s³).
        jerk: Option<f64> = optional(Input::Jerk),
        /// Accel jerk as the part of the ramp in which the acceleration changes (above 0 to 1).
        jerk_of_time: Option<f64> = optional(Input::JerkOfTime),
        /// Accel jerk as a part of that of the axis (above 0 to 1).
        jerk_of_maximum: Option<f64> = optional(Input::JerkOfMaximum),
        /// Accel jerk as the time in which the acceleration rises, and falls (s).
        jerk_time: Option<f64> = optional(Input::JerkTime),
        /// Decel jerk (m/s³ or rad/s³).
        deceleration_jerk: Option<f64> = optional(Input::DecelerationJerk),
        /// Decel jerk as the part of its ramp (above 0 to 1).
        deceleration_jerk_of_time: Option<f64> = optional(Input::DecelerationJerkOfTime),
        /// Decel jerk as a part of that of the axis (above 0 to 1).
        deceleration_jerk_of_maximum: Option<f64> = optional(Input::DecelerationJerkOfMaximum),
        /// Decel jerk as a time (s).
        deceleration_jerk_time: Option<f64> = optional(Input::DecelerationJerkTime),
    }
}

outputs! {
    /// Outputs of [`AxisMove`]: the bits of its motion control tag.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
    pub struct AxisMoveOutputs {
        /// EN.
        enabled: bool = MoveEnabled,
        /// DN.
        begun: bool = MoveBegun,
        /// ER.
        failed: bool = MoveFailed,
        /// IP.
        in_process: bool = InProcess,
        /// AC.
        active: bool = MoveActive,
        /// PC.
        complete: bool = ProcessComplete,
        /// CommandAborted, beside those of the tag: another command took the axis.
        command_aborted: bool = CommandAborted,
        /// ErrorID.
        error_id: ErrorId = ErrorId,
    }
}

impl AxisMoveInputs {
    /// Move to `position` as fast as `limits` allow, by a trapezoid; not executed.
    #[must_use]
    pub const fn to(position: f64, limits: &Limits) -> Self {
        Self {
            execute: false,
            move_type: MoveType::Absolute,
            position,
            velocity: limits.velocity,
            acceleration: limits.acceleration,
            deceleration: limits.acceleration,
            shape: ShapeKind::Trapezoid,
            jerk: None,
            jerk_of_time: None,
            jerk_of_maximum: None,
            jerk_time: None,
            deceleration_jerk: None,
            deceleration_jerk_of_time: None,
            deceleration_jerk_of_maximum: None,
            deceleration_jerk_time: None,
        }
    }

    /// Shape with its jerks.
    fn shape(&self) -> Result<Shape, BlockError> {
        let up = said([self.jerk, self.jerk_of_time, self.jerk_of_maximum, self.jerk_time], "AccelJerk")?;
        let down = said(
            [
                self.deceleration_jerk,
                self.deceleration_jerk_of_time,
                self.deceleration_jerk_of_maximum,
                self.deceleration_jerk_time,
            ],
            "DecelJerk",
        )?;
        match (self.shape, up.or(down)) {
            (ShapeKind::Trapezoid, None) => Ok(Shape::Trapezoid),
            (ShapeKind::Trapezoid, Some(_)) => {
                let (input, bound) =
                    ("AccelJerk", "left out with the profile \"trapezoid\", which takes all of that of the axis");
                Err(BlockError::Input { block: BlockName::AxisMove, input, value: 1.0, bound })
            }
            (ShapeKind::SCurve, _) => {
                let acceleration = up.unwrap_or(Jerk::PercentOfTime(100.0));
                Ok(Shape::SCurve { acceleration, deceleration: down.unwrap_or(acceleration) })
            }
        }
    }

    /// Checks everything that does not require an axis at rest.
    fn check(&self, axis: &Axis) -> Result<(), BlockError> {
        let block = BlockName::AxisMove;
        let limits = &axis.params().limits;
        for (input, value, limit) in [
            ("Speed", self.velocity, limits.velocity),
            ("AccelRate", self.acceleration, limits.acceleration),
            ("DecelRate", self.deceleration, limits.acceleration),
        ] {
            if value > limit {
                return Err(BlockError::AboveLimit { block, input, value, limit });
            }
        }
        if self.move_type == MoveType::Absolute && !axis.has_reference(BufferMode::Aborting) {
            return Err(BlockError::NotHomed { block, value: self.position });
        }
        let shape = self.shape()?;
        if shape == Shape::Trapezoid && limits.jerk.is_infinite() {
            let bound = "\"s-curve\" on an axis without a limit of jerk, which a trapezoid takes";
            return Err(BlockError::Input { block, input: "Profile", value: f64::INFINITY, bound });
        }
        let asked = self.asked(shape, self.position);
        asked.plan(&maximum(limits)).map_err(|error| BlockError::Plan { block, error })?;
        Ok(())
    }

    const fn asked(&self, shape: Shape, distance: f64) -> Move {
        let Self { velocity: speed, acceleration, deceleration, .. } = *self;
        Move { distance, speed, acceleration, deceleration, shape }
    }
}

/// Jerk from one of four inputs: value, part of the time, part of that of the axis, time.
fn said(inputs: [Option<f64>; 4], input: &'static str) -> Result<Option<Jerk>, BlockError> {
    let mut given = inputs.into_iter().enumerate().filter_map(|(way, value)| Some((way, value?)));
    let Some((way, value)) = given.next() else { return Ok(None) };
    if let Some((_, value)) = given.next() {
        let bound = "given in one form: as a value, a part of the time, a part of that of the axis, or a time";
        return Err(BlockError::Input { block: BlockName::AxisMove, input, value, bound });
    }
    Ok(Some(match way {
        0 => Jerk::Value(value),
        1 => Jerk::PercentOfTime(100.0 * value),
        2 => Jerk::PercentOfMaximum(100.0 * value),
        _ => Jerk::Time(value),
    }))
}

const fn maximum(limits: &Limits) -> MaximumJerk {
    MaximumJerk { acceleration: limits.jerk, deceleration: limits.jerk }
}

/// Trajectory of a move.
#[derive(Debug, Clone, PartialEq, Default, Stateful)]
struct Way {
    asked: Option<(Move, MoveType, MaximumJerk)>,
    origin: f64,
    trajectory: Option<Trajectory<7>>,
}

impl Way {
    fn plan(&self, from: f64) -> Result<Trajectory<7>, PlanError> {
        let Some((asked, move_type, maximum)) = &self.asked else { return Err(PlanError::TooFewPoints { points: 0 }) };
        let distance = match move_type {
            MoveType::Absolute => asked.distance - from,
            MoveType::Incremental => asked.distance,
        };
        Move { distance, ..*asked }.plan(maximum)
    }
}

impl Course for Way {
    fn begin(&mut self, from: &Setpoint) {
        (self.origin, self.trajectory) = (from.x, self.plan(from.x).ok());
    }

    fn at(&mut self, t: f64) -> Setpoint {
        let Some(trajectory) = &self.trajectory else {
            return Setpoint { v: f64::NAN, ..Setpoint::at_rest(self.origin) };
        };
        if let Some((Move { distance, .. }, MoveType::Absolute, _)) = self.asked
            && t >= trajectory.duration()
        {
            // The target bit for bit.
            return Setpoint::at_rest(distance);
        }
        let at = trajectory.at(t);
        Setpoint { x: self.origin + at.x, ..at }
    }

    fn duration(&self) -> f64 {
        self.trajectory.as_ref().map_or(0.0, Trajectory::duration)
    }

    fn beyond(&self, limits: &Limits) -> Option<Beyond> {
        let Some(trajectory) = &self.trajectory else {
            return Beyond::within(&Setpoint { v: f64::NAN, ..Setpoint::default() }, 0.0, limits);
        };
        trajectory.segments().find_map(|segment| Beyond::within(&trajectory.at(segment.start), segment.length, limits))
    }
}

impl FunctionBlock for AxisMove {
    const NAME: BlockName = BlockName::AxisMove;
    type Inputs<'i> = AxisMoveInputs;
    type Outputs = AxisMoveOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &AxisMoveInputs) -> AxisMoveOutputs {
        let (buffer_mode, ending) = (BufferMode::Aborting, Ending::AtRest);
        let call = Call { block: Self::NAME, execute: inputs.execute, ending, buffer_mode };
        let maximum = maximum(&axis.params().limits);
        let load = |way: &mut Way| {
            way.asked =
                inputs.shape().ok().map(|shape| (inputs.asked(shape, inputs.position), inputs.move_type, maximum));
        };
        let report = self.leading.step(axis, call, &mut self.way, |_, axis| inputs.check(axis), load);
        let was_executed = core::mem::replace(&mut self.execute, inputs.execute);
        let last = if inputs.execute && !was_executed { AxisMoveOutputs::default() } else { self.last };
        let in_process = report.is_busy();
        let failed = matches!(report, Report::Error(_));
        self.last = AxisMoveOutputs {
            enabled: inputs.execute || in_process,
            begun: last.begun || in_process || report == Report::Done,
            failed: last.failed || failed,
            in_process,
            active: report.is_active(),
            complete: last.complete || report == Report::Done,
            command_aborted: report == Report::Aborted,
            error_id: if failed { report.error_id() } else { last.error_id },
        };
        self.last
    }

    fn error(&self) -> Option<&BlockError> {
        self.leading.execution.error()
    }
}
