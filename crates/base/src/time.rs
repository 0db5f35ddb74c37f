//! Time is an integer: a run has one base rate in whole hertz and a tick counter, t = k/f.
//!
//! Every task's period is a whole number of base ticks. Seconds are computed from ticks, never accumulated.
use crate::state::Stateful;
use core::num::NonZeroU32;
use thiserror::Error;

/// Number of base ticks since the start of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Stateful)]
pub struct Tick(pub u64);

/// A rate in whole hertz, at least 1 Hz.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(transparent))]
pub struct Rate(NonZeroU32);

/// Number of base ticks in one period of a task, at least 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Divider(NonZeroU32);

/// Countdown to a task's next turn; the state that accompanies its [`Divider`]. The first turn is at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub struct Countdown {
    ticks_left: u32,
}

/// Reason why a rate or a time does not fit the grid of base ticks.
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
    /// A task runs at most once per base tick.
    #[error("{task} Hz is faster than the base rate {base} Hz")]
    TooFast {
        /// Rejected task rate (Hz).
        task: u32,
        /// Base rate (Hz).
        base: u32,
    },
}

/// Number of roundings in a time that [`Rate::tick_at`] tolerates, in units of its last place.
const ROUNDINGS: f64 = 8.0;

impl Rate {
    /// A rate of `hz` hertz; `None` for zero.
    #[must_use]
    pub const fn new(hz: u32) -> Option<Self> {
        match NonZeroU32::new(hz) {
            Some(hz) => Some(Self(hz)),
            None => None,
        }
    }

    /// The rate of a task that turns every `every` ticks of this one; rounded down to whole hertz.
    #[must_use]
    pub const fn of_task(self, every: Divider) -> Self {
        match NonZeroU32::new(self.0.get() / every.0.get()) {
            Some(hz) => Self(hz),
            None => Self(NonZeroU32::MIN),
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

    /// First tick at or after `seconds`; negative times count as tick 0. A time that is later than a tick only by rounding (by at most 1e-9
    /// of a tick, or by eight units in the last place of a long time) counts as that tick.
    #[must_use]
    pub fn tick_at(self, seconds: f64) -> Tick {
        let ticks = seconds * f64::from(self.0.get());
        let rounding = libm::fmax(1e-9, ROUNDINGS * f64::EPSILON * ticks);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, which is meant")]
        Tick(libm::ceil(ticks - rounding) as u64)
    }

    /// Number of ticks of this base rate in one period of `task`.
    ///
    /// # Errors
    /// [`RateError::TooFast`]; [`RateError::NotDividing`] with the nearest rates that fit.
    pub fn divider(self, task: Rate) -> Result<Divider, RateError> {
        let (base, wanted) = (self.hertz(), task.hertz());
        if wanted > base {
            return Err(RateError::TooFast { task: wanted, base });
        }
        if base.is_multiple_of(wanted) {
            return Ok(Divider(NonZeroU32::new(base / wanted).unwrap_or(NonZeroU32::MIN)));
        }
        let divides = |hz: &u32| base.is_multiple_of(*hz);
        let below = (1..wanted).rev().find(divides).unwrap_or(1);
        let above = (wanted..base).find(divides).unwrap_or(base);
        Err(RateError::NotDividing { task: wanted, base, below, above })
    }
}

impl Divider {
    /// A task that turns every `ticks` base ticks; `None` for zero.
    #[must_use]
    pub const fn new(ticks: u32) -> Option<Self> {
        match NonZeroU32::new(ticks) {
            Some(ticks) => Some(Self(ticks)),
            None => None,
        }
    }

    /// Base ticks per period.
    #[must_use]
    pub const fn ticks(self) -> u32 {
        self.0.get()
    }

    /// True if each turn of this task coincides with one of `faster`.
    #[must_use]
    pub const fn is_multiple_of(self, faster: Self) -> bool {
        self.0.get().is_multiple_of(faster.0.get())
    }
}

impl Countdown {
    /// Counts this tick; true if it is the task's turn. To be called once per tick with the task's own divider.
    #[inline]
    pub const fn is_due(&mut self, every: Divider) -> bool {
        let due = self.ticks_left == 0;
        self.ticks_left = if due { every.ticks() - 1 } else { self.ticks_left - 1 };
        due
    }

    /// Ticks since the last turn; 0 at the turn itself.
    #[inline]
    #[must_use]
    pub const fn since(self, every: Divider) -> u32 {
        every.ticks() - 1 - self.ticks_left
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
        let e = hz(16_000).divider(hz(32_000)).unwrap_err();
        assert_eq!(e.to_string(), "32000 Hz is faster than the base rate 16000 Hz");
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

    /// An hour at 16 kHz has 5.8e7 ticks: its rounding is 1e-8 of a tick, far below a hundredth of a tick.
    #[test]
    fn tick_at_forgives_no_more_after_an_hour() {
        let hour = 3600.0_f64;
        assert_eq!(hz(16_000).tick_at(hour.next_up().next_up()), Tick(16_000 * 3600));
        assert_eq!(hz(16_000).tick_at(hour + 0.01 / 16e3), Tick(16_000 * 3600 + 1));
    }

    /// Oracle: turns are at the multiples of the divider.
    #[test]
    fn a_countdown_is_due_at_every_multiple_of_its_divider() {
        for ticks in [1, 2, 5, 16] {
            let every = hz(16_000).divider(hz(16_000 / ticks)).unwrap();
            let mut countdown = Countdown::default();
            for k in 0..40 {
                assert_eq!(countdown.is_due(every), k % every.ticks() == 0, "tick {k} of every {every:?}");
                assert_eq!(countdown.since(every), k % every.ticks());
            }
        }
    }

    #[test]
    fn turns_coincide_when_one_period_holds_the_other_a_whole_number_of_times() {
        let every = |rate| hz(12_000).divider(hz(rate)).unwrap();
        assert!(every(2_000).is_multiple_of(every(6_000)) && every(2_000).is_multiple_of(every(2_000)));
        assert!(!every(4_000).is_multiple_of(every(6_000)) && !every(6_000).is_multiple_of(every(2_000)));
    }
}
