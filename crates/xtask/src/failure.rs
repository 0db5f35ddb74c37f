//! Failures of developer commands.
use std::io;
use std::path::PathBuf;
use std::process::{ExitCode, ExitStatus};
use thiserror::Error;

/// Failure of a developer command; each message is complete in itself.
#[derive(Debug, Error)]
pub(crate) enum Failure {
    /// Unknown command.
    #[error("`{given}` is not a command; the commands of `cargo xtask` are\n{commands}")]
    Usage {
        /// The arguments as given.
        given: String,
        /// One line per command.
        commands: String,
    },
    /// A file from outside the project could not be fetched.
    #[error("{name} cannot be fetched ({why}); {help}")]
    Fetch {
        /// Name and version.
        name: String,
        /// The cause, in short.
        why: String,
        /// The remedy.
        help: String,
    },
    /// A program could not be started.
    #[error("`{program}` cannot be started ({source}); install it or put it on the PATH")]
    Start {
        /// Its name.
        program: String,
        /// The system's reason.
        source: io::Error,
    },
    /// A program ended with an unexpected exit code.
    #[error("`{command}` ended with {status} instead of exit code {expected}")]
    Ended {
        /// The command line.
        command: String,
        /// Exit status.
        status: ExitStatus,
        /// Expected exit code.
        expected: i32,
    },
    /// A file operation failed.
    #[error("cannot {what} {}: {source}", path.display())]
    File {
        /// The operation: "read", "write".
        what: &'static str,
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A program printed unexpected output.
    #[error("`{command}` printed something unexpected: {why}")]
    Output {
        /// The command line.
        command: String,
        /// The mistake, in words.
        why: String,
    },
    /// The checks found something.
    #[error("{} found:\n{}", counted(findings.len()), findings.join("\n"))]
    Findings {
        /// One line each.
        findings: Vec<String>,
    },
    /// A step of `test` failed; its own message is printed already.
    #[error("{passed} passed, 1 failed, {not_run} not run")]
    Steps {
        /// Steps that passed.
        passed: usize,
        /// Steps that were not run.
        not_run: usize,
    },
}

impl Failure {
    /// The exit code of the process: 2 for wrong usage, else 1.
    pub(crate) fn exit_code(&self) -> ExitCode {
        match self {
            Self::Usage { .. } => ExitCode::from(2),
            _ => ExitCode::from(1),
        }
    }

    /// For `map_err` on a file operation.
    pub(crate) fn file(what: &'static str, path: impl Into<PathBuf>) -> impl FnOnce(io::Error) -> Self {
        let path = path.into();
        move |source| Self::File { what, path, source }
    }
}

fn counted(findings: usize) -> String {
    if findings == 1 { "1 mistake".into() } else { format!("{findings} mistakes") }
}
