//! The engines that this build has: the only place that knows of engine features.
use servobench_suite::{Engines, Installed};

/// Every engine of this build.
pub(crate) fn installed() -> Engines {
    Engines { exact: exact(), rapier: rapier(), mujoco: mujoco() }
}

#[cfg(feature = "exact")]
fn exact() -> Option<Installed> {
    Some(Installed { engine: &servobench_plant::Exact, isolated: false })
}

#[cfg(not(feature = "exact"))]
fn exact() -> Option<Installed> {
    None
}

#[cfg(feature = "rapier")]
fn rapier() -> Option<Installed> {
    Some(Installed { engine: &servobench_engine_rapier::Rapier, isolated: false })
}

#[cfg(not(feature = "rapier"))]
fn rapier() -> Option<Installed> {
    None
}

/// `MuJoCo` answers errors by ending the process: isolated.
#[cfg(feature = "mujoco")]
fn mujoco() -> Option<Installed> {
    Some(Installed { engine: &servobench_engine_mujoco::Mujoco, isolated: true })
}

#[cfg(not(feature = "mujoco"))]
fn mujoco() -> Option<Installed> {
    None
}
