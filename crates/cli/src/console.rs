//! Console output: results on standard output, everything else on standard error.
//!
//! All texts pass through here, since any may quote foreign text; they leave as [`servobench_report::shown`] makes them.
use crate::error::CliError;
use servobench_report::{Style, shown};
use servobench_results::printable_json;
use std::ffi::OsStr;
use std::io::{ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};

/// Prints `text` on standard output, fit for a terminal. A reader that closed the pipe (`| head`) is not an error; any other failure to
/// write is.
pub(crate) fn print(text: &str) -> Result<(), CliError> {
    print_bytes(shown(text, has_colour(&std::io::stdout())).as_bytes())
}

/// Prints a text in parts, whole lines each, as they come.
pub(crate) fn print_parts<E>(parts: impl Iterator<Item = Result<String, E>>) -> Result<(), CliError>
where
    CliError: From<E>,
{
    let colour = has_colour(&std::io::stdout());
    let mut text = String::new();
    for part in parts {
        text += &shown(&part?, colour);
        if text.len() >= BLOCK {
            print_bytes(text.as_bytes())?;
            text.clear();
        }
    }
    print_bytes(text.as_bytes())
}

/// Bytes of a text in parts that are collected before printing.
const BLOCK: usize = 1 << 16;

/// Prints JSON, escaped so that it keeps its meaning.
pub(crate) fn print_json(json: &str) -> Result<(), CliError> {
    print_bytes(printable_json(json).as_bytes())
}

/// Prints bytes unchanged: data that is not text, or texts for programs without foreign parts.
pub(crate) fn print_bytes(bytes: &[u8]) -> Result<(), CliError> {
    let mut out = std::io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(CliError::Print(error)),
        _ => Ok(()),
    }
}

/// Writes `text` to standard error, fit for a terminal. Failure is ignored: there is nowhere to report it.
pub(crate) fn say(text: &str) {
    let mut stderr = std::io::stderr().lock();
    let colour = has_colour(&stderr);
    stderr.write_all(shown(text, colour).as_bytes()).ok();
}

fn has_colour(stream: &impl IsTerminal) -> bool {
    stream.is_terminal() && std::env::var_os("NO_COLOR").is_none()
}

/// Routes panic messages through here from now on: they may quote a scenario.
pub(crate) fn say_panics() {
    let default = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        let text = panic.to_string();
        // The default hook where nothing has to be escaped: with the thread, and the stack if requested.
        if shown(&text, false) == text { default(panic) } else { say(&format!("{text}\n")) }
    }));
}

/// This program in commands to be pasted: by its name where the shell finds it, otherwise as it was started.
fn program() -> String {
    let started = std::env::args().next().unwrap_or_else(|| "servobench".into());
    let path = Path::new(&started);
    let search = std::env::var_os("PATH").unwrap_or_default();
    path.file_name()
        .filter(|name| found_by(name, &search).is_some_and(|found| path.canonicalize().is_ok_and(|own| own == found)))
        .map_or_else(|| started.clone(), |name| name.to_string_lossy().into_owned())
}

/// A command to be pasted into a shell: this program with `words`, quoted.
pub(crate) fn command(words: &[&str]) -> String {
    let quoted = |word: &str| shlex::try_quote(word).map_or_else(|_| word.to_owned(), Into::into);
    let words: Vec<String> = std::iter::once(program().as_str()).chain(words.iter().copied()).map(quoted).collect();
    words.join(" ")
}

/// Program that a shell starts for `name` alone, with this search path.
fn found_by(name: &OsStr, search: &OsStr) -> Option<PathBuf> {
    let found = std::env::split_paths(search).map(|folder| folder.join(name)).find(|path| path.is_file());
    found.and_then(|path| path.canonicalize().ok())
}

/// Style of tables on standard output.
pub(crate) fn style() -> Style {
    Style { colour: has_colour(&std::io::stdout()), ..Style::default() }
}

#[cfg(test)]
mod tests {
    use super::command;

    #[test]
    fn a_pasted_command_has_the_words_it_was_made_of() {
        let words = ["view", "runs of today/it's $HOME.rrd"];
        let pasted = shlex::split(&command(&words)).unwrap();
        assert_eq!(pasted[1..], words);
    }
}
