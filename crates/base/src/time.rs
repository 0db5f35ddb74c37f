//! Time is an integer: a run has one base rate in whole hertz and a tick counter, t = k/f.
//!
//! Every task's period is a whole number of base ticks. Seconds are computed from ticks, never accumulated.
use core::num::NonZeroU32;
use thiserror::Error;

/// Number of base ticks since the start of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Tick(pub u64);

/// A rate in whole hertz, at least 1 Hz.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Rate(NonZeroU32);

/// How many base ticks one period of a task lasts; at least 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Divider(NonZeroU32);

/// Why a rate or a time does not fit the grid of base ticks.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum RateError {
    /// A rate must be a whole number of hertz from 1 to 4 294 967 295.
    #[error("a rate must be a whole number of hertz from 1 to {}, got {value} Hz", u32::MAX)]
    NotWhole {
        /// Rejected rate (Hz).
        value: f64,
    },
    /// A task's period must be a whole number of base ticks.
    #[error("{task} Hz does not divide the base rate {base} Hz; {below} Hz and {above} Hz do")]
    NotDividing {
        /// Rejected task rate (Hz).
        task: u32,
        /// Base rate (Hz).
        base: u32,
        /// Nearest lower rate that divides the base rate (Hz).
        below: u32,
        /// Nearest higher rate that divides the base rate (Hz).
        above: u32,
    },
}

impl Rate {
    /// A rate of `hz` hertz; `None` for zero.
    #[must_use]
    pub const fn new(hz: u32) -> Option<Self> {
        match NonZeroU32::new(hz) {
            Some(hz) => Some(Self(hz)),
            None => None,
        }
    }

    /// A rate from a number of hertz that must be whole.
    ///
    /// # Errors
    /// [`RateError::NotWhole`] for fractions, zero, negative and non-finite values.
    pub fn from_hertz(value: f64) -> Result<Self, RateError> {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked by the comparison")]
        let whole = value as u32;
        #[expect(clippy::float_cmp, reason = "whole numbers of this size are exact in f64")]
        if f64::from(whole) == value { Self::new(whole) } else { None }.ok_or(RateError::NotWhole { value })
    }

    /// Hertz.
    #[must_use]
    pub const fn hertz(self) -> u32 {
        self.0.get()
    }

    /// Period (s).
    #[must_use]
    pub fn period(self) -> f64 {
        1.0 / f64::from(self.0.get())
    }

    /// Time of `tick` (s), correctly rounded as long as the counter is below 2⁵³.
    #[inline]
    #[must_use]
    pub fn time(self, tick: Tick) -> f64 {
        tick.0 as f64 / f64::from(self.0.get())
    }

    /// First tick at or after `seconds`; times within 1e-9 of a tick count as that tick, negative times as tick 0.
    #[must_use]
    pub fn tick_at(self, seconds: f64) -> Tick {
        let ticks = seconds * f64::from(self.0.get());
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, which is meant")]
        Tick(libm::ceil(ticks - 1e-9 * libm::fmax(1.0, libm::fabs(ticks))) as u64)
    }

    /// How many ticks of this base rate one period of `task` lasts.
    ///
    /// # Errors
    /// [`RateError::NotDividing`] names the nearest rates that fit.
    pub fn divider(self, task: Rate) -> Result<Divider, RateError> {
        let (base, wanted) = (self.hertz(), task.hertz());
        if wanted <= base && base.is_multiple_of(wanted) {
            return Ok(Divider(NonZeroU32::new(base / wanted).unwrap_or(NonZeroU32::MIN)));
        }
        let divides = |hz: &u32| base.is_multiple_of(*hz);
        let below = (1..=wanted.min(base)).rev().find(divides).unwrap_or(1);
        let above = (wanted.min(base)..=base).find(divides).unwrap_or(base);
        Err(RateError::NotDividing { task: wanted, base, below, above })
    }
}

impl Divider {
    /// Base ticks per period.
    #[must_use]
    pub const fn ticks(self) -> u32 {
        self.0.get()
    }

    /// Whether the task runs at `tick`.
    #[must_use]
    pub const fn is_due(self, tick: Tick) -> bool {
        tick.0.is_multiple_of(self.0.get() as u64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn hz(hz: u32) -> Rate {
        Rate::new(hz).unwrap()
    }

    #[test]
    fn twelve_kilohertz_is_exact_where_a_nanosecond_grid_is_not() {
        assert_eq!(hz(12_000).time(Tick(12_000 * 3600)).to_bits(), 3600.0_f64.to_bits());
        assert_eq!(hz(12_000).divider(hz(4_000)).unwrap().ticks(), 3);
    }

    #[test]
    fn a_task_that_does_not_fit_names_its_neighbours() {
        let e = hz(16_000).divider(hz(3_000)).unwrap_err();
        assert_eq!(e.to_string(), "3000 Hz does not divide the base rate 16000 Hz; 2000 Hz and 3200 Hz do");
        assert!(hz(16_000).divider(hz(32_000)).is_err());
    }

    #[test]
    fn only_whole_hertz() {
        assert_eq!(Rate::from_hertz(16e3), Ok(hz(16_000)));
        for bad in [0.0, -1.0, 0.5, f64::NAN, f64::INFINITY, 1e12] {
            assert!(Rate::from_hertz(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn tick_at_forgives_rounding_only() {
        assert_eq!(hz(1_000).tick_at(0.1 + 0.2), Tick(300));
        assert_eq!(hz(1_000).tick_at(0.300_1), Tick(301));
        assert_eq!(hz(1_000).tick_at(-1.0), Tick(0));
    }
}
