//! Reasons why a scenario was not loaded, changed, built or run.
use crate::check::Objection;
use crate::engines::EngineMissing;
use crate::panicked::Panicked;
use servobench_plant::MechanicsError;
use servobench_scenario::{LoadError, OverrideError};
use servobench_sim::{BuildError, Failure};
use std::io;
use thiserror::Error;

/// Reasons why a scenario was not loaded, changed, built or run.
#[derive(Debug, Error)]
pub enum Error {
    /// The scenario cannot be read, or has mistakes: all of them, each at its place.
    #[error(transparent)]
    Scenario(#[from] LoadError),
    /// The name of a key, or a value, is not one.
    #[error(transparent)]
    Setting(#[from] OverrideError),
    /// The scenario cannot be built on its engine: every reason.
    #[error("{}", lines(.0))]
    Refused(Vec<Objection>),
    /// The closed loop cannot be built.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The build lacks the engine.
    #[error(transparent)]
    EngineMissing(#[from] EngineMissing),
    /// The run ended early, with nothing to judge.
    #[error(transparent)]
    Failed(#[from] Failure),
    /// Something panicked.
    #[error(transparent)]
    Panicked(#[from] Panicked),
    /// The disk takes no more of its recording.
    #[error("the recording cannot be kept: {0}")]
    NotKept(#[source] io::Error),
}

/// True where the attempt failed, and the scenario is not at fault.
pub(crate) const fn is_of_the_run(error: &BuildError) -> bool {
    matches!(
        error,
        BuildError::Mechanics(MechanicsError::Native { .. } | MechanicsError::NotSaved)
            | BuildError::Broken(_)
            | BuildError::NotBegun(_)
    )
}

impl Error {
    /// True where the scenario is at fault: it requests something that cannot be built.
    #[must_use]
    pub const fn is_input(&self) -> bool {
        match self {
            Self::Scenario(_) | Self::Setting(_) | Self::Refused(_) => true,
            // A library that does not load, or an FMU that crashes, is not the scenario's fault.
            Self::Build(error) => !is_of_the_run(error),
            Self::EngineMissing(_) | Self::Failed(_) | Self::Panicked(_) | Self::NotKept(_) => false,
        }
    }
}

fn lines(objections: &[Objection]) -> String {
    objections.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}
