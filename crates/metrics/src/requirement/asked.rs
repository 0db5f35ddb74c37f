//! What asks an axis for effort: the acceleration of the set-point, and what disturbs the axis.
//!
//! A set-point that accelerates and brakes asks for one way from limit to limit at each change of the sign of its acceleration, and a
//! sine that disturbs the axis at each change of its own. What is far smaller than what is there anyway asks for nothing: signs of
//! the roundings of an interpolation change from tick to tick, and a millinewton sends no axis from limit to limit.
use servobench_signals::Signal;
use servobench_trace::Recording;
use std::ops::Range;

/// The least share that counts: of the largest acceleration of a stretch, of the largest effort of the motor in it.
const SHARE: f64 = 0.01;
/// Of the largest acceleration of the whole run less is a rounding.
const ROUNDING: f64 = 1e-9;

/// Ways from limit to limit that set-point and disturbances ask for in `rows`; `transmission` is axis per motor coordinate.
pub(super) fn reversals_asked_for(recording: &Recording, rows: &Range<usize>, transmission: f64) -> usize {
    let accelerations = recording.channel(Signal::SetpointAcceleration).map_or(0, |values| {
        let least = (SHARE * largest(&values[rows.clone()])).max(ROUNDING * largest(values));
        sign_changes(values[rows.clone()].iter().copied().filter(|a| a.abs() >= least))
    });
    let least = SHARE * effort(recording, rows);
    let disturbances = disturbances(recording, rows, transmission)
        .map(|(values, scale)| sign_changes(values.iter().copied().filter(|value| (scale * value).abs() >= least)));
    accelerations + disturbances.sum::<usize>()
}

/// Whether a disturbance changes in `rows`.
pub(super) fn is_disturbed(recording: &Recording, rows: &Range<usize>, transmission: f64) -> bool {
    let least = SHARE * effort(recording, rows);
    disturbances(recording, rows, transmission).any(|(values, scale)| {
        let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
        high > low && scale * (high - low) >= least
    })
}

/// How often the sign of `values` changes, zeros left out.
pub(super) fn sign_changes(values: impl Iterator<Item = f64>) -> usize {
    let mut signs = values.filter(|value| *value != 0.0).map(f64::is_sign_positive);
    let Some(mut sign) = signs.next() else { return 0 };
    signs.filter(|next| std::mem::replace(&mut sign, *next) != *next).count()
}

/// What disturbs motor and load in `rows`, end stops among it, and the factor that makes each an effort of the motor.
fn disturbances<'a>(
    recording: &'a Recording,
    rows: &Range<usize>,
    transmission: f64,
) -> impl Iterator<Item = (&'a [f64], f64)> {
    let rows = rows.clone();
    let on_load = [Signal::DisturbanceLoad, Signal::EffortEndStop].map(|signal| (signal, transmission.abs()));
    std::iter::once((Signal::DisturbanceMotor, 1.0))
        .chain(on_load)
        .filter_map(move |(name, scale)| Some((recording.channel(name)?.get(rows.clone())?, scale)))
}

/// The largest effort of the motor in `rows`, as the drive asks for it or as it is.
fn effort(recording: &Recording, rows: &Range<usize>) -> f64 {
    let channels =
        [Signal::EffortReference, Signal::EffortMotor].into_iter().filter_map(|name| recording.channel(name));
    channels.map(|values| largest(&values[rows.clone()])).fold(0.0, f64::max)
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, value| value.abs().max(largest))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::Build;
    use core::f64::consts::TAU;

    /// A second at 1 kHz.
    fn asked(acceleration: impl Fn(f64) -> f64, on_load: impl Fn(f64) -> f64, transmission: f64) -> (usize, bool) {
        let recording = Build::new(1000, 1000)
            .channel(Signal::SetpointAcceleration, "m/s²", acceleration)
            .channel(Signal::DisturbanceLoad, "N", on_load)
            .channel(Signal::EffortReference, "N m", |t| 3.0 * (TAU * 50.0 * t).cos())
            .finish();
        (reversals_asked_for(&recording, &(0..1000), transmission), is_disturbed(&recording, &(0..1000), transmission))
    }

    #[test]
    fn each_change_of_sign_asks_for_one_and_roundings_for_none() {
        let braking = |t: f64| {
            if t < 0.1 {
                5.0
            } else if t < 0.2 {
                0.0
            } else {
                -5.0
            }
        };
        assert_eq!(asked(braking, |_| 0.0, 1.0), (1, false));
        let rounded = |t: f64| if (0.1..0.2).contains(&t) { 1e-12 * (TAU * 333.0 * t).sin() } else { braking(t) };
        assert_eq!(asked(rounded, |_| 0.0, 1.0), (1, false));
        assert_eq!(
            asked(|t| 1e-3 * (TAU * (4.9 * t + 0.01)).sin(), |_| 0.0, 1.0),
            (9, false),
            "a slow sine is no rounding"
        );
    }

    /// Oracle: 1 % of the 3 N·m that the motor gives is 3 N at a lead of 0.01 m per rad.
    #[test]
    fn a_disturbance_counts_from_a_hundredth_of_the_effort_of_the_motor() {
        for (force, is_felt) in [(3.1, true), (2.9, false), (1e-6, false)] {
            let sine = |t: f64| force * (TAU * (4.9 * t + 0.05)).sin();
            assert_eq!(asked(|_| 0.0, sine, 0.01).0 > 0, is_felt, "{force} N");
        }
        for (step, is_felt) in [(3.1, true), (2.9, false)] {
            let found = asked(|_| 0.0, |t| if t < 0.5 { 20.0 } else { 20.0 + step }, 0.01);
            assert_eq!(found, (0, is_felt), "a step of {step} N");
        }
    }
}
