//! `servobench plc`: the generator of fourth order as code for a PLC.
use crate::args::{PlcCommand, PlcExportArgs};
use crate::console::say;
use crate::error::CliError;
use crate::exit::Exit;
use crate::output::write_time;
use crate::outputs::Outputs;
use servobench_structured_text::{Export, Times};

/// Runs a PLC subcommand; export is the only one.
pub(crate) fn plc(command: &PlcCommand) -> Result<Exit, CliError> {
    match command {
        PlcCommand::Export(args) => export(args),
    }
}

/// Writes the file; the memory of its blocks is stated in its head and, for a named file, on standard error.
fn export(args: &PlcExportArgs) -> Result<Exit, CliError> {
    let &PlcExportArgs { format, dialect, sample_time, settling_time, .. } = args;
    let output = Outputs::default().or_standard("-o", args.output.as_deref())?;
    let written = write_time()?.strftime("%Y-%m-%dT%H:%M:%SZ").to_string();
    let times = Times { sample: sample_time, settling: settling_time };
    let export = Export { dialect, format, times, move_block: &args.move_block };
    let text = export.text(&written)?;
    output.write_text(&text)?;
    if args.output.is_some() {
        let memory = export.instances().map(|(name, bytes)| format!("{bytes} bytes for an instance of {name}"));
        say(&format!("{}: {} lines, {}\n", output.shown(), text.lines().count(), memory.join(", ")));
    }
    Ok(Exit::Passed)
}
