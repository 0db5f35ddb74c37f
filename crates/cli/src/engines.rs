//! The engines that this build has: the only place that knows of engine features.
use servobench_plant::Engine;
use servobench_sim::Partners;
use servobench_suite::Engines;

const INSTALLED: &[&dyn Engine] = &[
    #[cfg(feature = "exact")]
    &servobench_plant::Exact,
    #[cfg(feature = "rapier")]
    &servobench_engine_rapier::Rapier,
    #[cfg(feature = "mujoco")]
    &servobench_engine_mujoco::Mujoco,
    #[cfg(feature = "fmu")]
    &crate::partners::ENGINE,
];

#[cfg(feature = "fmu")]
const PARTNERS: &dyn Partners = &crate::partners::ByEngine;
#[cfg(not(feature = "fmu"))]
const PARTNERS: &dyn Partners = &servobench_sim::NoPartners;

/// Every engine of this build.
pub(crate) const fn installed() -> Engines {
    Engines { installed: INSTALLED, partners: PARTNERS }
}
