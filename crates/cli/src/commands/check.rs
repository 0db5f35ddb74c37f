//! `servobench check`: validates without running.
use crate::args::CheckArgs;
use crate::console::print;
use crate::exit::{CliError, Exit};
use crate::sources;

/// Reports every mistake of every file in one go.
pub(crate) fn check(args: &CheckArgs) -> Result<Exit, CliError> {
    let files = sources::files(&args.scenarios)?;
    sources::load(&files)?;
    let plural = if files.len() == 1 { "scenario is" } else { "scenarios are" };
    print(&format!("{} {plural} valid\n", files.len()))?;
    Ok(Exit::Passed)
}
