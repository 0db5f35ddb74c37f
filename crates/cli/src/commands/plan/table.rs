//! A move through a table of points.
use super::arguments::Arguments;
use crate::args::PlanArgs;
use crate::console::say;
use servobench_motion::pvt::Knot;
use servobench_planner::{CommandRate, Follow, Generator, TableMove, Velocities, VelocitiesKind};
use servobench_scenario::{Derivative, Points, axis_quantity, read_points};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Bytes of a table at most: far more than five million rows need.
const LARGEST: u64 = 1 << 29;

/// As it is.
pub(super) fn pvt(args: &PlanArgs, arguments: &mut Arguments<'_>) -> Option<Generator> {
    let points = points(args, arguments)?;
    arguments.take("velocities");
    let default = if points.velocities.is_some() { VelocitiesKind::Given } else { VelocitiesKind::Average };
    let velocities = match args.velocities.unwrap_or(default) {
        VelocitiesKind::Given => Velocities::Given,
        VelocitiesKind::Average => Velocities::Average,
        VelocitiesKind::Continuous => Velocities::Continuous,
        VelocitiesKind::Smooth => {
            arguments.take("passes");
            Velocities::Smooth { passes: args.passes.map_or(Velocities::PASSES, u32::from) }
        }
    };
    if args.passes.is_some() && arguments.take("passes").is_some() && !matches!(velocities, Velocities::Smooth { .. }) {
        arguments.mistake("--passes are those of --velocities smooth: choose that, or leave them out");
    }
    let has_inner = points.velocities.as_ref().is_some_and(|all| {
        let inner = all.get(1..all.len().saturating_sub(1)).unwrap_or_default();
        inner.iter().any(Option::is_some)
    });
    if has_inner && velocities != Velocities::Given {
        say("of the velocities of the table only the first and the last are used\n");
    }
    Some(Generator::Table(TableMove { knots: knots(&points), velocities, follow: Follow::Segments }))
}

/// Sent as velocity commands.
pub(super) fn position(args: &PlanArgs, arguments: &mut Arguments<'_>) -> Option<Generator> {
    arguments.take("commands");
    let points = points(args, arguments)?;
    let follow = if arguments.is_given("plateau") {
        Follow::Plateaus { share: arguments.ratio("plateau")? }
    } else if arguments.is_given("command-rate") {
        Follow::Steps { rate: CommandRate::Given(arguments.frequency("command-rate")?) }
    } else if arguments.is_given("allowed-error") {
        let text = arguments.take("allowed-error")?;
        // In a unit of its own: positions stay in theirs.
        match axis_quantity(Derivative::Position, arguments.motion(), text) {
            Ok((error, _)) => Follow::Steps { rate: CommandRate::LowestWithin(error) },
            Err(error) => {
                arguments.mistake(format!("--allowed-error {error}"));
                return None;
            }
        }
    } else {
        arguments.missing(
            "plateau",
            "or --command-rate, or --allowed-error: a position profile is sent in one of these ways",
        );
        return None;
    };
    Some(Generator::Table(TableMove { knots: knots(&points), velocities: Velocities::Given, follow }))
}

fn knots(points: &Points) -> Vec<Knot> {
    let velocity = |i: usize| points.velocities.as_ref().and_then(|velocities| velocities[i]);
    let pairs = points.times.iter().zip(&points.positions).enumerate();
    pairs.map(|(i, (t, x))| Knot { t: *t, x: *x, v: velocity(i) }).collect()
}

/// The table, its units noted.
fn points(args: &PlanArgs, arguments: &mut Arguments<'_>) -> Option<Points> {
    arguments.take("points");
    let Some(path) = &args.points else {
        arguments.missing("points", "a CSV file with the heading `time [ms],position [mm],velocity [mm/s]`");
        return None;
    };
    let text = match read(path) {
        Ok(text) => text,
        Err(error) => {
            arguments.mistake(format!("--points: cannot read `{}`: {error}", path.display()));
            return None;
        }
    };
    let points = match read_points(&text) {
        Ok(points) => points,
        Err(error) => {
            arguments.mistake(format!("{}:{error}", path.display()));
            return None;
        }
    };
    arguments.set_motion(points.motion);
    let [_, position, velocity] = &points.units;
    for (derivative, unit) in [(Derivative::Position, position), (Derivative::Velocity, velocity)] {
        let text = unit.as_ref().map(|unit| format!("1 {unit}"));
        if let Some((text, (value, _))) =
            text.and_then(|text| Some((text.clone(), axis_quantity(derivative, Some(points.motion), &text).ok()?)))
        {
            arguments.tell_in(derivative, &text, value);
        }
    }
    Some(points)
}

fn read(path: &Path) -> io::Result<String> {
    let mut text = String::new();
    File::open(path)?.take(LARGEST + 1).read_to_string(&mut text)?;
    if text.len() as u64 > LARGEST {
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, "more than 512 MB; split it, or leave points out"));
    }
    Ok(text)
}
