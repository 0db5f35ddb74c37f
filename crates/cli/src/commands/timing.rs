//! `servobench timing`: the timing diagram of a stored recording.
use crate::args::TimingArgs;
use crate::error::CliError;
use crate::exit::Exit;
use crate::output::{print_or_write, spares};
use servobench_report::{TimingOptions, timing_diagram};
use servobench_trace::Recording;

/// Draws the diagram.
pub(crate) fn timing(args: &TimingArgs) -> Result<Exit, CliError> {
    spares(&args.recording, args.output.as_deref())?;
    let recording = Recording::read_parquet(&args.recording).map_err(CliError::ReadRecording)?;
    let default = TimingOptions::default();
    let options = TimingOptions {
        from: args.from,
        to: args.to,
        width: args.width.unwrap_or(default.width),
        sources: args.source.clone(),
        with_idle: args.idle,
    };
    let diagram = timing_diagram(&recording, &options)
        .map_err(|error| CliError::Timing { recording: args.recording.clone(), error })?;
    print_or_write(args.output.as_deref(), &diagram)?;
    Ok(Exit::Passed)
}
