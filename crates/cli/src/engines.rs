//! The engines that this build has: the only place that knows of engine features.
use servobench_plant::Engine;
use servobench_sim::FmuOpener;
use servobench_suite::Engines;

const INSTALLED: &[&dyn Engine] = &[
    #[cfg(feature = "exact")]
    &servobench_plant::Exact,
    #[cfg(feature = "rapier")]
    &servobench_engine_rapier::Rapier,
    #[cfg(feature = "mujoco")]
    &servobench_engine_mujoco::Mujoco,
    #[cfg(feature = "fmu")]
    &crate::fmu_opener::ENGINE,
];

#[cfg(feature = "fmu")]
const FMU_OPENER: &dyn FmuOpener = &crate::fmu_opener::ByEngine;
#[cfg(not(feature = "fmu"))]
const FMU_OPENER: &dyn FmuOpener = &servobench_sim::NoFmus;

/// Every engine of this build.
pub(crate) const fn installed() -> Engines {
    Engines { installed: INSTALLED, fmu_opener: FMU_OPENER }
}
