//! A trajectory whose highest derivative is piecewise constant.
use crate::online::Stretch;
use crate::{Order, Piece, Segment};
use servobench_base::{Setpoint, Stateful};

/// Up to `N` segments from a first state on, in the axis unit (m or rad) and seconds from the start.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Trajectory<const N: usize> {
    order: Order,
    /// Starts of the segments (s): sums of the lengths, needed at once by the search for a set-point.
    starts: [f64; N],
    /// Lengths of the segments (s). Differences of their starts would differ: a second that begins after a day is known to
    /// 1e-11 s only.
    lengths: [f64; N],
    /// Their states at the start, with the highest derivative until the next.
    anchors: [Setpoint; N],
    count: usize,
    duration: f64,
    /// The state at the end, which continues at its velocity.
    end: Setpoint,
}

impl<const N: usize> Trajectory<N> {
    /// From `from`, through `stretches`, without those of zero length; `arrive` gives the state at the end from the one that they reach,
    /// so that no rounding of theirs remains.
    ///
    /// More than `N` segments are a bug in the caller.
    pub(crate) fn new(
        order: Order,
        from: Setpoint,
        stretches: impl IntoIterator<Item = Stretch>,
        arrive: impl FnOnce(Setpoint) -> Setpoint,
    ) -> Self {
        // Counted beside the stored fields: read back from there, the processor would wait for all of them to be written.
        let (mut state, mut count, mut duration) = (from, 0, 0.0);
        let mut way = Self {
            order,
            starts: [0.0; N],
            lengths: [0.0; N],
            anchors: [Setpoint::default(); N],
            count: 0,
            duration: 0.0,
            end: from,
        };
        for Stretch { value, length, zeros } in stretches.into_iter().filter(|stretch| stretch.length > 0.0) {
            let Setpoint { x, v, .. } = state;
            state = match order.derivative() - usize::from(zeros) {
                4 => Setpoint { s: value, ..state },
                3 => Setpoint { j: value, s: 0.0, ..state },
                2 => Setpoint { v, a: value, ..Setpoint::at_rest(x) },
                _ => Setpoint { v: value, ..Setpoint::at_rest(x) },
            };
            way.starts[count] = duration;
            way.lengths[count] = length;
            way.anchors[count] = state;
            count += 1;
            state = state.after(length);
            duration += length;
        }
        (way.count, way.duration, way.end) = (count, duration, arrive(state));
        way
    }

    /// The set-point `t` seconds after the start; before it the first one, from the end on at the velocity of the end. NaN
    /// counts as before the start.
    #[must_use]
    #[inline]
    pub fn at(&self, t: f64) -> Setpoint {
        self.piece(t).at(t)
    }

    /// The polynomial that [`at`](Self::at) evaluates at `t` (s).
    #[must_use]
    pub fn piece(&self, t: f64) -> Piece {
        if t >= self.duration || self.count == 0 {
            return Piece::forward(self.end, self.duration, f64::MAX, f64::INFINITY);
        }
        let i = self.starts[1..self.count].iter().take_while(|start| **start <= t).count();
        Piece::forward(self.anchors[i], self.starts[i], self.lengths[i], self.end_of(i))
    }

    /// End of segment `i` (s).
    fn end_of(&self, i: usize) -> f64 {
        if i + 1 < self.count { self.starts[i + 1] } else { self.duration }
    }

    /// Duration (s).
    #[must_use]
    pub const fn duration(&self) -> f64 {
        self.duration
    }

    /// The state at the end.
    #[must_use]
    pub const fn end(&self) -> Setpoint {
        self.end
    }

    /// Order: the derivative of position that is piecewise constant.
    #[must_use]
    pub const fn order(&self) -> Order {
        self.order
    }

    /// The segments with their highest derivative.
    #[must_use]
    pub fn segments(&self) -> impl ExactSizeIterator<Item = Segment> + '_ {
        (0..self.count).map(move |i| {
            let anchor = self.anchors[i];
            let value = match self.order {
                Order::Second => anchor.a,
                Order::Third => anchor.j,
                Order::Fourth => anchor.s,
            };
            Segment { start: self.starts[i], length: self.lengths[i], value }
        })
    }

    /// The states at the starts of the segments, with their highest derivatives, and their lengths (s).
    pub(crate) fn pieces(&self) -> impl Iterator<Item = (Setpoint, f64)> + '_ {
        self.anchors[..self.count].iter().copied().zip(self.lengths[..self.count].iter().copied())
    }

    /// Appends `next`, which begins where this one ends.
    ///
    /// More than `N` segments of both are a bug in the caller.
    pub(crate) fn then(mut self, next: &Self) -> Self {
        let mut start = self.duration;
        for i in 0..next.count {
            self.starts[self.count] = start;
            self.lengths[self.count] = next.lengths[i];
            self.anchors[self.count] = next.anchors[i];
            self.count += 1;
            start += next.lengths[i];
        }
        self.duration += next.duration;
        self.end = next.end;
        self
    }

    /// True if the velocity never leaves the side of `sign`, except by rounding.
    pub(crate) fn keeps_direction(&self, sign: f64) -> bool {
        /// Relative to the highest velocity.
        const ROUNDING: f64 = 1e-11;
        let (mut lowest, mut highest) = (0.0_f64, 0.0_f64);
        for (i, anchor) in self.anchors[..self.count].iter().enumerate() {
            let length = self.lengths[i];
            // a + j·t + s·t²/2 = 0 without cancellation.
            let root = libm::sqrt((anchor.j * anchor.j - 2.0 * anchor.s * anchor.a).max(0.0));
            let sum = -anchor.j - root.copysign(anchor.j);
            let turns = [sum / anchor.s, 2.0 * anchor.a / sum].into_iter().filter(|t| *t > 0.0 && *t < length);
            for t in turns.chain([0.0, length]) {
                let v = sign * anchor.after(t).v;
                (lowest, highest) = (lowest.min(v), highest.max(v));
            }
        }
        lowest >= -ROUNDING * highest
    }
}
