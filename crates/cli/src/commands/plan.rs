//! `servobench plan`: one move of any family on paper.
mod arguments;
mod filter;
mod point_to_point;
mod replanning;
mod rockwell;
mod table;

use crate::args::{PlanArgs, PlanProfile};
use crate::console::print;
use crate::exit::{CliError, Exit};
use crate::output::write_file;
use arguments::Arguments;
use servobench_base::Coordinate;
use servobench_planner::{CommandCycle, Request};
use servobench_report::{PlannedMove, ReportError};
use std::path::Path;

/// Plans the move and prints, tabulates or draws it.
pub(crate) fn plan(args: &PlanArgs) -> Result<Exit, CliError> {
    let (planned, csv_step) = planned(args)?;
    if let Some(path) = &args.csv {
        write_csv(&planned, csv_step, path)?;
    }
    if let Some(path) = &args.commands {
        servobench_trace::stream_whole(path, |file| planned.write_commands(file).map(drop))
            .map_err(|error| cannot_write(path, &error))?;
    }
    if let Some(path) = &args.svg {
        write_file(path, planned.svg())?;
    }
    let json = || planned.json().map_err(|error| CliError::Run(error.to_string()));
    print(&if args.json { json()? } else { planned.table() })?;
    Ok(Exit::Passed)
}

/// The plan, and how far the rows of its table are apart (s) where that is said.
fn planned(args: &PlanArgs) -> Result<(PlannedMove, Option<f64>), CliError> {
    let mut arguments = Arguments::of(args);
    let generator = match args.profile {
        PlanProfile::PointToPoint if replanning::is_meant(&arguments) => replanning::generator(args, &mut arguments),
        PlanProfile::PointToPoint => point_to_point::generator(args, &mut arguments),
        PlanProfile::Rockwell => rockwell::generator(args, &mut arguments),
        PlanProfile::Pvt => table::pvt(args, &mut arguments),
        PlanProfile::Position => table::position(args, &mut arguments),
    };
    let duration = arguments.time("duration");
    // A bus whose units are finer than what matters, at its first instant when the move begins.
    let is_sent = matches!(args.profile, PlanProfile::Position);
    let cycle = is_sent.then(|| arguments.positive_time("command-cycle")).flatten();
    let commands = cycle.map(|period| CommandCycle { period, first: 0.0, unit: 0.0 });
    let csv_step = arguments.positive_time("csv-step");
    let filter = filter::filter(args, &mut arguments);
    let (motion, units) = arguments.finish()?;
    let Some(generator) = generator else {
        // Whatever is missing has been told.
        return Err(CliError::Input("the move is not described".into()));
    };
    let unit = motion.unwrap_or(Coordinate::Linear).unit();
    let planned = PlannedMove::new(Request { generator, duration, filter, commands }, unit);
    let planned = planned.map_err(|error| CliError::Input(by_flags(&error.to_string())))?;
    let planned =
        units.into_iter().fold(planned, |planned, told| planned.as_given(told.derivative, &told.text, told.value));
    Ok((planned, csv_step))
}

/// Fields of a request whose flags have other names.
const FIELDS: [(&str, &str); 14] = [
    ("alpha", "plateau"),
    ("rate", "command-rate"),
    ("allowed", "allowed-error"),
    ("speed", "velocity"),
    ("target.x", "distance"),
    ("target.v", "end-velocity"),
    ("from.x", "start-position"),
    ("from.v", "start-velocity"),
    ("from.a", "start-acceleration"),
    ("from.j", "start-jerk"),
    ("velocity.above", "velocity"),
    ("velocity.below", "negative-velocity"),
    ("acceleration.above", "acceleration"),
    ("acceleration.below", "negative-acceleration"),
];

/// What a planner says of its request, with flags for its fields.
fn by_flags(message: &str) -> String {
    let mut parts = message.split('`');
    let mut text = parts.next().unwrap_or_default().to_owned();
    for (i, part) in parts.enumerate() {
        if i % 2 == 0 {
            let flag = FIELDS.iter().find(|(field, _)| *field == part).map_or(part, |(_, flag)| flag);
            text.push_str("--");
            text.push_str(&flag.replace('_', "-"));
        } else {
            text.push_str(part);
        }
    }
    text
}

fn write_csv(planned: &PlannedMove, step: Option<f64>, path: &Path) -> Result<(), CliError> {
    servobench_trace::stream_whole(path, |file| planned.write_csv(step, file)).map_err(|error| match error {
        ReportError::TooManyRows { .. } => CliError::Input(format!("--csv would write {error}")),
        error => cannot_write(path, &error),
    })
}

fn cannot_write(path: &Path, error: &ReportError) -> CliError {
    CliError::Run(format!("cannot write `{}`: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_planner_speaks_of_flags() {
        assert_eq!(by_flags("`alpha` must be above 0, got 2"), "--plateau must be above 0, got 2");
        assert_eq!(by_flags("about `sample_time` = 1 s and `x`"), "about --sample-time = 1 s and --x");
        assert_eq!(by_flags("nothing"), "nothing");
    }
}
