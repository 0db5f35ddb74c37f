//! `servobench fmu`: shows the contents of an FMU, or exports an axis as an FMU.
use crate::args::{FmuCommand, FmuExportArgs, FmuInfoArgs};
use crate::console::{print, say, style};
use crate::error::CliError;
use crate::exit::Exit;
use crate::outputs::{Outputs, reads};
use crate::sources;
use servobench_config::Choice as _;
use servobench_fmi::{Archive, Limits};
use servobench_fmu::{export, library, library_path};
use servobench_report::fmu_table;
use servobench_results::printable;
use servobench_suite::file_name;
use std::io::IsTerminal;
use std::path::PathBuf;

/// Info or export.
pub(crate) fn fmu(command: &FmuCommand) -> Result<Exit, CliError> {
    match command {
        FmuCommand::Info(args) => info(args),
        FmuCommand::Export(args) => write(args),
    }
}

/// Hosts an FMU for another process of this program.
pub(crate) fn fmu_host() -> Result<Exit, CliError> {
    servobench_engine_fmu::host()?;
    Ok(Exit::Passed)
}

/// Prints the description of an FMU without executing any of its code.
fn info(args: &FmuInfoArgs) -> Result<Exit, CliError> {
    let mut archive = Archive::open(&args.file, &Limits::default()).map_err(CliError::Fmu)?;
    let description = archive.description().map_err(CliError::Fmu)?;
    let files: Vec<String> = archive.files().map(str::to_owned).collect();
    print(&fmu_table(&description, &files, style()))?;
    Ok(Exit::Passed)
}

fn write(args: &FmuExportArgs) -> Result<Exit, CliError> {
    let loaded = sources::read(&args.scenario, &args.with)?;
    let program = std::env::current_exe().map_err(CliError::OwnProgram)?;
    let no_library = |error| CliError::Library(Box::new(error));
    reads(&library_path(&program).map_err(no_library)?, "the library that goes into FMUs");
    let default = PathBuf::from(format!("{}.fmu", file_name(&loaded.scenario.name)));
    let output = Outputs::default().or_standard("-o", Some(args.output.as_ref().unwrap_or(&default)))?;
    if output.is_standard_output() && std::io::stdout().is_terminal() {
        return Err(CliError::BytesForATerminal);
    }
    let library = library(&program).map_err(no_library)?;
    let (version, part) = (args.fmi, args.part);
    let bytes = export(&loaded, version, part, &library).map_err(|error| CliError::Export(Box::new(error)))?;
    output.write(&bytes)?;
    let overrides: Vec<String> = loaded.scenario.overrides.iter().map(ToString::to_string).collect();
    let with = if overrides.is_empty() { String::new() } else { format!(" with {}", printable(&overrides.join(", "))) };
    say(&format!(
        "{}: {} of {}{with}, {:.1} MB\n",
        output.shown(),
        part.name(),
        printable(&loaded.scenario.name),
        bytes.len() as f64 * 1e-6
    ));
    Ok(Exit::Passed)
}
