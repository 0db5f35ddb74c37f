//! A block that gives one motion command.
use super::execution::{Execution, Report};
use super::outputs::{FunctionBlock, Outputs};
use crate::axis::Axis;
use crate::blocks::BlockName;
use crate::command::Command;
use crate::error::BlockError;
use crate::interface::BlockInputs;
use servobench_base::Stateful;

/// Inputs of a block that gives one motion command.
pub trait MotionInputs: Copy + PartialEq + for<'i> BlockInputs<'i> {
    /// Name of the block.
    const NAME: BlockName;
    /// Outputs of the block.
    type Outputs: Outputs + From<Report>;

    /// Execute.
    fn execute(&self) -> bool;

    /// ContinuousUpdate, for the blocks that have it.
    fn continuous_update(&self) -> bool {
        false
    }

    /// Command that these inputs request.
    fn command(&self) -> Command;
}

/// A block that gives one motion command.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct MotionBlock<I> {
    execution: Execution,
    /// Inputs in effect, if they may change.
    updated: Option<I>,
}

impl<I> Default for MotionBlock<I> {
    fn default() -> Self {
        Self { execution: Execution::default(), updated: None }
    }
}

impl<I: MotionInputs> FunctionBlock for MotionBlock<I> {
    const NAME: BlockName = I::NAME;
    type Inputs<'i> = I;
    type Outputs = I::Outputs;

    #[inline]
    fn step(&mut self, axis: &mut Axis, inputs: &I) -> I::Outputs {
        let updated = &mut self.updated;
        let report = self.execution.step(axis, inputs.execute(), |axis| {
            *updated = inputs.continuous_update().then_some(*inputs);
            axis.submit(inputs.command()).map(Some)
        });
        let report = match &mut self.updated {
            Some(latched) if report.is_busy() && inputs.execute() && *latched != *inputs => {
                *latched = *inputs;
                let changed = self.execution.running().map(|id| axis.update(id, inputs.command()));
                match changed {
                    Some(Err(error)) => self.execution.fail(error),
                    // The velocity that was reached may differ from the commanded one (section 2.4.1).
                    _ => self.execution.report(axis),
                }
            }
            _ => report,
        };
        report.into()
    }

    fn error(&self) -> Option<&BlockError> {
        self.execution.error()
    }
}

/// Declares the inputs of a block that moves to a goal within limits: its own ones, before and behind the limits that all such blocks have,
/// and the goal computed from them.
macro_rules! moves {
    (
        $(#[$meta:meta])*
        pub struct $inputs:ident of $block:ident -> $outputs:ty {
            $( $(#[$to_meta:meta])* $to:ident: $to_type:ty = $to_spec:expr, )+
        } {
            $( $(#[$way_meta:meta])* $way:ident: $way_type:ty = $way_spec:expr, )*
        }
        |$own:ident| $goal:expr
    ) => {
        $crate::interface::inputs! {
            $(#[$meta])*
            pub struct $inputs on execute {
                $( $(#[$to_meta])* $to: $to_type = $to_spec, )+
                /// Velocity (m/s or rad/s).
                velocity: f64 = $crate::interface::limit($crate::Input::Velocity).positive(),
                /// Acceleration (m/s² or rad/s²).
                acceleration: f64 = $crate::interface::limit($crate::Input::Acceleration),
                /// Deceleration (m/s² or rad/s²).
                deceleration: f64 =
                    $crate::interface::like($crate::Input::Deceleration, $crate::Input::Acceleration),
                /// Jerk (m/s³ or rad/s³); `None` leaves it to the axis.
                jerk: Option<f64> = $crate::interface::limit_if_any($crate::Input::Jerk),
                /// Snap (m/s⁴ or rad/s⁴), beyond the standard; `None` leaves it to the axis.
                snap: Option<f64> = $crate::interface::limit_if_any($crate::Input::Snap),
                $( $(#[$way_meta])* $way: $way_type = $way_spec, )*
                /// BufferMode.
                buffer_mode: $crate::BufferMode = $crate::interface::buffer_mode(),
                /// ContinuousUpdate.
                continuous_update: bool = $crate::interface::flag($crate::Input::ContinuousUpdate, false),
            }
        }

        impl $inputs {
            /// Inputs of a motion to zero as fast as `limits` allow, not executed.
            #[must_use]
            pub fn within(limits: &servobench_motion::Limits) -> Self {
                Self {
                    execute: false,
                    $( $to: Default::default(), )+
                    velocity: limits.velocity,
                    acceleration: limits.acceleration,
                    deceleration: limits.acceleration,
                    jerk: Some(limits.jerk).filter(|jerk| jerk.is_finite()),
                    snap: Some(limits.snap).filter(|snap| snap.is_finite()),
                    $( $way: Default::default(), )*
                    buffer_mode: $crate::BufferMode::default(),
                    continuous_update: false,
                }
            }
        }

        impl $crate::MotionInputs for $inputs {
            const NAME: BlockName = BlockName::$block;
            type Outputs = $outputs;

            fn execute(&self) -> bool {
                self.execute
            }

            fn continuous_update(&self) -> bool {
                self.continuous_update
            }

            fn command(&self) -> $crate::Command {
                let Self { velocity, acceleration, deceleration, jerk, snap, buffer_mode, .. } = *self;
                let $own = self;
                $crate::Command {
                    block: Self::NAME,
                    goal: $goal,
                    dynamics: $crate::Dynamics { velocity: Some(velocity), acceleration, deceleration, jerk, snap },
                    buffer_mode,
                }
            }
        }
    };
}

pub(super) use moves;
