//! `servobench completions`: shell completions.
use crate::args::{CompletionsArgs, visible};
use crate::console::print_bytes;
use crate::error::CliError;
use crate::exit::Exit;
use clap_complete::generate;

/// Prints the completions of a shell.
pub(crate) fn completions(args: &CompletionsArgs) -> Result<Exit, CliError> {
    let mut program = visible();
    let name = program.get_name().to_owned();
    let mut script = Vec::new();
    generate(args.shell, &mut program, name, &mut script);
    print_bytes(&script)?;
    Ok(Exit::Passed)
}
