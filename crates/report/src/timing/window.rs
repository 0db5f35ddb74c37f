//! The part of time that is shown.
use crate::error::ReportError;
use servobench_trace::Recording;

/// Shortest interval that is shown (s).
const SHORTEST: f64 = 1e-9;
/// A larger time is a mistake in the recording (s): thirty million years.
const BEYOND: f64 = 1e15;
/// Duration for which the last value is shown if nothing follows, as a fraction of the whole.
const AFTERWARDS: f64 = 0.05;

/// Start and end (s).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Window {
    pub(super) from: f64,
    pub(super) to: f64,
}

impl Window {
    /// Window on `recording`, `from` and `to` clamped to it.
    pub(super) fn of(recording: &Recording, from: Option<f64>, to: Option<f64>) -> Result<Self, ReportError> {
        let Self { from: start, to: end } = Self::whole(recording);
        let (asked_from, asked_to) = (from.unwrap_or(start), to.unwrap_or(end));
        let (from, to) = (asked_from.max(start), asked_to.min(end));
        // Relative, so that numbers along the axis stay apart late in a long recording.
        let shortest = SHORTEST * from.abs().max(to.abs()).max(1.0);
        if asked_from < asked_to && to - from >= shortest {
            Ok(Self { from, to })
        } else {
            Err(ReportError::NoSuchTime { from: asked_from, to: asked_to, start, end })
        }
    }

    /// From the first to the last recorded instant. After the last change its value is shown for a while.
    fn whole(recording: &Recording) -> Self {
        let instants = recording.len().checked_sub(1).map_or(0.0, |last| recording.time_of(last));
        let times = || recording.signals.iter().flat_map(|signal| &signal.changes).map(|(time, _)| *time);
        let times = || times().filter(|time| is_time(*time));
        let (first, last) = times().fold((0.0, instants), |(first, last), time| (time.min(first), time.max(last)));
        let is_over = last > instants || recording.is_empty();
        let to = if is_over { last + AFTERWARDS * (last - first) } else { last };
        let shortest = SHORTEST * first.abs().max(to.abs()).max(1.0);
        Self { from: first, to: if to - first >= shortest { to } else { first + first.abs().max(1.0) } }
    }
}

/// True if `time` (s) is a plausible time.
pub(super) fn is_time(time: f64) -> bool {
    time.abs() < BEYOND
}
