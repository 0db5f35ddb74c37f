//! `servobench timing`: the timing diagram of a stored recording.
use crate::args::TimingArgs;
use crate::error::CliError;
use crate::exit::Exit;
use crate::outputs::{Outputs, reads};
use servobench_report::{TimingOptions, timing_diagram};
use servobench_trace::Recording;

/// Draws the diagram.
pub(crate) fn timing(args: &TimingArgs) -> Result<Exit, CliError> {
    reads(&args.recording, "the recording");
    let output = Outputs::default().or_standard("-o", args.output.as_deref())?;
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
    output.write_text(&diagram)?;
    Ok(Exit::Passed)
}
