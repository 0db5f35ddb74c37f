//! Common parts of the blocks that follow a table: its pairs, and leading the axis along it.
//!
//! # The table
//!
//! PLCopen part 1, version 2.0, sections 3.14 to 3.16, leaves the type of the table to the supplier and gives an example, which is
//! implemented here: any number of pairs of the time since the previous pair and a value. The block defines the interpolation of position,
//! velocity or acceleration between the pairs; the present state of the axis comes before the first one. A first pair without time defines
//! the state at the beginning: any jump to it is beyond the limits of the axis.
//!
//! Each value is scaled and shifted by the offset, each time scaled by `TimeScale`.
//!
//! # During the profile
//!
//! The set-points are those of the profile at the cycles. Call a block that follows a profile in every cycle until it is done. A profile
//! that exceeds the limits of the axis is refused; one that begins later, behind another command or in place of one of the same instance,
//! stops the axis with an error when it begins. `MC_SetOverride` does not act on it (which the standard leaves to the supplier).
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
    /// Time since the previous pair, or since the start (s): positive, but for the first pair and jumps of acceleration.
    pub delta_time: f64,
    /// Position, velocity or acceleration (SI).
    pub value: f64,
}

/// Memory for a table: an array, a borrowed slice, or a vector.
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

/// Rows of the table; empty if there is no table.
pub(super) fn pairs<T: Tables>(values: &Values<T>) -> &[Pair] {
    values.table(Input::Table).and_then(Tables::profile).map_or(&[], |table| table.pairs)
}

pub(super) const TIME_SCALE: BlockInput = or(Input::TimeScale, 1.0);
pub(super) const VALUE_SCALE: BlockInput = or(Input::ValueScale, 1.0);

/// Scaling of a table by the inputs of the block.
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

    /// Checks the inputs, by their names at `block`, and their table.
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

/// Largest plausible magnitude, and inverse of the smallest: a value outside was written in the wrong unit.
const LARGEST: f64 = 1e15;

fn within(value: f64) -> bool {
    value.abs() <= LARGEST
}

/// Names of a block's inputs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Names {
    pub(super) table: &'static str,
    pub(super) scale: &'static str,
    /// True if a value may jump.
    pub(super) may_jump: bool,
}

/// Trajectory along which a block leads the axis.
pub(super) trait Course {
    /// Begins at the set-point of the axis; may be called repeatedly after loading.
    fn begin(&mut self, from: &Setpoint);

    /// Set-point `t` seconds after the beginning; called in the order of time.
    fn at(&mut self, t: f64) -> Setpoint;

    /// Velocity ramp to the set-point at `t`, for a drive in velocity mode; `None` for a ramp of one cycle.
    fn ramp(&self, t: f64) -> Option<VelocityRamp> {
        let _ = t;
        None
    }

    /// Duration (s).
    fn duration(&self) -> f64;

    /// First excess of the trajectory, once begun, beyond `limits`.
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
    /// First excess beyond `limits` from `from` on for `length` seconds, in which the jerk is constant.
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

/// Tolerance for rounding, as a part of a limit, or of the cycle in which a profile ends.
pub(super) const ROUNDING: f64 = 1e-9;

/// Inputs of a call other than the table.
#[derive(Debug, Clone, Copy)]
pub(super) struct Call {
    pub(super) block: BlockName,
    pub(super) execute: bool,
    pub(super) ending: Ending,
    pub(super) buffer_mode: BufferMode,
}

/// Execute, and the command that leads the axis.
#[derive(Debug, Clone, PartialEq, Default, Stateful)]
pub(super) struct Leading {
    pub(super) execution: Execution,
    id: Option<CommandId>,
}

impl Leading {
    /// Handles one call: `check` validates the inputs before anything is changed, and `load` takes them over.
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
                // One instance holds one trajectory.
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
            // Another block may have led the axis in the cycle before and not yet in this one.
            self.lead(axis, course);
        } else {
            self.begin(axis, course);
        }
        report
    }

    /// Begins the trajectory if the command has just got the axis.
    fn begin(&self, axis: &mut Axis, course: &mut impl Course) {
        let Some(id) = self.id.filter(|id| axis.led_cycles(*id) == Some(0)) else { return };
        course.begin(&axis.commanded());
        axis.begin_leading(id);
        if let Some(Beyond { quantity, value, limit }) = course.beyond(&axis.params().limits) {
            axis.abandon(id, quantity, value, limit);
        }
    }

    /// Continues along the trajectory while the command has the axis.
    fn go_on(&mut self, axis: &mut Axis, course: &mut impl Course) {
        let Some(id) = self.id else { return };
        if matches!(axis.progress(id), Progress::Done | Progress::Aborted | Progress::Failed) {
            self.id = None;
            return;
        }
        self.lead(axis, course);
    }

    /// Gives the set-point of this cycle, if the command has the axis and has not given it yet.
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

/// Dynamics of the velocity after the end, when nothing follows: the axis keeps it, within its limits.
fn dynamics(axis: &Axis) -> Dynamics {
    let limits = &axis.params().limits;
    let (velocity, acceleration) = (limits.velocity, limits.acceleration);
    Dynamics { velocity: Some(velocity), acceleration, deceleration: acceleration, jerk: None, snap: None }
}
