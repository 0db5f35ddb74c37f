//! The engines that this build has: the only place that knows of engine features.
use servobench_sim::Partners;
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

#[cfg(feature = "fmu")]
const FMU: Option<Installed> = Some(Installed { engine: &crate::partners::ENGINE, isolated: false });
#[cfg(not(feature = "fmu"))]
const FMU: Option<Installed> = None;

/// FMUs run in processes of their own, so the engine needs none.
#[cfg(feature = "fmu")]
const PARTNERS: &dyn Partners = &crate::partners::ByEngine;
#[cfg(not(feature = "fmu"))]
const PARTNERS: &dyn Partners = &servobench_sim::NoPartners;

/// Every engine of this build.
pub(crate) const fn installed() -> Engines {
    Engines { exact: EXACT, rapier: RAPIER, mujoco: MUJOCO, fmu: FMU, partners: PARTNERS }
}
