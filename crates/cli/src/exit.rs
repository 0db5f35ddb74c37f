//! Exit codes of the program. A reader that closes the pipe (`| head`) does not change them.
use servobench_results::Outcome;
use servobench_suite::RunError;
use std::process::ExitCode;

/// Every exit code with its meaning.
pub(crate) const CODES: [(&str, &str); 7] = [
    ("0", "passed, or unjudged because there are no limits"),
    ("1", "not of servobench: a native library ended the process"),
    ("2", "invalid input: arguments, scenario or model"),
    ("3", "error: a run could not be carried out, or its results could not be written"),
    ("4", "failed: a limit is missed, a requirement broken, an expected fault missing, or a run has what --deny names"),
    ("130", "interrupted by SIGINT (Ctrl-C); results of runs that have ended are kept"),
    ("143", "interrupted by SIGTERM; results of runs that have ended are kept"),
];

/// Precedence among the exit codes of a suite's runs.
pub(crate) const PRECEDENCE: &str = "Of several, 2 comes before 3 before 4.";

/// The exit codes in a paragraph, for `--help`.
pub(crate) fn help() -> String {
    let own = CODES.iter().filter(|(code, _)| *code != "1");
    let codes = own.map(|(code, meaning)| format!("{code} {}", meaning.replace(';', ",")));
    format!("Exit codes: {}. {PRECEDENCE}", codes.collect::<Vec<_>>().join("; "))
}

/// The exit codes. A run of several scenarios ends with the worst: 2 before 3 before 4 before 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Exit {
    /// All passed or are unjudged.
    Passed,
    /// The input is wrong.
    Input,
    /// A run could not be carried out.
    Run,
    /// A run failed, or has something that `--deny` names.
    Failed,
    /// Stopped by an interrupt.
    Interrupted,
}

impl Exit {
    /// The code.
    pub(crate) const fn code(self) -> u8 {
        match self {
            Self::Passed => 0,
            Self::Input => 2,
            Self::Run => 3,
            Self::Failed => 4,
            Self::Interrupted => 130,
        }
    }

    /// The worse of two ends.
    pub(crate) fn worse(self, other: Self) -> Self {
        let rank = |exit| match exit {
            Self::Passed => 0,
            Self::Failed => 1,
            Self::Run => 2,
            Self::Input => 3,
            Self::Interrupted => 4,
        };
        if rank(other) > rank(self) { other } else { self }
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        exit.code().into()
    }
}

/// Exit code for a run with this outcome.
pub(crate) const fn of_outcome(outcome: Outcome) -> Exit {
    match outcome {
        Outcome::Passed | Outcome::Unjudged => Exit::Passed,
        Outcome::Failed => Exit::Failed,
        Outcome::Invalid => Exit::Input,
        Outcome::Error => Exit::Run,
    }
}

/// Exit code for a run that ended with this error.
pub(crate) const fn of_run_error(error: &RunError) -> Exit {
    if error.is_input() { Exit::Input } else { Exit::Run }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_has_a_meaning() {
        let all = [Exit::Passed, Exit::Input, Exit::Run, Exit::Failed, Exit::Interrupted];
        assert!(all.iter().all(|exit| CODES.iter().any(|(code, _)| *code == exit.code().to_string())));
        assert!(help().contains("3 error: a run could not"), "{}", help());
    }

    #[test]
    fn of_several_two_comes_before_three_before_four() {
        let worst = |all: &[Exit]| all.iter().fold(Exit::Passed, |worst, exit| worst.worse(*exit)).code();
        assert_eq!(worst(&[Exit::Failed, Exit::Input, Exit::Run]), 2);
        assert_eq!(worst(&[Exit::Failed, Exit::Run, Exit::Passed]), 3);
        assert_eq!(worst(&[Exit::Passed, Exit::Failed]), 4);
        assert_eq!(worst(&[Exit::Passed]), 0);
    }
}
