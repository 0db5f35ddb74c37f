//! `servobench plan`: one move of any family without an axis.
//!
//! Each profile is a file with its options and the move that they describe; an option is added there.
mod filter;
mod mistake;
mod point_to_point;
mod points;
mod profile;
mod quantity;
mod replanning;
mod rockwell;
mod table;

pub(crate) use mistake::PlanMistake;

use crate::args::file;
use crate::console::{print, print_json, say};
use crate::error::CliError;
use crate::exit::Exit;
use crate::outputs::{Output, Outputs, reads};
use clap::Args;
use filter::FILTER;
use points::PointArgs;
use profile::Profile;
use quantity::{positive_time, time};
use servobench_base::Coordinate;
use servobench_report::{PlannedMove, ReportError};
use std::convert::Infallible;
use std::io::Write;
use std::path::PathBuf;

pub(crate) const EXAMPLES: &str = "\
Examples:
  servobench plan --order 4 --distance \"1 m\" --velocity \"1 m/s\"
      --acceleration \"5 m/s2\" --jerk \"50 m/s3\" --snap \"1000 m/s4\"
      --method optimal --svg plan.svg
  servobench plan --order 4 … --start-velocity \"0.4 m/s\" --online refined
  servobench plan rockwell --help";

#[derive(Debug, Args)]
pub(crate) struct PlanArgs {
    #[command(flatten)]
    profile: Profile,
    /// Slow the move down to this duration, as "2 s"; every derivative is lowered.
    #[arg(long, value_name = "TIME", value_parser = time, global = true, help_heading = FILTER)]
    duration: Option<f64>,
    #[command(flatten)]
    output: OutputArgs,
    #[command(flatten)]
    points: PointArgs,
    /// What profiles were chosen by before they were commands.
    #[arg(long = "profile", value_name = "PROFILE", hide = true, value_parser = former_profile)]
    former_profile: Option<Infallible>,
}

/// What every profile has.
#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
struct OutputArgs {
    /// Print JSON.
    #[arg(long, global = true)]
    json: bool,
    /// Write time, position, velocity, acceleration, jerk, snap (SI), which --points reads: a row for each sample of a
    /// sampled plan, 1001 rows at equal steps of another.
    #[arg(long, value_name = "FILE", value_parser = file(), global = true)]
    csv: Option<PathBuf>,
    /// Time from row to row of the table, as "1 ms".
    #[arg(long, value_name = "TIME", value_parser = positive_time, requires = "csv", global = true)]
    csv_step: Option<f64>,
    /// Draw position and its derivatives with their limits, and where they bind.
    #[arg(long, value_name = "FILE", value_parser = file(), global = true)]
    svg: Option<PathBuf>,
    /// Beginning of what is drawn, as "500 ms" [default: that of the move].
    #[arg(long, value_name = "TIME", value_parser = time, requires = "svg", global = true)]
    from: Option<f64>,
    /// End of what is drawn [default: that of the move].
    #[arg(long, value_name = "TIME", value_parser = time, requires = "svg", global = true)]
    to: Option<f64>,
}

/// Error that states the present form of `--profile NAME`.
fn former_profile(name: &str) -> Result<Infallible, String> {
    Err(match name {
        "point-to-point" => "leave --profile out: servobench plan --order … --distance …".into(),
        name => format!("each profile is a command now: servobench plan {name} …"),
    })
}

/// Plans the move and prints, tabulates or draws it.
pub(crate) fn plan(args: &PlanArgs) -> Result<Exit, CliError> {
    let OutputArgs { json, csv, csv_step, svg, from, to } = &args.output;
    if let Some(table) = args.profile.table() {
        reads(table, "the table of --points");
    }
    let mut outputs = Outputs::default();
    let csv = outputs.optional("--csv", csv.as_deref())?;
    let commands = outputs.optional("--commands", args.profile.commands())?;
    let points = outputs.optional("--pvt", args.points.pvt.as_deref())?;
    let words = outputs.optional("--words", args.points.words.as_deref())?;
    let svg = outputs.optional("--svg", svg.as_deref())?;
    let planned = planned(args).map_err(CliError::Plan)?;
    if let Some(output) = csv {
        write_table(&output, |out| planned.write_csv(*csv_step, out))?;
    }
    if let Some(output) = commands {
        write_table(&output, |out| planned.write_commands(out).map(drop))?;
    }
    if let Some(output) = points {
        write_table(&output, |out| planned.write_points(out).map(drop))?;
    }
    if let Some(output) = words {
        write_table(&output, |out| planned.write_words(out).map(drop))?;
    }
    if let Some(output) = svg {
        let drawing = planned.svg(*from, *to).map_err(|error| CliError::Plan(vec![PlanMistake::NotDrawn(error)]))?;
        output.write(drawing)?;
    }
    if *json {
        print_json(&planned.json()?)?;
    } else {
        print(&planned.table())?;
    }
    Ok(Exit::Passed)
}

/// The plan, in the units of the request.
fn planned(args: &PlanArgs) -> Result<PlannedMove, Vec<PlanMistake>> {
    let (request, mut axis) = args.profile.request(args.duration, args.points.counts())?;
    let points = args.points.asked(&mut axis);
    if args.points.has_unused_counts(args.profile.is_table()) {
        say("--counts are not used: they are those of a table, or of --words\n");
    }
    if !axis.mistakes.is_empty() {
        return Err(axis.mistakes);
    }
    let unit = axis.motion.unwrap_or(Coordinate::Linear).unit();
    let planned = PlannedMove::new(request, unit).map_err(|error| vec![PlanMistake::Refused(error)])?;
    let units = axis.units.into_iter();
    let planned = units.fold(planned, |planned, given| planned.as_given(given.derivative, &given.text, given.value));
    match points {
        Some(points) => points.of(planned).map_err(|mistake| vec![mistake]),
        None => Ok(planned),
    }
}

fn write_table(output: &Output, write: impl FnOnce(&mut dyn Write) -> Result<(), ReportError>) -> Result<(), CliError> {
    output.stream(|out| {
        write(out).map_err(|error| match error {
            error @ ReportError::TooManyRows { .. } => CliError::Plan(vec![PlanMistake::TooManyRows(error)]),
            ReportError::Io(error) => output.failed(error),
            error => error.into(),
        })
    })
}
