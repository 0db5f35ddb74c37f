//! The engines: their one list, and what makes mechanics of a model.
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

/// What an engine can do, whether or not a build has it: scenarios are checked and previewed on engines that the build lacks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capabilities {
    /// What it simulates; everything else is refused.
    pub models: &'static [ModelKind],
    /// Kinds of models with which it can end the process that it runs in, or not come back: they run in worker processes.
    pub in_worker: &'static [ModelKind],
    /// How it goes from tick to tick; `None` where that is the model's own business.
    pub integrator: Option<Integrator>,
    /// Whether a joint of a user's MJCF file slides slowly under an effort below its dry friction.
    pub creeps: bool,
    /// About what a tick of the closed loop with its recording and measures takes on a chain, and on an MJCF file (ns); `None`
    /// where the model decides. Processor time of `servobench run` for 30 s of current control at 16 kHz on two bodies with every
    /// channel recorded, and of `own-mjcf.toml`, on a shared machine of two cores. Right to a factor of two or three, and the same on
    /// every machine, so that a preview is.
    pub tick_time: Option<[f64; 2]>,
}

impl EngineName {
    /// What this engine can do.
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
            // Its loader reads a file of somebody else.
            Self::Rapier => Capabilities {
                models: &[ModelKind::Chain, ModelKind::Mjcf],
                in_worker: &[ModelKind::Mjcf],
                integrator: Some(Integrator::Leapfrog),
                creeps: false,
                tick_time: Some([2_000.0, 3_500.0]),
            },
            // It answers errors by ending the process; the friction of its joints is a soft constraint.
            Self::Mujoco => Capabilities {
                models: &[ModelKind::Chain, ModelKind::Mjcf],
                in_worker: &[ModelKind::Chain, ModelKind::Mjcf],
                integrator: Some(Integrator::Rk4),
                creeps: true,
                tick_time: Some([3_700.0, 4_800.0]),
            },
            // FMUs run in processes of their own, so the engine needs none.
            Self::Fmu => Capabilities {
                models: &[ModelKind::Fmu],
                in_worker: &[],
                integrator: None,
                creeps: false,
                tick_time: None,
            },
        }
    }

    /// Whether a model of this kind runs in a worker process.
    #[must_use]
    pub fn runs_in_worker(self, kind: ModelKind) -> bool {
        self.capabilities().in_worker.contains(&kind)
    }

    /// Whether it simulates models of this kind.
    #[must_use]
    pub fn simulates(self, kind: ModelKind) -> bool {
        self.capabilities().models.contains(&kind)
    }
}

/// The name as scenario files write it.
impl Display for EngineName {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Makes mechanics of the kinds of models that the [`Capabilities`] of its name list.
pub trait Engine: Sync {
    /// Which engine it is.
    fn name(&self) -> EngineName;

    /// Builds the mechanics at tick 0.
    ///
    /// # Errors
    /// [`MechanicsError`] when the model is wrong or needs what the engine does not have; for a kind of model that it does not
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
