//! Set-points in the order of time, without a search at each.
use crate::plan::Plan;
use servobench_base::Setpoint;
use servobench_motion::Piece;

/// What holds of a [`Plan`] at one time and for a while after it.
///
/// Nothing is allocated after the first look-up.
#[derive(Debug, Clone, Default)]
pub struct Reader {
    /// The polynomials whose weighted sum is the set-point: part, delay (s), polynomial.
    pieces: Vec<(f64, f64, Piece)>,
}

impl Reader {
    /// What holds at `t` (s) of `plan`.
    pub fn look_up(&mut self, plan: &Plan, t: f64) {
        self.pieces.clear();
        let pieces = plan.parts().iter().map(|part| {
            let since = t - part.time;
            let is_yet_to_come = part.time > 0.0 && since < 0.0;
            let piece = if is_yet_to_come {
                Piece::held(Setpoint::at_rest(plan.course().at(0.0).x), 0.0)
            } else {
                plan.course().piece(since)
            };
            (part.amplitude, part.time, piece)
        });
        self.pieces.extend(pieces);
    }

    /// Whether it still holds at `t` (s), a time not before that of the look-up.
    #[inline]
    #[must_use]
    pub fn holds(&self, t: f64) -> bool {
        self.pieces.iter().all(|(_, delay, piece)| piece.holds(t - delay))
    }

    /// The set-point at `t` (s), a time at which it holds.
    #[inline]
    #[must_use]
    pub fn at(&self, t: f64) -> Setpoint {
        let Some(((_, _, first), rest)) = self.pieces.split_first() else { return Setpoint::default() };
        let first = first.at(t);
        // Differences from the first part: at rest all are the same to the bit.
        rest.iter().fold(first, |sum, (part, delay, piece)| {
            let Setpoint { x, v, a, j, s } = piece.at(t - delay);
            Setpoint {
                x: sum.x + part * (x - first.x),
                v: sum.v + part * (v - first.v),
                a: sum.a + part * (a - first.a),
                j: sum.j + part * (j - first.j),
                s: sum.s + part * (s - first.s),
            }
        })
    }

    /// When the first of its polynomials ceases to hold (s).
    pub(crate) fn ends(&self) -> f64 {
        self.pieces.iter().map(|(_, delay, piece)| piece.ends() + delay).fold(f64::INFINITY, f64::min)
    }
}

impl Plan {
    /// A reader that has found what holds at `t` (s).
    pub(crate) fn reader_at(&self, t: f64) -> Reader {
        let mut reader = Reader { pieces: Vec::with_capacity(self.parts().len()) };
        reader.look_up(self, t);
        reader
    }
}
