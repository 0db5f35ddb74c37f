//! The part of a move that is drawn.
use crate::error::ReportError;
use servobench_planner::{Binding, Span};

/// Shortest interval that is drawn (s), and relative to the time at its end: numbers along the axis stay apart.
const SHORTEST: f64 = 1e-9;

/// Start and end (s).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Window {
    pub(super) from: f64,
    pub(super) to: f64,
    /// True if the window is the whole move.
    pub(super) is_whole: bool,
}

impl Window {
    /// Window on a move of `duration` (s), `from` and `to` clamped to it.
    pub(super) fn of(duration: f64, from: Option<f64>, to: Option<f64>) -> Result<Self, ReportError> {
        if from.is_none() && to.is_none() {
            return Ok(Self { from: 0.0, to: duration, is_whole: true });
        }
        let (asked_from, asked_to) = (from.unwrap_or(0.0), to.unwrap_or(duration));
        let (from, to) = (asked_from.max(0.0), asked_to.min(duration));
        if asked_from < asked_to && to - from >= SHORTEST * to.max(1.0) {
            Ok(Self { from, to, is_whole: from <= 0.0 && to >= duration })
        } else {
            Err(ReportError::NoTimeOfMove { from: asked_from, to: asked_to, end: duration })
        }
    }

    /// Part of `span` in the window.
    pub(super) fn part(&self, span: Span) -> Option<Span> {
        if self.is_whole {
            return Some(span);
        }
        let (from, to) = (span.start.max(self.from), (span.start + span.length).min(self.to));
        let state = if from > span.start { span.after(from - span.start) } else { span.state };
        (to > from).then_some(Span { start: from, length: to - from, state, ..span })
    }

    /// Part of `binding` in the window; an instant stays one.
    pub(super) fn part_of_binding(&self, binding: Binding) -> Option<Binding> {
        let (start, end) = (binding.start.max(self.from), (binding.start + binding.length).min(self.to));
        (end >= start).then_some(Binding { start, length: end - start, ..binding })
    }

    /// True if `time` (s) is in the window.
    pub(super) fn contains(&self, time: f64) -> bool {
        (self.from..=self.to).contains(&time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_base::Setpoint;

    #[test]
    fn a_window_is_within_the_move() {
        let of = |from, to| Window::of(2.0, from, to);
        assert!(of(None, None).unwrap().is_whole && of(Some(-1.0), Some(3.0)).unwrap().is_whole);
        let window = of(Some(0.5), None).unwrap();
        assert_eq!((window.from.to_bits(), window.to.to_bits()), (0.5_f64.to_bits(), 2.0_f64.to_bits()));
        for (from, to) in [(Some(1.0), Some(1.0)), (Some(1.5), Some(1.0)), (Some(2.0), None), (None, Some(-1.0))] {
            assert!(of(from, to).is_err(), "{from:?} {to:?}");
        }
        assert!(of(Some(f64::NAN), None).is_err());
        let message = of(Some(2.5), None).unwrap_err().to_string();
        assert_eq!(
            message,
            "the move has no time from 2.5 s to 2.0 s: choose a stretch of at least 1 ns between 0 s and 2.0 s"
        );
    }

    /// Oracle: the polynomial itself.
    #[test]
    fn a_span_is_cut_at_both_ends() {
        let state = Setpoint { v: 2.0, a: 3.0, ..Setpoint::default() };
        let span = Span { start: 0.25, length: 1.0, state, is_held: false };
        let window = Window::of(4.0, Some(0.5), Some(0.75)).unwrap();
        let part = window.part(span).unwrap();
        assert_eq!((part.start, part.length, part.state), (0.5, 0.25, span.after(0.25)));
        assert!(
            window.part(Span { start: 0.75, ..span }).is_none() && window.part(Span { length: 0.25, ..span }).is_none()
        );
    }
}
