//! Outputs of a suite, which overwrite neither inputs nor each other.
use crate::error::CliError;
use crate::output;
use crate::outputs::{Output, OutputFolder, Outputs};
use servobench_results::{JOURNAL, RESULTS};
use std::path::Path;

/// The option that names the JUnit report.
pub(crate) const JUNIT: &str = "--junit";

/// Outputs of a suite.
pub(crate) struct Files {
    pub(crate) out: OutputFolder,
    pub(crate) junit: Option<Output>,
}

impl Files {
    /// Results, journal, files of runs, and `others` in the folder `out`.
    pub(crate) fn named(
        out: &Path,
        junit: Option<&Path>,
        has_run: impl Fn(&str) -> bool,
        others: &[&str],
    ) -> Result<Self, CliError> {
        let mut outputs = Outputs::default();
        let is_ours = move |name: &str| {
            [RESULTS, JOURNAL].contains(&name) || others.contains(&name) || output::run_of(name).is_some_and(&has_run)
        };
        let out = outputs.folder("--out", out, is_ours)?;
        let junit = junit.map(|path| outputs.anywhere(JUNIT, path)).transpose()?;
        Ok(Self { out, junit })
    }
}
