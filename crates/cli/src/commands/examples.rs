//! `servobench examples`: the ready scenarios.
use crate::args::ExamplesArgs;
use crate::console::{command, print, style};
use crate::error::CliError;
use crate::exit::Exit;
use crate::outputs::{Outputs, is_name};
use crate::ready::{self, Ready, Written};
use servobench_report::{Style, two_columns, wrapped};
use std::path::Path;

/// Lists the ready scenarios, or writes one of them.
pub(crate) fn examples(args: &ExamplesArgs) -> Result<Exit, CliError> {
    let text = match &args.name {
        None => listed(&ready::all(), style()),
        Some(name) => write(&ready::named(name)?, args.to.as_deref().unwrap_or(Path::new("")))?,
    };
    print(&text)?;
    Ok(Exit::Passed)
}

/// The scenarios by folder, each with its description.
fn listed(all: &[Ready], style: Style) -> String {
    let mut text = String::new();
    for group in all.chunk_by(|one, other| one.folder() == other.folder()) {
        let rows: Vec<_> = group.iter().map(|ready| (ready.name(), ready.description())).collect();
        text += &two_columns(group[0].folder(), &rows, style);
        text.push('\n');
    }
    text + "servobench examples NAME writes one of them with the files that it names.\n"
}

/// Writes all files of `ready` into `folder`; returns their names and the next commands.
fn write(ready: &Ready, folder: &Path) -> Result<String, CliError> {
    let Written { files, missing } = ready.written();
    let mut outputs = Outputs::default();
    let mut all = Vec::new();
    for (name, text) in &files {
        is_name(name)?;
        let path = folder.join(name);
        let output = outputs.new_file("NAME", &path, "name another folder with `--to DIR`, or remove the file")?;
        all.push((path, output, text));
    }
    let mut said = String::new();
    for (path, output, text) in &all {
        output.write(text)?;
        said.extend([path.to_string_lossy().as_ref(), "\n"]);
    }
    let path = all.first().map(|(path, ..)| path.to_string_lossy().into_owned()).unwrap_or_default();
    let mut paragraph =
        |text: &str| said.extend(["\n", wrapped(text, Style::default().width).join("\n").as_str(), "\n"]);
    for file in missing {
        paragraph(&format!(
            "It needs {file}, which is not built in: the head of the scenario has the command that makes it."
        ));
    }
    paragraph(&ready.description());
    let run = if ready.is_sweep() { "sweep" } else { "run" };
    Ok(said + &format!("  {}\n", command(&[run, &path])))
}
