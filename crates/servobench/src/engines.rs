//! Engines of a build.
use servobench_config::Choice as _;
use servobench_plant::{Engine, EngineName};
use servobench_sim::{FmuOpener, NoFmus};
use thiserror::Error;

/// Engines of a build, and the opener of FMUs.
#[derive(Clone, Copy)]
pub struct Engines {
    /// Each at most once.
    pub installed: &'static [&'static dyn Engine],
    /// Opener of the FMUs beside an axis.
    pub fmu_opener: &'static dyn FmuOpener,
}

/// An engine is not there.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum EngineMissing {
    /// The build lacks it.
    #[error(
        "this build has no engine `{name}`; build it in with `cargo build --release -p servobench-cli --features {name}` (for \
         `mujoco` after `cargo xtask setup`), or choose one with `--engine`"
    )]
    Build {
        /// The engine; the feature has its name.
        name: EngineName,
    },
    /// The machine lacks a part of it.
    #[error("the engine `{name}` cannot be used: {why}; or choose another one with `--engine`")]
    Machine {
        /// The engine.
        name: EngineName,
        /// The missing part, and where it belongs.
        why: String,
    },
}

impl EngineMissing {
    /// The engine.
    #[must_use]
    pub const fn name(&self) -> EngineName {
        match self {
            Self::Build { name } | Self::Machine { name, .. } => *name,
        }
    }
}

impl Engines {
    /// The engines of this library: `exact`, and `rapier` with its feature. FMUs are not opened.
    pub const EMBEDDED: Self = Self {
        installed: &[
            &servobench_plant::Exact,
            #[cfg(feature = "rapier")]
            &servobench_engine_rapier::Rapier,
        ],
        fmu_opener: &NoFmus,
    };

    /// A build without engines.
    pub const NONE: Self = Self { installed: &[], fmu_opener: &NoFmus };

    /// The engine `name`.
    ///
    /// # Errors
    /// [`EngineMissing`] names the feature and the command, or the missing part.
    pub fn get(&self, name: EngineName) -> Result<&'static dyn Engine, EngineMissing> {
        let found = self.installed.iter().copied().find(|engine| engine.name() == name);
        let engine = found.ok_or(EngineMissing::Build { name })?;
        engine.missing().map_or(Ok(engine), |why| Err(EngineMissing::Machine { name, why }))
    }

    /// Names of the engines that are there, in the order in which tables list them.
    #[must_use]
    pub fn names(&self) -> Vec<EngineName> {
        EngineName::ALL.iter().map(|(_, name, _)| *name).filter(|name| self.get(*name).is_ok()).collect()
    }
}
