//! Which engines this build has.
use servobench_plant::Engine;
use servobench_scenario::EngineName;
use servobench_sim::{NoPartners, Partners};
use thiserror::Error;

/// An engine as this build has it.
#[derive(Clone, Copy)]
pub struct Installed {
    /// The engine.
    pub engine: &'static dyn Engine,
    /// Whether it can end the process that it runs in: it then runs in a worker process of its own.
    pub isolated: bool,
}

/// The engines of this build; the command line fills it, since it alone has engine features.
#[derive(Clone, Copy)]
pub struct Engines {
    /// `exact`.
    pub exact: Option<Installed>,
    /// `rapier`.
    pub rapier: Option<Installed>,
    /// `mujoco`.
    pub mujoco: Option<Installed>,
    /// `fmu`.
    pub fmu: Option<Installed>,
    /// Who opens the FMUs beside an axis.
    pub partners: &'static dyn Partners,
}

/// The build lacks an engine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "this build has no engine `{}`; build it in with `cargo build --release -p servobench-cli --features {}` (for \
     `mujoco` after `cargo xtask setup`), or choose one with `--engine`",
    name.as_str(), name.as_str()
)]
pub struct EngineMissing {
    /// The engine; the feature has its name.
    pub name: EngineName,
}

impl Engines {
    /// A build without engines.
    pub const NONE: Self = Self { exact: None, rapier: None, mujoco: None, fmu: None, partners: &NoPartners };

    /// The engine `name`.
    ///
    /// # Errors
    /// [`EngineMissing`] names the feature and the command.
    pub fn get(&self, name: EngineName) -> Result<Installed, EngineMissing> {
        let installed = match name {
            EngineName::Exact => self.exact,
            EngineName::Rapier => self.rapier,
            EngineName::Mujoco => self.mujoco,
            EngineName::Fmu => self.fmu,
        };
        installed.ok_or(EngineMissing { name })
    }

    /// Names of the engines that are there.
    #[must_use]
    pub fn names(&self) -> Vec<EngineName> {
        EngineName::ALL.into_iter().filter(|name| self.get(*name).is_ok()).collect()
    }
}
