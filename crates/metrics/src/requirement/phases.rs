//! The phases of a run: stretches in which the task makes one kind of request.
use super::REQUEST_KIND;
use servobench_base::RequestKind;
use servobench_trace::Recording;
use std::ops::Range;

/// A stretch of a run with one kind of request.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RequestPhase {
    /// The kind.
    pub(super) kind: RequestKind,
    /// Its rows; empty if it begins after the last one.
    pub(super) rows: Range<usize>,
}

/// The phases of `recording`, in order; none if it lacks the request. Phases without a row are left out.
pub(super) fn request_phases(recording: &Recording) -> Vec<RequestPhase> {
    let (source, name) = REQUEST_KIND;
    let Some(signal) = recording.signal(source, name) else { return Vec::new() };
    let mut phases: Vec<RequestPhase> = Vec::with_capacity(signal.changes.len());
    let ends = signal.changes.iter().skip(1).map(|(time, _)| recording.index_at(*time)).chain([recording.len()]);
    for ((time, value), end) in signal.changes.iter().zip(ends) {
        let Some(kind) = RequestKind::from_name(value) else { continue };
        let start = recording.index_at(*time);
        match phases.last_mut() {
            _ if start >= end => {}
            Some(last) if last.kind == kind && last.rows.end == start => last.rows.end = end,
            _ => phases.push(RequestPhase { kind, rows: start..end }),
        }
    }
    phases
}

/// `rows` cut where `values` turn: at each extremum from which they come back by more than `least`. A value that is not finite is
/// not a turning point.
pub(super) fn between_turning_points(values: &[f64], rows: &Range<usize>, least: f64) -> Vec<Range<usize>> {
    let mut cut = Vec::new();
    let mut start = rows.start;
    let Some(first) = values.get(rows.start).copied() else { return cut };
    let (mut low, mut high) = ((first, rows.start), (first, rows.start));
    // 0: not yet known.
    let mut direction = 0_i8;
    for row in rows.clone() {
        let value = values[row];
        if value > high.0 {
            high = (value, row);
        }
        if value < low.0 {
            low = (value, row);
        }
        let turned = match direction {
            0 if high.0 - low.0 > least => {
                direction = if high.1 > low.1 { 1 } else { -1 };
                None
            }
            1 if high.0 - value > least => Some(high.1),
            -1 if value - low.0 > least => Some(low.1),
            _ => None,
        };
        if let Some(at) = turned {
            cut.push(start..at);
            start = at;
            direction = -direction;
            (low, high) = if direction > 0 { (low, (value, row)) } else { ((value, row), high) };
        }
    }
    cut.push(start..rows.end);
    cut
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::Build;
    use core::f64::consts::TAU;

    #[test]
    fn a_phase_lasts_while_the_kind_is_the_same() {
        let recording = Build::new(1000, 1000)
            .channel("time", "s", |t| t)
            .requests(&[
                (0.0, "stand"),
                (0.1, "follow"),
                (0.2, "follow"),
                (0.4, "rest"),
                (0.4002, "velocity"),
                (2.0, "nothing"),
            ])
            .finish();
        let found: Vec<_> = request_phases(&recording).into_iter().map(|phase| (phase.kind, phase.rows)).collect();
        assert_eq!(
            found,
            [
                (RequestKind::Stand, 0..100),
                (RequestKind::Follow, 100..400),
                (RequestKind::Rest, 400..401),
                (RequestKind::Velocity, 401..1000)
            ]
        );
        assert_eq!(request_phases(&Build::new(1000, 10).finish()), []);
    }

    /// Oracle: cos(2π·t) turns at every half second; a return by less than the least is not a turn.
    #[test]
    fn turning_points_are_those_of_the_request() {
        let values: Vec<f64> = (0..1600).map(|k| (TAU * f64::from(k) / 1000.0).cos()).collect();
        assert_eq!(between_turning_points(&values, &(0..1600), 0.01), [0..500, 500..1000, 1000..1500, 1500..1600]);
        let rippled: Vec<f64> = values.iter().enumerate().map(|(k, x)| x + 1e-3 * (k as f64).sin()).collect();
        assert_eq!(between_turning_points(&rippled, &(0..1600), 0.01).len(), 4);
        assert_eq!(between_turning_points(&values, &(0..1600), 3.0), vec![0..1600]);
        assert_eq!(between_turning_points(&[2.0; 9], &(3..9), 0.0), vec![3..9]);
        assert_eq!(between_turning_points(&[], &(0..0), 0.0), [0..0; 0]);
    }
}
