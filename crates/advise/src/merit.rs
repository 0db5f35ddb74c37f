//! Merit of a set-point, whether it keeps its limits or not.
use crate::search::{Allowance, Reading};

/// Use of a limit that could not be measured, and of a requirement that failed, as multiples of the limit: a search moves away from both and
/// still tells which of two is nearer.
const UNKNOWN: f64 = 2.0;
const UNSOUND: f64 = 3.0;
/// A load that does not settle counts as if it took so many times its move.
const UNSETTLED: f64 = 2.0;
/// Power of the overshoot in the merit: a usage falls at least with the square root of time, so that less time never pays for more overshoot.
const PENALTY: f64 = 2.0;
/// Power with which the time is estimated to grow until a limit is kept. Residual vibration, which is over by the most, takes the least: half of
/// a period more is enough for ten times less. What falls smoothly with time is found by refinement from anywhere.
const STRETCH: f64 = 0.12;

/// Merit of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Merit {
    /// Move and settling (s).
    pub(crate) time: f64,
    /// The largest use of a limit; at most 1 where all are kept.
    pub(crate) over: f64,
}

impl Merit {
    /// Before any run.
    pub(crate) const NONE: Self = Self { time: 0.0, over: 0.0 };

    /// Of the `reading` of a move of `duration` (s).
    pub(crate) fn of(reading: &Reading, allowed: &Allowance, duration: f64) -> Self {
        let parts = reading.usage.iter().zip(allowed).map(|(usage, most)| usage / most);
        let unknown = parts.clone().filter(|part| part.is_nan()).count();
        // More than a limit of nothing has no measure.
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

    /// The worse of both in each respect.
    pub(crate) fn worse(self, other: Self) -> Self {
        Self { time: self.time.max(other.time), over: self.over.max(other.over) }
    }

    pub(crate) fn keeps(self) -> bool {
        self.over <= 1.0
    }

    /// The time (s) of what keeps its limits; infinite of what does not.
    pub(crate) fn time_kept(self) -> f64 {
        if self.keeps() { self.time } else { f64::INFINITY }
    }

    /// The time (s) with an exact penalty for what is over the limits: the smallest is where they are kept.
    pub(crate) fn penalised(self) -> f64 {
        self.time * self.over.powf(PENALTY)
    }

    /// The time (s) that a move like this one is estimated to take where it keeps the limits.
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

    /// Failures can still be compared; runs that broke off cannot.
    #[test]
    fn failures_have_an_order() {
        let unsettled = reading(f64::NAN, &[f64::NAN, 1.2], true);
        let worse = reading(f64::NAN, &[f64::NAN, 9.0], false);
        assert!(!unsettled.keeps() && unsettled.penalised() < worse.penalised() && worse.penalised().is_finite());
        assert!(!reading(0.5, &[0.1], false).keeps());
        assert!(reading(f64::NAN, &[f64::NAN, f64::NAN], false).promise().is_infinite());
    }
}
