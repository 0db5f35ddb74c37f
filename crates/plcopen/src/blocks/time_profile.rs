//! `MC_VelocityProfile` and `MC_AccelerationProfile`: along a table of velocities or accelerations.
//!
//! The velocity goes in straight lines from that of the axis to those of the pairs; the acceleration likewise, so that the velocity
//! is made of parabolas. Behind the last pair the velocity is kept and the acceleration zero (PLCopen part 1, version 2.0,
//! sections 3.15 and 3.16), and the axis stays in Continuous Motion.
use super::execution::Report;
use super::outputs::{FunctionBlock, Outputs, flag, number};
use super::profile::{Beyond, Course, Leading, Names, Pair, ROUNDING, Scales};
use crate::axis::Axis;
use crate::command::BufferMode;
use crate::error::{BlockError, ErrorId};
use crate::name::BlockName;
use servobench_base::Setpoint;
use servobench_motion::Limits;

/// Along a table of velocities.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct VelocityProfile<'a> {
    leading: Leading,
    sequence: Sequence<'a>,
}

/// Along a table of accelerations.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AccelerationProfile<'a> {
    leading: Leading,
    sequence: Sequence<'a>,
}

/// Inputs of [`VelocityProfile`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VelocityProfileInputs<'a> {
    /// Execute.
    pub execute: bool,
    /// TimeVelocity: velocities with a sign (m/s or rad/s).
    pub time_velocity: &'a [Pair],
    /// TimeScale.
    pub time_scale: f64,
    /// VelocityScale.
    pub velocity_scale: f64,
    /// Offset (m/s or rad/s).
    pub offset: f64,
    /// BufferMode.
    pub buffer_mode: BufferMode,
}

/// Inputs of [`AccelerationProfile`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AccelerationProfileInputs<'a> {
    /// Execute.
    pub execute: bool,
    /// TimeAcceleration: accelerations with a sign (m/s² or rad/s²).
    pub time_acceleration: &'a [Pair],
    /// TimeScale.
    pub time_scale: f64,
    /// AccelerationScale.
    pub acceleration_scale: f64,
    /// Offset (m/s² or rad/s²).
    pub offset: f64,
    /// BufferMode.
    pub buffer_mode: BufferMode,
}

impl<'a> VelocityProfileInputs<'a> {
    /// Along `time_velocity` as it is, not executed.
    #[must_use]
    pub fn along(time_velocity: &'a [Pair]) -> Self {
        let Scales { time: time_scale, value: velocity_scale, offset } = Scales::NONE;
        let buffer_mode = BufferMode::default();
        Self { execute: false, time_velocity, time_scale, velocity_scale, offset, buffer_mode }
    }
}

impl<'a> AccelerationProfileInputs<'a> {
    /// Along `time_acceleration` as it is, not executed.
    #[must_use]
    pub fn along(time_acceleration: &'a [Pair]) -> Self {
        let Scales { time: time_scale, value: acceleration_scale, offset } = Scales::NONE;
        let buffer_mode = BufferMode::default();
        Self { execute: false, time_acceleration, time_scale, acceleration_scale, offset, buffer_mode }
    }
}

impl<'a> FunctionBlock for VelocityProfile<'a> {
    const NAME: BlockName = BlockName::VelocityProfile;
    type Inputs = VelocityProfileInputs<'a>;
    type Outputs = ProfileOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &VelocityProfileInputs<'a>) -> ProfileOutputs {
        let VelocityProfileInputs { execute, time_velocity: pairs, buffer_mode, .. } = *inputs;
        let scales = Scales { time: inputs.time_scale, value: inputs.velocity_scale, offset: inputs.offset };
        let names = Names { table: "TimeVelocity", scale: "VelocityScale", may_jump: false };
        let sequence = Sequence::new(pairs, scales, Quantity::Velocity);
        let call = (Self::NAME, execute, buffer_mode);
        let check = |_: &Sequence<'_>, _: &Axis| scales.check(Self::NAME, &names, pairs);
        self.leading.step(axis, call, &mut self.sequence, check, |course| *course = sequence).into()
    }

    fn error(&self) -> Option<&BlockError> {
        self.leading.execution.error()
    }
}

impl<'a> FunctionBlock for AccelerationProfile<'a> {
    const NAME: BlockName = BlockName::AccelerationProfile;
    type Inputs = AccelerationProfileInputs<'a>;
    type Outputs = ProfileOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &AccelerationProfileInputs<'a>) -> ProfileOutputs {
        let AccelerationProfileInputs { execute, time_acceleration: pairs, buffer_mode, .. } = *inputs;
        let scales = Scales { time: inputs.time_scale, value: inputs.acceleration_scale, offset: inputs.offset };
        let names = Names { table: "TimeAcceleration", scale: "AccelerationScale", may_jump: true };
        let sequence = Sequence::new(pairs, scales, Quantity::Acceleration);
        let call = (Self::NAME, execute, buffer_mode);
        let check = |_: &Sequence<'_>, _: &Axis| scales.check(Self::NAME, &names, pairs);
        self.leading.step(axis, call, &mut self.sequence, check, |course| *course = sequence).into()
    }

    fn error(&self) -> Option<&BlockError> {
        self.leading.execution.error()
    }
}

/// What the values of a table are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Quantity {
    #[default]
    Velocity,
    Acceleration,
}

/// A table on its way.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Sequence<'a> {
    pairs: &'a [Pair],
    scales: Scales,
    quantity: Quantity,
    duration: f64,
    /// The pair to which the way leads now, and where and when it began.
    next: usize,
    anchor: Setpoint,
    began: f64,
}

impl Default for Sequence<'_> {
    fn default() -> Self {
        Self::new(&[], Scales::NONE, Quantity::Velocity)
    }
}

impl<'a> Sequence<'a> {
    fn new(pairs: &'a [Pair], scales: Scales, quantity: Quantity) -> Self {
        Self { pairs, scales, quantity, duration: 0.0, next: 0, anchor: Setpoint::default(), began: 0.0 }
    }

    /// What holds from the anchor on, and where it leads when; `None` behind the last pair.
    fn stretch(&self) -> Option<(Setpoint, Setpoint, f64)> {
        let Pair { delta_time, value } = self.scales.of(self.pairs.get(self.next)?);
        let is_jump = delta_time == 0.0;
        let slope = |from: f64| if is_jump { 0.0 } else { (value - from) / delta_time };
        let from = match self.quantity {
            Quantity::Velocity => Setpoint { a: slope(self.anchor.v), j: 0.0, ..self.anchor },
            Quantity::Acceleration => Setpoint { j: slope(self.anchor.a), ..self.anchor },
        };
        let end = from.after(delta_time);
        let end = match self.quantity {
            Quantity::Velocity => Setpoint { v: value, ..end },
            Quantity::Acceleration => Setpoint { a: value, ..end },
        };
        Some((from, end, delta_time))
    }
}

impl Course for Sequence<'_> {
    fn begin(&mut self, from: &Setpoint) {
        (self.next, self.began, self.anchor) = (0, 0.0, Setpoint { j: 0.0, s: 0.0, ..*from });
        self.duration = self.pairs.iter().map(|pair| self.scales.of(pair).delta_time).sum();
    }

    fn at(&mut self, t: f64) -> Setpoint {
        while let Some((from, end, delta_time)) = self.stretch() {
            if t < self.began + delta_time {
                return from.after(t - self.began);
            }
            (self.next, self.anchor, self.began) = (self.next + 1, end, self.began + delta_time);
        }
        // Behind the last pair, at its velocity.
        Setpoint { a: 0.0, j: 0.0, ..self.anchor }.after(t - self.began)
    }

    fn duration(&self) -> f64 {
        self.duration
    }

    fn beyond(&self, limits: &Limits) -> Option<Beyond> {
        let mut ahead = *self;
        while let Some((from, end, delta_time)) = ahead.stretch() {
            // A jump of velocity is one that no acceleration makes.
            let jump = Setpoint { a: f64::INFINITY, ..from };
            let gap = (end.v - from.v).abs();
            let is_jump = delta_time == 0.0 && gap > ROUNDING * limits.velocity;
            let found = Beyond::within(if is_jump { &jump } else { &from }, delta_time, limits);
            if found.is_some() {
                return found;
            }
            (ahead.next, ahead.anchor) = (ahead.next + 1, end);
        }
        Beyond::within(&Setpoint { a: 0.0, j: 0.0, ..ahead.anchor }, 0.0, limits)
    }
}

/// Outputs of [`VelocityProfile`] and [`AccelerationProfile`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is an output of the standard")]
pub struct ProfileOutputs {
    /// ProfileCompleted: the last pair is reached.
    pub profile_completed: bool,
    /// Busy: there is something left to do.
    pub busy: bool,
    /// Active: the block has the axis.
    pub active: bool,
    /// CommandAborted: another command took the axis.
    pub command_aborted: bool,
    /// Error.
    pub error: bool,
    /// ErrorID.
    pub error_id: ErrorId,
}

impl From<Report> for ProfileOutputs {
    fn from(report: Report) -> Self {
        Self {
            profile_completed: report == Report::Done,
            busy: report.is_busy(),
            active: report.is_active(),
            command_aborted: report == Report::Aborted,
            error: report.error_id() != ErrorId::None,
            error_id: report.error_id(),
        }
    }
}

impl Outputs for ProfileOutputs {
    const NAMES: &'static [&'static str] =
        &["ProfileCompleted", "Busy", "Active", "CommandAborted", "Error", "ErrorID"];

    fn each(&self, record: impl FnMut(f64)) {
        let Self { profile_completed, busy, active, command_aborted, error, error_id } = *self;
        let flags = [profile_completed, busy, active, command_aborted, error].map(flag);
        flags.into_iter().chain([number(error_id)]).for_each(record);
    }
}
