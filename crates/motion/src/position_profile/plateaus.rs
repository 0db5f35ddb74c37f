//! Option 1: velocity piecewise linear, with a plateau in each segment.
use super::Command;
use super::share::{Demand, PlateauShare};
use crate::limits::RANGE;
use crate::pvt::{Cursor, Knot, Knotted, checked, scratch_for, set_ends};
use crate::{Piece, PlanError};
use servobench_base::Setpoint;

/// A position profile with plateaus of velocity; the velocities W of the points are stored in them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plateaus<'a> {
    knots: &'a [Knot],
    alpha: f64,
}

impl<'a> Plateaus<'a> {
    /// Solves for the velocities of `knots`, of which the first one is the position at the start, and writes them
    /// there.
    ///
    /// `start` and `end` are the velocities V_s and V_e (m/s or rad/s), `share` gives the share α of a segment at either end in which
    /// velocity changes. `scratch` holds a value for each point.
    ///
    /// # Errors
    /// [`PlanError`] for fewer than two points, names the first one that is not finite or not later than the one
    /// before, and an argument out of its range.
    pub fn solve(
        knots: &'a mut [Knot],
        start: f64,
        end: f64,
        share: impl Into<PlateauShare>,
        scratch: &mut [f64],
    ) -> Result<Self, PlanError> {
        let alpha = share.into().found(|alpha| {
            let profile = Plateaus::solve_at(knots, start, end, alpha, scratch)?;
            Ok(Demand::of(profile.commands(), start))
        })?;
        Self::solve_at(knots, start, end, alpha, scratch)
    }

    fn solve_at(
        knots: &'a mut [Knot],
        start: f64,
        end: f64,
        alpha: f64,
        scratch: &mut [f64],
    ) -> Result<Self, PlanError> {
        let scratch = scratch_for(scratch, knots.len())?;
        set_ends(knots, start, end)?;
        let last = knots.len() - 1;
        eliminate(knots, start, end, alpha, scratch);
        let mut behind = knots[last].v.unwrap_or(end);
        for i in (1..last).rev() {
            // The stored value is V_i before substitution; W_i replaces it as soon as V_i is known.
            let here = knots[i].v.unwrap_or(0.0) - scratch[i] * behind;
            let share = share(&knots[i - 1], &knots[i], &knots[i + 1]);
            knots[i].v = Some(share * behind + (1.0 - share) * here);
            behind = here;
        }
        knots[last].v = Some(end);
        checked(knots)?;
        Ok(Self { knots, alpha })
    }

    /// The profile of `knots` in which an earlier [`solve`](Self::solve) with this `alpha` has left its velocities, if
    /// its result cannot be kept; nothing is checked again.
    #[must_use]
    pub const fn solved(knots: &'a [Knot], alpha: f64) -> Self {
        Self { knots, alpha }
    }

    /// The set-point at `t` (s), found in log N steps. Before the first point it is that of the first point, also for
    /// NaN; from the last one on it continues at V_e.
    #[must_use]
    pub fn at(&self, t: f64) -> Setpoint {
        self.piece(t).at(t)
    }

    /// The polynomial that [`at`](Self::at) evaluates at `t` (s).
    #[must_use]
    pub fn piece(&self, t: f64) -> Piece {
        let segment = self.knots.partition_point(|knot| knot.t <= t).saturating_sub(1);
        self.piece_in(segment, t)
    }

    /// Reads the set-points in the order of time.
    #[must_use]
    pub fn cursor(self) -> Cursor<Self> {
        Cursor::new(self)
    }

    /// The share α of a segment at either end in which velocity changes.
    #[must_use]
    pub const fn share(&self) -> f64 {
        self.alpha
    }

    /// The N + 1 commands: one at the start, one at the end of each plateau.
    #[must_use]
    pub fn commands(self) -> PlateauCommands<'a> {
        PlateauCommands { way: self, next: 0 }
    }

    /// The points with the velocities W at which they are passed.
    #[must_use]
    pub const fn knots(&self) -> &'a [Knot] {
        self.knots
    }

    /// The velocity V of the plateau in segment `i` (m/s or rad/s), the one from point i to point i + 1; `None`
    /// behind the last.
    #[must_use]
    pub fn plateau(&self, i: usize) -> Option<f64> {
        let (here, next) = (self.knots.get(i)?, self.knots.get(i + 1)?);
        let slope = (next.x - here.x) / (next.t - here.t);
        // 2·slope = α·W0 + (2 − 2α)·V + α·W1
        Some((slope - self.alpha * (here.v? + next.v?) / 2.0) / (1.0 - self.alpha))
    }

    fn command(&self, k: usize) -> Option<Command> {
        let point = self.knots.get(k)?;
        let ramp = |i: usize| self.alpha * (self.knots[i + 1].t - self.knots[i].t);
        let (from, to) = (k.checked_sub(1).and_then(|i| self.plateau(i)), self.plateau(k));
        let velocity = to.or(point.v)?;
        let before = from.or(point.v)?;
        let (left, right) = (from.map_or(0.0, |_| ramp(k - 1)), to.map_or(0.0, |_| ramp(k)));
        Some(Command { t: point.t - left, velocity, acceleration: (velocity - before).abs() / (left + right) })
    }
}

/// The share dT_i/(dT_i + dT_(i+1)) of the segment before a point in the time of both neighbours.
fn share(before: &Knot, here: &Knot, behind: &Knot) -> f64 {
    (here.t - before.t) / (behind.t - before.t)
}

/// First sweep: V_i + scratch(i)·V_(i+1) = the stored value of point i, for the segments i = 1 … N, each in the point at
/// its end. With α ≤ 1/2 the coefficients beside the pivot sum up to less than it.
fn eliminate(knots: &mut [Knot], start: f64, end: f64, alpha: f64, scratch: &mut [f64]) {
    let last = knots.len() - 1;
    let (mut above, mut known, mut share_before) = (0.0, 0.0, None);
    for i in 1..=last {
        let (before, here) = (knots[i - 1], knots[i]);
        let mut row = 2.0 * ((here.x - before.x) / (here.t - before.t));
        let mut pivot = 2.0 - 2.0 * alpha;
        // The velocity at the beginning: V_s, or share·V_i + (1 − share)·V_(i−1).
        match share_before {
            None => row -= alpha * start,
            Some(share) => {
                let beside = alpha * (1.0 - share);
                pivot += alpha * share - beside * above;
                row -= beside * known;
            }
        }
        // The velocity at the end: V_e, or share·V_(i+1) + (1 − share)·V_i.
        let mut beside = 0.0;
        if let Some(behind) = knots.get(i + 1) {
            let share = share(&before, &here, behind);
            beside = alpha * share;
            pivot += alpha * (1.0 - share);
            share_before = Some(share);
        } else {
            row -= alpha * end;
        }
        (above, known) = (beside / pivot, row / pivot);
        (scratch[i], knots[i].v) = (above, Some(known));
    }
}

impl Knotted for Plateaus<'_> {
    fn knots(&self) -> &[Knot] {
        self.knots
    }

    fn piece_in(&self, segment: usize, t: f64) -> Piece {
        let here = self.knots[segment];
        let (w0, moving) = (here.v.unwrap_or(0.0), |x, v, a| Setpoint { x, v, a, ..Setpoint::default() });
        let (Some(next), Some(v)) = (self.knots.get(segment + 1), self.plateau(segment)) else {
            return Piece::forward(moving(here.x, w0, 0.0), here.t, RANGE.1, f64::INFINITY);
        };
        let (w1, ramp) = (next.v.unwrap_or(0.0), self.alpha * (next.t - here.t));
        let (rise, fall) = (here.t + ramp, next.t - ramp);
        // From the end backwards in the last part, so that the point at its end is met without the rounding before.
        let x_fall = next.x - ramp * (v + w1) / 2.0;
        if t >= fall {
            Piece::forward(moving(x_fall, v, (w1 - v) / ramp), fall, ramp, next.t)
        } else if t >= rise {
            Piece::forward(moving(x_fall - v * (fall - rise), v, 0.0), rise, fall - rise, fall)
        } else {
            Piece::forward(moving(here.x, w0, (v - w0) / ramp), here.t, ramp, if rise < fall { rise } else { fall })
        }
    }
}

/// The commands of [`Plateaus`], in the order of time.
#[derive(Debug, Clone)]
pub struct PlateauCommands<'a> {
    way: Plateaus<'a>,
    next: usize,
}

impl Iterator for PlateauCommands<'_> {
    type Item = Command;

    fn next(&mut self) -> Option<Command> {
        let command = self.way.command(self.next)?;
        self.next += 1;
        Some(command)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.way.knots.len() - self.next;
        (left, Some(left))
    }
}

impl ExactSizeIterator for PlateauCommands<'_> {}
