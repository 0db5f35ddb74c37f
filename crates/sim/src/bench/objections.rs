//! What keeps a scenario from being built, found without running it.
use super::{Bench, plant};
use crate::coupled::FmuOpener;
use crate::error::BuildError;
use crate::program::Program;
use servobench_plant::Engine;
use servobench_scenario::Scenario;

impl Bench {
    /// Everything that keeps `scenario` from being built on `engine`, as far as it can be told at once; nothing when
    /// [`Bench::with_fmus`] builds it. The engine is asked by building its mechanics.
    #[must_use]
    pub fn objections(scenario: &Scenario, engine: &dyn Engine, fmu_opener: &dyn FmuOpener) -> Vec<BuildError> {
        let program = Program::new(scenario).err();
        let mechanics = plant::mechanics(scenario, engine).err();
        let found: Vec<_> = [program, mechanics].into_iter().flatten().collect();
        // The rest stands on these two.
        if found.is_empty() { Self::with_fmus(scenario, engine, fmu_opener).err().into_iter().collect() } else { found }
    }
}
