//! Permission to run code of FMUs: only the command line grants it, not a scenario.
use crate::args::{CheckArgs, Command, FmuTrustArgs};
#[cfg(feature = "fmu")]
use servobench_fmi::Isolation;
use servobench_scenario::{Diagnostic, Invalid, LoadError, Loaded};
use std::sync::OnceLock;

/// Permission for this process and those that it starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FmuTrust {
    /// No code runs; only descriptions are read.
    Describe,
    /// Code runs in separate processes.
    Isolated,
    /// Code runs as scenarios specify, in this process too.
    AsTheScenarioSays,
}

/// Permission by the command line; none before it is set.
static TRUST: OnceLock<FmuTrust> = OnceLock::new();

/// The option that lets code run without isolation.
#[cfg(feature = "fmu")]
const ALLOW: &str = "--allow-unisolated-fmus";

impl FmuTrust {
    /// Permission granted by `command`.
    pub(crate) const fn of(command: &Command) -> Self {
        match command {
            Command::Run(args) => Self::running(args.suite.fmus),
            Command::Sweep(args) => Self::running(args.suite.fmus),
            Command::Advise(args) => Self::running(args.fmus),
            Command::Compare(args) => Self::running(args.fmus),
            Command::Check(CheckArgs { load_fmus: true, fmus, .. }) => Self::running(*fmus),
            _ => Self::Describe,
        }
    }

    const fn running(args: FmuTrustArgs) -> Self {
        if args.allow_unisolated_fmus { Self::AsTheScenarioSays } else { Self::Isolated }
    }

    /// Sets the permission for the rest of the program.
    pub(crate) fn settle(self) {
        // The first setting stays.
        TRUST.set(self).ok();
    }

    /// Permission by the command line.
    pub(crate) fn settled() -> Self {
        TRUST.get().copied().unwrap_or(Self::Describe)
    }
}

/// `loaded`, unless it needs code of an FMU to run without isolation and the command line does not allow that.
pub(crate) fn trusted(loaded: Loaded) -> Result<Loaded, LoadError> {
    if FmuTrust::settled() != FmuTrust::Isolated {
        return Ok(loaded);
    }
    let diagnostics = unisolated(&loaded, "needs");
    if diagnostics.is_empty() {
        return Ok(loaded);
    }
    let Loaded { warnings, sources, .. } = loaded;
    Err(LoadError::Invalid(Box::new(Invalid { diagnostics, warnings, sources })))
}

/// Warnings of a check that runs no code: a run of `loaded` needs an option on the command line.
pub(crate) fn doubts(loaded: &Loaded) -> Vec<Diagnostic> {
    if FmuTrust::settled() == FmuTrust::Describe { unisolated(loaded, "will need") } else { Vec::new() }
}

/// A build that opens no FMUs runs none.
#[cfg(not(feature = "fmu"))]
fn unisolated(_: &Loaded, _: &str) -> Vec<Diagnostic> {
    Vec::new()
}

/// Places in `loaded` where an FMU is to run without isolation.
#[cfg(feature = "fmu")]
fn unisolated(loaded: &Loaded, needs: &str) -> Vec<Diagnostic> {
    let scenario = &loaded.scenario;
    let mechanics = scenario.axis.fmu.iter().map(|fmu| ("axis.fmu".to_owned(), &fmu.file));
    let beside = scenario.fmus.iter().enumerate().map(|(k, fmu)| (format!("fmu.{k}"), &fmu.file));
    let all = mechanics.chain(beside).filter(|(_, file)| file.isolation == Isolation::None);
    all.map(|(table, _)| {
        let message =
            format!("the code of an FMU without isolation can do what servobench can: a run {needs} `{ALLOW}`");
        let help = format!("leave `isolation` out, or give `{ALLOW}` if you trust this FMU");
        loaded.mistake(&format!("{table}.isolation"), message, help)
    })
    .collect()
}
