//! `servobench plan`: one rest-to-rest move on paper.
use crate::args::PlanArgs;
use crate::console::print;
use crate::exit::{CliError, Exit};
use crate::output::write_file;
use servobench_motion::{Limits, Order, Profile};
use servobench_report::{PlannedMove, ReportError};
use servobench_scenario::{ArgumentError, Derivative, Motion, axis_quantity, time};
use std::path::Path;

/// Plans the move and prints, tabulates or draws it.
pub(crate) fn plan(args: &PlanArgs) -> Result<Exit, CliError> {
    let planned = planned(args)?;
    if let Some(path) = &args.csv {
        write_csv(&planned, path)?;
    }
    if let Some(path) = &args.svg {
        write_file(path, &planned.svg())?;
    }
    let json = || planned.json().map_err(|error| CliError::Run(error.to_string()));
    print(&if args.json { json()? } else { planned.table() })?;
    Ok(Exit::Passed)
}

fn planned(args: &PlanArgs) -> Result<PlannedMove, CliError> {
    let named = |name: &'static str| move |error: ArgumentError| CliError::Input(format!("--{name} {error}"));
    let (distance, motion) = axis_quantity(Derivative::Position, None, &args.distance).map_err(named("distance"))?;
    let limit = |name: &'static str, derivative, text: &str| {
        axis_quantity(derivative, Some(motion), text).map(|(value, _)| value).map_err(named(name))
    };
    let needed = |name: &'static str, derivative, text: &Option<String>, order: u8| match text {
        Some(text) => limit(name, derivative, text),
        None if args.order >= order => {
            Err(CliError::Input(format!("--{name} is missing: a move of order {} needs its limit", args.order)))
        }
        None => Ok(f64::INFINITY),
    };
    let limits = Limits {
        velocity: limit("velocity", Derivative::Velocity, &args.velocity)?,
        acceleration: limit("acceleration", Derivative::Acceleration, &args.acceleration)?,
        jerk: needed("jerk", Derivative::Jerk, &args.jerk, 3)?,
        snap: needed("snap", Derivative::Snap, &args.snap, 4)?,
    };
    let order = Order::from_derivative(args.order)
        .ok_or_else(|| CliError::Input(format!("--order must be 2, 3 or 4, got {}", args.order)))?;
    let profile = match &args.sample_time {
        Some(text) => {
            let sample_time = time(text).map_err(named("sample-time"))?;
            Profile::plan_sampled(order, distance, &limits, sample_time)
        }
        None => Profile::plan(order, distance, &limits),
    };
    let profile = profile.map_err(|error| CliError::Input(error.to_string()))?;
    Ok(PlannedMove::new(profile, limits, if motion == Motion::Linear { "m" } else { "rad" }))
}

fn write_csv(planned: &PlannedMove, path: &Path) -> Result<(), CliError> {
    servobench_trace::stream_whole(path, |file| planned.write_csv(file)).map_err(|error| match error {
        ReportError::TooManyRows { .. } => CliError::Input(format!("--csv would write {error}")),
        error => CliError::Run(format!("cannot write `{}`: {error}", path.display())),
    })
}
