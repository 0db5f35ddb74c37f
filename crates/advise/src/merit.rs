//! Merit of a set-point, within its limits or not.
use crate::search::{Allowance, Reading};

/// Use of an unmeasured limit, and of a failed requirement, as multiples of the limit: a search moves away from both and can still compare
/// two set-points.
const UNKNOWN: f64 = 2.0;
const UNSOUND: f64 = 3.0;
/// Time of a load that does not settle, as a multiple of the duration of its move.
const UNSETTLED: f64 = 2.0;
/// Power of the excess in the merit: a usage falls at least with the square root of time, so that less time never outweighs more excess.
const PENALTY: f64 = 2.0;
/// Power of the excess in the estimated time at which a limit is met. Residual vibration, which exceeds by the most, needs the least: half
/// a period more reduces it tenfold. Figures that fall smoothly with time are found by refinement from anywhere.
const STRETCH: f64 = 0.12;

/// Merit of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Merit {
    /// Move and settling time (s).
    pub(crate) time: f64,
    /// The largest use of a limit; at most 1 if all are met.
    pub(crate) over: f64,
}

impl Merit {
    /// Merit before any run.
    pub(crate) const NONE: Self = Self { time: 0.0, over: 0.0 };

    /// Merit for the `reading` of a move of `duration` (s).
    pub(crate) fn of(reading: &Reading, allowed: &Allowance, duration: f64) -> Self {
        let parts = reading.usage.iter().zip(allowed).map(|(usage, most)| usage / most);
        let unknown = parts.clone().filter(|part| part.is_nan()).count();
        // An excess over a limit of zero has no measure.
        let part = |part: f64| if part.is_infinite() { UNSOUND } else { part };
        let mut over = parts.filter(|part| !part.is_nan()).map(part).fold(1.0, f64::max);
        if unknown > 0 && unknown == reading.usage.len() {
            return Self { time: f64::INFINITY, over: f64::INFINITY };
        }
        if unknown > 0 || !reading.time.is_finite() {
            over = over.max(UNKNOWN);
        }
        if !reading.is_sound {
            over = over.max(UNSOUND);
        }
        Self { time: if reading.time.is_finite() { reading.time } else { UNSETTLED * duration }, over }
    }

    /// The worse value of both in each figure.
    pub(crate) fn worse(self, other: Self) -> Self {
        Self { time: self.time.max(other.time), over: self.over.max(other.over) }
    }

    pub(crate) fn keeps(self) -> bool {
        self.over <= 1.0
    }

    /// The time (s) within the limits; infinite beyond them.
    pub(crate) fn time_kept(self) -> f64 {
        if self.keeps() { self.time } else { f64::INFINITY }
    }

    /// The time (s) with an exact penalty for an excess over the limits: its minimum is within them.
    pub(crate) fn penalised(self) -> f64 {
        self.time * self.over.powf(PENALTY)
    }

    /// Estimated time (s) of a similar move within the limits.
    pub(crate) fn promise(self) -> f64 {
        self.time * self.over.powf(STRETCH)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reading(time: f64, usage: &[f64], is_sound: bool) -> Merit {
        Merit::of(&Reading { time, usage: usage.to_vec(), is_sound }, &vec![1.0; usage.len()], 0.5)
    }

    #[test]
    fn what_keeps_its_limits_is_as_good_as_it_is_fast() {
        let good = reading(0.6, &[0.3, 1.0], true);
        assert!(good.keeps() && (good.penalised() - 0.6).abs() < 1e-15 && (good.promise() - 0.6).abs() < 1e-15);
        let over = reading(0.5, &[0.3, 4.0], true);
        assert!(
            !over.keeps()
                && (over.penalised() - 8.0).abs() < 1e-12
                && (over.promise() - 0.5 * 4_f64.powf(0.12)).abs() < 1e-12
        );
    }

    /// Failures can still be compared; aborted runs cannot.
    #[test]
    fn failures_have_an_order() {
        let unsettled = reading(f64::NAN, &[f64::NAN, 1.2], true);
        let worse = reading(f64::NAN, &[f64::NAN, 9.0], false);
        assert!(!unsettled.keeps() && unsettled.penalised() < worse.penalised() && worse.penalised().is_finite());
        assert!(!reading(0.5, &[0.1], false).keeps());
        assert!(reading(f64::NAN, &[f64::NAN, f64::NAN], false).promise().is_infinite());
    }
}
