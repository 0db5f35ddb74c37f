//! Set-points in the order of time, without a search at each.
use super::Knot;
use crate::Piece;
use servobench_base::Setpoint;

/// A path with its own polynomials between the points of a table.
pub trait Knotted {
    /// The points, two at least, in the order of time.
    fn knots(&self) -> &[Knot];

    /// The polynomial at `t` (s), a time between the points `segment` and `segment + 1`; behind the last
    /// point `segment` is its number.
    ///
    /// # Panics
    /// If there is no such point.
    fn piece_in(&self, segment: usize, t: f64) -> Piece;
}

/// The number of the last point at or before `t` (s); 0 before the first one and for NaN.
pub(super) fn segment_at(knots: &[Knot], t: f64) -> usize {
    knots.partition_point(|knot| knot.t <= t).saturating_sub(1)
}

/// Reads a path at one time after another.
///
/// As long as times increase, it only steps from one point to the next, so that a whole table of N points and M
/// samples takes N + M steps; a time before the last one causes a new search for the point, in log N steps. The
/// set-points are bit for bit those of the path itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cursor<W> {
    way: W,
    segment: usize,
    piece: Piece,
    /// Time for which the piece was looked up, from which on it is known to apply (s).
    from: f64,
}

impl<W: Knotted> Cursor<W> {
    /// At the first point of `way`.
    #[must_use]
    pub fn new(way: W) -> Self {
        let from = way.knots()[0].t;
        let piece = way.piece_in(0, from);
        Self { way, segment: 0, piece, from }
    }

    /// The set-point at `t` (s).
    #[inline]
    pub fn at(&mut self, t: f64) -> Setpoint {
        self.piece(t).at(t)
    }

    /// The polynomial at `t` (s).
    #[inline]
    pub fn piece(&mut self, t: f64) -> Piece {
        if !(t >= self.from && self.piece.holds(t)) {
            self.look_up(t);
        }
        self.piece
    }

    fn look_up(&mut self, t: f64) {
        let knots = self.way.knots();
        if t >= self.from {
            while knots.get(self.segment + 1).is_some_and(|next| next.t <= t) {
                self.segment += 1;
            }
        } else {
            self.segment = segment_at(knots, t);
        }
        self.piece = self.way.piece_in(self.segment, t);
        self.from = t;
    }

    /// The path.
    pub const fn way(&self) -> &W {
        &self.way
    }
}
