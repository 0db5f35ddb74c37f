//! A run: recorded, measured, judged.
use crate::question::question;
use crate::requirements::rules;
use servobench_metrics::{
    EarlyEnd, Limit, LinearLoop, Metrics, Name, Verdict, judge_requirements, measure_only, note_incidents,
};
use servobench_plant::MechanicsError;
use servobench_scenario::{Scenario, Step};
use servobench_sim::{Failure, MechanicsAtRest, Reason, selected, thinned};
use servobench_trace::Recording;
use std::collections::HashSet;
use std::io;

/// A completed run.
#[derive(Debug)]
pub struct Run {
    /// The signals that the scenario records, at `record.rate`, with events and moves.
    pub recording: Recording,
    /// Every metric, of the run and of each move.
    pub metrics: Metrics,
    /// Limits and requirements that were met or not, and why.
    pub verdict: Verdict,
}

/// Inputs beside the scenario that judge a recording.
#[derive(Debug, Default)]
pub struct Judging<'a> {
    /// The early end, if there was one.
    pub ended: Option<EarlyEnd>,
    /// The MJCF file of the axis around its rest, where it has one.
    pub model: Option<&'a MechanicsAtRest>,
    /// Metrics that are measured; `None`: all.
    pub wanted: Option<&'a HashSet<Name>>,
    /// True where the drive of the scenario did not control the run: the scenario's linear loop is then not that of the run.
    pub is_controlled_from_outside: bool,
}

impl Run {
    /// Measures and judges `recording`, a run of `scenario` at every tick.
    ///
    /// # Errors
    /// Those of the disk that keeps a long recording.
    pub fn judged(scenario: &Scenario, mut recording: Recording, judging: Judging<'_>) -> io::Result<Self> {
        let Judging { ended, model, wanted, is_controlled_from_outside } = judging;
        let mut rules = rules(scenario, &recording, ended, model);
        if is_controlled_from_outside {
            (rules.linear_loop, rules.poles) = (LinearLoop::NotAnalysed, None);
            rules.not_analysed = Some("the run alone is judged: its controller is outside of the scenario".to_owned());
        }
        note_incidents(&mut recording, &rules);
        let requirements = judge_requirements(&recording, &rules);
        let recording = selected(recording, &scenario.record.channels);
        let is_wanted = |name| wanted.is_none_or(|wanted| wanted.contains(&name));
        let mut metrics = measure_only(&recording, &question(scenario), &is_wanted);
        // Measured values do not depend on how much of the recording is kept.
        let recording = thinned(recording, scenario.record.rate)?;
        let of_moves: Vec<&[Limit]> = limits_of_moves(scenario).collect();
        let limits = metrics.judge(&scenario.limits).and(metrics.judge_moves(&of_moves));
        Ok(Self { verdict: limits.and(requirements), recording, metrics })
    }

    /// True where every limit and every requirement is met.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.verdict.passed()
    }

    /// A metric of the whole run (SI); `None` where it could not be measured.
    #[must_use]
    pub fn metric(&self, name: Name) -> Option<f64> {
        self.metrics.run.value(name)
    }

    /// The values of a signal, a row each; `None` of a signal that was not recorded.
    #[must_use]
    pub fn signal(&self, name: impl AsRef<str>) -> Option<&[f64]> {
        self.recording.channel(name)
    }

    /// The times of the rows (s).
    pub fn times(&self) -> impl Iterator<Item = f64> {
        (0..self.recording.len()).map(|row| self.recording.time_of(row))
    }
}

/// The limits of each move of `scenario`.
pub fn limits_of_moves(scenario: &Scenario) -> impl Iterator<Item = &[Limit]> {
    scenario.program.iter().filter_map(|step| match step {
        Step::Move(step) => Some(step.metric_limits.as_slice()),
        Step::Wait(_) => None,
    })
}

/// The early end of a failed run that can be judged: its mechanics diverged, or its program gave up.
///
/// # Errors
/// The failure itself, where it leaves nothing to judge.
pub fn early_end(failure: Failure) -> Result<EarlyEnd, Failure> {
    match failure.reason {
        Reason::Mechanics(MechanicsError::Diverged { message, .. }) => {
            Ok(EarlyEnd::Diverged { time: failure.time, reason: message })
        }
        Reason::Program(reason) => Ok(EarlyEnd::GaveUp(reason)),
        Reason::Mechanics(_) | Reason::Coupling(_) | Reason::Recording(_) | Reason::Stopped => Err(failure),
    }
}

/// Judges `recording`, a run that ended early if `failure` is given, by the requirements of `scenario`, and notes its incidents as events.
///
/// The scenario is the one by which an axis was designed, and sets its tolerances. The machine that ran may be another one, as in the drill
/// of healthy and sabotaged twins. Limits are not judged, and the loop of an MJCF file is not analysed.
///
/// # Errors
/// A failure that leaves nothing to judge.
pub fn judge(recording: &mut Recording, failure: Option<Failure>, scenario: &Scenario) -> Result<Verdict, Failure> {
    let ended = failure.map(early_end).transpose()?;
    let rules = rules(scenario, recording, ended, None);
    note_incidents(recording, &rules);
    Ok(judge_requirements(recording, &rules))
}
