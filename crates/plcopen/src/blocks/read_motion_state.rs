//! `MC_ReadMotionState`: acceleration, deceleration and direction of the axis.
use super::outputs::FunctionBlock;
use super::read::ReadInputs;
use crate::axis::Axis;
use crate::blocks::BlockName;
use crate::error::ErrorId;
use crate::interface::outputs;
use servobench_base::Stateful;

/// Reads the state of motion: that of the set-points, or the actual one if the axis follows none (in homing and torque control).
///
/// A change of velocity within a cycle of a millionth of what the acceleration limit allows is rounding: the velocity is constant.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct ReadMotionState {
    /// Velocity of the cycle before; `None` before the first one.
    velocity: Option<f64>,
}

outputs! {
    /// Outputs of [`ReadMotionState`].
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub struct ReadMotionStateOutputs {
        /// Valid.
        valid: bool = Valid,
        /// Busy: same as Valid.
        busy: bool = Busy,
        /// Error: the block cannot fail.
        error: bool = Error,
        /// ErrorID.
        error_id: ErrorId = ErrorId,
        /// ConstantVelocity, which may be zero.
        constant_velocity: bool = ConstantVelocity,
        /// Accelerating: the speed rises.
        accelerating: bool = Accelerating,
        /// Decelerating: the speed falls.
        decelerating: bool = Decelerating,
        /// DirectionPositive: the position increases.
        direction_positive: bool = DirectionPositive,
        /// DirectionNegative: the position decreases.
        direction_negative: bool = DirectionNegative,
    }
}

/// Part of a limit that counts as rounding.
const ROUNDING: f64 = 1e-6;

impl FunctionBlock for ReadMotionState {
    const NAME: BlockName = BlockName::ReadMotionState;
    type Inputs<'i> = ReadInputs;
    type Outputs = ReadMotionStateOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &ReadInputs) -> ReadMotionStateOutputs {
        let commanded = axis.commanded();
        let is_planned = axis.follows_set_points();
        let velocity = if is_planned { commanded.v } else { axis.actual().velocity };
        let before = self.velocity.replace(velocity).unwrap_or(velocity);
        if !inputs.enable {
            return ReadMotionStateOutputs::default();
        }
        let (limits, cycle_time) = (&axis.params().limits, axis.params().cycle_time);
        let acceleration = if is_planned { commanded.a } else { (velocity - before) / cycle_time };
        let moves = velocity.abs() > ROUNDING * limits.velocity;
        let changes = acceleration.abs() > ROUNDING * limits.acceleration;
        // At the turning point the speed is about to rise.
        let slows_down = changes && velocity * acceleration < 0.0;
        ReadMotionStateOutputs {
            valid: true,
            busy: true,
            error: false,
            error_id: ErrorId::None,
            constant_velocity: !changes,
            accelerating: changes && !slows_down,
            decelerating: slows_down,
            direction_positive: moves && velocity > 0.0,
            direction_negative: moves && velocity < 0.0,
        }
    }
}
