//! The box lengths of a plan, all orders and both grids in one loop; the derivation is in the crate documentation.

/// Admissible excess of a bound, relative: the rounding of one comparison. `Ts` itself, its fourth power, a product of
/// four counts and two quotients are some fifteen roundings of 2⁻⁵³ each.
const SLACK: f64 = 16.0 * f64::EPSILON;

/// A continuous dwell below this part of the box that holds it is rounding of the request, not a dwell.
const NO_DWELL: f64 = 1e-12;

/// Largest sample count: above it not every whole number is an `f64`.
pub(crate) const MAX_SAMPLES: f64 = 9_007_199_254_740_992.0;

/// What box lengths may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Grid {
    /// Any length.
    Continuous,
    /// Whole numbers; the unit of time is the sample.
    Whole,
}

/// Lengths of the `bounds.len() − 1` boxes of the shortest profile that the sequential method finds.
///
/// `bounds` runs from the limit of the highest derivative over those below it to the distance, all positive and in the
/// grid's unit of time. The boxes that an order does not have are zero. `None`: a move of more than [`MAX_SAMPLES`].
pub(crate) fn lengths(bounds: &[f64], grid: Grid) -> Option<[f64; 4]> {
    let n = bounds.len() - 1;
    let mut boxes = [0.0; 4];
    // The amplitude that makes the last chosen bound an equality, and ∏ and Σ of the boxes so far.
    let (mut amplitude, mut product, mut sum) = (bounds[0], 1.0, 0.0);
    for (k, slot) in boxes.iter_mut().enumerate().take(n) {
        let shortest = |level: usize| grid.shortest(level - k - 1, sum, bounds[level] / (amplitude * product));
        let equality = |level: usize, t: f64| bounds[level] / (product * growth(level - k - 1, sum, t));
        // First the distance, then every lower derivative whose limit the result would exceed.
        let mut length = shortest(n);
        let mut next = equality(n, length);
        for level in (k + 1..n).rev() {
            if next * product * growth(level - k - 1, sum, length) > bounds[level] * (1.0 + SLACK) {
                length = shortest(level);
                next = equality(level, length);
            }
        }
        *slot = length;
        amplitude = next;
        product *= length;
        sum += length;
        if grid == Grid::Whole && sum > MAX_SAMPLES {
            return None;
        }
    }
    Some(boxes)
}

/// How far the whole numbers of the fewest samples may lie from the lengths of the continuous profile: to the next whole
/// number, and this much farther. Brute force over far wider windows finds nothing shorter (`tests/plans/fewest.rs`).
const REACH: f64 = 2.0;

/// Whole lengths of the `bounds.len() − 1` boxes of the profile with the smallest sum; of several, the one with the lowest
/// amplitude. `bounds` and `None` as for [`lengths`].
///
/// With the distance X = amplitude·∏ n_k, a bound on the product of the first m boxes and the amplitude is one on the
/// product of the boxes behind them, for whatever n_1 … n_m:
///
/// ```text
/// X/V ≤ n_4,   X/A ≤ n_3·n_4,   X/J ≤ n_2·n_3·n_4,   X/D ≤ n_1·n_2·n_3·n_4        (order 4)
/// ```
///
/// All but the last box take every whole number near the continuous length; the last follows.
pub(crate) fn fewest(bounds: &[f64]) -> Option<[f64; 4]> {
    let near = lengths(bounds, Grid::Continuous)?;
    let mut search = Search { bounds, near, best: lengths(bounds, Grid::Whole)? };
    search.from(0, [0.0; 4], 0.0);
    Some(search.best)
}

/// The boxes that are tried, and the best of them.
struct Search<'a> {
    bounds: &'a [f64],
    near: [f64; 4],
    best: [f64; 4],
}

impl Search<'_> {
    /// Tries all lengths from box `k` on behind `boxes`, whose sum is `sum`.
    fn from(&mut self, k: usize, mut boxes: [f64; 4], sum: f64) {
        let last = self.bounds.len() - 2;
        let shortest = sum.max(1.0);
        if k == last {
            let mut product = 1.0;
            boxes[k] = shortest;
            for (m, bound) in self.bounds[..=last].iter().enumerate().rev() {
                if m < last {
                    product *= boxes[m];
                }
                let needed = self.bounds[last + 1] / (bound * product) * (1.0 - SLACK);
                boxes[k] = boxes[k].max(libm::ceil(needed));
            }
            if rank(&boxes) < rank(&self.best) {
                self.best = boxes;
            }
            return;
        }
        let lowest = (libm::floor(self.near[k]) - REACH).max(shortest);
        let highest = (libm::ceil(self.near[k]) + REACH).max(shortest);
        boxes[k] = lowest;
        while boxes[k] <= highest {
            self.from(k + 1, boxes, sum + boxes[k]);
            boxes[k] += 1.0;
        }
    }
}

/// Fewer samples are better, then a larger product, which is a lower amplitude.
fn rank(boxes: &[f64; 4]) -> (f64, f64) {
    let product: f64 = boxes.iter().filter(|length| **length > 0.0).product();
    (boxes.iter().sum(), -product)
}

/// Product of a box of length `t` and the `i` shortest boxes that may follow it, if those before it sum up to `c`:
/// 2^(i(i−1)/2)·t·(c + t)^i.
fn growth(i: usize, c: f64, t: f64) -> f64 {
    const DOUBLINGS: [f64; 4] = [1.0, 1.0, 2.0, 8.0];
    let mut product = DOUBLINGS[i] * t;
    for _ in 0..i {
        product *= c + t;
    }
    product
}

impl Grid {
    /// Smallest length, at least `c`, whose [`growth`] reaches `q`.
    fn shortest(self, i: usize, c: f64, q: f64) -> f64 {
        let t = root(i, c, q);
        match self {
            Self::Continuous if t <= c * (1.0 + NO_DWELL) => c,
            Self::Continuous => t,
            Self::Whole => smallest_whole(t, c, |n| growth(i, c, n) >= q * (1.0 - SLACK)),
        }
    }
}

/// Positive root of `growth(i, c, t) = q`; i = 3 occurs for the first box only, where c = 0.
fn root(i: usize, c: f64, q: f64) -> f64 {
    match i {
        0 => q,
        // Quadratic formula without cancellation.
        1 => 2.0 * q / (c + libm::sqrt(c * c + 4.0 * q)),
        2 => cubic(c, q / 2.0),
        _ => libm::sqrt(libm::sqrt(q / 8.0)),
    }
}

/// Positive root of `t(c + t)² = q`, by Newton from above: convex and increasing, so that the steps go down
/// monotonically until rounding stops them. Cardano's formula, (23) of the paper, cancels for t ≪ c.
fn cubic(c: f64, q: f64) -> f64 {
    let mut t = libm::cbrt(q).min(q / (c * c));
    loop {
        let s = c + t;
        let next = t - (t * s * s - q) / (s * (s + 2.0 * t));
        if next < t {
            t = next;
        } else {
            return t;
        }
    }
}

/// Smallest whole number from `at_least` on for which `holds`; `guess` is within a few roundings of it.
/// Stops at [`MAX_SAMPLES`].
fn smallest_whole(guess: f64, at_least: f64, holds: impl Fn(f64) -> bool) -> f64 {
    let mut n = libm::ceil(guess).max(at_least);
    while n > at_least && n <= MAX_SAMPLES && holds(n - 1.0) {
        n -= 1.0;
    }
    while n < MAX_SAMPLES && !holds(n) {
        n += 1.0;
    }
    n
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// 10^−20 … 10^20.
    fn decades() -> impl Strategy<Value = f64> {
        (-20.0..20.0_f64).prop_map(|exponent| 10.0_f64.powf(exponent))
    }

    proptest! {
        #[test]
        fn the_root_solves_its_equation(i in 0..4_usize, c in decades(), q in decades()) {
            let c = if i == 3 { 0.0 } else { c };
            let t = root(i, c, q);
            // The condition number of t(c + t)^i is at most 4; a handful of roundings.
            prop_assert!((growth(i, c, t) / q - 1.0).abs() < 1e-14, "t = {t:e}");
        }

        #[test]
        fn the_whole_number_is_the_smallest_that_reaches(i in 1..4_usize, c in 0..1_000_u32, n in 1..1_000_u32) {
            // Exact in f64: 8·1000·2000³ < 2⁵³.
            let c = if i == 3 { 0.0 } else { f64::from(c) };
            let n = f64::from(n) + c;
            let exactly = growth(i, c, n);
            prop_assert_eq!(Grid::Whole.shortest(i, c, exactly).to_bits(), n.to_bits());
            prop_assert_eq!(Grid::Whole.shortest(i, c, exactly + 0.5).to_bits(), (n + 1.0).to_bits());
        }
    }

    #[test]
    fn a_wrong_guess_is_corrected_both_ways() {
        for guess in [1.0, 6.3, 7.0, 7.1, 12.0] {
            assert_eq!(smallest_whole(guess, 2.0, |n| n * n >= 49.0).to_bits(), 7.0_f64.to_bits(), "{guess}");
        }
    }

    #[test]
    fn counting_stops_where_whole_numbers_end() {
        assert!(smallest_whole(MAX_SAMPLES - 9.0, 0.0, |_| false) >= MAX_SAMPLES);
        assert!(smallest_whole(f64::INFINITY, 0.0, |_| true) >= MAX_SAMPLES);
        // A distance of n at a velocity of one per sample takes n samples of cruise; the slack is 32 samples here.
        assert!(lengths(&[1.0, 1.0, MAX_SAMPLES - 64.0], Grid::Whole).is_some());
        assert_eq!(lengths(&[1.0, 1.0, MAX_SAMPLES + 64.0], Grid::Whole), None);
        assert_eq!(lengths(&[1e-150, 1.0, 1e30], Grid::Whole), None);
    }
}
