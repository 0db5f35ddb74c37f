//! What the blocks that follow a table have in common: its pairs, and how the axis is led along it.
//!
//! # The table
//!
//! PLCopen part 1, version 2.0, sections 3.14 to 3.16, leaves the type of the table to the supplier and gives an example, which
//! is the one here: pairs of the time since the pair before and a value, for any number of them. Between the pairs position,
//! velocity or acceleration goes in the way that the block says; where the axis is when the block takes it is before the first.
//! A first pair without time says where the axis must be then: what it would have to jump is beyond its limits.
//!
//! Each value is scaled and moved by the offset, each time scaled by `TimeScale`.
//!
//! # On the way
//!
//! The set-points are those of the profile at the cycles. A block that follows a profile is called in every cycle until it is
//! done. A profile that does not keep the limits of the axis is refused; where it begins later, behind another command, or in
//! the place of one of the same instance, it stops the axis with an error when it begins. `MC_SetOverride` does not act on it
//! (which the standard leaves to the supplier).
use super::execution::{Execution, Report};
use crate::axis::Axis;
use crate::blocks::{BlockName, Input};
use crate::command::{BufferMode, Command, Dynamics, Ending, Goal};
use crate::error::BlockError;
use crate::interface::{BlockInput, Tables, Values, or};
use crate::ledger::{CommandId, Progress};
use crate::state::AxisState;
use servobench_base::{Setpoint, Stateful};
use servobench_motion::position_profile::VelocityRamp;
use servobench_motion::{Limits, PlanError};

/// A row of a table: `DeltaTime` and `Position`, `Velocity` or `Acceleration`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct Pair {
    /// Time since the pair before, or since the start (s): positive, but for the first pair, and those of accelerations that jump.
    pub delta_time: f64,
    /// Position, velocity or acceleration (SI).
    pub value: f64,
}

/// Memory for a table: an array, a slice that is lent, or a vector.
pub trait Memory<T>: AsRef<[T]> + AsMut<[T]> {}

impl<T, M: AsRef<[T]> + AsMut<[T]>> Memory<T> for M {}

/// # Errors
/// [`BlockError::Plan`] when the memory `name` is shorter than `points`.
pub(super) fn check_room(
    block: BlockName,
    name: &'static str,
    memory: &[impl Sized],
    points: usize,
) -> Result<(), BlockError> {
    let length = memory.len();
    if length < points {
        return Err(BlockError::Plan { block, error: PlanError::ShortSlice { name, length, points } });
    }
    Ok(())
}

/// The rows of the table; none where there is no table.
pub(super) fn pairs<T: Tables>(values: &Values<T>) -> &[Pair] {
    values.table(Input::Table).and_then(Tables::profile).map_or(&[], |table| table.pairs)
}

pub(super) const TIME_SCALE: BlockInput = or(Input::TimeScale, 1.0);
pub(super) const VALUE_SCALE: BlockInput = or(Input::ValueScale, 1.0);

/// What the inputs of the block make of a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scales {
    pub(super) time: f64,
    pub(super) value: f64,
    pub(super) offset: f64,
}

impl Scales {
    pub(super) const NONE: Self = Self { time: 1.0, value: 1.0, offset: 0.0 };

    /// `pair` after scaling.
    pub(super) fn of(&self, pair: &Pair) -> Pair {
        Pair { delta_time: self.time * pair.delta_time, value: self.value * pair.value + self.offset }
    }

    /// Checks the inputs by the names that they have at `block`, and the table that they are for.
    pub(super) fn check(&self, block: BlockName, names: &Names, pairs: &[Pair]) -> Result<(), BlockError> {
        let Self { time, value, offset } = *self;
        let refuse = |input, value, bound| Err(BlockError::Input { block, input, value, bound });
        if !(1.0 / LARGEST..=LARGEST).contains(&time) {
            return refuse("TimeScale", time, "positive, from 1e-15 to 1e15");
        }
        if !(1.0 / LARGEST..=LARGEST).contains(&value.abs()) {
            return refuse(names.scale, value, "other than zero, from 1e-15 to 1e15 in magnitude");
        }
        if !within(offset) {
            return refuse("Offset", offset, "a number within ±1e15");
        }
        if pairs.is_empty() {
            return refuse(names.table, 0.0, "a table of one pair at least");
        }
        for (i, pair) in pairs.iter().enumerate() {
            let Pair { delta_time, value } = self.of(pair);
            if !within(delta_time) || delta_time < 0.0 {
                return refuse(names.table, pair.delta_time, "a table of times since the pair before, none negative");
            }
            if delta_time < 1.0 / LARGEST && i > 0 && !names.may_jump {
                return refuse(names.table, pair.delta_time, "a table of positive times since the pair before");
            }
            if !within(value) {
                return refuse(names.table, pair.value, "a table of values within ±1e15, scaled and moved");
            }
        }
        Ok(())
    }
}

/// What is larger, or smaller than its inverse, was written in the wrong unit.
const LARGEST: f64 = 1e15;

fn within(value: f64) -> bool {
    value.abs() <= LARGEST
}

/// What the inputs of a block are called.
#[derive(Debug, Clone, Copy)]
pub(super) struct Names {
    pub(super) table: &'static str,
    pub(super) scale: &'static str,
    /// Whether a value may jump.
    pub(super) may_jump: bool,
}

/// What a block leads the axis along.
pub(super) trait Course {
    /// Begins where the axis is; as often as that is asked after it was loaded.
    fn begin(&mut self, from: &Setpoint);

    /// The set-point `t` seconds after the beginning; asked in the order of time.
    fn at(&mut self, t: f64) -> Setpoint;

    /// The line of velocity that leads to the set-point of `t`, for a drive that is told velocities; `None` for one that lasts a cycle.
    fn ramp(&self, t: f64) -> Option<VelocityRamp> {
        let _ = t;
        None
    }

    /// Duration (s).
    fn duration(&self) -> f64;

    /// What of it, once it has begun, is beyond `limits`, if anything is.
    fn beyond(&self, limits: &Limits) -> Option<Beyond>;
}

/// A quantity beyond a limit of the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Beyond {
    quantity: &'static str,
    value: f64,
    limit: f64,
}

impl Beyond {
    /// What is beyond `limits` from `from` on for `length` seconds, in which the jerk is constant.
    pub(super) fn within(from: &Setpoint, length: f64, limits: &Limits) -> Option<Self> {
        let (end, turn) = (from.after(length), -from.a / from.j);
        let fastest = if turn > 0.0 && turn < length { from.after(turn).v } else { from.v };
        let values = [
            ("velocity of the profile", from.v, limits.velocity),
            ("velocity of the profile", fastest, limits.velocity),
            ("velocity of the profile", end.v, limits.velocity),
            ("acceleration of the profile", from.a, limits.acceleration),
            ("acceleration of the profile", end.a, limits.acceleration),
            ("jerk of the profile", from.j, limits.jerk),
        ];
        let beyond = |value: f64, limit: f64| value.is_nan() || value.abs() > limit * (1.0 + ROUNDING);
        let found = values.into_iter().find(|(_, value, limit)| beyond(*value, *limit));
        found.map(|(quantity, value, limit)| Self { quantity, value, limit })
    }
}

/// What rounding may be, as a part of a limit, or of a cycle in which a profile ends.
pub(super) const ROUNDING: f64 = 1e-9;

/// The inputs of a call that are not the table's.
#[derive(Debug, Clone, Copy)]
pub(super) struct Call {
    pub(super) block: BlockName,
    pub(super) execute: bool,
    pub(super) ending: Ending,
    pub(super) buffer_mode: BufferMode,
}

/// Execute and the command that leads the axis.
#[derive(Debug, Clone, PartialEq, Default, Stateful)]
pub(super) struct Leading {
    pub(super) execution: Execution,
    id: Option<CommandId>,
}

impl Leading {
    /// One call: `check` looks at the inputs, before anything is changed, and `load` takes them over.
    pub(super) fn step<C: Course>(
        &mut self,
        axis: &mut Axis,
        call: Call,
        course: &mut C,
        check: impl FnOnce(&C, &Axis) -> Result<(), BlockError>,
        load: impl Fn(&mut C),
    ) -> Report {
        let Call { block, execute, ending, buffer_mode } = call;
        self.go_on(axis, course);
        let Self { execution, id } = self;
        let mut has_begun = false;
        let report = execution.step(axis, execute, |axis| {
            check(course, axis)?;
            let is_aborting = buffer_mode == BufferMode::Aborting;
            let limits = &axis.params().limits;
            if id.is_none() {
                load(course);
                if is_aborting || axis.state() == AxisState::Standstill {
                    course.begin(&axis.commanded());
                    has_begun = true;
                    if let Some(Beyond { quantity: input, value, limit }) = course.beyond(limits) {
                        return Err(BlockError::AboveLimit { block, input, value, limit });
                    }
                }
            } else if !is_aborting {
                // One instance holds one course.
                return Err(BlockError::BufferFull { block, held: 1 });
            }
            let goal = Goal::Led(ending);
            let issued = axis.submit(Command { block, goal, dynamics: dynamics(axis), buffer_mode })?;
            if id.is_some() {
                load(course);
            }
            *id = Some(issued);
            Ok(*id)
        });
        if has_begun {
            // Where another block led the axis in the cycle before and not yet in this one.
            self.lead(axis, course);
        } else {
            self.begin(axis, course);
        }
        report
    }

    /// Begins where the command has just got the axis.
    fn begin(&self, axis: &mut Axis, course: &mut impl Course) {
        let Some(id) = self.id.filter(|id| axis.led_cycles(*id) == Some(0)) else { return };
        course.begin(&axis.commanded());
        axis.begin_leading(id);
        if let Some(Beyond { quantity, value, limit }) = course.beyond(&axis.params().limits) {
            axis.abandon(id, quantity, value, limit);
        }
    }

    /// Goes on along the course, as long as the command has the axis.
    fn go_on(&mut self, axis: &mut Axis, course: &mut impl Course) {
        let Some(id) = self.id else { return };
        if matches!(axis.progress(id), Progress::Done | Progress::Aborted | Progress::Failed) {
            self.id = None;
            return;
        }
        self.lead(axis, course);
    }

    /// Gives the set-point of this cycle, where the command has the axis and it is not there yet.
    fn lead(&mut self, axis: &mut Axis, course: &mut impl Course) {
        let Some(id) = self.id else { return };
        let (cycle_time, Some(cycles)) = (axis.params().cycle_time, axis.led_cycles(id)) else { return };
        if cycles > 0 {
            let (t, end) = (cycles as f64 * cycle_time, course.duration());
            let is_over = t >= end - ROUNDING * cycle_time;
            axis.lead(id, course.at(if is_over { t.max(end) } else { t }));
            if axis.params().velocity_ramps.is_some() {
                axis.lead_along(id, course.ramp(t));
            }
            if is_over {
                axis.conclude(id);
                self.id = None;
            }
        }
    }
}

/// What the axis does with the velocity at the end, when nothing follows: it keeps it, within its limits.
fn dynamics(axis: &Axis) -> Dynamics {
    let limits = &axis.params().limits;
    let (velocity, acceleration) = (limits.velocity, limits.acceleration);
    Dynamics { velocity: Some(velocity), acceleration, deceleration: acceleration, jerk: None, snap: None }
}
