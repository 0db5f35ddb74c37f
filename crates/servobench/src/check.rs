//! Objections to a scenario that cannot be built on an engine, found without running it.
mod basis;

use crate::engines::Engines;
use crate::error::{Error, is_of_the_run};
use crate::panicked::caught;
use crate::preview::Doubt;
use serde::{Deserialize, Serialize};
use servobench_fmu_file::{FmuEntry, FmuMistake};
use servobench_plant::{Engine, EngineName, MechanicsError, Refusal, RefusedAt};
use servobench_scenario::{AxisMechanics, Scenario, parameter_key, switch_key};
use servobench_sim::{Bench, BuildError, ConnectionDelay, FmuDoubt, FmuOpener, UnusableFmu};
use std::fmt;

/// A reason why a scenario cannot be built.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Objection {
    /// Key of the scenario that is to blame: `axis.mjcf.file`, `program.0`.
    pub key: String,
    /// Line, from 1, of the MJCF file that is to blame; without one it is the key itself.
    pub line: Option<u32>,
    /// The mistake, in words.
    pub message: String,
    /// Remedy; empty when the message contains it.
    pub help: String,
}

/// Signal exchange between axis and FMUs.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Exchange {
    /// Delay of each connection.
    pub delays: Vec<ConnectionDelay>,
    /// Doubtful settings of the exchange.
    pub doubts: Vec<Doubt>,
}

/// The exchange of axis and FMUs of a scenario without objections; nothing where no FMU is beside the axis.
///
/// # Errors
/// [`Error`] when it cannot be built after all.
pub fn exchange(scenario: &Scenario, engine: EngineName, engines: &Engines) -> Result<Exchange, Error> {
    let engine = engines.get(engine)?;
    if scenario.fmus.is_empty() {
        return Ok(Exchange::default());
    }
    caught(|| {
        let bench = Bench::with_fmus(scenario, engine, engines.fmu_opener)?;
        let doubt = |FmuDoubt { index, doubt }: &FmuDoubt| {
            let Objection { key, message, help, .. } = Objection::to_fmu(doubt, &format!("fmu.{index}"));
            Doubt { key, line: None, message, help }
        };
        Ok(Exchange { delays: bench.delays().to_vec(), doubts: bench.fmu_doubts().iter().map(doubt).collect() })
    })?
}

/// All reasons why `scenario` cannot be built on `engine`, as far as they can be found in one pass; empty when it can be built.
///
/// # Errors
/// [`Error`] when no answer is possible: a library does not load, an FMU crashes.
pub fn objections(
    scenario: &Scenario,
    engine: &dyn Engine,
    fmu_opener: &dyn FmuOpener,
) -> Result<Vec<Objection>, Error> {
    let mut all = Vec::new();
    for error in Bench::objections(scenario, engine, fmu_opener) {
        if is_of_the_run(&error) {
            return Err(error.into());
        }
        all.extend(of(&error, scenario));
    }
    Ok(all)
}

/// Limits of `scenario` that no run can keep; the scenario must be one that can be built.
#[must_use]
pub fn unmeasurable(scenario: &Scenario) -> Vec<Objection> {
    basis::objections(scenario)
}

/// Objections behind `error`, each at its key.
fn of(error: &BuildError, scenario: &Scenario) -> Vec<Objection> {
    let key = match error {
        BuildError::Mechanics(MechanicsError::Refused { engine, refusals, help, .. }) => {
            return refusals.iter().map(|refusal| Objection::to(refusal, *engine, help, scenario)).collect();
        }
        BuildError::Mechanics(MechanicsError::Fmu { mistakes, .. }) => {
            return mistakes.iter().map(|mistake| Objection::to_fmu(mistake, "axis.fmu")).collect();
        }
        BuildError::Fmus(fmus) | BuildError::Broken(fmus) => {
            let of = |fmu: &UnusableFmu| {
                let table = format!("fmu.{}", fmu.index);
                fmu.mistakes.iter().map(|mistake| Objection::to_fmu(mistake, &table)).collect::<Vec<_>>()
            };
            return fmus.iter().flat_map(of).collect();
        }
        BuildError::NoSuchFault { index, .. } => format!("expect.{index}.fault"),
        BuildError::NoSuchSignal { index, variable, .. } => format!("fmu.{index}.inputs.{variable}"),
        BuildError::Mechanics(MechanicsError::Unsupported { engine, what, help }) => {
            let message = format!("engine `{engine}` does not support {what}");
            return vec![Objection { help: help.clone(), ..Objection::new(model_key(scenario), message) }];
        }
        // The key names the object.
        BuildError::Object { key, error } => return vec![Objection::new(key, error.to_string())],
        BuildError::Drive(error) => parameter_key(error.name).to_owned(),
        BuildError::Switches(error) => switch_key(error.name).to_owned(),
        BuildError::EndStops(error) => parameter_key(error.parameter()).to_owned(),
        BuildError::Key(error) => error.name.to_owned(),
        BuildError::Mechanics(_) | BuildError::Parameter(_) => model_key(scenario).to_owned(),
        BuildError::Plan { index, .. }
        | BuildError::NothingToAbort { index, .. }
        | BuildError::TooLong { step: Some(index), .. } => format!("program.{index}"),
        BuildError::UnknownChannel { .. } => "record.channels".to_owned(),
        BuildError::IdleDisturbance { index, .. } => format!("disturbance.{index}"),
        BuildError::TooLong { step: None, .. } | BuildError::TooManyTicks { .. } => "run.duration".to_owned(),
        BuildError::RecordingTooLarge { .. } => "record".to_owned(),
        BuildError::Rate(_) => "drive".to_owned(),
        BuildError::Objects(_) => "drive.objects".to_owned(),
        BuildError::Units(_) => "bus.units".to_owned(),
        BuildError::Link(_) | BuildError::NoDriveOnTheBus => "bus".to_owned(),
        BuildError::Points(_) => "program".to_owned(),
        BuildError::Coupling(_) | BuildError::NotBegun(_) => "fmu".to_owned(),
        BuildError::OnlyAnFmu { .. } | BuildError::NoFmu { .. } => "engine".to_owned(),
    };
    vec![Objection::new(&key, error.to_string())]
}

/// `axis.mjcf.file: the file has no joint; name one`
impl fmt::Display for Objection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { key, line, message, help } = self;
        let line = line.map(|line| format!(", line {line}")).unwrap_or_default();
        let help = if help.is_empty() { String::new() } else { format!("; {help}") };
        write!(f, "`{key}`{line}: {message}{help}")
    }
}

impl Objection {
    /// An objection to `key`.
    #[must_use]
    pub fn new(key: &str, message: String) -> Self {
        Self { key: key.to_owned(), line: None, message, help: String::new() }
    }

    /// Objection for a refusal by `engine` of the MJCF file of `scenario`.
    fn to(refusal: &Refusal, engine: EngineName, help: &str, scenario: &Scenario) -> Self {
        let (key, line) = match &refusal.place {
            RefusedAt::Line(line) => (model_key(scenario), Some(*line)),
            RefusedAt::Name(name) => (name_key(name, scenario).unwrap_or(model_key(scenario)), None),
            RefusedAt::File => (model_key(scenario), None),
            // The same for every engine.
            RefusedAt::Joint { is_motor, .. } => {
                let key = if *is_motor { "axis.mjcf.motor_joint" } else { "axis.mjcf.load_joint" };
                return Self::new(key, refusal.message.clone());
            }
        };
        let message = format!("engine `{engine}`: {}", refusal.message);
        Self { key: key.to_owned(), line, message, help: help.to_owned() }
    }

    /// Objection for a mismatch with the file of the FMU that `table` describes.
    fn to_fmu(mistake: &FmuMistake, table: &str) -> Self {
        let key = match &mistake.at {
            FmuEntry::File | FmuEntry::Conduct => format!("{table}.file"),
            FmuEntry::Step => format!("{table}.step"),
            FmuEntry::EventMode => format!("{table}.event_mode"),
            FmuEntry::Isolation => format!("{table}.isolation"),
            FmuEntry::Start(variable) => format!("{table}.parameters.{variable}"),
            FmuEntry::Input(variable) => format!("{table}.inputs.{variable}"),
            FmuEntry::Output(variable) => format!("{table}.outputs.{variable}"),
        };
        Self { key, line: None, message: mistake.message.clone(), help: mistake.help.clone() }
    }
}

pub(crate) fn has_mjcf(scenario: &Scenario) -> bool {
    matches!(scenario.axis.mechanics, AxisMechanics::Mjcf(_))
}

/// Key of the model that the engine simulates.
#[must_use]
pub fn model_key(scenario: &Scenario) -> &'static str {
    if has_mjcf(scenario) { "axis.mjcf.file" } else { "axis" }
}

/// Key that gives the name of a joint or an actuator.
fn name_key(name: &str, scenario: &Scenario) -> Option<&'static str> {
    let AxisMechanics::Mjcf(mjcf) = &scenario.axis.mechanics else { return None };
    [
        ("axis.mjcf.motor_joint", &mjcf.motor_joint),
        ("axis.mjcf.load_joint", &mjcf.load_joint),
        ("axis.mjcf.actuator", &mjcf.actuator),
    ]
    .into_iter()
    .find_map(|(key, own)| (own == name).then_some(key))
}
