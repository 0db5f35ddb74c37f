//! `servobench check`: validates without running.
use crate::args::CheckArgs;
use crate::exit::{CliError, Exit};
use crate::sources;
use std::io::Write;

/// Reports every mistake of every file in one go.
pub(crate) fn check(args: &CheckArgs) -> Result<Exit, CliError> {
    let files = sources::files(&args.scenarios)?;
    sources::load(&files)?;
    let plural = if files.len() == 1 { "scenario is" } else { "scenarios are" };
    writeln!(std::io::stdout(), "{} {plural} valid", files.len())?;
    Ok(Exit::Passed)
}
