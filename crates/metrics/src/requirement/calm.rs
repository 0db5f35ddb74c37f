//! Stretches in which the task requests one velocity and nothing that the scenario orders disturbs the axis: swings there are
//! the loop's own.
use super::Rules;
use super::excitation::disturbed;
use super::phases::{between_turning_points, request_phases};
use super::task::OF_FARTHEST;
use crate::extremes::span_of;
use servobench_base::RequestKind;
use servobench_signals::Signal;
use servobench_trace::Recording;
use std::ops::Range;

/// Changes of the requested velocity below this share of its largest value in the run are roundings.
const ROUNDING: f64 = 1e-9;

/// A stretch with one requested velocity.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Calm {
    /// Its rows.
    pub(super) rows: Range<usize>,
    /// Requested velocity (axis unit per s), 0 where the axis is to stand.
    pub(super) velocity: f64,
    /// Distance of the last motion before it, from its last turning point (axis unit); `None` before the first one.
    pub(super) after: Option<f64>,
}

/// The calm stretches of `recording` in order. Later rows do not change earlier stretches, except the end of the last one.
pub(super) fn calm(recording: &Recording, rules: &Rules<'_>) -> Vec<Calm> {
    let channels = (recording.channel(Signal::RequestVelocity), recording.channel(Signal::RequestPosition));
    let (Some(velocities), Some(positions)) = channels else { return Vec::new() };
    let rounding = ROUNDING * velocities.iter().fold(0.0, |largest: f64, v| largest.max(v.abs()));
    let disturbed = disturbed(recording, rules);
    let (mut all, mut stood, mut after) = (Vec::new(), None, None);
    let mut moves = false;
    for phase in request_phases(recording) {
        if matches!(phase.kind, RequestKind::Nothing | RequestKind::Effort) {
            (stood, after, moves) = (None, None, false);
            continue;
        }
        let mut start = phase.rows.start;
        while start < phase.rows.end {
            let v = velocities[start];
            let same =
                velocities[start..phase.rows.end].iter().take_while(|next| (**next - v).abs() <= rounding).count();
            // A not-a-number value is not even equal to itself.
            let end = start + same.max(1);
            let stands = v.abs() <= rounding;
            let from = *stood.get_or_insert(start);
            if stands && std::mem::take(&mut moves) {
                after = Some(last_way(positions, from..start + 1));
            }
            moves |= !stands;
            if stands {
                stood = Some(end - 1);
            }
            if stands || phase.kind == RequestKind::Velocity {
                let velocity = if stands { 0.0 } else { v };
                all.extend(without(start..end, &disturbed).map(|rows| Calm { rows, velocity, after }));
            }
            start = end;
        }
    }
    all
}

/// Distance from the last turning point to the end of a motion in `rows`, at the ends of which it stands. Turns so small that an
/// interpolation makes them do not count.
fn last_way(positions: &[f64], rows: Range<usize>) -> f64 {
    let ways = between_turning_points(positions, &rows, OF_FARTHEST * span_of(&positions[rows.clone()]));
    ways.last().map_or(0.0, |way| (positions[rows.end - 1] - positions[way.start]).abs())
}

/// Parts of `rows` outside `others`, which are in order and disjoint.
fn without(rows: Range<usize>, others: &[Range<usize>]) -> impl Iterator<Item = Range<usize>> {
    let mut left = Vec::new();
    let mut start = rows.start;
    let within = &others[others.partition_point(|other| other.end <= rows.start)..];
    for other in within.iter().take_while(|other| other.start < rows.end) {
        if other.start > start {
            left.push(start..other.start);
        }
        start = start.max(other.end);
    }
    if start < rows.end {
        left.push(start..rows.end);
    }
    left.into_iter()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirement::rules::Disturbance;
    use crate::requirement::tests::rules;
    use crate::synthetic::Build;

    /// A second at 1 kHz: a motion over 0.2 m from 0.2 s to 0.4 s, and at 0.1 m/s from 0.7 s on.
    fn recording() -> Recording {
        let velocity = |t: f64| match t {
            t if (0.2..0.4).contains(&t) => 1.0 + 0.1 * t,
            t if t >= 0.7 => 0.1,
            _ => 0.0,
        };
        Build::new(1000, 1000)
            .channel(Signal::RequestVelocity, "m/s", velocity)
            .channel(Signal::RequestPosition, "m", |t| if t < 0.3 { 0.1 } else { 0.3 })
            .requests(&[(0.0, "nothing"), (0.1, "stand"), (0.2, "follow"), (0.4, "rest"), (0.7, "velocity")])
            .finish()
    }

    /// To 0.2 m and back at 1 m/s without a pause: the return is the motion before the rest.
    #[test]
    fn a_motion_there_and_back_is_as_long_as_its_way_back() {
        let recording = Build::new(1000, 1000)
            .channel(Signal::RequestVelocity, "m/s", |t| {
                if t < 0.2 {
                    1.0
                } else if t < 0.4 {
                    -1.0
                } else {
                    0.0
                }
            })
            .channel(Signal::RequestPosition, "m", |t| if t < 0.2 { t } else { (0.4 - t).max(0.0) })
            .requests(&[(0.0, "follow"), (0.4, "rest")])
            .finish();
        let found = calm(&recording, &rules());
        assert_eq!(found.len(), 1);
        assert!((found[0].after.unwrap() - 0.2).abs() < 1e-12, "{found:?}");
    }

    /// Function blocks make one request per cycle, and the path between two of their requests overshoots by nanometres.
    #[test]
    fn a_motion_that_ends_with_a_ripple_is_as_long_as_its_way() {
        let x = |t: f64| if t < 0.2 { t } else { 0.2 + 1e-5 * ((0.22 - t).max(0.0) * 314.0).sin() };
        let recording = Build::new(1000, 1000)
            .channel(Signal::RequestVelocity, "m/s", |t| (x(t + 1e-3) - x(t)) / 1e-3)
            .channel(Signal::RequestPosition, "m", x)
            .requests(&[(0.0, "follow"), (0.22, "rest")])
            .finish();
        let found = calm(&recording, &rules());
        assert!((found.last().unwrap().after.unwrap() - 0.2).abs() < 2e-5, "{found:?}");
    }

    #[test]
    fn the_axis_is_calm_where_it_is_to_stand_or_to_keep_its_velocity() {
        let found = calm(&recording(), &rules());
        let rows: Vec<_> = found.iter().map(|calm| (calm.rows.clone(), calm.velocity)).collect();
        assert_eq!(rows, [(100..200, 0.0), (400..700, 0.0), (700..1000, 0.1)]);
        assert_eq!(found[0].after, None);
        assert!((found[1].after.unwrap() - 0.2).abs() < 1e-12);
    }

    #[test]
    fn a_disturbance_cuts_a_stretch_where_it_changes() {
        let sine = Disturbance { start: 0.5, end: 0.6, effort: 1.0, frequency: Some(5.0) };
        let step = Disturbance { start: 0.15, end: f64::INFINITY, effort: 1.0, frequency: None };
        let found = calm(&recording(), &Rules { disturbances: vec![sine, step], ..rules() });
        let rows: Vec<_> = found.into_iter().map(|calm| calm.rows).collect();
        assert_eq!(rows, [100..150, 151..200, 400..500, 600..700, 700..1000]);
    }
}
