//! `servobench man`: man pages, generated from the help.
use crate::args::{ManArgs, visible};
use crate::console::{print_bytes, say};
use crate::error::CliError;
use crate::exit::Exit;
use crate::outputs::{Outputs, make_folder};
use clap::Command;
use clap_mangen::Man;

/// Prints the page of the program, or writes that and those of all commands into a folder.
pub(crate) fn man(args: &ManArgs) -> Result<Exit, CliError> {
    let mut program = visible().disable_help_subcommand(true);
    program.build();
    let Some(folder) = &args.out else {
        print_bytes(&page(&program)?)?;
        return Ok(Exit::Passed);
    };
    let (mut names, mut pages) = (Vec::new(), Vec::new());
    render(&program, &mut names, &mut pages)?;
    let output = Outputs::default().folder("--out", folder, |name| names.iter().any(|page| page == name))?;
    make_folder(folder)?;
    for (name, page) in names.iter().zip(pages) {
        output.file(name)?.write(page)?;
    }
    let count = names.len();
    say(&format!("{count} pages: {}\n", folder.display()));
    Ok(Exit::Passed)
}

/// Renders the pages of `command` and its subcommands, with their file names.
fn render(command: &Command, names: &mut Vec<String>, pages: &mut Vec<Vec<u8>>) -> Result<(), CliError> {
    let name = command.get_display_name().unwrap_or_else(|| command.get_name());
    names.push(format!("{name}.1"));
    pages.push(page(command)?);
    let mut inner = command.get_subcommands().filter(|inner| !inner.is_hide_set());
    inner.try_for_each(|inner| render(inner, names, pages))
}

fn page(command: &Command) -> Result<Vec<u8>, CliError> {
    let mut page = Vec::new();
    let program = concat!("servobench ", env!("CARGO_PKG_VERSION"));
    Man::new(command.clone()).source(program).render(&mut page).map_err(CliError::Print)?;
    Ok(page)
}
