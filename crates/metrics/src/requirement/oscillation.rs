//! `stable`: the linear loop has no pole outside the unit circle; nothing swings between its limits; no oscillation grows.
//!
//! A stretch is from the start of the run to that of the first move, from there to that of the next, and from that of the last to the
//! end of the run; without a move it is the whole run.
//!
//! - **Limit to limit.** In each stretch the reversals of a limited quantity are counted: cut at one limit after it was cut at the
//!   other. More than [`MOST_REVERSALS`] beyond those that set-point and disturbances ask for (module [`asked`](super::asked)) are an
//!   oscillation. A limit that binds on one side is none. Where a recording holds as many as are kept, what follows is not known.
//! - **Growth.** Before the first move, after the last profile of a sequence, or in the whole run without a move, the following error
//!   of the motor is cut into [`PARTS`] equal parts. It grows when it swings in each of them, each part swings further than the one
//!   before, the last [`GROWTH`] times as far as the first, and the growth does not fade from part to part, as that of a beat would.
use super::Rules;
use super::asked::{is_disturbed, reversals_asked_for, sign_changes};
use super::rules::{Driven, LinearLoop};
use crate::quantity::Quantity;
use crate::span::{Phase, phases};
use servobench_signals::Signal;
use servobench_trace::{LimitReversals, Recording};
use std::ops::Range;

/// Reversals between limits in a stretch that nobody asks for, at most.
pub(super) const MOST_REVERSALS: usize = 8;
/// Parts in which an oscillation must grow.
const PARTS: usize = 4;
/// How much further it swings in the last part than in the first.
const GROWTH: f64 = 2.0;
/// How much further at least in each part than in the one before.
const STEP: f64 = 1.1;
/// What the growth from part to part may lose to the next.
const FADING: f64 = 0.8;
/// Turns in each part, at least: two periods.
const TURNS: usize = 4;
/// An oscillation is larger than so many increments of the encoder.
const INCREMENTS: f64 = 4.0;
/// What differences of positions say nothing about, as a part of the largest position.
const ROUNDING: f64 = 1e-12;

/// Why the axis is not stable; `None` where no loop is closed.
pub(super) fn broken(recording: &Recording, rules: &Rules<'_>) -> Option<Vec<String>> {
    if rules.driven != Driven::ByLoops {
        return None;
    }
    let linear = match &rules.linear_loop {
        LinearLoop::Unstable(words) => Some(words.clone()),
        LinearLoop::Stable | LinearLoop::NotAnalysed => None,
    };
    Some(linear.into_iter().chain(between_limits(recording, rules)).chain(growth(recording, rules)).collect())
}

/// The worst swinging between limits, in words.
fn between_limits(recording: &Recording, rules: &Rules<'_>) -> Option<String> {
    let stretches = stretches(recording);
    let worst = stretches.iter().flat_map(|rows| {
        recording.limit_reversals.iter().map(move |reversals| {
            let (from, to) = (recording.time_of(rows.start), recording.time_of(rows.end));
            let within: Vec<f64> = reversals.times.iter().copied().filter(|t| (from..to).contains(t)).collect();
            (reversals.limit.as_str(), within, reversals_asked_for(recording, rows, rules.transmission))
        })
    });
    let (limit, times, asked) = worst.max_by_key(|(_, times, asked)| times.len().saturating_sub(*asked))?;
    if times.len() <= asked + MOST_REVERSALS {
        return recording.limit_reversals.iter().find_map(not_known);
    }
    let (first, last) = (Quantity::new(*times.first()?, "s"), Quantity::new(*times.last()?, "s"));
    Some(format!("it goes from one {limit} to the other {} times from {first} to {last}", times.len()))
}

/// Of a run with more reversals than are kept nobody can say that the others were asked for.
fn not_known(reversals: &LimitReversals) -> Option<String> {
    let LimitReversals { limit, times } = reversals;
    let last = times.get(LimitReversals::MOST - 1)?;
    let (most, last) = (LimitReversals::MOST, Quantity::new(*last, "s"));
    Some(format!("it has gone from one {limit} to the other {most} times by {last}, and what follows is not judged"))
}

/// Rows before the first move, and from the start of each move to the next; all without a move.
fn stretches(recording: &Recording) -> Vec<Range<usize>> {
    let of_moves: Vec<_> = phases(recording).iter().map(Phase::rows).collect();
    match of_moves.first() {
        None => std::iter::once(0..recording.len()).collect(),
        Some(first) if first.start > 0 => std::iter::once(0..first.start).chain(of_moves).collect(),
        Some(_) => of_moves,
    }
}

/// Rows in which the set-point rests: before the first move, and after each of them; all without a move.
fn at_rest(recording: &Recording) -> Vec<Range<usize>> {
    let phases = phases(recording);
    let before = 0..phases.first().map_or(recording.len(), |first| first.profile.start);
    std::iter::once(before).chain(phases.into_iter().map(|phase| phase.after)).collect()
}

/// An oscillation that grows, in words.
fn growth(recording: &Recording, rules: &Rules<'_>) -> Option<String> {
    let error = recording.channel(Signal::FollowingErrorMotor)?;
    let largest = recording.channel(Signal::MotorPosition)?.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let floor = (INCREMENTS * rules.increment).max(ROUNDING * largest);
    let is_growing =
        |rows: &Range<usize>| !is_disturbed(recording, rows, rules.transmission) && grows(&error[rows.clone()], floor);
    let growing = at_rest(recording).into_iter().find(is_growing)?;
    let (from, to) = (recording.time_of(growing.start), recording.time_of(growing.end - 1));
    let (from, to) = (Quantity::new(from, "s"), Quantity::new(to, "s"));
    Some(format!("the following error of the motor swings further and further from {from} to {to}"))
}

fn grows(values: &[f64], floor: f64) -> bool {
    let length = values.len() / PARTS;
    if length < 2 * TURNS {
        return false;
    }
    let swings: Vec<Option<f64>> = values.chunks_exact(length).take(PARTS).map(swing).collect();
    let Some(swings) = swings.into_iter().collect::<Option<Vec<f64>>>() else { return false };
    let ratios: Vec<f64> = swings.windows(2).map(|pair| pair[1] / pair[0]).collect();
    // Of what grows a thousandfold from part to part, where a part begins in a swing is a factor of its own.
    let goes_on = |pair: &[f64]| pair[1] >= FADING * pair[0] || pair[1].ln() >= FADING * pair[0].ln();
    let is_steady = ratios.windows(2).all(goes_on);
    let (first, last) = (swings[0], swings[PARTS - 1]);
    last > floor && last >= GROWTH * first && ratios.iter().all(|ratio| *ratio >= STEP) && is_steady
}

/// From the lowest to the highest value, if they swing. Turns and not crossings of the mean are counted: the last swing of what
/// grows fast moves the mean out of the reach of all others.
fn swing(values: &[f64]) -> Option<f64> {
    let steps: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let (low, high) =
        values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
    (sign_changes(steps.into_iter()) >= TURNS && high > low).then_some(high - low)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirement::tests::rules;
    use crate::synthetic::{Build, planned};
    use core::f64::consts::TAU;
    use servobench_trace::LimitReversals;

    /// A second at 1 kHz in which the motor is off by `error(t)`.
    fn recording(error: impl Fn(f64) -> f64) -> Recording {
        Build::new(1000, 1001)
            .channel(Signal::FollowingErrorMotor, "m", error)
            .channel(Signal::MotorPosition, "m", |_| 1.0)
            .finish()
    }

    #[test]
    fn an_oscillation_that_grows_is_found_and_one_that_does_not_is_not() {
        for (growth, is_found) in
            [(1.5, true), (5.0, true), (200.0, true), (650.0, true), (0.3, false), (0.0, false), (-2.0, false)]
        {
            let found = broken(&recording(|t| 1e-4 * (growth * t).exp() * (TAU * 33.0 * t).sin()), &rules()).unwrap();
            assert_eq!(!found.is_empty(), is_found, "{growth}: {found:?}");
        }
        let found = broken(&recording(|t| 1e-4 * (3.0 * t).exp() * (TAU * 33.0 * t).sin()), &rules()).unwrap();
        assert_eq!(found, ["the following error of the motor swings further and further from 0 s to 1.00 s"]);
    }

    /// A beat grows too, but less and less; a drift does not swing; what the encoder does not see is nothing.
    #[test]
    fn beats_drifts_and_rounding_are_no_instability() {
        let beat = |t: f64| 1e-4 * (TAU * 0.24 * t).sin() * (TAU * 60.0 * t).sin();
        let drift = |t: f64| 1e-4 * (3.0 * t).exp();
        let tiny = |t: f64| 1e-14 * (3.0 * t).exp() * (TAU * 33.0 * t).sin();
        for (name, error) in [("beat", &beat as &dyn Fn(f64) -> f64), ("drift", &drift), ("tiny", &tiny)] {
            assert_eq!(broken(&recording(error), &rules()).unwrap(), [""; 0], "{name}");
        }
        let growing = recording(|t| 1e-6 * (3.0 * t).exp() * (TAU * 33.0 * t).sin());
        let coarse = Rules { increment: 1e-5, ..rules() };
        assert_eq!(broken(&growing, &coarse).unwrap(), [""; 0], "below four increments");
        assert_eq!(broken(&growing, &rules()).unwrap().len(), 1);
    }

    #[test]
    fn growth_is_looked_for_where_the_set_point_rests() {
        let mut recording = recording(|t| if t < 0.5 { 1e-4 * (8.0 * t).exp() * (TAU * 33.0 * t).sin() } else { 0.0 });
        recording.moves = vec![planned(0.0, 0.5, 0.0, 1.0).made()];
        assert_eq!(broken(&recording, &rules()).unwrap(), [""; 0]);
        recording.moves = vec![planned(0.5, 0.6, 0.0, 1.0).made()];
        let before = "the following error of the motor swings further and further from 0 s to 499 ms";
        assert_eq!(broken(&recording, &rules()).unwrap(), [before], "and before the first move it rests too");
    }

    fn reversing(times: usize, acceleration: impl Fn(f64) -> f64) -> Recording {
        let mut recording = Build::new(1000, 1001).channel(Signal::SetpointAcceleration, "m/s²", acceleration).finish();
        let times = (0..times).map(|k| 0.1 + 0.01 * k as f64).collect();
        recording.limit_reversals = vec![LimitReversals { limit: "effort limit".into(), times }];
        recording
    }

    #[test]
    fn more_than_eight_reversals_that_nobody_asks_for_are_an_oscillation() {
        for (times, is_found) in [(0, false), (8, false), (9, true), (60, true)] {
            let found = broken(&reversing(times, |_| 0.0), &rules()).unwrap();
            assert_eq!(!found.is_empty(), is_found, "{times}: {found:?}");
        }
        assert_eq!(
            broken(&reversing(9, |_| 0.0), &rules()).unwrap(),
            ["it goes from one effort limit to the other 9 times from 100 ms to 180 ms"]
        );
        // Ten half periods of the set-point: ten changes of sign, of which the end of the run sees nine or ten.
        let sine = |t: f64| (TAU * 5.0 * t).sin();
        assert_eq!(broken(&reversing(17, sine), &rules()).unwrap(), [""; 0]);
        assert_eq!(broken(&reversing(20, sine), &rules()).unwrap().len(), 1);
    }

    #[test]
    fn reversals_before_the_first_move_count_too() {
        let mut recording = reversing(12, |_| 0.0);
        recording.moves = vec![planned(0.25, 0.5, 0.0, 1.0).made()];
        let found = broken(&recording, &rules()).unwrap();
        assert_eq!(found, ["it goes from one effort limit to the other 12 times from 100 ms to 210 ms"]);
    }

    #[test]
    fn reversals_beyond_those_that_are_kept_are_not_judged_as_none() {
        let mut recording = reversing(0, |t| (TAU * 400.0 * t).sin());
        let late = |count: usize| vec![LimitReversals { limit: "effort limit".into(), times: vec![-1.0; count] }];
        recording.limit_reversals = late(LimitReversals::MOST - 1);
        assert_eq!(broken(&recording, &rules()).unwrap(), [""; 0], "outside of all stretches");
        recording.limit_reversals = late(LimitReversals::MOST);
        let found = broken(&recording, &rules()).unwrap();
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].contains("what follows is not judged"), "{found:?}");
    }

    /// Each stretch is judged for itself.
    #[test]
    fn reversals_of_two_moves_do_not_add_up() {
        let mut recording = reversing(12, |_| 0.0);
        assert_eq!(broken(&recording, &rules()).unwrap().len(), 1);
        recording.moves = vec![planned(0.0, 0.05, 0.0, 1.0).made(), planned(0.155, 0.2, 1.0, 0.0).made()];
        assert_eq!(broken(&recording, &rules()).unwrap(), [""; 0]);
    }

    #[test]
    fn an_unstable_linear_loop_is_unstable_whatever_the_trace_shows() {
        let linear_loop = LinearLoop::Unstable("the loop is unstable".into());
        let found = broken(&recording(|_| 0.0), &Rules { linear_loop: linear_loop.clone(), ..rules() }).unwrap();
        assert_eq!(found, ["the loop is unstable"]);
        for driven in [Driven::Exactly, Driven::Not] {
            assert_eq!(
                broken(&recording(|_| 0.0), &Rules { linear_loop: linear_loop.clone(), driven, ..rules() }),
                None
            );
        }
    }
}
