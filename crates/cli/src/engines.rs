//! The engines that this build has: the only place that knows of engine features.
use servobench_suite::{Engines, Installed};

#[cfg(feature = "exact")]
const EXACT: Option<Installed> = Some(Installed { engine: &servobench_plant::Exact, isolated: false });
#[cfg(not(feature = "exact"))]
const EXACT: Option<Installed> = None;

#[cfg(feature = "rapier")]
const RAPIER: Option<Installed> = Some(Installed { engine: &servobench_engine_rapier::Rapier, isolated: false });
#[cfg(not(feature = "rapier"))]
const RAPIER: Option<Installed> = None;

/// `MuJoCo` answers errors by ending the process: isolated.
#[cfg(feature = "mujoco")]
const MUJOCO: Option<Installed> = Some(Installed { engine: &servobench_engine_mujoco::Mujoco, isolated: true });
#[cfg(not(feature = "mujoco"))]
const MUJOCO: Option<Installed> = None;

/// Every engine of this build.
pub(crate) const fn installed() -> Engines {
    Engines { exact: EXACT, rapier: RAPIER, mujoco: MUJOCO, ..Engines::NONE }
}
