//! `MC_VelocityProfile` and `MC_AccelerationProfile`: motion along a table of velocities or accelerations.
//!
//! The velocity is linear from that of the axis to those of the pairs; so is the acceleration, whose velocity consists of parabolas. Behind
//! the last pair the velocity is kept and the acceleration zero (PLCopen part 1, version 2.0, sections 3.15 and 3.16), and the axis stays
//! in Continuous Motion.
use super::outputs::FunctionBlock;
use super::profile::{
    Beyond, Call, Course, Leading, Memory, Names, Pair, ROUNDING, Scales, TIME_SCALE, VALUE_SCALE, check_room, pairs,
};
use crate::axis::Axis;
use crate::blocks::{BlockName, Input};
use crate::command::{BufferMode, Ending};
use crate::error::BlockError;
use crate::interface::{
    BlockInput, BlockInputs, FromValues as _, Tables, Trigger, Values, buffer_mode, command_outputs, or, required,
};
use servobench_base::{Setpoint, Stateful};
use servobench_motion::Limits;

/// Moves along a table of velocities, which it keeps in the memory `M`.
#[derive(Debug, Clone, PartialEq, Stateful)]
pub struct VelocityProfile<M> {
    leading: Leading,
    sequence: Sequence<M>,
}

/// Moves along a table of accelerations, which it keeps in the memory `M`.
#[derive(Debug, Clone, PartialEq, Stateful)]
pub struct AccelerationProfile<M> {
    leading: Leading,
    sequence: Sequence<M>,
}

impl<M: Memory<Pair>> VelocityProfile<M> {
    /// A block with memory for a table of as many pairs as `pairs` holds.
    #[must_use]
    pub fn new(pairs: M) -> Self {
        Self { leading: Leading::default(), sequence: Sequence::new(pairs, Quantity::Velocity) }
    }
}

impl<M: Memory<Pair>> AccelerationProfile<M> {
    /// A block with memory for a table of as many pairs as `pairs` holds.
    #[must_use]
    pub fn new(pairs: M) -> Self {
        Self { leading: Leading::default(), sequence: Sequence::new(pairs, Quantity::Acceleration) }
    }
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
    /// Inputs for `time_velocity`, unscaled, not executed.
    #[must_use]
    pub fn along(time_velocity: &'a [Pair]) -> Self {
        let Scales { time: time_scale, value: velocity_scale, offset } = Scales::NONE;
        let buffer_mode = BufferMode::default();
        Self { execute: false, time_velocity, time_scale, velocity_scale, offset, buffer_mode }
    }
}

impl<'a> AccelerationProfileInputs<'a> {
    /// Inputs for `time_acceleration`, unscaled, not executed.
    #[must_use]
    pub fn along(time_acceleration: &'a [Pair]) -> Self {
        let Scales { time: time_scale, value: acceleration_scale, offset } = Scales::NONE;
        let buffer_mode = BufferMode::default();
        Self { execute: false, time_acceleration, time_scale, acceleration_scale, offset, buffer_mode }
    }
}

impl<'i> BlockInputs<'i> for VelocityProfileInputs<'i> {
    const TRIGGER: Trigger = Trigger::Execute;
    const INPUTS: &'static [BlockInput] =
        &[required(Input::Table), TIME_SCALE, VALUE_SCALE, VELOCITY_OFFSET, buffer_mode()];

    fn read<T: Tables>(values: &'i Values<T>, execute: bool) -> Self {
        Self {
            execute,
            time_velocity: pairs(values),
            time_scale: f64::read(values, &TIME_SCALE),
            velocity_scale: f64::read(values, &VALUE_SCALE),
            offset: f64::read(values, &VELOCITY_OFFSET),
            buffer_mode: BufferMode::read(values, &buffer_mode()),
        }
    }
}

impl<'i> BlockInputs<'i> for AccelerationProfileInputs<'i> {
    const TRIGGER: Trigger = Trigger::Execute;
    const INPUTS: &'static [BlockInput] =
        &[required(Input::Table), TIME_SCALE, VALUE_SCALE, ACCELERATION_OFFSET, buffer_mode()];

    fn read<T: Tables>(values: &'i Values<T>, execute: bool) -> Self {
        Self {
            execute,
            time_acceleration: pairs(values),
            time_scale: f64::read(values, &TIME_SCALE),
            acceleration_scale: f64::read(values, &VALUE_SCALE),
            offset: f64::read(values, &ACCELERATION_OFFSET),
            buffer_mode: BufferMode::read(values, &buffer_mode()),
        }
    }
}

const VELOCITY_OFFSET: BlockInput = or(Input::VelocityOffset, 0.0);
const ACCELERATION_OFFSET: BlockInput = or(Input::AccelerationOffset, 0.0);

impl VelocityProfileInputs<'_> {
    const fn scales(&self) -> Scales {
        Scales { time: self.time_scale, value: self.velocity_scale, offset: self.offset }
    }

    /// Pairs after scaling and offset.
    pub fn scaled(&self) -> impl Iterator<Item = Pair> {
        let scales = self.scales();
        self.time_velocity.iter().map(move |pair| scales.of(pair))
    }
}

impl AccelerationProfileInputs<'_> {
    const fn scales(&self) -> Scales {
        Scales { time: self.time_scale, value: self.acceleration_scale, offset: self.offset }
    }

    /// Pairs after scaling and offset.
    pub fn scaled(&self) -> impl Iterator<Item = Pair> {
        let scales = self.scales();
        self.time_acceleration.iter().map(move |pair| scales.of(pair))
    }
}

#[cfg(feature = "program")]
impl crate::program::New for VelocityProfile<alloc::vec::Vec<Pair>> {
    fn new_for(inputs: &crate::program::Inputs) -> Self {
        Self::new(alloc::vec![Pair::default(); pairs(inputs).len()])
    }
}

#[cfg(feature = "program")]
impl crate::program::New for AccelerationProfile<alloc::vec::Vec<Pair>> {
    fn new_for(inputs: &crate::program::Inputs) -> Self {
        Self::new(alloc::vec![Pair::default(); pairs(inputs).len()])
    }
}

impl<M: Memory<Pair>> FunctionBlock for VelocityProfile<M> {
    const NAME: BlockName = BlockName::VelocityProfile;
    type Inputs<'i> = VelocityProfileInputs<'i>;
    type Outputs = ProfileOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &VelocityProfileInputs<'_>) -> ProfileOutputs {
        let VelocityProfileInputs { execute, time_velocity: pairs, buffer_mode, .. } = *inputs;
        let scales = inputs.scales();
        let names = Names { table: "TimeVelocity", scale: "VelocityScale", may_jump: false };
        let call = Call { block: Self::NAME, execute, ending: Ending::Moving, buffer_mode };
        let check = |sequence: &Sequence<M>, _: &Axis| {
            scales.check(Self::NAME, &names, pairs)?;
            check_room(Self::NAME, "pairs", sequence.memory.as_ref(), pairs.len())
        };
        let load = |sequence: &mut Sequence<M>| sequence.load(pairs, &scales);
        self.leading.step(axis, call, &mut self.sequence, check, load).into()
    }

    fn error(&self) -> Option<&BlockError> {
        self.leading.execution.error()
    }
}

impl<M: Memory<Pair>> FunctionBlock for AccelerationProfile<M> {
    const NAME: BlockName = BlockName::AccelerationProfile;
    type Inputs<'i> = AccelerationProfileInputs<'i>;
    type Outputs = ProfileOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &AccelerationProfileInputs<'_>) -> ProfileOutputs {
        let AccelerationProfileInputs { execute, time_acceleration: pairs, buffer_mode, .. } = *inputs;
        let scales = inputs.scales();
        let names = Names { table: "TimeAcceleration", scale: "AccelerationScale", may_jump: true };
        let call = Call { block: Self::NAME, execute, ending: Ending::Moving, buffer_mode };
        let check = |sequence: &Sequence<M>, _: &Axis| {
            scales.check(Self::NAME, &names, pairs)?;
            check_room(Self::NAME, "pairs", sequence.memory.as_ref(), pairs.len())
        };
        let load = |sequence: &mut Sequence<M>| sequence.load(pairs, &scales);
        self.leading.step(axis, call, &mut self.sequence, check, load).into()
    }

    fn error(&self) -> Option<&BlockError> {
        self.leading.execution.error()
    }
}

/// Quantity in a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Stateful)]
enum Quantity {
    Velocity,
    Acceleration,
}

/// A table being followed.
#[derive(Debug, Clone, PartialEq, Stateful)]
struct Sequence<M> {
    /// Memory, whose first `count` elements are the pairs after scaling.
    memory: M,
    count: usize,
    quantity: Quantity,
    duration: f64,
    place: Place,
}

/// Next pair, with the state and time at the beginning of the stretch to it.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
struct Place {
    next: usize,
    anchor: Setpoint,
    began: f64,
}

/// Motion from a place on, and its end.
struct Stretch {
    from: Setpoint,
    length: f64,
    end: Place,
}

impl<M: Memory<Pair>> Sequence<M> {
    fn new(memory: M, quantity: Quantity) -> Self {
        Self { memory, count: 0, quantity, duration: 0.0, place: Place::default() }
    }

    /// Loads the table.
    fn load(&mut self, pairs: &[Pair], scales: &Scales) {
        self.count = pairs.len();
        for (own, pair) in self.memory.as_mut().iter_mut().zip(pairs) {
            *own = scales.of(pair);
        }
    }

    fn pairs(&self) -> &[Pair] {
        &self.memory.as_ref()[..self.count]
    }

    /// Stretch from `place` on; `None` behind the last pair.
    fn stretch(&self, place: &Place) -> Option<Stretch> {
        let Place { next, anchor, began } = *place;
        let Pair { delta_time: length, value } = *self.pairs().get(next)?;
        let is_jump = length == 0.0;
        let slope = |from: f64| if is_jump { 0.0 } else { (value - from) / length };
        let from = match self.quantity {
            Quantity::Velocity => Setpoint { a: slope(anchor.v), j: 0.0, ..anchor },
            Quantity::Acceleration => Setpoint { j: slope(anchor.a), ..anchor },
        };
        let end = from.after(length);
        let anchor = match self.quantity {
            Quantity::Velocity => Setpoint { v: value, ..end },
            Quantity::Acceleration => Setpoint { a: value, ..end },
        };
        Some(Stretch { from, length, end: Place { next: next + 1, anchor, began: began + length } })
    }
}

impl<M: Memory<Pair>> Course for Sequence<M> {
    fn begin(&mut self, from: &Setpoint) {
        self.place = Place { next: 0, anchor: Setpoint { j: 0.0, s: 0.0, ..*from }, began: 0.0 };
        self.duration = self.pairs().iter().map(|pair| pair.delta_time).sum();
    }

    fn at(&mut self, t: f64) -> Setpoint {
        while let Some(Stretch { from, end, .. }) = self.stretch(&self.place) {
            if t < end.began {
                return from.after(t - self.place.began);
            }
            self.place = end;
        }
        // Behind the last pair the velocity is kept.
        Setpoint { a: 0.0, j: 0.0, ..self.place.anchor }.after(t - self.place.began)
    }

    fn duration(&self) -> f64 {
        self.duration
    }

    fn beyond(&self, limits: &Limits) -> Option<Beyond> {
        let mut ahead = self.place;
        while let Some(Stretch { from, length, end }) = self.stretch(&ahead) {
            // No acceleration produces a jump of velocity.
            let jump = Setpoint { a: f64::INFINITY, ..from };
            let gap = (end.anchor.v - from.v).abs();
            let is_jump = length == 0.0 && gap > ROUNDING * limits.velocity;
            let found = Beyond::within(if is_jump { &jump } else { &from }, length, limits);
            if found.is_some() {
                return found;
            }
            ahead = end;
        }
        Beyond::within(&Setpoint { a: 0.0, j: 0.0, ..ahead.anchor }, 0.0, limits)
    }
}

command_outputs! {
    /// Outputs of [`VelocityProfile`] and [`AccelerationProfile`].
    pub struct ProfileOutputs;
    /// ProfileCompleted: the last pair is reached.
    profile_completed = ProfileCompleted by Done
}
