//! `rings`: swings after a motion die out as the linear loop predicts.
//!
//! From the end of a motion to the next one, the motor must not continue to swing by more than twice the window: its decay is at least
//! [`SHARE`] of that of the pole that oscillates and fades last, or of the slowest one where none does. Where poles are not known, the
//! last quarter of the time from the first swing on must not swing by [`SAME`] of the quarter before. A load that a loop with known poles
//! lets ring dies out by its damping: limits judge that.
use super::Rules;
use super::arrival::arrival_window;
use super::calm::{Calm, calm};
use super::rules::{Driven, LinearLoop};
use super::turning_points::{Swing, swings};
use crate::quantity::Quantity;
use servobench_signals::Signal;
use servobench_trace::Recording;

/// The least part of the decay of the slowest pole that oscillates.
const SHARE: f64 = 0.5;
/// Ratio from quarter to quarter of a swing that does not die out.
const SAME: f64 = 0.98;
/// Swings on either side of a comparison: three periods, and half of that where poles predict the decay.
const SWINGS: usize = 6;
const SWINGS_OF_POLE: usize = 3;

/// Swings that continue after a motion; `None` if the axis never comes to rest, or no loop is closed.
pub(super) fn broken(recording: &Recording, rules: &Rules<'_>) -> Option<Vec<String>> {
    if rules.driven != Driven::ByLoops {
        return None;
    }
    let position = recording.channel(Signal::MotorPosition)?;
    let rests: Vec<Calm> =
        calm(recording, rules).into_iter().filter(|calm| calm.velocity == 0.0 && calm.after.is_some()).collect();
    if rests.is_empty() {
        return None;
    }
    Some(rests.iter().filter_map(|rest| ringing(recording, position, rest, rules)).collect())
}

fn ringing(recording: &Recording, position: &[f64], rest: &Calm, rules: &Rules<'_>) -> Option<String> {
    let rows = rest.rows.clone();
    let window = rules.window.unwrap_or_else(|| arrival_window(rest.after.unwrap_or_default(), rules.resolution()));
    let least = (2.0 * window).max(rules.unseen());
    let all = swings(&position[rows.clone()], rows.start, least, 0.0);
    let period = recording.rate.period();
    let (earlier, later) = if let Some(decay) = decay(rules) {
        // The beginning may fade faster, with separate poles.
        let (earlier, later) = halves(&all[all.len() / 4..])?;
        let predicted = decay * (middle(later) - middle(earlier)) * period;
        // Half of it has to be visible.
        let is_visible = SHARE * predicted >= -SAME.ln();
        if !is_visible || (mean(earlier) / mean(later)).ln() >= SHARE * predicted {
            return None;
        }
        (earlier, later)
    } else {
        // A swing that begins in the middle of a rest is not compared with the time before.
        let quarter = (rows.end - all.first()?.end) / 4;
        let (before, from) = (rows.end - 2 * quarter, rows.end - quarter);
        let third = all.iter().position(|swing| swing.end >= before)?;
        let fourth = all.iter().position(|swing| swing.end >= from)?;
        let (earlier, later) = (&all[third..fourth], &all[fourth..]);
        if earlier.len() < SWINGS || later.len() < SWINGS || median(later) < SAME * median(earlier) {
            return None;
        }
        (earlier, later)
    };
    let unit = recording.about.axis_unit.as_str();
    let [from, to] = [earlier.first()?.end, later.last()?.end].map(|row| Quantity::new(recording.time_of(row), "s"));
    let size = Quantity::new(mean(later), unit);
    Some(format!("the motor keeps oscillating by {size} after a motion, from {from} to {to}"))
}

/// Decay of the pole that oscillates and fades last, or of the slowest one where none does (1/s), of a loop that is known.
fn decay(rules: &Rules<'_>) -> Option<f64> {
    if rules.linear_loop != LinearLoop::Stable || rules.not_analysed.is_some() {
        return None;
    }
    let poles = rules.poles?;
    poles.oscillating.map(|oscillation| oscillation.decay).or(poles.slowest_real)
}

/// The earlier and the later half, with enough swings in each.
fn halves(swings: &[Swing]) -> Option<(&[Swing], &[Swing])> {
    let (earlier, later) = swings.split_at(swings.len() / 2);
    (earlier.len() >= SWINGS_OF_POLE).then_some((earlier, later))
}

fn mean(swings: &[Swing]) -> f64 {
    swings.iter().map(|swing| swing.size).sum::<f64>() / swings.len() as f64
}

/// Median of the sizes, which a beginning that fades, or a later start, changes little.
fn median(swings: &[Swing]) -> f64 {
    let mut sizes: Vec<f64> = swings.iter().map(|swing| swing.size).collect();
    sizes.sort_unstable_by(f64::total_cmp);
    sizes[sizes.len() / 2]
}

/// The mean row of their ends.
fn middle(swings: &[Swing]) -> f64 {
    swings.iter().map(|swing| swing.end as f64).sum::<f64>() / swings.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirement::rules::{Oscillation, Poles};
    use crate::requirement::tests::rules;
    use crate::synthetic::Build;
    use core::f64::consts::TAU;

    /// Four seconds at 1 kHz: a motion of 0.1 m in the first half second, and then the motor is off by `error` of the time since then.
    fn moved(error: impl Fn(f64) -> f64) -> Recording {
        Build::new(1000, 4000)
            .channel(Signal::MotorPosition, "m", |t| if t < 0.5 { 0.2 * t } else { 0.1 - error(t - 0.5) })
            .channel(Signal::RequestPosition, "m", |t| (0.2 * t).min(0.1))
            .channel(Signal::RequestVelocity, "m/s", |t| if (0.1..0.5).contains(&t) { 0.2 } else { 0.0 })
            .requests(&[(0.0, "stand"), (0.1, "follow"), (0.5, "rest")])
            .finish()
    }

    fn known(decay: f64) -> Rules<'static> {
        let oscillating = Some(Oscillation { frequency: 20.0, decay });
        Rules { poles: Some(Poles { oscillating, slowest_real: None }), window: Some(1e-5), ..rules() }
    }

    fn unknown() -> Rules<'static> {
        Rules { linear_loop: LinearLoop::NotAnalysed, window: Some(1e-5), ..rules() }
    }

    /// Half of the decay that the poles predict is the least. A window larger than the swing is never exceeded.
    #[test]
    fn what_dies_out_as_the_poles_say_does_not_ring() {
        for (decay, rings) in [(2.0, false), (1.2, false), (0.8, true), (0.0, true), (-0.3, true)] {
            let recording = moved(|t| 1e-3 * (-decay * t).exp() * (TAU * 20.0 * t).sin());
            let found = broken(&recording, &known(2.0)).unwrap();
            assert_eq!(!found.is_empty(), rings, "{decay}: {found:?}");
            let wide = Rules { window: Some(2e-3), ..known(2.0) };
            assert_eq!(broken(&recording, &wide).unwrap().is_empty(), decay >= 0.0, "{decay}");
        }
    }

    /// A load without damping has a pole that explains endless swings.
    #[test]
    fn a_load_that_is_not_damped_does_not_ring() {
        let recording = moved(|t| 1e-3 * (TAU * 20.0 * t).sin());
        assert_eq!(broken(&recording, &known(1e-9)).unwrap(), [""; 0]);
        assert_eq!(broken(&recording, &known(0.05)).unwrap().len(), 1);
    }

    /// Without poles: 2 % from quarter to quarter of the rest, 0.875 s, are 0.023 1/s.
    #[test]
    fn without_poles_what_goes_on_rings() {
        for (decay, rings) in [(2.0, false), (0.05, false), (0.03, false), (0.015, true), (0.0, true)] {
            let recording = moved(|t| 1e-3 * (-decay * t).exp() * (TAU * 20.0 * t).sin());
            let found = broken(&recording, &unknown()).unwrap();
            assert_eq!(!found.is_empty(), rings, "{decay}: {found:?}");
        }
        for late in [2.0, 3.0] {
            let recording = moved(|t| if t < late { 0.0 } else { 1e-3 * (TAU * 30.0 * t).sin() });
            assert_eq!(broken(&recording, &unknown()).unwrap().len(), 1, "it begins {late} s after the motion");
        }
        let slow = moved(|t| 1e-3 * (TAU * 3.0 * t).sin());
        assert_eq!(broken(&slow, &unknown()).unwrap(), [""; 0], "less than three periods in a quarter");
        let partly = Rules { not_analysed: Some("the position loop of the master".into()), ..known(2.0) };
        let recording = moved(|t| 1e-3 * (-0.8 * t).exp() * (TAU * 20.0 * t).sin());
        assert_eq!(broken(&recording, &partly).unwrap(), [""; 0]);
    }

    #[test]
    fn what_the_encoder_does_not_see_does_not_ring() {
        let recording = moved(|t| 1e-5 * (TAU * 20.0 * t).sin());
        for (window, increment, noise, rings) in
            [(1e-6, 0.0, 0.0, true), (1.1e-5, 0.0, 0.0, false), (1e-6, 6e-6, 0.0, false), (1e-6, 0.0, 5e-6, false)]
        {
            let rules = Rules { window: Some(window), increment, noise, ..known(2.0) };
            assert_eq!(!broken(&recording, &rules).unwrap().is_empty(), rings, "{window} {increment} {noise}");
        }
    }

    #[test]
    fn rest_after_a_motion_and_a_loop_are_what_it_takes() {
        let swinging = |t: f64| 1e-3 * (TAU * 20.0 * t).sin();
        for driven in [Driven::Exactly, Driven::Not] {
            assert_eq!(broken(&moved(swinging), &Rules { driven, ..known(2.0) }), None);
        }
        let mut standing = moved(swinging);
        standing.signals[0].changes = vec![(0.0, "nothing".into()), (0.6, "stand".into())];
        assert_eq!(broken(&standing, &known(2.0)), None, "no motion before");
    }
}
