//! Growth: an oscillation that swings further and further while the task requests one velocity.
//!
//! The position of a standing axis swings, and the velocity of a moving one. Swings from turning point to turning point are
//! gathered in windows of equal numbers of swings, from the beginning of the stretch on. An oscillation grows if over [`WINDOWS`]
//! consecutive windows each mean swing is larger than the one before, the last one [`GROWTH`] times the first, and the growth does not
//! fade from window to window, as that of a beat does; and if it has become larger than everything before, and than the encoder sees.
//! The windows have the length of the swings, not of the run: growth in a run is growth in every longer one, whether or not it continues.
use super::Rules;
use super::calm::{Calm, calm};
use super::turning_points::{Swing, swings};
use crate::quantity::Quantity;
use core::f64::consts::PI;
use servobench_signals::Signal;
use servobench_trace::Recording;

/// Windows in which an oscillation must grow.
const WINDOWS: usize = 4;
/// Swings in the shortest windows of a standing axis; longer ones are twice as long, and so on.
const STANDING: [usize; 2] = [2, 3];
/// The same of a moving one: a turning motor always swings at many frequencies, and two of its swings tell little.
const MOVING: [usize; 2] = [4, 6];
/// Minimum ratio of the swings in the last window to those in the first. The ratio of a beat or of a driven oscillation, whose growth
/// from window to window is at most constant, is 2.9 with a growth that fades as slowly as [`FADING`] allows.
const GROWTH: f64 = 3.0;
/// Minimum ratio of each window to the one before.
const STEP: f64 = 1.1;
/// Minimum ratio of the growth from window to window to the growth before.
const FADING: f64 = 0.85;
/// Minimum ratio to all windows before the first of them.
const RECORD: f64 = 1.5;
/// Maximum ratio of the longest to the shortest duration of the swings.
const EVEN: usize = 3;
/// Hysteresis of turning points, as a share of the largest swing so far.
const SHARE: f64 = 0.125;

/// An oscillation that grows, in words.
pub(super) fn growth(recording: &Recording, rules: &Rules<'_>) -> Option<String> {
    let position = recording.channel(Signal::MotorPosition)?;
    calm(recording, rules).iter().find_map(|calm| {
        let (swings, shortest, what) = of(recording, position, calm, rules);
        let (from, to) = grows(&swings, shortest)?;
        let (from, to) = (Quantity::new(recording.time_of(from), "s"), Quantity::new(recording.time_of(to), "s"));
        Some(format!("the {what} of the motor oscillates with growing amplitude from {from} to {to}"))
    })
}

/// The swings of a calm stretch beyond what the encoder sees, the lengths of the shortest windows, and the name of the quantity.
fn of(
    recording: &Recording,
    position: &[f64],
    calm: &Calm,
    rules: &Rules<'_>,
) -> (Vec<Swing>, [usize; 2], &'static str) {
    let rows = calm.rows.clone();
    let unseen = rules.unseen();
    if calm.velocity == 0.0 {
        return (swings(&position[rows.clone()], rows.start, unseen, SHARE), STANDING, "position");
    }
    let period = recording.rate.period();
    let velocity: Vec<f64> = position[rows.clone()].windows(2).map(|pair| (pair[1] - pair[0]) / period).collect();
    let all = swings(&velocity, rows.start, 0.0, SHARE);
    // A velocity that swings by Δv over a time T moves the motor by Δv·T/π.
    let is_seen = |pair: &[Swing]| pair[1].size * (pair[1].end - pair[0].end) as f64 * period / PI > unseen;
    (all.windows(2).filter(|pair| is_seen(pair)).map(|pair| pair[1]).collect(), MOVING, "velocity")
}

/// First and last row of its growth, in windows of at least so many swings.
fn grows(swings: &[Swing], shortest: [usize; 2]) -> Option<(usize, usize)> {
    let lengths = (0..usize::BITS).flat_map(|k| shortest.map(|shortest| shortest.checked_shl(k)));
    lengths.map_while(|length| length.filter(|length| WINDOWS * length <= swings.len())).find_map(|length| {
        let windows: Vec<f64> = swings
            .chunks_exact(length)
            .map(|window| window.iter().map(|swing| swing.size).sum::<f64>() / length as f64)
            .collect();
        let mut largest_before = 0.0_f64;
        for (k, four) in windows.windows(WINDOWS).enumerate() {
            let (first, last) = (k * length, (k + WINDOWS) * length);
            if is_growth(four) && four[WINDOWS - 1] > RECORD * largest_before && is_even(&swings[first..last]) {
                return Some((swings[first].end, swings[last - 1].end));
            }
            largest_before = largest_before.max(four[0]);
        }
        None
    })
}

/// True if the swings take about equally long, as those of one oscillation do, and those of noise do not.
fn is_even(swings: &[Swing]) -> bool {
    let lengths = || swings.windows(2).map(|pair| pair[1].end - pair[0].end);
    lengths().max() <= lengths().min().map(|shortest| EVEN * shortest.max(1))
}

fn is_growth(windows: &[f64]) -> bool {
    let ratios: Vec<f64> = windows.windows(2).map(|pair| pair[1] / pair[0]).collect();
    // If it grows a thousandfold from window to window, the phase in which a window begins is a factor in itself.
    let goes_on = |pair: &[f64]| pair[1] >= FADING * pair[0] || pair[1].ln() >= FADING * pair[0].ln();
    let whole: f64 = ratios.iter().product();
    whole >= GROWTH && ratios.iter().all(|ratio| *ratio >= STEP) && ratios.windows(2).all(goes_on)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirement::tests::rules;
    use crate::synthetic::Build;
    use core::f64::consts::TAU;

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few seconds")]
    fn rows(length: f64) -> usize {
        (1000.0 * length) as usize + 1
    }

    /// At 1 kHz for `length` (s), the motor is off by `error(t)` from where it is to stand.
    fn standing_for(length: f64, error: impl Fn(f64) -> f64) -> Recording {
        Build::new(1000, rows(length))
            .channel(Signal::MotorPosition, "m", |t| 1.0 - error(t))
            .channel(Signal::RequestPosition, "m", |_| 1.0)
            .channel(Signal::RequestVelocity, "m/s", |_| 0.0)
            .requests(&[(0.0, "stand")])
            .finish()
    }

    fn found(error: impl Fn(f64) -> f64) -> Option<String> {
        growth(&standing_for(1.0, error), &rules())
    }

    #[test]
    fn an_oscillation_that_grows_is_found_and_one_that_does_not_is_not() {
        for (rate, is_found) in
            [(2.0, true), (5.0, true), (200.0, true), (600.0, true), (0.3, false), (0.0, false), (-2.0, false)]
        {
            let found = found(|t| 1e-4 * (rate * t).exp() * (TAU * 33.0 * t).sin());
            assert_eq!(found.is_some(), is_found, "{rate}: {found:?}");
        }
        let found = found(|t| 1e-4 * (3.0 * t).exp() * (TAU * 33.0 * t).sin()).unwrap();
        assert!(found.starts_with("the position of the motor oscillates with growing amplitude from "), "{found}");
    }

    /// A beat grows too, but less and less, in any part of it; so does a driven oscillation. A drift does not swing,
    /// and motion that the encoder does not see does not count.
    #[test]
    fn beats_drifts_and_roundings_are_no_growth() {
        for share in [0.003, 0.01, 0.02, 0.03, 0.05, 0.1] {
            for phase in [0.0, 0.1, 0.3, 0.7] {
                let beat = |t: f64| 1e-4 * (TAU * (share * 60.0 * t + phase)).sin() * (TAU * 60.0 * t).sin();
                assert_eq!(growth(&standing_for(6.0, beat), &rules()), None, "{share} {phase}");
            }
        }
        for rate in [0.3, 1.0, 3.0, 10.0, 30.0] {
            assert_eq!(found(|t| 1e-4 * (1.0 - (-rate * t).exp()) * (TAU * 60.0 * t).sin()), None, "{rate}");
        }
        assert_eq!(found(|t| 1e-4 * (3.0 * t).exp()), None);
        assert_eq!(found(|t| 1e-14 * (3.0 * t).exp() * (TAU * 33.0 * t).sin()), None);
        let growing = standing_for(1.0, |t| 1e-6 * (3.0 * t).exp() * (TAU * 33.0 * t).sin());
        for (increment, noise, is_found) in
            [(1e-7, 0.0, true), (1e-5, 0.0, false), (0.0, 1e-7, true), (0.0, 1e-5, false)]
        {
            let found = growth(&growing, &Rules { increment, noise, ..rules() });
            assert_eq!(found.is_some(), is_found, "{increment} {noise}: {found:?}");
        }
    }

    /// Growth once found stays found, whether it continues, stays or fades: from 10 periods of the swing to thirty times as many.
    #[test]
    fn a_longer_run_is_never_greener() {
        let mut red = 0;
        for rate in [0.05, 0.2, 0.5, 1.0, 2.0, 5.0, 20.0] {
            for most in [3.0, 10.0, 100.0, 1e12] {
                for fading in [0.0, 0.3] {
                    let size = |t: f64| 1e-4 * (rate * t).exp().min(most) * (-fading * (t - 2.0).max(0.0)).exp();
                    let error = |t: f64| size(t) * (TAU * 20.0 * t).sin();
                    let lengths = (0..10).map(|k| 0.5 * 1.46_f64.powi(k));
                    let found: Vec<bool> =
                        lengths.map(|length| growth(&standing_for(length, error), &rules()).is_some()).collect();
                    assert!(found.is_sorted(), "{rate} {most} {fading}: {found:?}");
                    red += usize::from(found[9]);
                }
            }
        }
        assert!(red >= 28, "{red}");
    }

    #[test]
    fn growth_is_looked_for_while_the_request_is_calm() {
        let error = |t: f64| 1e-4 * (4.0 * t).exp() * (TAU * 33.0 * t).sin();
        let moving = |kind: &'static str, v: f64| {
            Build::new(1000, 1001)
                .channel(Signal::MotorPosition, "m", |t| v * t - error(t))
                .channel(Signal::RequestPosition, "m", |t| v * t)
                .channel(Signal::RequestVelocity, "m/s", |_| v)
                .requests(&[(0.0, kind)])
                .finish()
        };
        for (kind, v, what) in [
            ("rest", 0.0, Some("position")),
            ("velocity", 0.0, Some("position")),
            ("velocity", 0.4, Some("velocity")),
            ("velocity", -7.0, Some("velocity")),
            ("follow", 0.4, None),
            ("nothing", 0.0, None),
        ] {
            let found = growth(&moving(kind, v), &rules());
            let said = what.map(|what| format!("the {what} of the motor"));
            assert_eq!(found.is_some(), said.is_some(), "{kind} {v}: {found:?}");
            assert!(found.unwrap_or_default().starts_with(&said.unwrap_or_default()), "{kind} {v}");
        }
    }
}
