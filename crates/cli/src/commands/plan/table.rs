//! A move through a table of points.
use super::filter::SampledFilterArgs;
use super::mistake::PlanMistake;
use super::quantity::{ACCELERATION, Axis, AxisQuantity, POSITION, VELOCITY, frequency, positive_time, ratio};
use crate::args::{choice, file};
use crate::console::say;
use clap::Args;
use servobench_motion::online::Sides;
use servobench_motion::position_profile::PlateauShare;
use servobench_motion::pvt::Knot;
use servobench_planner::{CommandCycle, CommandRate, Filter, Follow, Generator, TableMove, Velocities, VelocitiesKind};
use servobench_scenario::{Counts, Derivative, Points, axis_quantity, read_points_in};
use std::io;
use std::path::{Path, PathBuf};

/// Bytes of a table at most: far more than five million rows need.
const LARGEST: u64 = 1 << 29;

/// A table that is followed as it is.
#[derive(Debug, Args)]
pub(crate) struct PvtArgs {
    #[command(flatten)]
    table: TableArgs,
    /// Where velocities come from [default: given if the table has some, else average].
    #[arg(long, value_parser = choice::<VelocitiesKind>())]
    velocities: Option<VelocitiesKind>,
    /// Passes of --velocities smooth [default: 2].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    passes: Option<u16>,
    /// Velocity that the move is held against, as "1 m/s"; what exceeds it is told, and marked in a drawing.
    #[arg(long, value_parser = VELOCITY.magnitude())]
    velocity: Option<AxisQuantity>,
    /// The same for the acceleration, as "5 m/s2".
    #[arg(long, value_parser = ACCELERATION.magnitude())]
    acceleration: Option<AxisQuantity>,
    #[command(flatten)]
    filter: SampledFilterArgs,
}

/// A table that is sent as velocity commands.
#[derive(Debug, Args)]
pub(crate) struct PositionArgs {
    #[command(flatten)]
    table: TableArgs,
    #[command(flatten)]
    sent: SentArgs,
    /// Largest velocity, for --plateau auto.
    #[arg(long, value_name = "VELOCITY", value_parser = VELOCITY)]
    velocity: Option<AxisQuantity>,
    /// Largest acceleration, for --plateau auto.
    #[arg(long, value_name = "ACCELERATION", value_parser = ACCELERATION)]
    acceleration: Option<AxisQuantity>,
    /// Commands at whole multiples of this cycle alone, as a bus sends them, "1 ms".
    #[arg(long, value_name = "TIME", value_parser = positive_time)]
    command_cycle: Option<f64>,
    /// Write the velocity commands (SI).
    #[arg(long, value_name = "FILE", value_parser = file())]
    pub(super) commands: Option<PathBuf>,
}

#[derive(Debug, Args)]
struct TableArgs {
    /// Table of points: time, position and, if known, velocity, with their units in the heading; counts are those of
    /// --counts.
    #[arg(long, value_name = "FILE")]
    points: PathBuf,
}

/// The ways to make velocity commands of positions: one of them.
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
struct SentArgs {
    /// Option 1: share of a segment at either end in which velocity changes, above 0 to 0.5; "auto" for the one that takes the smallest
    /// part of --velocity and --acceleration.
    #[arg(long, value_name = "ALPHA", value_parser = plateau)]
    plateau: Option<Plateau>,
    /// Option 2: velocity commands along the spline, as "100 Hz".
    #[arg(long, value_name = "RATE", value_parser = frequency)]
    command_rate: Option<f64>,
    /// Option 2 at the lowest rate that keeps this distance to the spline, as "10 um".
    #[arg(long, value_name = "DISTANCE", value_parser = POSITION)]
    allowed_error: Option<AxisQuantity>,
}

/// The share of `--plateau`.
#[derive(Debug, Clone, Copy)]
enum Plateau {
    Auto,
    Given(f64),
}

/// A share, as "0.25", or "auto".
fn plateau(text: &str) -> Result<Plateau, String> {
    if text.trim() == "auto" { Ok(Plateau::Auto) } else { ratio(text).map(Plateau::Given) }
}

impl PvtArgs {
    pub(super) fn generator(&self, counts: Option<Counts>, axis: &mut Axis) -> Result<Generator, PlanMistake> {
        let points = self.table.points(counts, axis)?;
        let default = if points.velocities.is_some() { VelocitiesKind::Given } else { VelocitiesKind::Average };
        let velocities = match (self.velocities.unwrap_or(default), self.passes) {
            (VelocitiesKind::Smooth, passes) => {
                Velocities::Smooth { passes: passes.map_or(Velocities::PASSES, u32::from) }
            }
            (_, Some(_)) => return Err(PlanMistake::PassesOfOthers),
            (VelocitiesKind::Given, None) => Velocities::Given,
            (VelocitiesKind::Average, None) => Velocities::Average,
            (VelocitiesKind::Continuous, None) => Velocities::Continuous,
        };
        if velocities != Velocities::Given {
            say_velocities_are_unused(&points);
        }
        Ok(Generator::Table(TableMove { knots: knots(&points), velocities, follow: Follow::Segments }))
    }

    pub(super) fn filter(&self) -> Result<Filter, PlanMistake> {
        self.filter.filter()
    }

    /// File of the table.
    pub(super) fn file(&self) -> &Path {
        &self.table.points
    }
}

impl PositionArgs {
    pub(super) fn generator(&self, counts: Option<Counts>, axis: &mut Axis) -> Result<Generator, PlanMistake> {
        let points = self.table.points(counts, axis)?;
        say_velocities_are_unused(&points);
        let has_limits = self.velocity.is_some() || self.acceleration.is_some();
        if has_limits && !matches!(self.sent.plateau, Some(Plateau::Auto)) {
            return Err(PlanMistake::UnusedLimits);
        }
        let follow = match &self.sent {
            SentArgs { plateau: Some(share), .. } => Follow::Plateaus { share: self.share(*share, axis)? },
            SentArgs { command_rate: Some(rate), .. } => Follow::Steps { rate: CommandRate::Given(*rate) },
            SentArgs { allowed_error, .. } => {
                // Read in its own unit, which positions do not take over.
                let error = allowed_error.as_ref().map_or(0.0, |error| axis.value(error));
                Follow::Steps { rate: CommandRate::LowestWithin(error) }
            }
        };
        Ok(Generator::Table(TableMove { knots: knots(&points), velocities: Velocities::Given, follow }))
    }

    /// File of the table.
    pub(super) fn file(&self) -> &Path {
        &self.table.points
    }

    fn share(&self, plateau: Plateau, axis: &mut Axis) -> Result<PlateauShare, PlanMistake> {
        let limits = axis.optional(self.velocity.as_ref()).zip(axis.optional(self.acceleration.as_ref()));
        match (plateau, limits) {
            (Plateau::Given(share), _) => Ok(PlateauShare::Given(share)),
            (Plateau::Auto, Some((velocity, acceleration))) => {
                Ok(PlateauShare::SmallestPartOf { velocity, acceleration })
            }
            (Plateau::Auto, None) => Err(PlanMistake::NoLimits),
        }
    }

    /// Command cycle of a bus with negligible unit, at whose first instant the move begins.
    pub(super) fn cycle(&self) -> Option<CommandCycle> {
        self.command_cycle.map(|period| CommandCycle { period, first: 0.0, unit: 0.0 })
    }
}

fn say_velocities_are_unused(points: &Points) {
    let has_inner = points.velocities.as_ref().is_some_and(|all| {
        let inner = all.get(1..all.len().saturating_sub(1)).unwrap_or_default();
        inner.iter().any(Option::is_some)
    });
    if has_inner {
        say("of the velocities of the table only the first and the last are used\n");
    }
}

fn knots(points: &Points) -> Vec<Knot> {
    let velocity = |i: usize| points.velocities.as_ref().and_then(|velocities| velocities[i]);
    let pairs = points.times.iter().zip(&points.positions).enumerate();
    pairs.map(|(i, (t, x))| Knot { t: *t, x: *x, v: velocity(i) }).collect()
}

impl PvtArgs {
    /// Limits that velocity and acceleration are checked against.
    pub(super) fn limits(&self, axis: &mut Axis) -> [Sides; 2] {
        let mut limit = |given: Option<&AxisQuantity>| Sides::both(axis.optional(given).unwrap_or(f64::INFINITY));
        [limit(self.velocity.as_ref()), limit(self.acceleration.as_ref())]
    }
}

impl TableArgs {
    /// Reads the table and takes over its units.
    fn points(&self, counts: Option<Counts>, axis: &mut Axis) -> Result<Points, PlanMistake> {
        let file = || self.points.clone();
        let text = read(&self.points).map_err(|error| PlanMistake::Unreadable { file: file(), error })?;
        let points = read_points_in(counts, &text).map_err(|error| PlanMistake::Points { file: file(), error })?;
        if !points.unused.is_empty() {
            let names: Vec<String> = points.unused.iter().map(ToString::to_string).collect();
            say(&format!(
                "not used of the table: {}; between its points only time, position and velocity count\n",
                names.join(", ")
            ));
        }
        axis.motion = Some(points.motion);
        let [_, position, velocity] = &points.units;
        for (derivative, unit) in [(Derivative::Position, position), (Derivative::Velocity, velocity)] {
            let text = unit.as_ref().map(|unit| format!("1 {unit}"));
            if let Some((text, (value, _))) =
                text.and_then(|text| Some((text.clone(), axis_quantity(derivative, Some(points.motion), &text).ok()?)))
            {
                axis.tell_in(derivative, &text, value);
            }
        }
        Ok(points)
    }
}

fn read(path: &Path) -> io::Result<String> {
    servobench_files::read_text(path, LARGEST)
}
