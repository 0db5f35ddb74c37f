//! The program `servobench-view`: recordings in, a file for the Rerun viewer out. `servobench` starts it for `view`, `compare` and
//! `--rrd`; it opens no file for writing, so that its output is whole or not there as all outputs of that program.
use servobench_isolation::{ContainError, contain};
use servobench_results::printable_lines;
use servobench_trace::{Recording, TraceError};
use servobench_view::{ViewError, requested_rrd};
use servobench_view_request::{CONTAINED, PROGRAM, Request, RequestError, VERSION};
use std::ffi::OsString;
use std::io::{self, IsTerminal, Read, Write};
use std::process::ExitCode;
use thiserror::Error;

const HELP: &str = "\
Draws recordings of servobench for the Rerun viewer.

Usage: servobench-view RECORDING.parquet… < REQUEST > DRAWN.rrd

servobench starts it for view, compare and run --rrd. REQUEST is JSON with what
is not in the recordings (labels, verdicts, limits); it may be empty for one
recording. docs/viewer.md describes it.

  -h, --help     Print help
  -V, --version  Print version
";

/// Reasons why nothing was drawn.
#[derive(Debug, Error)]
enum Failure {
    #[error("name a recording (.parquet)")]
    NoRecording,
    #[error("there is no option `{0}`; `--help` lists them")]
    Option(String),
    #[error("an .rrd file is not a text for a terminal: send standard output into a file")]
    Terminal,
    #[error(transparent)]
    Recording(#[from] TraceError),
    #[error(transparent)]
    Request(#[from] RequestError),
    #[error(transparent)]
    Contain(#[from] ContainError),
    #[error("cannot read standard input: {0}")]
    Input(io::Error),
    #[error("cannot write to standard output: {0}")]
    Output(io::Error),
    #[error(transparent)]
    View(#[from] ViewError),
}

impl Failure {
    /// Exit codes as those of `servobench`: 2 for invalid input, 3 for a failed operation.
    fn exit_code(&self) -> ExitCode {
        match self {
            Self::NoRecording
            | Self::Option(_)
            | Self::Terminal
            | Self::Recording(_)
            | Self::Request(_)
            | Self::View(ViewError::TooFewRuns { .. } | ViewError::Labels { .. } | ViewError::Label(_)) => 2.into(),
            Self::Contain(_) | Self::Input(_) | Self::Output(_) | Self::View(_) => 3.into(),
        }
    }
}

fn main() -> ExitCode {
    let arguments: Vec<OsString> = std::env::args_os().skip(1).collect();
    match answer(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            let text = printable_lines(&failure.to_string());
            // When standard error is closed, no reader is left.
            writeln!(io::stderr(), "{PROGRAM}: {text}").ok();
            failure.exit_code()
        }
    }
}

fn answer(arguments: &[OsString]) -> Result<(), Failure> {
    match arguments {
        [] => Err(Failure::NoRecording),
        [word] if word == "--version" || word == "-V" => written(format!("{VERSION}\n").as_bytes()),
        [word] if word == "--help" || word == "-h" => written(HELP.as_bytes()),
        [first, recordings @ ..] if first == CONTAINED => {
            contain()?;
            draw(recordings)
        }
        recordings => {
            let mut words = recordings.iter().map(|path| path.to_string_lossy());
            match words.find(|word| word.starts_with('-')) {
                Some(option) => Err(Failure::Option(option.into_owned())),
                None => draw(recordings),
            }
        }
    }
}

fn draw(paths: &[OsString]) -> Result<(), Failure> {
    if io::stdout().is_terminal() {
        return Err(Failure::Terminal);
    }
    let request = Request::from_json(&asked()?)?;
    let recordings = paths.iter().map(Recording::read_parquet).collect::<Result<Vec<_>, _>>()?;
    written(&requested_rrd(&recordings, &request)?)
}

/// Text on standard input; a terminal has none.
fn asked() -> Result<String, Failure> {
    let mut text = String::new();
    if !io::stdin().is_terminal() {
        io::stdin().read_to_string(&mut text).map_err(Failure::Input)?;
    }
    Ok(text)
}

fn written(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    out.write_all(bytes).and_then(|()| out.flush()).map_err(Failure::Output)
}
