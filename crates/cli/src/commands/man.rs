//! `servobench man`: man pages, made of the help.
use crate::args::{ManArgs, visible};
use crate::console::{print_bytes, say};
use crate::error::CliError;
use crate::exit::Exit;
use crate::output::{make_folder, write_file};
use clap::Command;
use clap_mangen::Man;
use std::path::Path;

/// Prints the page of the program, or writes that and those of all commands into a folder.
pub(crate) fn man(args: &ManArgs) -> Result<Exit, CliError> {
    let mut program = visible().disable_help_subcommand(true);
    program.build();
    let Some(folder) = &args.out else {
        print_bytes(&page(&program)?)?;
        return Ok(Exit::Passed);
    };
    make_folder(folder)?;
    let count = write(&program, folder)?;
    say(&format!("{count} pages: {}\n", folder.display()));
    Ok(Exit::Passed)
}

/// Writes the pages of `command` and of those below it; returns how many.
fn write(command: &Command, folder: &Path) -> Result<usize, CliError> {
    let name = command.get_display_name().unwrap_or_else(|| command.get_name());
    write_file(&folder.join(format!("{name}.1")), page(command)?)?;
    let mut count = 1;
    for inner in command.get_subcommands().filter(|inner| !inner.is_hide_set()) {
        count += write(inner, folder)?;
    }
    Ok(count)
}

fn page(command: &Command) -> Result<Vec<u8>, CliError> {
    let mut page = Vec::new();
    let program = concat!("servobench ", env!("CARGO_PKG_VERSION"));
    Man::new(command.clone()).source(program).render(&mut page).map_err(CliError::Print)?;
    Ok(page)
}
