//! `servobench plan`: one rest-to-rest move on paper.
use crate::args::PlanArgs;
use crate::console::{print, say};
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
    let mut mistakes = Mistakes::default();
    let distance = mistakes.unless("distance", axis_quantity(Derivative::Position, None, &args.distance));
    let (distance, motion) = distance.map_or((0.0, None), |(distance, motion)| (distance, Some(motion)));
    let mut limit = |name: &'static str, derivative, text: &str| {
        let quantity = axis_quantity(derivative, motion, text);
        mistakes.unless(name, quantity).map_or(f64::INFINITY, |(value, _)| value)
    };
    let (velocity, acceleration) = (
        limit("velocity", Derivative::Velocity, &args.velocity),
        limit("acceleration", Derivative::Acceleration, &args.acceleration),
    );
    let mut optional = |name: &'static str, derivative, text: &Option<String>, order| {
        let is_used = args.order >= order;
        let Some(text) = text else {
            if is_used {
                mistakes.0.push(format!("--{name} is missing: a move of order {} needs its limit", args.order));
            }
            return f64::INFINITY;
        };
        if !is_used {
            say(&format!("--{name} is not used by a move of order {}\n", args.order));
        }
        mistakes.unless(name, axis_quantity(derivative, motion, text)).map_or(f64::INFINITY, |(value, _)| value)
    };
    let (jerk, snap) =
        (optional("jerk", Derivative::Jerk, &args.jerk, 3), optional("snap", Derivative::Snap, &args.snap, 4));
    let sample_time = args.sample_time.as_ref().and_then(|text| mistakes.unless("sample-time", time(text)));
    mistakes.none()?;
    let limits = Limits { velocity, acceleration, jerk, snap };
    let order = Order::from_derivative(args.order)
        .ok_or_else(|| CliError::Input(format!("--order must be 2, 3 or 4, got {}", args.order)))?;
    let profile = match sample_time {
        Some(sample_time) => Profile::plan_sampled(order, distance, &limits, sample_time),
        None => Profile::plan(order, distance, &limits),
    };
    let profile = profile.map_err(|error| CliError::Input(error.to_string()))?;
    let unit = if motion == Some(Motion::Rotary) { "rad" } else { "m" };
    let given = [&args.velocity, &args.acceleration].into_iter().chain(&args.jerk).chain(&args.snap);
    Ok(PlannedMove::new(profile, limits, unit).as_given(&args.distance, given.map(String::as_str)))
}

/// Arguments that are wrong.
#[derive(Default)]
struct Mistakes(Vec<String>);

impl Mistakes {
    /// The value of the argument `name`, unless it is wrong.
    fn unless<T>(&mut self, name: &str, value: Result<T, ArgumentError>) -> Option<T> {
        value.map_err(|error| self.0.push(format!("--{name} {error}"))).ok()
    }

    /// All of them at once, if there are any.
    fn none(self) -> Result<(), CliError> {
        if self.0.is_empty() { Ok(()) } else { Err(CliError::Input(self.0.join("\n"))) }
    }
}

fn write_csv(planned: &PlannedMove, path: &Path) -> Result<(), CliError> {
    servobench_trace::stream_whole(path, |file| planned.write_csv(file)).map_err(|error| match error {
        ReportError::TooManyRows { .. } => CliError::Input(format!("--csv would write {error}")),
        error => CliError::Run(format!("cannot write `{}`: {error}", path.display())),
    })
}
