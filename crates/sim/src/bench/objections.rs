//! Reasons why a scenario cannot be built, found without running it.
use super::{Bench, plant};
use crate::coupled::FmuOpener;
use crate::error::BuildError;
use crate::program::Program;
use servobench_plant::Engine;
use servobench_scenario::Scenario;

impl Bench {
    /// All reasons why `scenario` cannot be built on `engine`, as far as they can be found at once; empty if
    /// [`Bench::with_fmus`] builds it. The engine is checked by building its mechanics.
    #[must_use]
    pub fn objections(scenario: &Scenario, engine: &dyn Engine, fmu_opener: &dyn FmuOpener) -> Vec<BuildError> {
        let program = Program::new(scenario).err();
        let mechanics = plant::mechanics(scenario, engine).err();
        let found: Vec<_> = [program, mechanics].into_iter().flatten().collect();
        // The rest depends on these two.
        if found.is_empty() { Self::with_fmus(scenario, engine, fmu_opener).err().into_iter().collect() } else { found }
    }
}
