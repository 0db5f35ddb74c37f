//! Delay of the set-point by any time up to [`DelayLine::CAPACITY`] task periods, fractions included.
//!
//! The feedforward effort takes a while to reach the motor; the reference of the loops waits as long, or the position
//! controller works against the feedforward. Between two samples the set-point is the polynomial of the earlier one
//! ([`Setpoint::after`]): exact as long as snap switches at sample instants, as a sampled plan does.
use servobench_base::{ParamError, Setpoint};

/// The last set-points, newest first in time.
#[derive(Debug, Clone, PartialEq)]
pub struct DelayLine {
    kept: [Setpoint; DelayLine::CAPACITY + 2],
    /// Index of the newest.
    newest: usize,
    /// Whole periods of delay, rounded up.
    whole: usize,
    /// What the rounding added (s).
    rest: f64,
}

impl DelayLine {
    /// Longest delay in task periods.
    pub const CAPACITY: usize = 30;

    /// A line that delays by `delay` (s) at the task period `period` (s), filled with `start`.
    ///
    /// # Errors
    /// [`ParamError`] when the delay is negative or longer than [`DelayLine::CAPACITY`] periods.
    pub fn new(delay: f64, period: f64, start: Setpoint) -> Result<Self, ParamError> {
        let periods = delay / period;
        if !(0.0..=Self::CAPACITY as f64).contains(&periods) {
            let bound = "from 0 s to 30 periods of the position task";
            return Err(ParamError { name: "drive.feedforward.delay", value: delay, bound });
        }
        let whole = libm::ceil(periods - 1e-9);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to CAPACITY")]
        let index = if whole > 0.0 { whole as usize } else { 0 };
        let rest = (index as f64 * period - delay).max(0.0);
        Ok(Self { kept: [start; Self::CAPACITY + 2], newest: 0, whole: index, rest })
    }

    /// Takes the set-point of this task tick and returns the one of `delay` ago.
    pub fn push(&mut self, now: Setpoint) -> Setpoint {
        let size = self.kept.len();
        self.newest = if self.newest + 1 == size { 0 } else { self.newest + 1 };
        self.kept[self.newest] = now;
        let index = if self.newest >= self.whole { self.newest - self.whole } else { self.newest + size - self.whole };
        let earlier = self.kept[index];
        if self.rest == 0.0 { earlier } else { earlier.after(self.rest) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a quartic is its own Taylor polynomial, so the delayed set-point is the polynomial at t − delay.
    #[test]
    fn a_fraction_of_a_period_is_exact_for_a_quartic() {
        let (period, start) = (1e-3, Setpoint { x: 0.0, v: 0.1, a: -2.0, j: 30.0, s: 400.0 });
        for delay in [0.0, 0.25e-3, 1e-3, 2.6e-3, 30e-3] {
            let mut line = DelayLine::new(delay, period, start).unwrap();
            for k in 0..100 {
                let t = f64::from(k) * period;
                let found = line.push(start.after(t));
                if k >= 30 {
                    let exact = start.after(t - delay);
                    assert!((found.x - exact.x).abs() < 1e-14 && (found.v - exact.v).abs() < 1e-13, "{delay} {k}");
                }
            }
        }
    }

    #[test]
    fn it_starts_at_rest_and_refuses_what_it_cannot_hold() {
        let mut line = DelayLine::new(2.5e-3, 1e-3, Setpoint::at_rest(0.4)).unwrap();
        assert_eq!(line.push(Setpoint::at_rest(0.5)), Setpoint::at_rest(0.4));
        // By the key of the scenario file, in the unit of the value.
        let said = DelayLine::new(31e-3, 1e-3, Setpoint::default()).unwrap_err().to_string();
        assert_eq!(said, "`drive.feedforward.delay` must be from 0 s to 30 periods of the position task, got 0.031");
        assert!(DelayLine::new(-1e-6, 1e-3, Setpoint::default()).is_err());
        assert!(DelayLine::new(f64::NAN, 1e-3, Setpoint::default()).is_err());
    }
}
