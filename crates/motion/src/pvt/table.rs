//! The path through a table: cubic and linear segments.
use super::cursor::segment_at;
use super::{Cursor, Knot, Knotted, checked};
use crate::limits::RANGE;
use crate::{Piece, PlanError};
use servobench_base::Setpoint;

/// A move through any number of points that the caller keeps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Table<'a> {
    knots: &'a [Knot],
}

impl<'a> Table<'a> {
    /// The move through `knots`.
    ///
    /// # Errors
    /// [`PlanError`] for fewer than two points, and names the first one that is not finite or not later than the one
    /// before.
    pub fn new(knots: &'a [Knot]) -> Result<Self, PlanError> {
        checked(knots)?;
        Ok(Self { knots })
    }

    pub(crate) const fn solved(knots: &'a [Knot]) -> Self {
        Self { knots }
    }

    /// The set-point at `t` (s), found in log N steps. Before the first point it is that of the first point, also for
    /// NaN; from the last one on it continues at the velocity of that point, zero if it has none.
    ///
    /// For many in the order of time: [`cursor`](Self::cursor).
    #[must_use]
    pub fn at(&self, t: f64) -> Setpoint {
        self.piece(t).at(t)
    }

    /// The polynomial that [`at`](Self::at) evaluates at `t` (s).
    #[must_use]
    pub fn piece(&self, t: f64) -> Piece {
        self.piece_in(segment_at(self.knots, t), t)
    }

    /// Reads the move in the order of time.
    #[must_use]
    pub fn cursor(self) -> Cursor<Self> {
        Cursor::new(self)
    }

    /// Set-points every `sample_time` (s) from the first point on, the last one at or behind the last point; NaN and
    /// non-positive times give that of the first point only.
    pub fn samples(self, sample_time: f64) -> impl Iterator<Item = Setpoint> + 'a {
        let start = self.knots[0].t;
        let count = if sample_time > 0.0 { libm::ceil(self.duration() / sample_time * (1.0 - 1e-12)) } else { 0.0 };
        let mut cursor = self.cursor();
        // Counted as a float: the number of samples may exceed every integer, and the caller then takes some of them.
        (0..)
            .map(|k: u64| k as f64)
            .take_while(move |k| *k <= count)
            .map(move |k| cursor.at(if k == 0.0 { start } else { start + k * sample_time }))
    }

    /// Time from the first point to the last (s).
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.knots[self.knots.len() - 1].t - self.knots[0].t
    }

    /// The points.
    #[must_use]
    pub const fn knots(&self) -> &'a [Knot] {
        self.knots
    }

    /// The state at the beginning of segment `i`.
    pub(crate) fn segment(&self, i: usize) -> Setpoint {
        let (Knot { t, x, v }, next) = (self.knots[i], self.knots[i + 1]);
        let h = next.t - t;
        let slope = (next.x - x) / h;
        let Some(v_end) = next.v else {
            return Setpoint { x, v: slope, ..Setpoint::default() };
        };
        let v = v.unwrap_or_else(|| if i == 0 { 0.0 } else { self.slope(i - 1) });
        // 2·b2 and 6·b3, in differences of velocities: the positions cancel once only.
        let (a, j) = ((3.0 * slope - 2.0 * v - v_end) * 2.0 / h, (v + v_end - 2.0 * slope) * 6.0 / h / h);
        Setpoint { x, v, a, j, s: 0.0 }
    }

    /// Mean velocity in segment `i` (m/s or rad/s).
    fn slope(&self, i: usize) -> f64 {
        let (here, next) = (self.knots[i], self.knots[i + 1]);
        (next.x - here.x) / (next.t - here.t)
    }
}

impl Knotted for Table<'_> {
    fn knots(&self) -> &[Knot] {
        self.knots
    }

    fn piece_in(&self, segment: usize, _: f64) -> Piece {
        let Knot { t, x, v } = self.knots[segment];
        let Some(next) = self.knots.get(segment + 1) else {
            let end = Setpoint { x, v: v.unwrap_or(0.0), ..Setpoint::default() };
            return Piece::forward(end, t, RANGE.1, f64::INFINITY);
        };
        Piece::forward(self.segment(segment), t, next.t - t, next.t)
    }
}
