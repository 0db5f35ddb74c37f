//! Errors of commands: one type, each variant with the error of the crate that it comes from, and one match from it to the exit code.
use crate::commands::{AdviseMistake, Findings, PlanMistake};
use crate::diagnostics::mistakes;
use crate::exit::{Exit, of_run_error};
use crate::outputs::Refused;
use crate::sources::{Unusable, named, told};
use crate::view_program::NoViewProgram;
use servobench_advise::AdviseError;
use servobench_config::Choice as _;
use servobench_isolation::ContainError;
use servobench_report::ReportError;
use servobench_results::{COMPARISON, FolderError, JournalError, RESULTS, ResultsError, printable};
use servobench_scenario::{Diagnostic, LoadError, Sources};
use servobench_structured_text::ExportError;
use servobench_suite::{CompareError, Job, RunError};
use servobench_trace::TraceError;
use servobench_view_request::{LabelError, RequestError};
use std::ffi::OsString;
use std::fmt::Display;
use std::io;
use std::path::PathBuf;
use std::process::ExitStatus;
use thiserror::Error;

/// Instructions for getting the viewer.
const GET_VIEWER: &str = "there is no Rerun viewer: `cargo xtask viewer` fetches one, and so does \
                          `pip install rerun-sdk==0.36.3`";

/// Error of a command.
#[derive(Debug, Error)]
pub(crate) enum CliError {
    // Invalid input.
    #[error("{}", told(.0))]
    Scenario(#[from] LoadError),
    #[error("{}", lines(.0))]
    Scenarios(Vec<Unusable>),
    /// Mistakes in a scenario that are found after it was read.
    #[error("{}", mistakes(.diagnostics, .sources))]
    Mistakes { diagnostics: Vec<Diagnostic>, sources: Box<Sources> },
    #[error("there is no scenario (`*.toml`) in `{}`", .folder.display())]
    NoScenario { folder: PathBuf },
    #[error("`-` is there twice: standard input holds one scenario")]
    StdinTwice,
    #[error("`{}` has no `[bus]`, over which objects are written: add one, or leave the scenario out for the values after \
             power-on", named(.scenario))]
    NoBus { scenario: PathBuf },
    #[error("there is no {what} `{name}`: {help}")]
    NoSuch { what: &'static str, name: String, help: String },
    #[error("there are several {what} `{name}`: {}; name the folder, too", .names.join(", "))]
    Several { what: &'static str, name: String, names: Vec<String> },
    #[error("cannot read `{}`: {error}", .path.display())]
    Read { path: PathBuf, error: io::Error },
    #[error("cannot read `{}`: {error}", .path.display())]
    ReadResults { path: PathBuf, error: ResultsError },
    #[error("there is no `{RESULTS}` and no `{COMPARISON}` in `{}`; name a recording, or a folder that `run` or `compare` \
             wrote", .folder.display())]
    NoResults { folder: PathBuf },
    #[error("`{}` is the recording of another run than the results beside it: run the scenarios again, or name the recording \
             itself", .0.display())]
    OtherRecording(PathBuf),
    #[error("no run in `{}` left a recording: each was invalid, or run with `--keep failed` or `--keep none`; run it again \
             with `--keep all`", .folder.display())]
    NoRecording { folder: PathBuf },
    #[error("there is no suite in `{}` that could go on: `run` writes one there with `--out`", .0.display())]
    NothingToResume(PathBuf),
    #[error("the suite in `{}` cannot go on: its scenarios, a file that they name, or the program are not those it was begun \
             with; run it again\n  {}", .folder.display(), .found.join("\n  "))]
    OtherSuite { folder: PathBuf, found: Vec<String> },
    #[error("the suite in `{}` is complete, and its report is not one of today; run it again\n  {}", .folder.display(), .found.join("\n  "))]
    NotOfToday { folder: PathBuf, found: Vec<String> },
    #[error("the journal in `{}` names `{}`, which is outside of {}: a journal may come from anywhere; if you trust it, allow a folder \
             that holds its scenarios by `--root DIR`", .folder.display(), .path.display(), folders(.roots))]
    OutsideOfToday { folder: PathBuf, path: PathBuf, roots: Vec<PathBuf> },
    #[error("--resume: this suite was begun with `--root {}`; give it again if its scenarios may read there", printable(&.0.display().to_string()))]
    RootAgain(PathBuf),
    #[error(transparent)]
    Advise(#[from] AdviseMistake),
    #[error("`{}` is no table of a sweep and would be lost: name another folder with `--out`, or remove it", .0.display())]
    OtherTable(PathBuf),
    #[error("name a sweep file")]
    NoSweep,
    #[error(
        "no point of the sweep that was tried ({checked}) is a valid scenario, not even the first, with {point}:\n{why}"
    )]
    NoValidPoint { checked: usize, point: String, why: String },
    #[error("`{}` holds a suite of `{command}`: resume it with `servobench {command} --resume`", .folder.display())]
    OtherCommand { folder: PathBuf, command: &'static str },
    #[error("--resume: this suite was begun with `--allow-unisolated-fmus`; give it again if you trust its FMUs")]
    TrustAgain,
    #[error("--rrd: with `--keep none` no recording is left for the viewer; leave one of them out")]
    NothingForTheViewer,
    #[error(transparent)]
    ReadRecording(TraceError),
    /// Message of `servobench-view`.
    #[error("{0}")]
    NotDrawn(String),
    #[error(transparent)]
    Label(#[from] LabelError),
    #[error("`{}`: {}{error}", .recording.display(), options(.error))]
    Timing { recording: PathBuf, error: ReportError },
    #[error(transparent)]
    Output(#[from] Refused),
    #[cfg(feature = "fmu")]
    #[error("-o: an FMU is no text for a terminal; name a file, or pipe standard output into something")]
    BytesForATerminal,
    #[error("the variable SOURCE_DATE_EPOCH is `{}`; it is a number of seconds since 1970, or unset", .0.display())]
    SourceDateEpoch(OsString),
    #[error("{}", lines(.0))]
    Plan(Vec<PlanMistake>),
    #[error(
        "a comparison needs two runs at least: name a second scenario, two variants (--variant, --shaper), or results of earlier \
         runs (--against)"
    )]
    TooFewScenarios,
    #[error("--variant: two are called `{0}`; give each a name of its own")]
    VariantTwice(String),
    #[error("variant `{variant}` of `{}`: {}", named(.scenario), told(.error))]
    Variant { variant: String, scenario: PathBuf, error: LoadError },
    #[error("{0}")]
    Shaper(String),
    #[error("--equal {quantity}={error}")]
    EqualValue { quantity: &'static str, error: String },
    #[error("--against: cannot read `{}`: {why}", .path.display())]
    Earlier { path: PathBuf, why: String },
    #[error(transparent)]
    Compare(Box<CompareError>),
    #[error("nothing was measured of two of these runs: there is nothing to compare")]
    NothingToCompare,
    #[error(transparent)]
    Plc(#[from] ExportError),
    #[cfg(feature = "fmu")]
    #[error("{}", printable(&.0.to_string()))]
    Fmu(servobench_fmi::FmuError),
    #[cfg(feature = "fmu")]
    #[error(transparent)]
    Export(Box<servobench_fmu::FmuError>),

    // Invalid input, or work that could not be carried out.
    #[error("{}", lines(.0))]
    Runs(Vec<FailedRun>),
    #[error(transparent)]
    Check(Findings),

    // Work that could not be carried out.
    #[error(transparent)]
    NoAdvice(#[from] AdviseError),
    #[error("{0}; nothing was begun")]
    Shortage(LoadError),
    #[error(transparent)]
    Folder(#[from] FolderError),
    #[error(transparent)]
    Journal(#[from] JournalError),
    #[error(transparent)]
    Results(#[from] ResultsError),
    #[error("cannot make the folder `{}`: {error}", .folder.display())]
    MakeFolder { folder: PathBuf, error: io::Error },
    #[error("cannot write `{}`: {error}", .path.display())]
    Write { path: PathBuf, error: io::Error },
    #[error("cannot write to standard output: {0}")]
    Print(io::Error),
    #[error("standard input: {0}")]
    Listen(io::Error),
    #[error(transparent)]
    WriteRecording(TraceError),
    #[error(transparent)]
    ViewProgram(#[from] NoViewProgram),
    #[error("a recording was not drawn for the Rerun viewer: {0}")]
    Drawing(String),
    #[error(transparent)]
    Request(#[from] RequestError),
    #[error(transparent)]
    Report(#[from] ReportError),
    #[error(transparent)]
    Schema(serde_json::Error),
    #[error("cannot find myself: {0}")]
    OwnProgram(io::Error),
    #[error("cannot listen to signals: {0}")]
    Signals(io::Error),
    #[error(transparent)]
    Contain(#[from] ContainError),
    #[error("{GET_VIEWER}")]
    NoViewer,
    #[error("cannot start {}: {error}; {GET_VIEWER}", .viewer.display())]
    StartViewer { viewer: PathBuf, error: io::Error },
    #[error("the viewer ended with {0}")]
    ViewerEnded(ExitStatus),
    #[cfg(feature = "fmu")]
    #[error(transparent)]
    Library(Box<servobench_fmu::FmuError>),
    #[cfg(feature = "fmu")]
    #[error(transparent)]
    Host(#[from] servobench_engine_fmu::HostError),
}

impl From<CompareError> for CliError {
    fn from(error: CompareError) -> Self {
        Self::Compare(Box::new(error))
    }
}

/// A run of a comparison that could not be carried out.
#[derive(Debug, Error)]
#[error("{scenario} on {engine}: {error}")]
pub(crate) struct FailedRun {
    scenario: String,
    engine: &'static str,
    error: RunError,
}

impl FailedRun {
    pub(crate) fn new(job: &Job, error: RunError) -> Self {
        Self { scenario: job.label().to_owned(), engine: job.engine.name(), error }
    }
}

impl CliError {
    /// Exit code of the program.
    pub(crate) fn exit(&self) -> Exit {
        match self {
            Self::Scenario(_)
            | Self::Scenarios(_)
            | Self::Mistakes { .. }
            | Self::NoScenario { .. }
            | Self::StdinTwice
            | Self::NoBus { .. }
            | Self::NoSuch { .. }
            | Self::Several { .. }
            | Self::Read { .. }
            | Self::ReadResults { .. }
            | Self::NoResults { .. }
            | Self::NoRecording { .. }
            | Self::OtherRecording(_)
            | Self::NothingToResume(_)
            | Self::Folder(FolderError::NotOurs { .. })
            | Self::OtherSuite { .. }
            | Self::NotOfToday { .. }
            | Self::OutsideOfToday { .. }
            | Self::RootAgain(_)
            | Self::Journal(JournalError::Link(_) | JournalError::Outside { .. })
            | Self::OtherCommand { .. }
            | Self::NoValidPoint { .. }
            | Self::NoSweep
            | Self::OtherTable(_)
            | Self::Advise(_)
            | Self::NoAdvice(AdviseError::TooFewDraws { .. } | AdviseError::TooMuch { .. })
            | Self::TrustAgain
            | Self::NothingForTheViewer
            | Self::ReadRecording(_)
            | Self::NotDrawn(_)
            | Self::Label(_)
            | Self::Timing { .. }
            | Self::Output(_)
            | Self::SourceDateEpoch(_)
            | Self::Plan(_)
            | Self::TooFewScenarios
            | Self::VariantTwice(_)
            | Self::Variant { .. }
            | Self::Shaper(_)
            | Self::EqualValue { .. }
            | Self::Earlier { .. }
            | Self::Compare(_)
            | Self::Plc(_)
            | Self::NothingToCompare => Exit::Input,
            #[cfg(feature = "fmu")]
            Self::Fmu(_) | Self::Export(_) | Self::BytesForATerminal => Exit::Input,
            Self::Runs(failed) => {
                failed.iter().fold(Exit::Run, |worst, failed| worst.worse(of_run_error(&failed.error)))
            }
            Self::Check(findings) => findings.exit(),
            Self::NoAdvice(_) => Exit::Failed,
            Self::Shortage(_)
            | Self::Folder(_)
            | Self::Journal(_)
            | Self::Results(_)
            | Self::MakeFolder { .. }
            | Self::Write { .. }
            | Self::Print(_)
            | Self::Listen(_)
            | Self::WriteRecording(_)
            | Self::ViewProgram(_)
            | Self::Drawing(_)
            | Self::Request(_)
            | Self::Report(_)
            | Self::Schema(_)
            | Self::OwnProgram(_)
            | Self::Signals(_)
            | Self::Contain(_)
            | Self::NoViewer
            | Self::StartViewer { .. }
            | Self::ViewerEnded(_) => Exit::Run,
            #[cfg(feature = "fmu")]
            Self::Library(_) | Self::Host(_) => Exit::Run,
        }
    }
}

/// A line each.
fn lines(all: &[impl Display]) -> String {
    all.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

/// Folders in a list.
fn folders(all: &[PathBuf]) -> String {
    all.iter().map(|folder| format!("`{}`", folder.display())).collect::<Vec<_>>().join(" and ")
}

/// The options that a diagram was refused for, before the reason.
const fn options(error: &ReportError) -> &'static str {
    match error {
        ReportError::Width { .. } => "--width: ",
        ReportError::UnknownSource { .. } => "--source: ",
        ReportError::NoSuchTime { .. } => "--from, --to: ",
        _ => "",
    }
}
