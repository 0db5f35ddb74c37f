//! A move by the operands of Rockwell's axis move.
use super::filter::SampledFilterArgs;
use super::mistake::PlanMistake;
use super::quantity::{ACCELERATION, Axis, AxisQuantity, JERK, POSITION, VELOCITY, percent, positive_time, ratio};
use crate::args::choice;
use clap::Args;
use servobench_motion::rockwell::{Jerk, MaximumJerk, Move, Shape, ShapeKind};
use servobench_planner::{Filter, Rockwell};

#[derive(Debug, Args)]
pub(crate) struct RockwellArgs {
    /// Distance, as "100 mm" or "90 deg"; its sign is the direction.
    #[arg(long, value_parser = POSITION, allow_hyphen_values = true)]
    distance: AxisQuantity,
    /// Speed of the move, as "0.2 m/s".
    #[arg(long, value_parser = VELOCITY)]
    velocity: AxisQuantity,
    /// Acceleration, as "10 m/s2".
    #[arg(long, value_parser = ACCELERATION)]
    acceleration: AxisQuantity,
    /// Deceleration [default: as --acceleration].
    #[arg(long, value_parser = ACCELERATION)]
    deceleration: Option<AxisQuantity>,
    /// Shape of the velocity; an S-curve where a jerk is given.
    #[arg(long, value_parser = choice::<ShapeKind>())]
    shape: Option<ShapeKind>,
    /// Jerk, as "1000 m/s3".
    #[arg(long, value_parser = JERK, group = "up")]
    jerk: Option<AxisQuantity>,
    /// Part of the ramp in which the acceleration changes, 0 to 100.
    #[arg(
        long,
        value_name = "PERCENT",
        value_parser = percent,
        group = "up"
    )]
    jerk_percent_of_time: Option<f64>,
    /// Part of --maximum-jerk, 0 to 100.
    #[arg(long, value_name = "PERCENT", value_parser = percent, group = "up")]
    jerk_percent_of_maximum: Option<f64>,
    /// Time in which the acceleration rises at the beginning of the ramp, and falls at its end, as "2 ms".
    #[arg(long, value_name = "TIME", value_parser = positive_time, group = "up")]
    jerk_time: Option<f64>,
    /// The same as a way of the master in its units.
    #[arg(long, value_name = "UNITS", value_parser = ratio, group = "up", requires = "master_speed")]
    jerk_master_units: Option<f64>,
    /// Jerk of the deceleration [default: as for the acceleration].
    #[arg(long, value_name = "JERK", value_parser = JERK, group = "down")]
    deceleration_jerk: Option<AxisQuantity>,
    /// The same as a part of the ramp.
    #[arg(
        long,
        value_name = "PERCENT",
        value_parser = percent,
        group = "down"
    )]
    deceleration_jerk_percent_of_time: Option<f64>,
    /// The same as a part of --maximum-jerk.
    #[arg(long, value_name = "PERCENT", value_parser = percent, group = "down")]
    deceleration_jerk_percent_of_maximum: Option<f64>,
    /// The same as the time in which the deceleration rises, and falls.
    #[arg(long, value_name = "TIME", value_parser = positive_time, group = "down")]
    deceleration_jerk_time: Option<f64>,
    /// The same as a way of the master in its units.
    #[arg(long, value_name = "UNITS", value_parser = ratio, group = "down", requires = "master_speed")]
    deceleration_jerk_master_units: Option<f64>,
    /// Speed of the master, in its units per second.
    #[arg(long, value_name = "SPEED", value_parser = ratio)]
    master_speed: Option<f64>,
    /// Jerk that the axis is configured for, as "1000 m/s3"; a trapezoid takes all of it.
    #[arg(long, value_name = "JERK", value_parser = JERK)]
    maximum_jerk: Option<AxisQuantity>,
    #[command(flatten)]
    filter: SampledFilterArgs,
}

impl RockwellArgs {
    pub(super) fn generator(&self, axis: &mut Axis) -> Result<Rockwell, PlanMistake> {
        let distance = axis.si(&self.distance);
        let speed = axis.si(&self.velocity);
        let acceleration = axis.si(&self.acceleration);
        let deceleration = axis.optional(self.deceleration.as_ref()).unwrap_or(acceleration);
        let shape = self.shape(axis)?;
        let maximum = self.maximum_jerk(shape, axis)?;
        let operands = Move { distance, speed, acceleration, deceleration, shape };
        Ok(Rockwell { operands, maximum: MaximumJerk { acceleration: maximum, deceleration: maximum } })
    }

    pub(super) fn filter(&self) -> Result<Filter, PlanMistake> {
        self.filter.filter()
    }

    /// The shape with its jerks: an S-curve where one is given.
    fn shape(&self, axis: &mut Axis) -> Result<Shape, PlanMistake> {
        let of_master =
            |way: Option<f64>| way.zip(self.master_speed).map(|(way, speed)| Jerk::MasterUnits { way, speed });
        let parts = |of_time: Option<f64>, of_maximum: Option<f64>, time: Option<f64>| {
            let of_time = of_time.map(Jerk::PercentOfTime).or(of_maximum.map(Jerk::PercentOfMaximum));
            of_time.or(time.map(Jerk::Time))
        };
        let up = axis.optional(self.jerk.as_ref()).map(Jerk::Value);
        let up = up.or(parts(self.jerk_percent_of_time, self.jerk_percent_of_maximum, self.jerk_time));
        let up = up.or(of_master(self.jerk_master_units));
        let down = axis.optional(self.deceleration_jerk.as_ref()).map(Jerk::Value);
        let down = down.or(parts(
            self.deceleration_jerk_percent_of_time,
            self.deceleration_jerk_percent_of_maximum,
            self.deceleration_jerk_time,
        ));
        let down = down.or(of_master(self.deceleration_jerk_master_units));
        let in_master_units = self.jerk_master_units.is_some() || self.deceleration_jerk_master_units.is_some();
        if self.master_speed.is_some() && !in_master_units {
            return Err(PlanMistake::UnusedMasterSpeed);
        }
        let has_jerk = up.is_some() || down.is_some();
        match self.shape.unwrap_or(if has_jerk { ShapeKind::SCurve } else { ShapeKind::Trapezoid }) {
            ShapeKind::Trapezoid if has_jerk => Err(PlanMistake::JerkOfTrapezoid),
            ShapeKind::Trapezoid => Ok(Shape::Trapezoid),
            ShapeKind::SCurve => {
                let acceleration = up.ok_or(PlanMistake::NoJerk)?;
                Ok(Shape::SCurve { acceleration, deceleration: down.unwrap_or(acceleration) })
            }
        }
    }

    /// The jerk that the axis is configured for (SI), where `shape` depends on it.
    fn maximum_jerk(&self, shape: Shape, axis: &mut Axis) -> Result<f64, PlanMistake> {
        let is_part = |jerk| matches!(jerk, Jerk::PercentOfMaximum(_));
        let needed_for = match shape {
            Shape::Trapezoid => Some("a trapezoid takes it"),
            Shape::SCurve { acceleration, deceleration } if is_part(acceleration) || is_part(deceleration) => {
                Some("a percentage of it is asked for")
            }
            Shape::SCurve { .. } => None,
        };
        match (needed_for, axis.optional(self.maximum_jerk.as_ref())) {
            (Some(_), Some(maximum)) => Ok(maximum),
            (Some(why), None) => Err(PlanMistake::NoMaximumJerk { why }),
            (None, Some(_)) => Err(PlanMistake::UnusedMaximumJerk),
            (None, None) => Ok(f64::INFINITY),
        }
    }
}
