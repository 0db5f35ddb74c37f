//! Delay of the set-point by up to [`CAPACITY`] task periods, fractions included.
//!
//! The feedforward effort reaches the motor with a delay; the reference of the loops is delayed equally, lest the position controller
//! counteract the feedforward. Between two samples the set-point is the polynomial of the earlier one ([`Setpoint::after`]): exact as long
//! as snap switches at sample instants, as in a sampled plan.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use servobench_base::{Setpoint, Stateful};
use servobench_config::Kind::Plain;
use servobench_config::quantities::TIME;
use servobench_config::{ParameterError, not_negative};

servobench_config::parameters! {
    /// A parameter of the delay.
    pub enum Parameter {
        /// Delay of the reference, which matches the feedforward path
        DELAY "delay of the reference" = not_negative(Plain(&TIME), "0.2 ms");
    }
}

/// Longest delay in task periods.
pub const CAPACITY: usize = 30;

/// Delay; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Params {
    /// Whole task periods, rounded up.
    whole: usize,
    /// Excess of the rounding (s), and as a share of a task period.
    rest: f64,
    share: f64,
}

/// State from tick to tick: the last set-points.
#[derive(Debug, Clone, PartialEq, Default, Stateful)]
pub struct State {
    kept: [Setpoint; CAPACITY + 2],
    /// Index of the newest set-point.
    newest: usize,
}

impl Params {
    /// Parameters for a delay by `delay` (s) in a task of the period `period` (s).
    ///
    /// # Errors
    /// [`ParameterError`] when the delay is negative or longer than [`CAPACITY`] periods.
    pub fn new(delay: f64, period: f64) -> Result<Self, ParameterError> {
        let periods = delay / period;
        if !(0.0..=CAPACITY as f64).contains(&periods) {
            let bound = "from 0 s to 30 periods of the position task";
            return Err(ParameterError { name: Parameter::DELAY, value: delay, bound });
        }
        let whole = libm::ceil(periods - 1e-9);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to CAPACITY")]
        let whole = if whole > 0.0 { whole as usize } else { 0 };
        let rest = (whole as f64 * period - delay).max(0.0);
        Ok(Self { whole, rest, share: rest / period })
    }

    /// Delay (s) in a task of the period `period` (s).
    #[must_use]
    pub fn length(&self, period: f64) -> f64 {
        self.whole as f64 * period - self.rest
    }
}

impl State {
    /// State filled with `start`.
    #[must_use]
    pub const fn new(start: Setpoint) -> Self {
        Self { kept: [start; CAPACITY + 2], newest: 0 }
    }
}

/// Last values of a quantity other than a set-point, interpolated linearly between samples.
#[derive(Debug, Clone, PartialEq, Default, Stateful)]
pub struct Values {
    kept: [f64; CAPACITY + 2],
    /// Index of the newest value.
    newest: usize,
}

impl Values {
    /// State filled with `start`.
    #[must_use]
    pub const fn new(start: f64) -> Self {
        Self { kept: [start; CAPACITY + 2], newest: 0 }
    }
}

/// Stores the value of this task tick and returns the value delayed by `p`.
#[inline(always)]
pub fn step_value(p: &Params, x: &mut Values, now: f64) -> f64 {
    let size = x.kept.len();
    x.newest = if x.newest + 1 == size { 0 } else { x.newest + 1 };
    x.kept[x.newest] = now;
    let ago = |periods: usize| x.kept[if x.newest >= periods { x.newest - periods } else { x.newest + size - periods }];
    let earlier = ago(p.whole);
    if p.share == 0.0 { earlier } else { earlier + p.share * (ago(p.whole - 1) - earlier) }
}

/// Stores the set-point of this task tick and returns the set-point delayed by `p`.
#[inline(always)]
pub fn step(p: &Params, x: &mut State, now: Setpoint) -> Setpoint {
    let size = x.kept.len();
    x.newest = if x.newest + 1 == size { 0 } else { x.newest + 1 };
    x.kept[x.newest] = now;
    let index = if x.newest >= p.whole { x.newest - p.whole } else { x.newest + size - p.whole };
    let earlier = x.kept[index];
    if p.rest == 0.0 { earlier } else { earlier.after(p.rest) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a quartic is its own Taylor polynomial, so the delayed set-point is the polynomial at t − delay.
    #[test]
    fn a_fraction_of_a_period_is_exact_for_a_quartic() {
        let (period, start) = (1e-3, Setpoint { x: 0.0, v: 0.1, a: -2.0, j: 30.0, s: 400.0 });
        for delay in [0.0, 0.25e-3, 1e-3, 2.6e-3, 30e-3] {
            let (p, mut x) = (Params::new(delay, period).unwrap(), State::new(start));
            for k in 0..100 {
                let t = f64::from(k) * period;
                let found = step(&p, &mut x, start.after(t));
                if k >= 30 {
                    let exact = start.after(t - delay);
                    assert!((found.x - exact.x).abs() < 1e-14 && (found.v - exact.v).abs() < 1e-13, "{delay} {k}");
                }
            }
        }
    }

    /// Oracle: a straight line equals its linear interpolation.
    #[test]
    fn a_value_is_as_late_as_a_set_point() {
        let period = 1e-3;
        for delay in [0.0, 0.25e-3, 1e-3, 2.6e-3, 30e-3] {
            let (p, mut x) = (Params::new(delay, period).unwrap(), Values::new(0.0));
            for k in 0..100 {
                let t = f64::from(k) * period;
                let found = step_value(&p, &mut x, 7.0 + 3.0 * t);
                assert!(k < 31 || (found - (7.0 + 3.0 * (t - delay))).abs() < 1e-14, "{delay} {k}: {found}");
            }
        }
    }

    #[test]
    fn it_starts_at_rest_and_refuses_what_it_cannot_hold() {
        let p = Params::new(2.5e-3, 1e-3).unwrap();
        assert_eq!(step(&p, &mut State::new(Setpoint::at_rest(0.4)), Setpoint::at_rest(0.5)), Setpoint::at_rest(0.4));
        assert_eq!(Params::new(0.0, 1e-3).unwrap(), Params::default(), "no delay");
        // By the key of the scenario file, in the unit of the value.
        let said = Params::new(31e-3, 1e-3).unwrap_err().to_string();
        assert_eq!(said, "`delay of the reference` must be from 0 s to 30 periods of the position task, got 0.031");
        assert!(Params::new(-1e-6, 1e-3).is_err() && Params::new(f64::NAN, 1e-3).is_err());
    }
}
