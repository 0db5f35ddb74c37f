//! Causes that explain swings of an axis: the task, and disturbances that the scenario orders.
//!
//! A request that accelerates and brakes explains one transition from limit to limit at each turning point of its velocity, a
//! disturbance at each of its own. Nothing that responds to the axis explains a swing: neither the set-point that a loop makes, nor the
//! force of an end stop or of an FMU.
use super::Rules;
use super::rules::Disturbance;
use super::turning_points::TurningPoints;
use servobench_signals::Signal;
use servobench_trace::Recording;
use std::ops::Range;

/// Least effort that counts, as a share of the largest effort of the motor in the run. A longer run does not have a smaller one.
const EFFORT: f64 = 0.01;
/// Share of the range of the requested velocity below which a change is a rounding or a ripple.
const VELOCITY: f64 = 1e-3;

/// Times (s) at which task and disturbances turn, in order.
pub(super) fn turns(recording: &Recording, rules: &Rules<'_>) -> Vec<f64> {
    let mut times = Vec::new();
    if let Some(velocity) = recording.channel(Signal::RequestVelocity) {
        turns_of(recording, velocity, VELOCITY * range(velocity), &mut times);
    }
    let least = EFFORT * largest_effort(recording);
    let end = recording.time_of(recording.len());
    for one in rules.disturbances.iter().filter(|one| one.effort.abs() >= least) {
        match one.frequency {
            Some(frequency) => {
                let turns = (0..).map(|k| one.start + (f64::from(k) + 0.5) / (2.0 * frequency));
                times.extend(turns.take_while(|time| *time < one.end.min(end)));
            }
            None => times.extend([one.start, one.end].into_iter().filter(|time| *time < end)),
        }
    }
    for (signal, scale) in &rules.excited {
        if let Some(values) = recording.channel(*signal) {
            turns_of(recording, values, least / scale.abs(), &mut times);
        }
    }
    times.sort_by(f64::total_cmp);
    times
}

/// Rows in which a disturbance changes, in order and apart from each other.
pub(super) fn disturbed(recording: &Recording, rules: &Rules<'_>) -> Vec<Range<usize>> {
    if rules.disturbances.is_empty() && rules.excited.is_empty() {
        return Vec::new();
    }
    let least = EFFORT * largest_effort(recording);
    let mut rows = Vec::new();
    for Disturbance { start, end, effort, frequency } in &rules.disturbances {
        // An infinite time is at no tick.
        let end = if end.is_finite() { recording.index_at(*end) } else { recording.len() };
        let start = recording.index_at(*start);
        match frequency {
            _ if effort.abs() < least => {}
            Some(_) => rows.push(start..end),
            None => rows.extend([start..start + 1, end..end + 1]),
        }
    }
    for (signal, scale) in &rules.excited {
        let values = recording.channel(*signal).unwrap_or_default();
        let mut before = values.first().copied().unwrap_or_default();
        for (row, value) in values.iter().enumerate() {
            let step = (scale * (value - before)).abs();
            if step > 0.0 && step >= least {
                rows.push(row..row + 1);
                before = *value;
            }
        }
    }
    rows.sort_by_key(|rows| rows.start);
    let mut apart: Vec<Range<usize>> = Vec::with_capacity(rows.len());
    for next in rows {
        match apart.last_mut() {
            Some(last) if next.start <= last.end => last.end = last.end.max(next.end),
            _ => apart.push(next),
        }
    }
    apart
}

fn turns_of(recording: &Recording, values: &[f64], least: f64, times: &mut Vec<f64>) {
    let mut points = TurningPoints::new(0, values.first().copied().unwrap_or_default());
    let turns = values.iter().enumerate().filter_map(|(row, value)| points.next(row, *value, least));
    times.extend(turns.map(|(row, _)| recording.time_of(row)));
}

/// The largest effort of the motor, requested by the drive or actual.
fn largest_effort(recording: &Recording) -> f64 {
    let channels =
        [Signal::EffortReference, Signal::EffortMotor].into_iter().filter_map(|name| recording.channel(name));
    channels.flatten().filter(|value| value.is_finite()).fold(0.0, |largest, value| value.abs().max(largest))
}

fn range(values: &[f64]) -> f64 {
    let (low, high) = values
        .iter()
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (value.min(low), value.max(high)));
    (high - low).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirement::tests::rules;
    use crate::synthetic::Build;
    use core::f64::consts::TAU;

    /// A second at 1 kHz in which the motor gives 3 N·m at most.
    fn recording(velocity: impl Fn(f64) -> f64, on_load: impl Fn(f64) -> f64) -> Recording {
        Build::new(1000, 1000)
            .channel(Signal::RequestVelocity, "m/s", velocity)
            .channel(Signal::DisturbanceLoad, "N", on_load)
            .channel(Signal::EffortReference, "N m", |t| 3.0 * (TAU * 50.0 * t).cos())
            .finish()
    }

    #[test]
    fn a_request_explains_a_turn_where_its_velocity_turns() {
        let trapezoid = |t: f64| (t.min(0.6 - t) * 10.0).clamp(0.0, 2.0);
        assert_eq!(turns(&recording(trapezoid, |_| 0.0), &rules()), [0.2]);
        let rounded = |t: f64| trapezoid(t) + 1e-6 * (TAU * 333.0 * t).sin();
        assert_eq!(turns(&recording(rounded, |_| 0.0), &rules()).len(), 1);
        let sine = turns(&recording(|t| (TAU * 5.0 * t).sin(), |_| 0.0), &rules());
        assert_eq!(sine.len(), 10, "{sine:?}");
        assert_eq!(turns(&recording(|_| 0.0, |_| 0.0), &rules()), [0.0; 0]);
    }

    /// Oracle: 1 % of the 3 N·m that the motor gives. A step explains one turn, a sine of 5 Hz ten in a second.
    #[test]
    fn a_disturbance_counts_from_a_hundredth_of_the_effort_of_the_motor() {
        for (effort, is_felt) in [(0.031, true), (-0.031, true), (0.029, false), (1e-6, false)] {
            let step = Disturbance { start: 0.5, end: f64::INFINITY, effort, frequency: None };
            let sine = Disturbance { start: 0.0, frequency: Some(5.0), ..step };
            for (one, expected, rows) in [(step, 1, 500..501), (sine, 10, 0..1000)] {
                let rules = Rules { disturbances: vec![one], ..rules() };
                let recording = recording(|_| 0.0, |_| 0.0);
                assert_eq!(turns(&recording, &rules).len(), if is_felt { expected } else { 0 }, "{effort}");
                let disturbed = disturbed(&recording, &rules);
                assert_eq!(disturbed.first(), is_felt.then_some(&rows), "{effort}");
            }
        }
    }

    /// The force of an FMU counts where the scenario declares it an excitation of the axis.
    #[test]
    fn what_an_fmu_gives_counts_where_it_excites() {
        let recording = recording(|_| 0.0, |t| 20.0 * (TAU * 5.0 * t).sin());
        assert_eq!(turns(&recording, &rules()), [0.0; 0]);
        assert_eq!(disturbed(&recording, &rules()), []);
        let excited = Rules { excited: vec![(Signal::DisturbanceLoad, 0.01)], ..rules() };
        assert_eq!(turns(&recording, &excited).len(), 10);
        assert!(disturbed(&recording, &excited).iter().map(ExactSizeIterator::len).sum::<usize>() > 100);
    }
}
