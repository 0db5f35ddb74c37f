//! `servobench-view`, the program beside this one that draws recordings for the Rerun viewer: this one does not link Rerun.
//!
//! It reads recordings, gets everything else to be shown as JSON on standard input ([`servobench_view_request`]), and writes to the file
//! that [`Output`] opens here. It runs contained, as workers do: no Ctrl-C reaches it, and it ends with this program.
use crate::error::CliError;
use crate::outputs::Output;
use servobench_isolation::{Contained, Ending, Limits, Program};
use servobench_view_request::{CONTAINED, PROGRAM, Request, VERSION};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;
use thiserror::Error;

/// Instructions for getting the program.
const GET: &str = "`cargo build --release -p servobench-view` builds it, and the archive has it in `bin`";
/// Period of checks on a drawing program.
const GLANCE: Duration = Duration::from_secs(1);

/// Reasons why the drawing program cannot be used.
#[derive(Debug, Error)]
pub(crate) enum NoViewProgram {
    #[error(
        "the program `{PROGRAM}`, which draws recordings for the Rerun viewer, is neither beside this program nor on the PATH: {GET}"
    )]
    Missing,
    #[error("`{}` is {found}, and this program needs {VERSION}: {GET}", .program.display())]
    OtherVersion { program: PathBuf, found: String },
    #[error("cannot start `{}`: {error}; {GET}", .program.display())]
    Start { program: PathBuf, error: io::Error },
}

/// The program, of the version that belongs to this one.
#[derive(Debug)]
pub(crate) struct ViewProgram(PathBuf);

impl ViewProgram {
    /// Finds it beside this program, or on the search path.
    pub(crate) fn find() -> Result<Self, NoViewProgram> {
        let program = found().ok_or(NoViewProgram::Missing)?;
        let answer = Command::new(&program).arg("--version").stdin(Stdio::null()).stderr(Stdio::null()).output();
        let answer = match answer {
            Ok(answer) => answer,
            Err(error) => return Err(NoViewProgram::Start { program, error }),
        };
        let text = String::from_utf8_lossy(&answer.stdout);
        match text.trim() {
            VERSION => Ok(Self(program)),
            "" => Err(NoViewProgram::OtherVersion { program, found: "a program without a version".into() }),
            found => Err(NoViewProgram::OtherVersion { program, found: found.chars().take(80).collect() }),
        }
    }

    /// Draws `recordings` into `output` as specified by `request`: the whole file or nothing.
    pub(crate) fn draw(&self, recordings: &[&Path], request: &Request, output: &Output) -> Result<(), CliError> {
        let request = request.to_json()?;
        output.by_process(|file| {
            let start = |error| NoViewProgram::Start { program: self.0.clone(), error };
            let (stdin, mut to_stdin) = io::pipe().map_err(start)?;
            let paths = recordings.iter().map(|path| path.as_os_str().to_owned());
            let args = std::iter::once(CONTAINED.into()).chain(paths).collect();
            let program = Program { program: self.0.clone(), args, env: Vec::new() };
            // Its memory is that of recordings and drawing, which this program has bounded.
            let limits = Limits { memory: u64::MAX, is_foreign: false };
            let process = Contained::start(&program, stdin.into(), Some(file.into()), limits, || ()).map_err(start)?;
            // Writing fails if the program has ended; its exit status is checked below.
            to_stdin.write_all(request.as_bytes()).ok();
            drop(to_stdin);
            while process.ending().is_none() {
                process.wait_for_end(GLANCE);
            }
            process.ending().map_or(Ok(()), drawn)
        })
    }
}

/// Exit code of invalid input, a recording that cannot be read.
const INPUT: i32 = 2;

fn drawn(ending: &Ending) -> Result<(), CliError> {
    let code = ending.status.and_then(|status| status.code());
    let words = ending.last_words.trim();
    let own = words.strip_prefix(PROGRAM).and_then(|words| words.strip_prefix(": "));
    match (code, own) {
        (Some(0), _) => Ok(()),
        (Some(INPUT), Some(words)) => Err(CliError::NotDrawn(words.to_owned())),
        _ => Err(CliError::Drawing(ending.how())),
    }
}

fn found() -> Option<PathBuf> {
    let name = format!("{PROGRAM}{}", std::env::consts::EXE_SUFFIX);
    let beside = std::env::current_exe().ok().and_then(|program| Some(program.parent()?.join(&name)));
    let search = std::env::var_os("PATH").unwrap_or_default();
    let on_path = std::env::split_paths(&search).map(|folder| folder.join(&name));
    beside.into_iter().chain(on_path).find(|candidate| candidate.is_file())
}
