//! A move from point to point: from rest to rest, or from a state of motion.
use super::filter::FilterArgs;
use super::mistake::PlanMistake;
use super::quantity::{ACCELERATION, Axis, AxisQuantity, JERK, POSITION, SNAP, VELOCITY, time};
use super::replanning::InMotionArgs;
use crate::args::choice;
use crate::console::say;
use clap::builder::TypedValueParser;
use clap::{Args, value_parser};
use servobench_motion::sampled::Execution;
use servobench_motion::{Limits, Order};
use servobench_planner::{Filter, Generator, Grid, Method, PointToPoint, Sampling};

#[derive(Debug, Args)]
pub(crate) struct PointToPointArgs {
    /// Order of the profile: 2 trapezoid, 3 jerk-limited, 4 snap-limited.
    #[arg(long, value_parser = order())]
    pub(super) order: Order,
    /// Distance, as "1 m" or "90 deg"; its sign is the direction.
    #[arg(long, value_parser = POSITION, allow_hyphen_values = true, required_unless_present = "to_velocity")]
    distance: Option<AxisQuantity>,
    /// Velocity limit, as "1 m/s".
    #[arg(long, value_parser = VELOCITY)]
    velocity: AxisQuantity,
    /// Acceleration limit, as "5 m/s2".
    #[arg(long, value_parser = ACCELERATION)]
    acceleration: AxisQuantity,
    /// Jerk limit, as "50 m/s3" (orders 3 and 4).
    #[arg(long, value_parser = JERK, required_if_eq_any = [("order", "3"), ("order", "4")])]
    jerk: Option<AxisQuantity>,
    /// Snap limit, as "1000 m/s4" (order 4).
    #[arg(long, value_parser = SNAP, required_if_eq("order", "4"))]
    snap: Option<AxisQuantity>,
    /// Make every time a whole number of samples of this length, as "1 ms".
    #[arg(long, value_name = "TIME", value_parser = time)]
    sample_time: Option<f64>,
    #[command(flatten)]
    from_rest: FromRestArgs,
    #[command(flatten)]
    in_motion: Option<InMotionArgs>,
    #[command(flatten)]
    filter: FilterArgs,
}

/// What only a move from rest to rest has.
#[derive(Debug, Args)]
#[command(next_help_heading = "From rest to rest")]
struct FromRestArgs {
    /// Published or shortest profile; with --sample-time the shortest in whole samples.
    #[arg(long, value_parser = choice::<Method>(), conflicts_with = "InMotionArgs")]
    method: Option<Method>,
    /// How segment times become whole samples.
    #[arg(long, value_parser = choice::<Sampling>(), requires = "sample_time", conflicts_with = "InMotionArgs")]
    sampling: Option<Sampling>,
    /// Exact hold of the highest derivative, without lag; or the forward-Euler cascade, which lags by 1.5 samples at
    /// order 4.
    #[arg(long, value_parser = choice::<Execution>(), requires = "sample_time", conflicts_with = "InMotionArgs")]
    execution: Option<Execution>,
}

fn order() -> impl TypedValueParser<Value = Order> {
    value_parser!(u8).range(2..=4).try_map(|order| Order::from_derivative(order).ok_or("not an order"))
}

impl PointToPointArgs {
    pub(super) fn generator(&self, axis: &mut Axis) -> Result<Generator, PlanMistake> {
        let distance = axis.optional(self.distance.as_ref());
        if let Some(in_motion) = &self.in_motion {
            if self.sample_time.is_some() && !self.filter.has_averages() {
                return Err(PlanMistake::NotSampled);
            }
            return in_motion.generator(distance, self, axis).map(Generator::Replanning);
        }
        let method = self.from_rest.method.unwrap_or_default();
        let (limits, grid) = (self.limits(axis), self.grid(method)?);
        // Only a move from a state of motion may go to a velocity instead.
        let distance = distance.unwrap_or_default();
        Ok(Generator::PointToPoint(PointToPoint { distance, order: self.order, limits, method, grid }))
    }

    pub(super) fn filter(&self) -> Result<Filter, PlanMistake> {
        self.filter.filter(self.sample_time)
    }

    /// The limits that the order uses.
    pub(super) fn limits(&self, axis: &mut Axis) -> Limits {
        let velocity = axis.si(&self.velocity);
        let acceleration = axis.si(&self.acceleration);
        let mut from = |lowest: usize, name, limit: Option<&AxisQuantity>| {
            let value = axis.optional(limit);
            let order = self.order.derivative();
            if order < lowest && value.is_some() {
                say(&format!("--{name} is not used by a move of order {order}\n"));
            }
            value.filter(|_| order >= lowest).unwrap_or(f64::INFINITY)
        };
        let jerk = from(3, "jerk", self.jerk.as_ref());
        let snap = from(4, "snap", self.snap.as_ref());
        Limits { velocity, acceleration, jerk, snap }
    }

    /// Sampling of the move, if requested.
    fn grid(&self, method: Method) -> Result<Option<Grid>, PlanMistake> {
        let FromRestArgs { sampling, execution, .. } = self.from_rest;
        if method == Method::Optimal && sampling.is_some() {
            return Err(PlanMistake::SamplingOfTheShortest);
        }
        let (sampling, execution) = (sampling.unwrap_or_default(), execution.unwrap_or_default());
        Ok(self.sample_time.map(|sample_time| Grid { sample_time, sampling, execution }))
    }
}
