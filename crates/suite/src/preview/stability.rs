//! Whether the loops are stable, and how far from their boundaries.
use super::Doubt;
use servobench_drive::{self as drive, current, velocity};
use servobench_metrics::Quantity;
use servobench_scenario::{Scenario, parameter_key};
use servobench_sim::{Analysis, BuildError, analyse_stability};
use servobench_stability::{Boundaries, Depth, GainName, LEFT_OUT, LoopReport};

/// What the analysis of the linear loop says of a scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct LoopStability(Analysis);

impl LoopStability {
    pub(super) fn of(scenario: &Scenario) -> Result<Self, BuildError> {
        Ok(Self(analyse_stability(scenario, Depth::Boundaries)?))
    }

    /// How far each loop is from a boundary; or why that is not known.
    pub(super) fn words(&self) -> Vec<String> {
        let (report, without) = match &self.0 {
            Analysis::Done { report, without } => (report, without),
            Analysis::NotPossible(why) => return vec![why.to_string()],
        };
        let mut words: Vec<String> = report.loops.iter().filter_map(margins).collect();
        if !report.is_stable() {
            words.insert(0, "unstable".to_owned());
        }
        words.extend(without.as_ref().map(ToString::to_string));
        words
    }

    /// An unstable loop, and loops that are faster than those below them.
    pub(super) fn doubts(&self) -> Vec<Doubt> {
        let Analysis::Done { report, .. } = &self.0 else { return Vec::new() };
        let unstable = report.instability.iter().map(|instability| {
            let help = format!("every run of it fails the requirement `stable`; {LEFT_OUT}");
            Doubt::new(key_of(instability.gain_name), instability.to_string(), help)
        });
        let key =
            |outer| report.loops.iter().find(|one| one.name == outer).map_or("drive", |one| key_of(one.gain_name));
        let orders = report.warnings.iter().map(|warning| Doubt::new(key(warning.outer), warning.to_string(), ""));
        unstable.chain(orders).collect()
    }
}

/// The key that sets `gain`.
fn key_of(gain: GainName) -> &'static str {
    match gain {
        GainName::Position => parameter_key(drive::Parameter::POSITION_GAIN),
        GainName::Velocity => parameter_key(velocity::Parameter::GAIN),
        GainName::CurrentBandwidth => "drive.current.bandwidth",
        GainName::CurrentD => parameter_key(current::Parameter::GAIN_D),
        GainName::CurrentQ => parameter_key(current::Parameter::GAIN_Q),
    }
}

/// By how much the gain of a loop may change until the verdict on the whole loop does.
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
