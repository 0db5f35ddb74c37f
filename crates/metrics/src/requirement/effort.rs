//! `effort`: where a torque or a force is requested, the motor gives it for half of the time at least, and of its second half.
use super::rules::Driven;
use super::task::Task;
use crate::quantity::Quantity;
use crate::span::unit;
use servobench_base::RequestKind;
use servobench_signals::Signal;
use std::ops::Range;

/// Share of the time, and of its second half.
const OF_TIME: f64 = 0.5;
/// Least effort that counts, as a share of the largest effort of the drive.
const OF_MOST: f64 = 1e-3;
/// Shortest phase that is judged (s).
const SHORTEST: f64 = 0.02;

/// Reasons why an effort is not given; `None` where none is requested.
pub(super) fn broken(task: &Task<'_>) -> Option<Vec<String>> {
    let recording = task.recording;
    let (requested, given) = (recording.channel(Signal::RequestEffort)?, recording.channel(Signal::EffortMotor)?);
    if task.rules.driven != Driven::ByLoops {
        return None;
    }
    let is_long = |rows: usize| rows as f64 * recording.rate.period() >= SHORTEST;
    let phases: Vec<_> =
        task.phases.iter().filter(|phase| phase.kind == RequestKind::Effort && is_long(phase.rows.len())).collect();
    if phases.is_empty() {
        return None;
    }
    let most = task.rules.deflection.max_effort;
    let least = if most.is_finite() { OF_MOST * most } else { 0.0 };
    let unit = unit(recording, Signal::EffortMotor);
    let missed = phases.into_iter().filter(|phase| !task.is_excused(&phase.rows)).filter_map(|phase| {
        let rows = phase.rows.clone();
        let fits = |row: &usize| {
            (given[*row] - requested[*row]).abs() <= (task.rules.tolerances.effort * requested[*row].abs()).max(least)
        };
        let is_given = |rows: Range<usize>| rows.clone().filter(fits).count() as f64 >= OF_TIME * rows.len() as f64;
        let second_half = usize::midpoint(rows.start, rows.end)..rows.end;
        (!is_given(rows.clone()) || !is_given(second_half)).then(|| {
            let last = rows.end - 1;
            format!(
                "the motor gives {} at {}, where {} is requested from {} on",
                Quantity::new(given[last], unit),
                task.time(last),
                Quantity::new(requested[last], unit),
                task.time(rows.start)
            )
        })
    });
    Some(missed.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirement::tests::rules;
    use crate::synthetic::Build;

    #[test]
    fn an_effort_is_given_for_half_of_its_phase_and_of_its_second_half() {
        let found_to = |from: f64, to: f64, share: f64| {
            let given = move |t: f64| if (from..to).contains(&t) { -2.0 * share } else { 0.0 };
            let recording = Build::new(1000, 1001)
                .channel(Signal::RequestEffort, "N m", |_| -2.0)
                .channel(Signal::EffortMotor, "N m", given)
                .requests(&[(0.0, "effort")])
                .finish();
            broken(&Task::of(&recording, &rules(), &[])).unwrap()
        };
        let found = |from: f64, share: f64| found_to(from, f64::INFINITY, share);
        assert_eq!(found(0.49, 1.0), [""; 0]);
        assert_eq!(found(0.0, 0.961), [""; 0]);
        assert_eq!(found(0.51, 1.0).len(), 1);
        assert_eq!(found_to(0.0, 0.76, 1.0), [""; 0]);
        assert_eq!(found_to(0.0, 0.74, 1.0).len(), 1, "it ends in the second half");
        assert_eq!(found(0.0, 0.9), ["the motor gives -1.80 N·m at 1.00 s, where -2.00 N·m is requested from 0 s on"]);
    }
}
