//! Which engines this build has.
use servobench_config::Choice as _;
use servobench_plant::{Engine, EngineName};
use servobench_sim::{FmuOpener, NoFmus};
use thiserror::Error;

/// The engines of this build; the command line lists them, since it alone has engine features.
#[derive(Clone, Copy)]
pub struct Engines {
    /// Each at most once.
    pub installed: &'static [&'static dyn Engine],
    /// Who opens the FMUs beside an axis.
    pub fmu_opener: &'static dyn FmuOpener,
}

/// The build lacks an engine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "this build has no engine `{name}`; build it in with `cargo build --release -p servobench-cli --features {name}` (for \
     `mujoco` after `cargo xtask setup`), or choose one with `--engine`"
)]
pub struct EngineMissing {
    /// The engine; the feature has its name.
    pub name: EngineName,
}

impl Engines {
    /// A build without engines.
    pub const NONE: Self = Self { installed: &[], fmu_opener: &NoFmus };

    /// The engine `name`.
    ///
    /// # Errors
    /// [`EngineMissing`] names the feature and the command.
    pub fn get(&self, name: EngineName) -> Result<&'static dyn Engine, EngineMissing> {
        self.installed.iter().copied().find(|engine| engine.name() == name).ok_or(EngineMissing { name })
    }

    /// Names of the engines that are there, in the order in which tables list them.
    #[must_use]
    pub fn names(&self) -> Vec<EngineName> {
        EngineName::ALL.iter().map(|(_, name, _)| *name).filter(|name| self.get(*name).is_ok()).collect()
    }
}
