//! The linear loop of a scenario.
use crate::error::Error;
use servobench_scenario::Scenario;
use servobench_sim::{Analysis, MechanicsAtRest, NotAnalysed, Speeds, analyse_stability};
use servobench_stability::{Depth, Report};

/// The linear loop of an axis around standstill, derived from the tick that every run has.
#[derive(Debug, Clone, PartialEq)]
pub struct Linear {
    analysis: Analysis,
}

impl Linear {
    /// The loop of `scenario`; `model` is its MJCF file around its rest.
    pub(crate) fn of(scenario: &Scenario, model: Option<&MechanicsAtRest>) -> Result<Self, Error> {
        let speeds = Speeds::planned(scenario)?;
        let analysis = analyse_stability(scenario, Depth::Boundaries, speeds.as_ref(), model)?;
        Ok(Self { analysis })
    }

    /// The analysis; `None` where the loop is not known, as of a drive that is an FMU.
    #[must_use]
    pub fn report(&self) -> Option<&Report> {
        match &self.analysis {
            Analysis::Done { report, .. } => Some(report),
            Analysis::NotPossible(_) => None,
        }
    }

    /// Reason why the loop is unstable; `None` where it is stable, or not known.
    #[must_use]
    pub fn instability(&self) -> Option<String> {
        let Analysis::Done { report, master, .. } = &self.analysis else { return None };
        let of_master = || master.filter(servobench_sim::MasterLoop::is_unstable).map(|master| master.to_string());
        report.instability.as_ref().map(ToString::to_string).or_else(of_master)
    }

    /// Parts of the scenario that are not analysed.
    #[must_use]
    pub fn left_out(&self) -> &[NotAnalysed] {
        match &self.analysis {
            Analysis::Done { without, .. } => without,
            Analysis::NotPossible(why) => std::slice::from_ref(why),
        }
    }
}
