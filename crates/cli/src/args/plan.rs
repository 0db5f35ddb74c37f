//! Arguments of `servobench plan`.
use super::choice::choice;
use clap::{Args, ValueEnum};
use servobench_motion::online::Effort;
use servobench_motion::rockwell::ShapeKind;
use servobench_motion::sampled::Execution;
use servobench_motion::shape::ShaperKind;
use servobench_planner::{Method, Sampling, VelocitiesKind};
use std::path::PathBuf;

const POINT_TO_POINT: &str = "From rest to rest (--profile point-to-point)";
const ONLINE: &str = "From a state of motion";
const ROCKWELL: &str = "Rockwell axis move (--profile rockwell)";
const TABLE: &str = "Through a table (--profile pvt, --profile position)";
const FILTER: &str = "Behind the planner";
const OUTPUT: &str = "Output";

pub(super) const EXAMPLES: &str = "\
Examples:
  servobench plan --order 4 --distance \"1 m\" --velocity \"1 m/s\"
      --acceleration \"5 m/s2\" --jerk \"50 m/s3\" --snap \"1000 m/s4\"
      --method optimal --svg plan.svg
  servobench plan --order 4 … --start-velocity \"0.4 m/s\" --online refined
  servobench plan --profile rockwell --distance \"100 mm\" --velocity \"0.2 m/s\"
      --acceleration \"10 m/s2\" --jerk-percent-of-time 25
  servobench plan --profile pvt --points table.csv --velocities continuous
  servobench plan --profile position --points table.csv --allowed-error \"10 um\"

A table of points is a CSV file like
  time [ms],position [mm],velocity [mm/s]
  0,0,0
  10,5,750";

#[derive(Debug, Args)]
pub(crate) struct PlanArgs {
    /// Family of the set-point.
    #[arg(long, value_enum, default_value_t = PlanProfile::PointToPoint)]
    pub(crate) profile: PlanProfile,
    /// Distance, as "1 m" or "90 deg"; its sign is the direction.
    #[arg(long, allow_hyphen_values = true)]
    pub(crate) distance: Option<String>,
    /// Velocity limit, as "1 m/s"; of a Rockwell move the speed.
    #[arg(long)]
    pub(crate) velocity: Option<String>,
    /// Acceleration limit, as "5 m/s2".
    #[arg(long)]
    pub(crate) acceleration: Option<String>,
    /// Jerk limit, as "50 m/s3" (orders 3 and 4); of a Rockwell move the jerk.
    #[arg(long)]
    pub(crate) jerk: Option<String>,
    /// Slow the move down to this duration, as "2 s"; every derivative is lowered.
    #[arg(long, value_name = "TIME")]
    pub(crate) duration: Option<String>,

    /// Order of the profile: 2 trapezoid, 3 jerk-limited, 4 snap-limited.
    #[arg(long, value_parser = clap::value_parser!(u8).range(2..=4), help_heading = POINT_TO_POINT)]
    pub(crate) order: Option<u8>,
    /// Snap limit, as "1000 m/s4" (order 4).
    #[arg(long, help_heading = POINT_TO_POINT)]
    pub(crate) snap: Option<String>,
    /// Published: the step through boxes. Optimal: the shortest, with --sample-time that of the fewest samples.
    #[arg(long, value_parser = choice::<Method>(), help_heading = POINT_TO_POINT)]
    pub(crate) method: Option<Method>,
    /// Make every time a whole number of samples of this length, as "1 ms".
    #[arg(long, value_name = "TIME", help_heading = POINT_TO_POINT)]
    pub(crate) sample_time: Option<String>,
    /// How times of boxes are made whole: as published, or with the fewest samples.
    #[arg(long, value_parser = choice::<Sampling>(), help_heading = POINT_TO_POINT)]
    pub(crate) sampling: Option<Sampling>,
    /// Exact hold of the highest derivative, without lag; or the forward-Euler cascade, which lags by 1.5 samples at
    /// order 4.
    #[arg(long, value_parser = choice::<Execution>(), help_heading = POINT_TO_POINT)]
    pub(crate) execution: Option<Execution>,

    /// Fast: bounded work, for a control cycle. Refined: nearer to the optimum.
    #[arg(long, value_parser = choice::<Effort>(), help_heading = ONLINE)]
    pub(crate) online: Option<Effort>,
    /// Position at the start; the distance is counted from there.
    #[arg(long, allow_hyphen_values = true, help_heading = ONLINE)]
    pub(crate) start_position: Option<String>,
    /// Velocity at the start.
    #[arg(long, allow_hyphen_values = true, help_heading = ONLINE)]
    pub(crate) start_velocity: Option<String>,
    /// Acceleration at the start.
    #[arg(long, allow_hyphen_values = true, help_heading = ONLINE)]
    pub(crate) start_acceleration: Option<String>,
    /// Jerk at the start (order 4).
    #[arg(long, allow_hyphen_values = true, help_heading = ONLINE)]
    pub(crate) start_jerk: Option<String>,
    /// Velocity with which the target is passed.
    #[arg(long, allow_hyphen_values = true, help_heading = ONLINE)]
    pub(crate) end_velocity: Option<String>,
    /// Go to this velocity, wherever that is reached, instead of a distance.
    #[arg(long, allow_hyphen_values = true, conflicts_with_all = ["distance", "end_velocity"], help_heading = ONLINE)]
    pub(crate) to_velocity: Option<String>,
    /// Velocity limit below zero, a magnitude, where it is another.
    #[arg(long, allow_hyphen_values = true, help_heading = ONLINE)]
    pub(crate) negative_velocity: Option<String>,
    /// Acceleration limit below zero, a magnitude, where it is another.
    #[arg(long, allow_hyphen_values = true, help_heading = ONLINE)]
    pub(crate) negative_acceleration: Option<String>,

    /// Shape of the velocity; an S-curve where a jerk is given.
    #[arg(long, value_parser = choice::<ShapeKind>(), help_heading = ROCKWELL)]
    pub(crate) shape: Option<ShapeKind>,
    /// Deceleration, where it is not the acceleration.
    #[arg(long, help_heading = ROCKWELL)]
    pub(crate) deceleration: Option<String>,
    /// Part of the ramp in which the acceleration changes, 0 to 100.
    #[arg(long, value_name = "PERCENT", conflicts_with_all = ["jerk", "jerk_percent_of_maximum"], help_heading = ROCKWELL)]
    pub(crate) jerk_percent_of_time: Option<String>,
    /// Part of --maximum-jerk, 0 to 100.
    #[arg(long, value_name = "PERCENT", conflicts_with = "jerk", help_heading = ROCKWELL)]
    pub(crate) jerk_percent_of_maximum: Option<String>,
    /// Jerk of the deceleration, where it is not said as that of the acceleration.
    #[arg(long, value_name = "JERK", help_heading = ROCKWELL)]
    pub(crate) deceleration_jerk: Option<String>,
    /// The same as a part of the ramp.
    #[arg(
        long,
        value_name = "PERCENT",
        conflicts_with_all = ["deceleration_jerk", "deceleration_jerk_percent_of_maximum"],
        help_heading = ROCKWELL
    )]
    pub(crate) deceleration_jerk_percent_of_time: Option<String>,
    /// The same as a part of --maximum-jerk.
    #[arg(long, value_name = "PERCENT", conflicts_with = "deceleration_jerk", help_heading = ROCKWELL)]
    pub(crate) deceleration_jerk_percent_of_maximum: Option<String>,
    /// Jerk that the axis is configured for.
    #[arg(long, value_name = "JERK", help_heading = ROCKWELL)]
    pub(crate) maximum_jerk: Option<String>,

    /// Table of points: time, position and, if known, velocity, with their units in the heading.
    #[arg(long, value_name = "FILE", help_heading = TABLE)]
    pub(crate) points: Option<PathBuf>,
    /// PVT: where velocities come from [default: given if the table has some, else average].
    #[arg(long, value_parser = choice::<VelocitiesKind>(), help_heading = TABLE)]
    pub(crate) velocities: Option<VelocitiesKind>,
    /// PVT: passes of --velocities smooth [default: 2].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), help_heading = TABLE)]
    pub(crate) passes: Option<u16>,
    /// Position profile, option 1: share of a segment at either end in which velocity changes, above 0 to 0.5.
    #[arg(long, value_name = "ALPHA", conflicts_with_all = ["command_rate", "allowed_error"], help_heading = TABLE)]
    pub(crate) plateau: Option<String>,
    /// Position profile, option 2: velocity commands along the spline, as "100 Hz".
    #[arg(long, value_name = "RATE", conflicts_with = "allowed_error", help_heading = TABLE)]
    pub(crate) command_rate: Option<String>,
    /// The same at the lowest rate that stays so near to the spline, as "10 um".
    #[arg(long, value_name = "DISTANCE", help_heading = TABLE)]
    pub(crate) allowed_error: Option<String>,

    /// Position profile: commands at whole multiples of this cycle alone, as a bus sends them, "1 ms".
    #[arg(long, value_name = "TIME", help_heading = TABLE)]
    pub(crate) command_cycle: Option<String>,

    /// Input shaper for one vibration.
    #[arg(long, value_parser = choice::<ShaperKind>(), help_heading = FILTER)]
    pub(crate) shaper: Option<ShaperKind>,
    /// Natural frequency of the vibration, as "12 Hz".
    #[arg(long, value_name = "FREQUENCY", help_heading = FILTER)]
    pub(crate) shaper_frequency: Option<String>,
    /// Damping ratio of the vibration [default: 0].
    #[arg(long, value_name = "RATIO", help_heading = FILTER)]
    pub(crate) shaper_damping: Option<String>,
    /// Part of the vibration that the EI shaper may leave [default: 5 %].
    #[arg(long, value_name = "RATIO", help_heading = FILTER)]
    pub(crate) shaper_tolerable: Option<String>,
    /// Moving averages one after the other, as "10 ms,5 ms"; they need --sample-time.
    #[arg(long, value_name = "TIMES", help_heading = FILTER)]
    pub(crate) averages: Option<String>,

    /// Print JSON.
    #[arg(long, help_heading = OUTPUT)]
    pub(crate) json: bool,
    /// Write time, position, velocity, acceleration, jerk, snap (SI): a row for each sample of a sampled plan, 1001 rows
    /// at equal steps of another.
    #[arg(long, value_name = "FILE", help_heading = OUTPUT)]
    pub(crate) csv: Option<PathBuf>,
    /// Write a row of the table every so often instead, as "1 ms".
    #[arg(long, value_name = "TIME", requires = "csv", help_heading = OUTPUT)]
    pub(crate) csv_step: Option<String>,
    /// Write the velocity commands of a position profile (SI).
    #[arg(long, value_name = "FILE", help_heading = OUTPUT)]
    pub(crate) commands: Option<PathBuf>,
    /// Draw position and its derivatives with their limits, and where they bind.
    #[arg(long, value_name = "FILE", help_heading = OUTPUT)]
    pub(crate) svg: Option<PathBuf>,
}

/// A family of set-points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum PlanProfile {
    /// Order 2, 3 or 4; from rest to rest, or from a state of motion.
    PointToPoint,
    /// Trapezoid or S-curve by the operands of Rockwell's axis move.
    Rockwell,
    /// Positions, times and, if given, velocities of a table.
    Pvt,
    /// The same sent as velocity commands.
    Position,
}
