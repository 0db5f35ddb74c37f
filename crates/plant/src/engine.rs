//! The engines: their list, and the trait that builds mechanics from a model.
use crate::integration::Integrator;
use crate::mechanics::{Mechanics, MechanicsError, MechanicsSetup, ModelKind};
use servobench_config::{Choice as _, choices};
use std::fmt::{self, Display, Formatter};

choices! {
    /// An engine. A build has some of them; the feature that builds one in has its name.
    pub enum EngineName default Exact {
        /// exact zero-order hold of the linear chain
        Exact = "exact",
        /// Rapier, in f64
        Rapier = "rapier",
        /// MuJoCo
        Mujoco = "mujoco",
        /// the FMU of the axis
        Fmu = "fmu",
    }
}

/// Capabilities of an engine, whether or not a build has it: scenarios are checked and previewed on engines that the build lacks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capabilities {
    /// Kinds of models that it simulates; all others are refused.
    pub models: &'static [ModelKind],
    /// Kinds of models with which it can end its process, or not return: they run in worker processes.
    pub in_worker: &'static [ModelKind],
    /// Method of integration from tick to tick; `None` where the model decides.
    pub integrator: Option<Integrator>,
    /// True if a joint of a user's MJCF file slides slowly under an effort below its dry friction.
    pub creeps: bool,
    /// Approximate time of a tick of the closed loop with its recording and measures on a chain, and on an MJCF file (ns); `None`
    /// where the model decides. Processor time of `servobench run` for 30 s of current control at 16 kHz on two bodies with every
    /// channel recorded, and of `own-mjcf.toml`, on a shared machine of two cores. Right to a factor of two or three, and the same on
    /// every machine, so that a preview is.
    pub tick_time: Option<[f64; 2]>,
}

impl EngineName {
    /// Capabilities of this engine.
    #[must_use]
    pub const fn capabilities(self) -> Capabilities {
        match self {
            Self::Exact => Capabilities {
                models: &[ModelKind::Chain],
                in_worker: &[],
                integrator: Some(Integrator::Exact),
                creeps: false,
                tick_time: Some([450.0, 450.0]),
            },
            // Its loader reads a foreign file.
            Self::Rapier => Capabilities {
                models: &[ModelKind::Chain, ModelKind::Mjcf],
                in_worker: &[ModelKind::Mjcf],
                integrator: Some(Integrator::Leapfrog),
                creeps: false,
                tick_time: Some([2_000.0, 3_500.0]),
            },
            // It ends the process on errors; the friction of its joints is a soft constraint.
            Self::Mujoco => Capabilities {
                models: &[ModelKind::Chain, ModelKind::Mjcf],
                in_worker: &[ModelKind::Chain, ModelKind::Mjcf],
                integrator: Some(Integrator::Rk4),
                creeps: true,
                tick_time: Some([3_700.0, 4_800.0]),
            },
            // FMUs run in separate processes, so the engine needs none.
            Self::Fmu => Capabilities {
                models: &[ModelKind::Fmu],
                in_worker: &[],
                integrator: None,
                creeps: false,
                tick_time: None,
            },
        }
    }

    /// True if a model of this kind runs in a worker process.
    #[must_use]
    pub fn runs_in_worker(self, kind: ModelKind) -> bool {
        self.capabilities().in_worker.contains(&kind)
    }

    /// True if it simulates models of this kind.
    #[must_use]
    pub fn simulates(self, kind: ModelKind) -> bool {
        self.capabilities().models.contains(&kind)
    }
}

/// The name as in scenario files.
impl Display for EngineName {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// An engine: builds mechanics from the kinds of models in the [`Capabilities`] of its name.
pub trait Engine: Sync {
    /// Name of the engine.
    fn name(&self) -> EngineName;

    /// Why the engine cannot be used on this machine, such as a library that is not installed; `None` where it can.
    fn missing(&self) -> Option<String> {
        None
    }

    /// Builds the mechanics at tick 0.
    ///
    /// # Errors
    /// [`MechanicsError`] when the model is wrong or needs more than the engine has; for a kind of model that it does not
    /// simulate [`MechanicsError::not_simulated`].
    fn build(&self, setup: &MechanicsSetup) -> Result<Box<dyn Mechanics>, MechanicsError>;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_model_has_an_engine() {
        for kind in [ModelKind::Chain, ModelKind::Mjcf, ModelKind::Fmu] {
            assert!(EngineName::ALL.iter().any(|(_, engine, _)| engine.simulates(kind)), "{kind:?}");
        }
        assert_eq!(format!("{:>7}", EngineName::Exact), "  exact");
    }
}
