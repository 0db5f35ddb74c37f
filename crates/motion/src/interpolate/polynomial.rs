//! Polynomials of the fraction u of an interval.
use super::Sample;
use servobench_base::Stateful;

/// `c[0] + c[1]·u + … + c[5]·u⁵`.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(super) struct Polynomial([f64; 6]);

impl Polynomial {
    /// From `y0` to `y1`.
    pub(super) const fn linear(y0: f64, y1: f64) -> Self {
        Self([y0, y1 - y0, 0.0, 0.0, 0.0, 0.0])
    }

    /// From `y0` with slope `v0` to `y1` with slope `v1`, slopes by u.
    pub(super) const fn cubic([y0, y1]: [f64; 2], [v0, v1]: [f64; 2]) -> Self {
        let d = y1 - y0;
        Self([y0, v0, 3.0 * d - 2.0 * v0 - v1, v0 + v1 - 2.0 * d, 0.0, 0.0])
    }

    /// As [`cubic`](Self::cubic) with the second derivatives `a0` and `a1` by u.
    pub(super) const fn quintic([y0, y1]: [f64; 2], [v0, v1]: [f64; 2], [a0, a1]: [f64; 2]) -> Self {
        let d = y1 - y0;
        Self([
            y0,
            v0,
            0.5 * a0,
            10.0 * d - 6.0 * v0 - 4.0 * v1 - 0.5 * (3.0 * a0 - a1),
            -15.0 * d + 8.0 * v0 + 7.0 * v1 + 0.5 * (3.0 * a0 - 2.0 * a1),
            6.0 * d - 3.0 * (v0 + v1) - 0.5 * (a0 - a1),
        ])
    }

    /// The segment between the middle two of four control points. Differences to the point at u = 0, so that an axis
    /// far from zero rounds no more than its position must.
    pub(super) const fn cubic_b_spline(points: &[Sample; 4]) -> Self {
        let y0 = points[1].x;
        let [before, one, two] = [points[0].x - y0, points[2].x - y0, points[3].x - y0];
        Self([
            y0 + (before + one) / 6.0,
            0.5 * (one - before),
            0.5 * (one + before),
            (two - 3.0 * one - before) / 6.0,
            0.0,
            0.0,
        ])
    }

    /// The segment between the middle two of six control points.
    pub(super) const fn quintic_b_spline(points: &[Sample; 6]) -> Self {
        let y0 = points[2].x;
        let [m2, m1] = [points[0].x - y0, points[1].x - y0];
        let [p1, p2, p3] = [points[3].x - y0, points[4].x - y0, points[5].x - y0];
        Self([
            y0 + (26.0 * (m1 + p1) + m2 + p2) / 120.0,
            (10.0 * (p1 - m1) + p2 - m2) / 24.0,
            (2.0 * (m1 + p1) + m2 + p2) / 12.0,
            (2.0 * (m1 - p1) + p2 - m2) / 12.0,
            (m2 + p2 - 4.0 * (m1 + p1)) / 24.0,
            (p3 - m2 + 5.0 * (m1 - p2) + 10.0 * p1) / 120.0,
        ])
    }

    /// The derivative by time, the interval being `period` (s) long.
    pub(super) fn rate(&self, period: f64) -> Self {
        let [_, one, two, three, four, five] = self.0;
        Self([one, 2.0 * two, 3.0 * three, 4.0 * four, 5.0 * five, 0.0].map(|c| c / period))
    }

    #[inline]
    pub(super) fn at(&self, u: f64) -> f64 {
        self.0.iter().rev().fold(0.0, |sum, c| sum * u + c)
    }
}
