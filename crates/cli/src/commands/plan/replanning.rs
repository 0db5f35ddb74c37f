//! A move from a state of motion.
use super::mistake::PlanMistake;
use super::point_to_point::PointToPointArgs;
use super::quantity::{ACCELERATION, Axis, AxisQuantity, JERK, POSITION, VELOCITY};
use crate::args::choice;
use clap::Args;
use servobench_base::Setpoint;
use servobench_motion::online::{DirectionalLimits, Effort, Sides, Target};
use servobench_planner::Replanning;

/// What only a move from a state of motion has.
#[derive(Debug, Args)]
#[command(next_help_heading = "From a state of motion")]
pub(crate) struct InMotionArgs {
    /// Fast: bounded work, for a control cycle. Refined: nearer to the optimum.
    #[arg(long, value_parser = choice::<Effort>())]
    online: Option<Effort>,
    /// Position at the start; the distance is counted from there.
    #[arg(long, value_name = "POSITION", value_parser = POSITION, allow_hyphen_values = true)]
    start_position: Option<AxisQuantity>,
    /// Velocity at the start.
    #[arg(long, value_name = "VELOCITY", value_parser = VELOCITY, allow_hyphen_values = true)]
    start_velocity: Option<AxisQuantity>,
    /// Acceleration at the start.
    #[arg(long, value_name = "ACCELERATION", value_parser = ACCELERATION, allow_hyphen_values = true)]
    start_acceleration: Option<AxisQuantity>,
    /// Jerk at the start (order 4).
    #[arg(long, value_name = "JERK", value_parser = JERK, allow_hyphen_values = true)]
    start_jerk: Option<AxisQuantity>,
    /// Velocity with which the target is passed.
    #[arg(long, value_name = "VELOCITY", value_parser = VELOCITY, allow_hyphen_values = true)]
    end_velocity: Option<AxisQuantity>,
    /// Go to this velocity, wherever that is reached, instead of a distance.
    #[arg(
        long,
        value_name = "VELOCITY",
        value_parser = VELOCITY,
        allow_hyphen_values = true,
        conflicts_with_all = ["distance", "end_velocity"]
    )]
    to_velocity: Option<AxisQuantity>,
    /// Velocity limit below zero, a magnitude [default: as --velocity].
    #[arg(long, value_name = "VELOCITY", value_parser = VELOCITY.magnitude(), allow_hyphen_values = true)]
    negative_velocity: Option<AxisQuantity>,
    /// Acceleration limit below zero, a magnitude [default: as --acceleration].
    #[arg(long, value_name = "ACCELERATION", value_parser = ACCELERATION.magnitude(), allow_hyphen_values = true)]
    negative_acceleration: Option<AxisQuantity>,
}

impl InMotionArgs {
    /// A move by `distance`, or to a velocity.
    pub(super) fn generator(
        &self,
        distance: Option<f64>,
        asked: &PointToPointArgs,
        axis: &mut Axis,
    ) -> Result<Replanning, PlanMistake> {
        let to_velocity = axis.optional(self.to_velocity.as_ref());
        let limits = asked.limits(axis);
        self.may_start(asked.order.derivative())?;
        let mut start = |quantity: &Option<AxisQuantity>| axis.optional(quantity.as_ref()).unwrap_or(0.0);
        let x = start(&self.start_position);
        let v = start(&self.start_velocity);
        let a = start(&self.start_acceleration);
        let j = start(&self.start_jerk);
        let end_velocity = start(&self.end_velocity);
        let negative_velocity = axis.optional(self.negative_velocity.as_ref());
        let negative_acceleration = axis.optional(self.negative_acceleration.as_ref());
        let sides = |above: f64, below: Option<f64>| Sides { above, below: below.unwrap_or(above) };
        let limits = DirectionalLimits {
            velocity: sides(limits.velocity, negative_velocity),
            acceleration: sides(limits.acceleration, negative_acceleration),
            jerk: limits.jerk,
            snap: limits.snap,
        };
        let target = match to_velocity {
            Some(velocity) => Target::Velocity(velocity),
            None => Target::Position { x: x + distance.unwrap_or_default(), v: end_velocity },
        };
        let from = Setpoint { x, v, a, j, s: 0.0 };
        Ok(Replanning { from, target, order: asked.order, limits, effort: self.online.unwrap_or_default() })
    }

    /// Refuses a derivative at the start that a move of `order` lets jump.
    fn may_start(&self, order: usize) -> Result<(), PlanMistake> {
        if order < 3 && self.start_acceleration.is_some() {
            let (option, quantity) = ("start-acceleration", "acceleration");
            return Err(PlanMistake::Jumps { option, quantity, order, lowest: 3 });
        }
        if order < 4 && self.start_jerk.is_some() {
            return Err(PlanMistake::Jumps { option: "start-jerk", quantity: "jerk", order, lowest: 4 });
        }
        Ok(())
    }
}
