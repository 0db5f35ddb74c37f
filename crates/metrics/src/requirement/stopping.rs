//! `stopped`: an axis that is stopped comes to rest in the time that its profile and its loops take.
use super::phases::{RequestPhase, between_turning_points};
use super::rules::Driven;
use super::stretch::Rows;
use super::task::{ROUNDING, TIME_CONSTANTS, Task};
use crate::extremes::{most_of, range_of};
use crate::quantity::Quantity;
use servobench_base::RequestKind;
use servobench_signals::Signal;
use std::ops::Range;

/// What is left of the velocity at the beginning.
const LEFT: f64 = 0.01;
/// Least share of the largest requested velocity that counts.
const OF_LARGEST: f64 = 1e-3;
/// Times the planned time.
const TIMES: usize = 2;
/// The velocity is a mean over this time at least (s): of a load that rings, over a period.
const MEAN: f64 = 0.02;
/// Least share of its way after the stop by which a load swings.
const OF_SWING: f64 = 0.05;
/// Resolutions that an axis at rest moves in it.
const RESOLUTIONS: f64 = 4.0;

/// Why the axis has not stopped; `None` where it is not asked to.
pub(super) fn broken(task: &Task<'_>) -> Option<Vec<String>> {
    let rows = task.rows.as_ref()?;
    if task.rules.driven != Driven::ByLoops {
        return None;
    }
    let moved =
        |phase: &RequestPhase| matches!(phase.kind, RequestKind::Follow | RequestKind::Velocity | RequestKind::Effort);
    let mut stops =
        task.phases.iter().skip_while(|phase| !moved(phase)).filter(|phase| phase.kind == RequestKind::Stand);
    let mut reasons = Vec::new();
    let first = stops.next()?;
    for stop in std::iter::once(first).chain(stops).filter(|stop| !task.is_excused(&stop.rows)) {
        reasons.extend(still_moves(task, rows, stop));
    }
    Some(reasons)
}

/// Rows of `stop` until the set-point of the drive stands.
fn planned(task: &Task<'_>, stop: &Range<usize>, h: f64) -> usize {
    let setpoint = task.recording.channel(Signal::SetpointPosition).map(|values| &values[stop.clone()]);
    let Some(setpoint) = setpoint else { return 0 };
    let Some(first) = setpoint.first_chunk::<2>() else { return 0 };
    let least = (LEFT * (first[1] - first[0]).abs()).max(ROUNDING * h);
    setpoint.windows(2).rposition(|pair| (pair[1] - pair[0]).abs() > least).map_or(0, |last| last + 1)
}

fn still_moves(task: &Task<'_>, rows: &Rows<'_>, stop: &RequestPhase) -> Option<String> {
    let row = |time: f64| task.recording.index_at(time);
    let mean = task.rules.oscillation().map_or(MEAN, |slowest| slowest.frequency.recip().max(MEAN));
    let span = row(mean).max(1);
    let (start, end) = (stop.rows.start, stop.rows.end);
    let requested = rows.request_velocity[start.saturating_sub(1)];
    let planned = planned(task, &stop.rows, rows.h);
    let settling = task.rules.servo.map_or(MEAN, |servo| {
        // With the velocity fed forward the loop of the position has little to do.
        let rate = if servo.velocity_feedforward < 1.0 { servo.slowest_rate() } else { servo.bandwidth };
        TIME_CONSTANTS / rate
    });
    let due = start.saturating_add(TIMES * planned).saturating_add(row(settling)).saturating_add(span);
    let is_last = end == task.recording.len();
    if due >= end && !is_last {
        return None;
    }
    let before = rows.load_velocity(start.saturating_sub(span), start).abs().max(requested.abs());
    let largest = most_of([rows.request_velocity], |[v]| v.abs());
    let resolution = RESOLUTIONS * task.rules.resolution() / (span as f64 * rows.h);
    let bound = (LEFT * before).max(OF_LARGEST * largest).max(resolution);
    let unit = format!("{}/s", task.recording.about.axis_unit);
    let cycle = last_cycle(rows, &((start + planned).min(end - 1)..end), RESOLUTIONS * task.rules.resolution());
    let at = |last: usize| {
        let velocity = rows.load_velocity(last.saturating_sub(span).max(start), last);
        let of_cycle = cycle.as_ref().map(|cycle| rows.load_velocity(cycle.start, cycle.end));
        (last, of_cycle.filter(|mean| mean.abs() < velocity.abs()).unwrap_or(velocity))
    };
    let (last, velocity) = [due.min(end - 1), end - 1]
        .map(at)
        .into_iter()
        .find(|(_, velocity)| velocity.is_nan() || velocity.abs() > bound)?;
    Some(format!(
        "the load still moves at {} at {}, after it was stopped from {} at {} (at most {}){}",
        Quantity::new(velocity, &unit),
        task.time(last),
        Quantity::new(before, &unit),
        task.time(start),
        Quantity::new(bound, &unit),
        task.bound_by(&(start..end))
    ))
}

/// The last whole cycle of a load that swings in the time `after` a stop, by more than `least`, up to its end.
fn last_cycle(rows: &Rows<'_>, after: &Range<usize>, least: f64) -> Option<Range<usize>> {
    let (low, high) = range_of(&rows.load[after.clone()]);
    let turns = between_turning_points(rows.load, after, least.max(OF_SWING * (high - low)));
    let [.., _, first, second, last] = turns.as_slice() else { return None };
    // What comes after the last turn is shorter than half of a cycle.
    (last.len() <= first.len().max(second.len())).then_some(first.start..last.start)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirement::tests::rules;
    use crate::synthetic::Build;

    /// 1 m/s, stopped at 1 s, in 0.1 s as the set-point has it; the load slows down with `slows` (m/s²).
    fn found(slows: f64, next: f64) -> Vec<String> {
        let load = move |t: f64| {
            let since = (t - 1.0).clamp(0.0, 1.0 / slows);
            t.min(1.0) + since - slows * since * since / 2.0
        };
        let recording = Build::new(1000, 2001)
            .channel(Signal::RequestPosition, "m", load)
            .channel(Signal::RequestVelocity, "m/s", |t| if t < 1.0 { 1.0 } else { 0.0 })
            .channel(Signal::SetpointPosition, "m", |t| {
                t.min(1.0) + 0.05 * (1.0 - (1.0 - (t - 1.0).clamp(0.0, 0.1) / 0.1).powi(2))
            })
            .channel(Signal::LoadPosition, "m", load)
            .requests(&[(0.0, "velocity"), (1.0, "stand"), (next, "velocity")])
            .finish();
        broken(&Task::of(&recording, &rules(), &[])).unwrap()
    }

    /// A load on a soft coupling swings about where it stopped, at 4 Hz; one that drifts by 3 % of the velocity besides has not stopped.
    #[test]
    fn a_load_that_swings_has_stopped() {
        let found = |drift: f64| {
            let load = move |t: f64| {
                let since = (t - 1.0).max(0.0);
                t.min(1.0) + drift * since + 0.02 * (core::f64::consts::TAU * 4.0 * since).sin() * (-since).exp()
            };
            let recording = Build::new(1000, 2001)
                .channel(Signal::RequestPosition, "m", |t| t.min(1.0))
                .channel(Signal::RequestVelocity, "m/s", |t| if t < 1.0 { 1.0 } else { 0.0 })
                .channel(Signal::SetpointPosition, "m", |t| t.min(1.0))
                .channel(Signal::LoadPosition, "m", load)
                .requests(&[(0.0, "velocity"), (1.0, "stand")])
                .finish();
            broken(&Task::of(&recording, &rules(), &[])).unwrap()
        };
        assert_eq!(found(0.0), [""; 0]);
        assert_eq!(found(0.03).len(), 1);
    }

    #[test]
    fn an_axis_that_brakes_too_weakly_has_not_stopped() {
        assert_eq!(found(10.0, 9.0), [""; 0]);
        assert_eq!(found(4.5, 9.0), [""; 0], "twice the planned time is granted");
        // Due after twice 99 ms of the set-point, 20 ms of the loop and 20 ms of the mean, whose middle is at 228 ms: 1 - 2·0.228 m/s.
        let late = found(2.0, 9.0);
        assert!(
            late[0].starts_with("the load still moves at 544 mm/s at 1.24 s, after it was stopped from"),
            "{late:?}"
        );
        assert_eq!(found(0.5, 1.1), [""; 0], "the next command came before it was due");
    }
}
