//! Instants of commands: once per cycle of a bus.
//!
//! A drive on a bus gets a command at the instants `first + k·period` and at no others. A table is moved to them in two steps. Its ends
//! are moved inwards to the nearest instants, along the velocities V_s and V_e that the axis has there:
//!
//! ```text
//! t_0' = the first instant not before t_0,   p_0' = p_0 + V_s·(t_0' − t_0)
//! t_N' = the last instant not after t_N,     p_N' = p_N − V_e·(t_N − t_N')
//! ```
//!
//! Then the commands are sent, and their ramps end, at instants: [`ClockedPlateaus`](super::ClockedPlateaus) still meets every
//! position, whatever its time between two instants, as long as there is an instant between one and the next.
use crate::PlanError;
use crate::limits::in_range;
use crate::pvt::{Knot, checked};
use servobench_base::{ParamError, Stateful, finite, positive};

/// The instants of commands.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Clock {
    first: f64,
    period: f64,
}

/// Share of a period within which a time counts as an instant.
const NEAR: f64 = 1e-6;
/// Longest table, in periods.
const LONGEST: f64 = 1e9;

impl Clock {
    /// A clock that ticks every `period` (s), once at `first` (s).
    ///
    /// # Errors
    /// [`PlanError`] for a period that is not positive or out of range, and a time that is not finite.
    pub fn new(first: f64, period: f64) -> Result<Self, PlanError> {
        let period = in_range("command_cycle", positive("command_cycle", period)?, "give seconds")?;
        Ok(Self { first: finite("first_command", first)?, period })
    }

    /// Time from one instant to the next (s).
    #[must_use]
    pub const fn period(&self) -> f64 {
        self.period
    }

    /// Number of the instant nearest to `t` (s).
    pub(super) fn nearest(&self, t: f64) -> f64 {
        libm::round(self.place(t))
    }

    /// The same clock, its instants counted from instant `k` on.
    pub(super) fn from(self, k: f64) -> Self {
        Self { first: self.time(k), ..self }
    }

    /// Instant `k` (s).
    pub(super) fn time(&self, k: f64) -> f64 {
        self.first + k * self.period
    }

    /// `t` (s) in periods from instant 0 on.
    pub(super) fn place(&self, t: f64) -> f64 {
        (t - self.first) / self.period
    }

    /// Moves the ends of `knots` inwards to instants; returns the clock from the first of them on, and the number of periods up to the
    /// last.
    pub(super) fn align(self, knots: &mut [Knot], start: f64, end: f64) -> Result<(Self, f64), PlanError> {
        checked(knots)?;
        let (first, last) = (knots[0], knots[knots.len() - 1]);
        let (from, to) = (behind(self.place(first.t)), before(self.place(last.t)));
        let cycles = to - from;
        if !(2.0..=LONGEST).contains(&cycles) {
            let bound = "so short that at least two and at most 1e9 of them fit into the table";
            return Err(ParamError { name: "command_cycle", value: self.period, bound }.into());
        }
        let moved =
            |knot: Knot, k: f64, v: f64| Knot { t: self.time(k), x: knot.x + v * (self.time(k) - knot.t), v: Some(v) };
        knots[0] = moved(first, from, start);
        knots[knots.len() - 1] = moved(last, to, end);
        Ok((Self { first: self.time(from), ..self }, cycles))
    }
}

/// The last whole number not behind `place`.
pub(super) fn before(place: f64) -> f64 {
    libm::floor(place + NEAR)
}

/// The first whole number not before `place`.
pub(super) fn behind(place: f64) -> f64 {
    libm::ceil(place - NEAR)
}

/// Moves the points between the ends that are kept to the front, behind the first, and the last one behind them; returns their
/// number.
pub(super) fn thin(knots: &mut [Knot], mut is_kept: impl FnMut(&Knot) -> bool) -> usize {
    let (last, mut count) = (knots.len() - 1, 1);
    for i in 1..last {
        if is_kept(&knots[i]) {
            knots[count] = knots[i];
            count += 1;
        }
    }
    knots[count] = knots[last];
    count + 1
}
