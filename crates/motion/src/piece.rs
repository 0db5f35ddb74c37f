//! One polynomial of a profile.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use servobench_base::{Setpoint, Stateful};

/// Polynomial at one time of a [`Profile`](crate::Profile) and for a while after it.
///
/// To read set-points in the order of time, keep a piece as long as it [`holds`](Self::holds), instead of looking it
/// up at each instant by [`Profile::at`](crate::Profile::at); the set-points are the same bit for bit.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Piece {
    pub(crate) anchor: Setpoint,
    /// Anchor of the polynomial and its duration (s from `origin`, in the direction of `sign`).
    pub(crate) start: f64,
    pub(crate) length: f64,
    /// 0 and 1, or the end of the move and −1: x(t) = `base` + `sign`·polynomial(`sign`·(t − `origin`)).
    pub(crate) origin: f64,
    pub(crate) sign: f64,
    pub(crate) base: f64,
    /// Distance within which a switching instant counts as reached (s).
    pub(crate) tolerance: f64,
    /// The next switching instant (s from `origin`).
    pub(crate) until: f64,
}

impl Piece {
    /// At rest at `x`, for ever.
    #[must_use]
    pub const fn at_rest(x: f64) -> Self {
        Self {
            anchor: Setpoint::at_rest(x),
            start: 0.0,
            length: 0.0,
            origin: 0.0,
            sign: 1.0,
            base: 0.0,
            tolerance: 0.0,
            until: f64::INFINITY,
        }
    }

    /// From `anchor` at `start` (s) on until `until` (s), with the snap of `anchor`.
    #[must_use]
    pub const fn between(anchor: Setpoint, start: f64, until: f64) -> Self {
        Self::forward(anchor, start, until - start, until)
    }

    /// `setpoint`, unchanged until `until` (s), although its velocity is not zero: a set-point held between two samples.
    #[must_use]
    pub const fn held(setpoint: Setpoint, until: f64) -> Self {
        Self::forward(setpoint, 0.0, 0.0, until)
    }

    /// The same with `tolerance` (s): a switching instant nearer than that counts as reached.
    #[must_use]
    pub const fn within(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    /// The same, executed `factor` times as slowly.
    #[must_use]
    pub fn slowed(&self, factor: f64) -> Self {
        let [start, length, origin] = [self.start, self.length, self.origin].map(|time| time * factor);
        let [tolerance, until] = [self.tolerance, self.until].map(|time| time * factor);
        Self { anchor: self.anchor.at_pace(1.0 / factor), start, length, origin, tolerance, until, ..*self }
    }

    /// The same relative to the time `time` (s) and the position `x`.
    #[must_use]
    pub fn seen_from(&self, time: f64, x: f64) -> Self {
        Self { origin: self.origin - time, base: self.base - x, ..*self }
    }

    /// From `anchor` at `start` (s) for `length` (s), until `until` (s).
    pub(crate) const fn forward(anchor: Setpoint, start: f64, length: f64, until: f64) -> Self {
        Self { anchor, start, length, origin: 0.0, sign: 1.0, base: 0.0, tolerance: 0.0, until }
    }

    /// True if it still applies at `t` (s), a time not before the one for which it was looked up.
    #[inline(always)]
    #[must_use]
    pub fn holds(&self, t: f64) -> bool {
        t + self.tolerance - self.origin < self.until
    }

    /// The end of its validity (s); infinite for the last one.
    #[must_use]
    pub fn ends(&self) -> f64 {
        self.origin + self.until
    }

    /// The set-point at `t` (s), a time at which it applies.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, t: f64) -> Setpoint {
        let since = self.sign * (t - self.origin) - self.start;
        let state = self.anchor.after(since.max(0.0).min(self.length));
        // The sum turns negative zeros into positive ones.
        Setpoint {
            x: self.base + self.sign * state.x,
            a: 0.0 + self.sign * state.a,
            s: 0.0 + self.sign * state.s,
            ..state
        }
    }
}
