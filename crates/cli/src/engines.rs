//! The engines of this build: the only place that depends on engine features.
use crate::fmu_trust::FmuTrust;
use servobench::Engines;
use servobench_plant::Engine;
use servobench_sim::FmuOpener;

/// The engines of this build, with the given one for FMUs.
macro_rules! with_fmus_of {
    ($fmu:expr) => {
        &[
            #[cfg(feature = "exact")]
            &servobench_plant::Exact,
            #[cfg(feature = "rapier")]
            &servobench_engine_rapier::Rapier,
            #[cfg(feature = "mujoco")]
            &servobench_engine_mujoco::Mujoco,
            #[cfg(feature = "fmu")]
            $fmu,
        ]
    };
}

const DESCRIBED: &[&dyn Engine] = with_fmus_of!(&crate::fmu_opener::DESCRIBED);
const ISOLATED: &[&dyn Engine] = with_fmus_of!(&crate::fmu_opener::ISOLATED);
const ANYWHERE: &[&dyn Engine] = with_fmus_of!(&crate::fmu_opener::ANYWHERE);

#[cfg(feature = "fmu")]
const fn fmu_opener(trust: FmuTrust) -> &'static dyn FmuOpener {
    use crate::fmu_opener::{ANYWHERE, ByEngine, DESCRIBED, ISOLATED};
    match trust {
        FmuTrust::Describe => &ByEngine(DESCRIBED),
        FmuTrust::Isolated => &ByEngine(ISOLATED),
        FmuTrust::AsTheScenarioSays => &ByEngine(ANYWHERE),
    }
}

#[cfg(not(feature = "fmu"))]
const fn fmu_opener(_: FmuTrust) -> &'static dyn FmuOpener {
    &servobench_sim::NoFmus
}

/// Every engine of this build, with the permission for code of FMUs from the command line.
pub(crate) fn installed() -> Engines {
    with(FmuTrust::settled())
}

/// Every engine of this build, with the permission `trust` for code of FMUs.
pub(crate) const fn with(trust: FmuTrust) -> Engines {
    let installed = match trust {
        FmuTrust::Describe => DESCRIBED,
        FmuTrust::Isolated => ISOLATED,
        FmuTrust::AsTheScenarioSays => ANYWHERE,
    };
    Engines { installed, fmu_opener: fmu_opener(trust) }
}
