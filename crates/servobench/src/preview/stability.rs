//! Stability of the loops, and their distance from their boundaries.
use super::Doubt;
use servobench_drive::{self as drive, current, velocity};
use servobench_metrics::Quantity;
use servobench_scenario::{Scenario, parameter_key};
use servobench_sim::{Analysis, BuildError, MasterLoop, MechanicsAtRest, Speeds, analyse_stability};
use servobench_stability::{Boundaries, Depth, GainName, Instability, LEFT_OUT, LoopReport};

/// Result of the analysis of the linear loop of a scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct LoopStability {
    analysis: Analysis,
    /// True where the gains depend on the speed.
    is_scheduled: bool,
}

impl LoopStability {
    pub(super) fn of(scenario: &Scenario, depth: Depth, model: Option<&MechanicsAtRest>) -> Result<Self, BuildError> {
        let is_scheduled = scenario.actuator.drive().is_some_and(|drive| drive.params.blocks.schedule.is_some());
        let speeds = if is_scheduled { Speeds::planned(scenario)? } else { None };
        Ok(Self { analysis: analyse_stability(scenario, depth, speeds.as_ref(), model)?, is_scheduled })
    }

    /// Distance of each loop from its boundaries, or the reason why it is unknown.
    pub(super) fn words(&self) -> Vec<String> {
        let (report, master, without) = match &self.analysis {
            Analysis::Done { report, master, without } => (report, master, without),
            Analysis::NotPossible(why) => return vec![why.to_string()],
        };
        let mut words: Vec<String> = report.loops.iter().filter_map(margins).collect();
        if !report.is_stable() || master.is_some_and(|master| master.is_unstable()) {
            words.insert(0, "unstable".to_owned());
        }
        words.extend(master.as_ref().and_then(of_master));
        if self.is_scheduled {
            words.push("margins of the gains at standstill".to_owned());
        }
        words.extend(without.iter().map(ToString::to_string));
        words
    }

    /// An unstable loop, and loops that are faster than those below them.
    pub(super) fn doubts(&self) -> Vec<Doubt> {
        let Analysis::Done { report, master, .. } = &self.analysis else { return Vec::new() };
        let help = || format!("every run of it fails the requirement `stable`; {LEFT_OUT}");
        let of_drive = report
            .instability
            .iter()
            .map(|instability| Doubt::new(key_of(instability), instability.to_string(), help()));
        let of_master = master.iter().filter(|master| master.is_unstable());
        let of_master = of_master.map(|master| Doubt::new("bus.position_gain", master.to_string(), help()));
        let unstable = of_drive.chain(of_master);
        let key =
            |outer| report.loops.iter().find(|one| one.name == outer).map_or("drive", |one| key_of_gain(one.gain_name));
        let orders = report.warnings.iter().map(|warning| Doubt::new(key(warning.outer), warning.to_string(), ""));
        unstable.chain(orders).collect()
    }
}

/// The key that makes the gain of `instability`: at speed the schedule, since the loop is stable at standstill.
fn key_of(instability: &Instability) -> &'static str {
    if instability.speed.is_some() { "drive.gain_schedule" } else { key_of_gain(instability.gain_name) }
}

/// The key that sets `gain`.
fn key_of_gain(gain: GainName) -> &'static str {
    match gain {
        GainName::Position => parameter_key(drive::Parameter::POSITION_GAIN),
        GainName::Velocity => parameter_key(velocity::Parameter::GAIN),
        GainName::CurrentBandwidth => "drive.current.bandwidth",
        GainName::CurrentD => parameter_key(current::Parameter::GAIN_D),
        GainName::CurrentQ => parameter_key(current::Parameter::GAIN_Q),
    }
}

/// The gain of the position loop in the master, and its distance from its bound.
fn of_master(master: &MasterLoop) -> Option<String> {
    let largest = master.largest?;
    let factor = Quantity::new(largest / master.gain, "");
    let [gain, largest] = [master.gain, largest].map(|gain| Quantity::new(gain, "1/s"));
    Some(format!("master's position gain {gain} to {factor} × ({largest})"))
}

/// Change of a loop's gain that changes the verdict on the whole loop.
fn margins(one: &LoopReport) -> Option<String> {
    let Boundaries { below, above, .. } = one.boundaries?;
    let times = |factor: f64| format!("{} ×", Quantity::new(factor, ""));
    let name = one.name.to_string();
    let name = name.trim_end_matches(" loop");
    Some(match (below, above) {
        (Some(below), Some(above)) => format!("{name} gain from {} to {}", times(below.factor), times(above.factor)),
        (None, Some(above)) => format!("{name} gain to {}", times(above.factor)),
        (Some(below), None) => format!("{name} gain from {}", times(below.factor)),
        (None, None) => format!("{name} gain no boundary"),
    })
}
