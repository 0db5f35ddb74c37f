//! Set-points at ascending times, without a search for each.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use crate::plan::Plan;
use servobench_base::{Setpoint, Stateful};
use servobench_motion::Piece;

/// The polynomials of a [`Plan`] valid at one time and for a while after it.
///
/// Nothing is allocated after the first look-up.
#[derive(Debug, Clone, Stateful)]
pub struct Reader {
    /// The polynomial of the first part, which has no delay: the only one unless the plan is shaped.
    first: Piece,
    /// Those of the delayed parts: amplitude, delay (s), polynomial.
    later: Vec<(f64, f64, Piece)>,
}

impl Default for Reader {
    fn default() -> Self {
        Self { first: Piece::at_rest(0.0), later: Vec::new() }
    }
}

impl Reader {
    /// Looks up the polynomials at `t` (s) of `plan`.
    pub fn look_up(&mut self, plan: &Plan, t: f64) {
        self.first = plan.course().piece(t);
        self.later.clear();
        self.later.extend(plan.parts().iter().skip(1).map(|part| {
            let since = t - part.time;
            let piece = if since < 0.0 {
                Piece::held(Setpoint::at_rest(plan.course().at(0.0).x), 0.0)
            } else {
                plan.course().piece(since)
            };
            (part.amplitude, part.time, piece)
        }));
    }

    /// True if it is still valid at `t` (s), a time not before that of the look-up.
    #[inline(always)]
    #[must_use]
    pub fn holds(&self, t: f64) -> bool {
        self.first.holds(t) && self.later.iter().all(|(_, delay, piece)| piece.holds(t - delay))
    }

    /// The set-point at `t` (s), a time at which it is valid.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, t: f64) -> Setpoint {
        let first = self.first.at(t);
        if self.later.is_empty() {
            return first;
        }
        // As numbers, so that a set-point without later parts stays in registers.
        let [x, v, a, j, s] = self.with_later(first, t);
        Setpoint { x, v, a, j, s }
    }

    /// The set-point with the delayed parts: position and its derivatives.
    fn with_later(&self, first: Setpoint, t: f64) -> [f64; 5] {
        // Differences from the first part: at rest all parts agree bit for bit.
        let Setpoint { x, v, a, j, s } = self.later.iter().fold(first, |sum, (part, delay, piece)| {
            let Setpoint { x, v, a, j, s } = piece.at(t - delay);
            Setpoint {
                x: sum.x + part * (x - first.x),
                v: sum.v + part * (v - first.v),
                a: sum.a + part * (a - first.a),
                j: sum.j + part * (j - first.j),
                s: sum.s + part * (s - first.s),
            }
        });
        [x, v, a, j, s]
    }

    /// Earliest end of validity of its polynomials (s).
    pub(crate) fn ends(&self) -> f64 {
        self.later.iter().map(|(_, delay, piece)| piece.ends() + delay).fold(self.first.ends(), f64::min)
    }
}

impl Plan {
    /// A reader after the look-up at `t` (s).
    pub(crate) fn reader_at(&self, t: f64) -> Reader {
        let mut reader = Reader::default();
        reader.look_up(self, t);
        reader
    }
}
