//! A scenario's properties that need no run: durations, effort and voltage against the available ones, modes and their distortion by each
//! engine, bandwidths, delays, memory and time; and doubtful settings, each at its key.
//!
//! ```text
//! Scenario → program of moves → set-point → effort → current, voltage     the axis follows exactly and is rigid
//! Scenario → chain → modes → steps per period on each engine
//! ```
//! An axis that follows exactly needs the effort of its set-point. Additions by vibration, an integrator or an encoder appear only in a
//! run.

mod cost;
mod coupling;
mod demand;
mod doubt;
mod integration;
mod mjcf;
mod pace;
mod program;
mod resistance;
mod screen;
mod servo;
mod stability;
mod tables;

pub use cost::Cost;
pub use demand::{Demand, EffortDemand, VoltageDemand};
pub use doubt::Doubt;
pub use integration::EngineSteps;
pub use pace::{Delay, LoopBandwidth};
pub use program::PlannedProgram;
pub use servo::{Inertias, Modes};
pub use stability::LoopStability;

use crate::panicked::caught;
use servobench_plant::EngineName;
use servobench_scenario::{AxisMechanics, Scenario};
use servobench_sim::{BuildError, MechanicsAtRest, Program};
use servobench_stability::Depth;

/// Properties of a scenario that need no run.
#[derive(Debug, Clone, PartialEq)]
pub struct Preview {
    /// Name of the scenario.
    pub name: String,
    /// Tables of the file that are based on a model, each with the file of the model.
    pub models: Vec<(&'static str, String)>,
    /// The moves.
    pub program: PlannedProgram,
    /// Demand of the moves on motor and inverter.
    pub demand: Demand,
    /// Inertia on both sides of the first spring; `None` where only a user's file or an FMU defines it.
    pub inertias: Option<Inertias>,
    /// Modes of the axis; `None` where only a user's file or an FMU defines them.
    pub modes: Option<Modes>,
    /// Integration of the fastest mode by each engine.
    pub engines: Vec<EngineSteps>,
    /// The loops of the drive, the fastest first.
    pub loops: Vec<LoopBandwidth>,
    /// Stability of these loops, and their distance from their boundaries.
    pub stability: LoopStability,
    /// Delays from the set-point to the voltage.
    pub delays: Vec<Delay>,
    /// Memory and time of a run.
    pub cost: Cost,
    /// Doubtful settings.
    pub doubts: Vec<Doubt>,
}

/// Previews `scenario` on `engines`; `model` is its MJCF file around its rest, where it has one.
///
/// # Errors
/// [`BuildError`] of moves that cannot be planned or of bodies that cannot be built; [`objections`](crate::check::objections) have the place.
pub fn preview(
    scenario: &Scenario,
    engines: &[EngineName],
    model: Option<&MechanicsAtRest>,
) -> Result<Preview, BuildError> {
    previewed(scenario, engines, Depth::Boundaries, model)
}

/// Warnings about `scenario` on `engine`, each behind its place: about its files, then, where it can be built, from its preview. An
/// unstable loop with an MJCF file is found by the run itself.
#[must_use]
pub fn warnings(scenario: &Scenario, engine: EngineName) -> Vec<String> {
    let found = caught(|| previewed(scenario, &[engine], Depth::Verdict, None));
    let doubts = found.ok().and_then(Result::ok).map_or_else(Vec::new, |preview| preview.doubts);
    let placed = doubts.iter().map(|doubt| placed(doubt, scenario));
    scenario.warnings.iter().cloned().chain(placed).collect()
}

/// `axis.toml:12: the move has no length`
fn placed(doubt: &Doubt, scenario: &Scenario) -> String {
    let Doubt { key, line, message, .. } = doubt;
    if let (Some(line), AxisMechanics::Mjcf(mjcf)) = (line, &scenario.axis.mechanics) {
        return format!("{}:{line}: {message}", mjcf.path.display());
    }
    let is_of_key = |own: &str| own == key || own.strip_prefix(key.as_str()).is_some_and(|rest| rest.starts_with('.'));
    let parameter = scenario.parameters.iter().find(|parameter| is_of_key(&parameter.key));
    let file = scenario.path.as_ref().map_or_else(|| scenario.name.clone(), |path| path.display().to_string());
    match parameter.and_then(|parameter| parameter.line) {
        Some(line) => format!("{file}:{line}: {message}"),
        None => format!("{file}: `{key}`: {message}"),
    }
}

fn previewed(
    scenario: &Scenario,
    names: &[EngineName],
    depth: Depth,
    model: Option<&MechanicsAtRest>,
) -> Result<Preview, BuildError> {
    let (planned, chain) = (Program::new(scenario)?, servobench_sim::Bench::chain(scenario)?);
    let program = PlannedProgram::new(scenario, &planned);
    let demand = Demand::of(scenario, chain.as_ref(), program.run)?;
    let modes = chain.as_ref().map(|chain| Modes::of(scenario, chain));
    let engines = EngineSteps::of(scenario, modes.as_ref(), names, program.run);
    let stability = LoopStability::of(scenario, depth, model)?;
    let mut doubts = program.doubts(scenario);
    doubts.extend(stability.doubts());
    doubts.extend(demand.doubts(scenario));
    doubts.extend(engines.iter().filter_map(|engine| engine.doubt(program.run)));
    doubts.extend(coupling::doubt(scenario, modes.as_ref()));
    doubts.extend(tables::doubts(scenario));
    doubts.extend(mjcf::doubts(scenario, names));
    Ok(Preview {
        name: scenario.name.clone(),
        models: models(scenario),
        demand,
        inertias: chain.as_ref().and_then(Inertias::of),
        modes,
        engines,
        loops: pace::loops(scenario),
        stability,
        delays: pace::delays(scenario),
        cost: Cost::of(scenario, program.run, names),
        program,
        doubts,
    })
}

/// Tables of the file that are based on a model, each with the model's path; folders may have any name.
fn models(scenario: &Scenario) -> Vec<(&'static str, String)> {
    let shown = |path: &str| path.replace(char::is_control, "\u{fffd}");
    scenario.made_of.iter().filter_map(|file| Some((file.role.modelled()?, shown(&file.path)))).collect()
}

/// Units of axis and motor (SI).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Units {
    axis: &'static str,
    motor: &'static str,
    effort: &'static str,
}

impl Units {
    fn of(scenario: &Scenario) -> Self {
        let (axis, motor) = (scenario.axis.motion, scenario.axis.motor_motion);
        Self { axis: axis.unit(), motor: motor.unit(), effort: motor.effort_unit() }
    }
}
