//! Swinging between limits: a limited quantity moves from its positive to its negative limit and back.
//!
//! A stretch lasts from one start of a motion to the next. Each part of it is checked for alternations that task and disturbances
//! ([`excitation`](super::excitation)) do not explain: more than [`MOST`] are an oscillation. An alternation counts if the motor's error
//! over [`NINE`] of them swings as often by more than the encoder sees: alternations caused by an edge of the encoder, noise or a peak of
//! one tick do not move the motor, or are sporadic. A part that is over does not change, so that a longer run has at least as many.
use super::Rules;
use super::excitation::turns;
use super::turning_points::{ROUNDING, swings};
use crate::quantity::Quantity;
use servobench_signals::Signal;
use servobench_trace::{LimitReversals, Recording};
use std::ops::RangeInclusive;

/// Maximum number of unexplained alternations.
pub(super) const MOST: usize = 8;
/// Alternations over which the motor's error has to swing.
const NINE: usize = 9;
/// Swings of that error among them: about one from each to the next. A motion makes fewer, and a torque ripple more.
const SWINGS: RangeInclusive<usize> = 5..=9;
/// Maximum ratio of the largest of these swings to the smallest. The ratio is larger for a motor that noise shakes.
const EQUAL: f64 = 1.6;
/// Maximum ratio of the longest period of an oscillation to the shortest, a period being the time from one of the nine to the next
/// but one.
const REGULAR: usize = 2;

/// The worst swinging between limits, in words.
pub(super) fn between_limits(recording: &Recording, rules: &Rules<'_>) -> Option<String> {
    if recording.limit_reversals.is_empty() {
        return None;
    }
    let error = error(recording)?;
    let (turns, starts) = (turns(recording, rules), starts(recording));
    let mut not_known = None;
    let worst = recording.limit_reversals.iter().filter_map(|LimitReversals { limit, times }| {
        let counting = counting(recording, &error, times, rules);
        not_known = not_known.take().or_else(|| words_of_unknown(limit, times, &counting));
        Some((limit, unexplained(&counting, &turns, &starts)?))
    });
    let Some((limit, swinging)) = worst.max_by_key(|(_, swinging)| swinging.excess) else { return not_known };
    let Swinging { times, first, last, .. } = swinging;
    let (first, last) = (Quantity::new(first, "s"), Quantity::new(last, "s"));
    Some(format!("it alternates from one {limit} to the other {times} times from {first} to {last}"))
}

/// Reason if there are more alternations than are kept, and the last one that is kept counts: the others may be unexplained.
fn words_of_unknown(limit: &str, times: &[f64], counting: &[f64]) -> Option<String> {
    let last = times.get(LimitReversals::MOST - 1).filter(|last| counting.last() == Some(*last))?;
    let (most, last) = (LimitReversals::MOST, Quantity::new(*last, "s"));
    Some(format!("it has alternated from one {limit} to the other {most} times by {last}, and the rest is not judged"))
}

/// A part of a run in which a quantity swings.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Swinging {
    /// Number of unexplained alternations.
    excess: usize,
    times: usize,
    first: f64,
    last: f64,
}

/// The part with the most of `alternations` beyond `turns`, if those are too many; it does not extend across `starts`. All in order.
fn unexplained(alternations: &[f64], turns: &[f64], starts: &[f64]) -> Option<Swinging> {
    let mut worst: Option<Swinging> = None;
    let mut now: Option<Swinging> = None;
    let (mut turns, mut starts) = (turns.iter().peekable(), starts.iter().peekable());
    for time in alternations {
        let begins = core::iter::from_fn(|| starts.next_if(|start| *start <= time)).count() > 0;
        let explained = core::iter::from_fn(|| turns.next_if(|turn| *turn <= time)).count();
        let goes_on = now.filter(|one| !begins && one.excess > explained);
        let one = goes_on.map_or(Swinging { excess: 1, times: 1, first: *time, last: *time }, |one| Swinging {
            excess: one.excess - explained + 1,
            times: one.times + 1,
            last: *time,
            ..one
        });
        now = Some(one);
        if one.excess > MOST && worst.is_none_or(|worst| one.excess > worst.excess) {
            worst = Some(one);
        }
    }
    worst
}

/// Those of `times` at which the motor's error swings over nine of them by more than the encoder sees, and as often.
fn counting(recording: &Recording, error: &[f64], times: &[f64], rules: &Rules<'_>) -> Vec<f64> {
    let rows: Vec<usize> = times.iter().map(|time| recording.index_at(*time).min(error.len())).collect();
    let mut counts = vec![false; times.len()];
    let largest = error.iter().filter(|x| x.is_finite()).fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let unseen = rules.unseen().max(ROUNDING * largest);
    for k in 0..(rows.len() + 1).saturating_sub(NINE) {
        let nine = &rows[k..k + NINE];
        if is_regular(nine) && swings_along(error, nine, unseen) {
            counts[k..k + NINE].fill(true);
        }
    }
    times.iter().zip(counts).filter_map(|(time, counts)| counts.then_some(*time)).collect()
}

/// True if `rows` are as regular as those of an oscillation.
fn is_regular(rows: &[usize]) -> bool {
    let periods = || rows.windows(3).map(|three| three[2] - three[0]);
    periods().max() <= periods().min().map(|shortest| REGULAR * shortest)
}

/// True if the error swings by more than `unseen` from the first of `rows` to the last, as often and each time as far, not counting the
/// drift between them.
fn swings_along(error: &[f64], rows: &[usize], unseen: f64) -> bool {
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else { return false };
    let values = error.get(*first..=*last).unwrap_or_default();
    let (Some(begin), Some(end)) = (values.first(), values.last()) else { return false };
    let drift = (end - begin) / (last - first).max(1) as f64;
    let values: Vec<f64> = values.iter().enumerate().map(|(row, error)| error - drift * row as f64).collect();
    let all = swings(&values, 0, unseen, 0.0);
    let (smallest, largest) =
        all.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), one| (low.min(one.size), high.max(one.size)));
    SWINGS.contains(&all.len()) && largest <= EQUAL * smallest
}

/// Requested motion less that of the motor, at each row (axis unit).
fn error(recording: &Recording) -> Option<Vec<f64>> {
    let position = recording.channel(Signal::MotorPosition)?;
    let velocity = recording.channel(Signal::RequestVelocity)?;
    let (period, mut way) = (recording.rate.period(), 0.0);
    let error = position.iter().zip(velocity).map(|(x, v)| {
        let error = way - x;
        way += v * period;
        error
    });
    Some(error.collect())
}

/// Times at which a motion starts from rest (s).
fn starts(recording: &Recording) -> Vec<f64> {
    let velocity = recording.channel(Signal::RequestVelocity).unwrap_or_default();
    // A velocity that passes zero is not at rest.
    let starts = velocity.windows(3).enumerate().filter(|(_, v)| v[0] == 0.0 && v[1] == 0.0 && v[2] != 0.0);
    starts.map(|(row, _)| recording.time_of(row + 1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirement::rules::Disturbance;
    use crate::requirement::tests::rules;
    use crate::synthetic::Build;
    use core::f64::consts::TAU;

    /// A second at 1 kHz, in which the effort alternates `times` times between its limits from 100 ms on, every 10 ms, while the motor
    /// swings by `size`.
    fn reversing(times: usize, size: f64, velocity: impl Fn(f64) -> f64) -> Recording {
        let mut recording = Build::new(1000, 1001)
            .channel(Signal::RequestVelocity, "m/s", velocity)
            .channel(Signal::MotorPosition, "m", |t| size / 2.0 * (TAU * 50.0 * t).cos())
            .channel(Signal::EffortReference, "N", |_| 100.0)
            .finish();
        let times = (0..times).map(|k| 0.1 + 0.01 * k as f64).collect();
        recording.limit_reversals = vec![LimitReversals { limit: "effort limit".into(), times }];
        recording
    }

    #[test]
    fn more_than_eight_alternations_that_nothing_explains_are_an_oscillation() {
        for (times, is_found) in [(0, false), (8, false), (9, true), (60, true)] {
            let found = between_limits(&reversing(times, 1e-3, |_| 0.0), &rules());
            assert_eq!(found.is_some(), is_found, "{times}: {found:?}");
        }
        assert_eq!(
            between_limits(&reversing(9, 1e-3, |_| 0.0), &rules()).unwrap(),
            "it alternates from one effort limit to the other 9 times from 100 ms to 180 ms"
        );
    }

    /// A request that turns as often explains them, and so does a disturbance; one that turns half as often does not.
    #[test]
    fn task_and_disturbances_explain_alternations() {
        for (hertz, is_found) in [(50.0, false), (25.0, true)] {
            let found = between_limits(&reversing(60, 1e-3, |t| 1e-3 * (TAU * hertz * t).sin()), &rules());
            assert_eq!(found.is_some(), is_found, "request of {hertz} Hz: {found:?}");
            for (effort, is_felt) in [(20.0, true), (0.5, false)] {
                let sine = Disturbance { start: 0.0, end: f64::INFINITY, effort, frequency: Some(hertz) };
                let rules = Rules { disturbances: vec![sine], ..rules() };
                let found = between_limits(&reversing(60, 1e-3, |_| 0.0), &rules);
                assert_eq!(found.is_some(), is_found || !is_felt, "disturbance of {hertz} Hz, {effort} N: {found:?}");
            }
        }
    }

    /// Edges of an encoder, noise and peaks of one tick send an effort to its limits, but do not move the motor.
    #[test]
    fn what_does_not_move_the_motor_does_not_count() {
        for (increment, noise, is_found) in
            [(0.9e-6, 0.0, true), (1.1e-6, 0.0, false), (0.0, 0.7e-6, true), (0.0, 0.9e-6, false)]
        {
            let found = between_limits(&reversing(800, 4e-6, |_| 0.0), &Rules { increment, noise, ..rules() });
            assert_eq!(found.is_some(), is_found, "{increment} {noise}: {found:?}");
        }
    }

    /// Sporadic peaks while the motor is off for another reason are not an oscillation; an asymmetric oscillation is one.
    #[test]
    fn an_oscillation_is_regular() {
        let mut recording = reversing(0, 1e-3, |_| 0.0);
        for (gaps, is_found) in
            [([5, 5, 5, 5], true), ([1, 9, 1, 9], true), ([2, 9, 4, 7], true), ([1, 2, 9, 9], false)]
        {
            let times = (0..40).scan(0.05, |time, k| {
                *time += 2e-3 * f64::from(gaps[k % 4]);
                Some(*time)
            });
            recording.limit_reversals = vec![LimitReversals { limit: "effort limit".into(), times: times.collect() }];
            assert_eq!(between_limits(&recording, &rules()).is_some(), is_found, "{gaps:?}");
        }
    }

    /// A motion that starts from rest begins anew, a request that passes zero does not.
    #[test]
    fn alternations_of_two_motions_do_not_add_up() {
        let starting = |t: f64| if t < 0.155 { 0.0 } else { 1.0 };
        assert_eq!(between_limits(&reversing(12, 1e-3, starting), &rules()), None);
        assert!(between_limits(&reversing(12, 1e-3, |t| 0.155 - t), &rules()).is_some());
    }

    /// Ten thousand alternations, all of them explained, of a motor that swings; of one that the encoder does not see swing they are noise.
    #[test]
    fn what_is_not_kept_is_not_judged_as_none() {
        let most = LimitReversals::MOST;
        for (increment, count, is_found) in [(0.0, most, true), (0.0, most - 1, false), (1e-3, most, false)] {
            let mut recording = Build::new(20_000, 20_001)
                .channel(Signal::RequestVelocity, "m/s", |t| (TAU * 5000.0 * t + 0.1).sin())
                .channel(Signal::MotorPosition, "m", |t| 1e-3 * (TAU * 5000.0 * t).cos())
                .finish();
            let times = (0..count).map(|k| 1e-4 * k as f64).collect();
            recording.limit_reversals = vec![LimitReversals { limit: "effort limit".into(), times }];
            let found = between_limits(&recording, &Rules { increment, ..rules() });
            let is_unknown = found.as_ref().is_some_and(|found| found.contains("the rest is not judged"));
            assert_eq!((found.is_some(), is_unknown), (is_found, is_found), "{increment} {count}: {found:?}");
        }
    }

    /// Each part of a run has at least as many of them in a longer one, whatever comes afterwards.
    #[test]
    fn a_longer_run_is_never_greener() {
        let velocity = |t: f64| if t > 0.3 { 0.3 * (TAU * 200.0 * t).sin() } else { 0.0 };
        let mut last = false;
        for k in 1..=10 {
            let mut recording = reversing(6 * k, 1e-3, velocity);
            let rows = 100 + 60 * k + 1;
            for channel in &mut recording.channels {
                channel.values = channel.values.iter().copied().take(rows).collect();
            }
            let found = between_limits(&recording, &rules()).is_some();
            assert!(found || !last, "{k}");
            last = found;
        }
        assert!(last);
    }
}
