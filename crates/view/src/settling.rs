//! Settling of the load in its window after the last move.
use crate::run::Run;
use servobench_metrics::{Absence, Name, Question, measure};
use servobench_signals::Signal;
use servobench_trace::Recording;

/// Settling of the load after the last move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Settling {
    /// Time after the end of the profile (s).
    After(f64),
    /// Never within the recording.
    Never,
}

/// Settling of the load of `run` in ± `window`, by the definition of the metric; `None` where it cannot be measured.
pub(crate) fn settling(run: &Run<'_>, window: f64) -> Option<Settling> {
    let recording = run.recording;
    let last = recording.moves.iter().max_by(|one, two| one.end.total_cmp(&two.end))?;
    let load = run.first_of(&[Signal::LoadPosition.name()])?;
    // Data that the metric does not need would only cost time.
    let mut only = Recording::new(recording.about.clone(), recording.rate);
    (only.channels, only.moves) = (vec![load.clone()], vec![last.clone()]);
    let metrics = measure(&only, &Question { window: Some(window), ..Question::default() });
    let of_last = &metrics.moves.first()?.metrics;
    match (of_last.value(Name::SettlingTime), of_last.absence(Name::SettlingTime)) {
        (Some(time), _) => Some(Settling::After(time)),
        (None, Some(Absence::NotSettled { .. })) => Some(Settling::Never),
        (None, _) => None,
    }
}
