//! Lengths of the moving averages of a plan, all orders in one loop; the derivation is in the crate documentation.
//!
//! On [`whole`] numbers every bound that is met lowers the amplitude. In [`continuous`] time it stays the limit D, and a
//! bound that binds is the peak from which the averages behind it continue:
//!
//! ```text
//! T1 = min(J/D, √(A/D), ∛(V/2D), ∜(X/8D))
//!   X binds:  T2 = T1,  T3 = 2·T1,  T4 = 4·T1
//!   V binds:  T2 = T1,  T3 = 2·T1,  T4 = X/V
//!   A binds:  T2 = T1,  T3 = least T of  T = V/A,  T(2·T1 + T) = X/A;  …
//!   J binds:  T2 = least T of  T = A/J,  T(T1 + T) = V/J,  2T(T1 + T)² = X/J;  …
//! ```

/// Relative excess of a bound that is accepted: the rounding of one comparison. `Ts` itself, its fourth power, a product of
/// four counts and two quotients are some fifteen roundings of 2⁻⁵³ each.
const SLACK: f64 = 16.0 * f64::EPSILON;

/// Share of an average's length below which a continuous dwell in it is rounding of the request.
const NO_DWELL: f64 = 1e-12;

/// Largest sample count: above it not every whole number is an `f64`.
pub(crate) const MAX_SAMPLES: f64 = 9_007_199_254_740_992.0;

/// Whole lengths of the `bounds.len() − 1` moving averages of the shortest profile that the sequential method finds.
///
/// `bounds` goes from the limit of the highest derivative over those below it to the distance, all positive and in the
/// time unit of the averages. The averages that an order lacks are zero. `None`: a move of more than [`MAX_SAMPLES`].
pub(crate) fn whole(bounds: &[f64]) -> Option<[f64; 4]> {
    let n = bounds.len() - 1;
    let mut boxes = [0.0; 4];
    // The amplitude that makes the last chosen bound an equality, and ∏ and Σ of the averages so far.
    let (mut amplitude, mut product, mut sum) = (bounds[0], 1.0, 0.0);
    for (k, slot) in boxes.iter_mut().enumerate().take(n) {
        let shortest = |level: usize| shortest_whole(level - k - 1, sum, bounds[level] / (amplitude * product));
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
        if sum > MAX_SAMPLES {
            return None;
        }
    }
    Some(boxes)
}

/// Lengths of any size; `bounds` as for [`whole`].
pub(crate) fn continuous(bounds: &[f64]) -> [f64; 4] {
    let n = bounds.len() - 1;
    // The next `following` averages are as short as their order permits.
    let (mut boxes, mut sum, mut following) = ([0.0; 4], 0.0, 0);
    for k in 0..n {
        if following > 0 {
            following -= 1;
            boxes[k] = sum;
        } else {
            let (i, length) = binding(sum, bounds[k], &bounds[k + 1..]);
            boxes[k] = if length <= sum * (1.0 + NO_DWELL) { sum } else { length };
            following = i;
        }
        sum += boxes[k];
    }
    boxes
}

/// Index of the one of `bounds` that binds the average behind those that sum up to `sum` and reach `peak`, and its permitted length.
///
/// Only the first one needs no root: for the others, the cubic last, one is computed if the length so far exceeds the bound.
fn binding(sum: f64, peak: f64, bounds: &[f64]) -> (usize, f64) {
    let (mut which, mut length) = (0, bounds[0] / peak);
    for i in [1, 3, 2] {
        if let Some(bound) = bounds.get(i)
            && peak * growth(i, sum, length) > *bound
        {
            (which, length) = (i, root(i, sum, bound / peak));
        }
    }
    (which, length)
}

/// Distance of the whole numbers of the fewest samples from the lengths of the continuous profile: up to the next whole
/// number, and this much farther. Brute force over far wider windows finds nothing shorter (`tests/plans/fewest.rs`).
const REACH: f64 = 2.0;

/// Whole lengths of the `bounds.len() − 1` moving averages of the profile with the smallest sum; among several, the one with the
/// lowest amplitude. `bounds` and `None` as for [`whole`].
///
/// With the distance X = amplitude·∏ n_k, a bound on the product of the first m averages and the amplitude is one on the
/// product of the averages behind them, for any n_1 … n_m:
///
/// ```text
/// X/V ≤ n_4,   X/A ≤ n_3·n_4,   X/J ≤ n_2·n_3·n_4,   X/D ≤ n_1·n_2·n_3·n_4        (order 4)
/// ```
///
/// All but the last average take every whole number near the continuous length; the last follows.
pub(crate) fn fewest(bounds: &[f64]) -> Option<[f64; 4]> {
    let near = continuous(bounds);
    let mut search = Search { bounds, near, best: whole(bounds)? };
    search.from(0, [0.0; 4], 0.0);
    Some(search.best)
}

/// Search for the best averages.
struct Search<'a> {
    bounds: &'a [f64],
    near: [f64; 4],
    best: [f64; 4],
}

impl Search<'_> {
    /// Tries all lengths from average `k` on behind `boxes`, whose sum is `sum`.
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

/// Product of an average of length `t` and the `i` shortest averages that may follow it, if those before it sum up to `c`:
/// 2^(i(i−1)/2)·t·(c + t)^i.
fn growth(i: usize, c: f64, t: f64) -> f64 {
    const DOUBLINGS: [f64; 4] = [1.0, 1.0, 2.0, 8.0];
    let mut product = DOUBLINGS[i] * t;
    for _ in 0..i {
        product *= c + t;
    }
    product
}

/// Smallest whole number, at least `c`, whose [`growth`] reaches `q`.
fn shortest_whole(i: usize, c: f64, q: f64) -> f64 {
    smallest_whole(root(i, c, q), c, |n| growth(i, c, n) >= q * (1.0 - SLACK))
}

/// Positive root of `growth(i, c, t) = q`; i = 3 occurs for the first average only, where c = 0.
fn root(i: usize, c: f64, q: f64) -> f64 {
    match i {
        0 => q,
        // Quadratic formula without cancellation.
        1 => 2.0 * q / (c + libm::sqrt(c * c + 4.0 * q)),
        2 => cubic(c, q / 2.0),
        _ => libm::sqrt(libm::sqrt(q / 8.0)),
    }
}

/// Positive root of `t(c + t)² = q`, by Halley's method: where the function rises its Schwarzian derivative is negative, so
/// that the steps lead from either side to the root and not past it. Cardano's formula, (23) of the paper, cancels for
/// t ≪ c.
fn cubic(c: f64, q: f64) -> f64 {
    /// Last step, relative to the root: it leaves the cube of itself, which is below rounding.
    const LAST: f64 = 1e-6;
    let mut t = near_cubic(c, q);
    loop {
        let s = c + t;
        let (off, slope) = (t * s * s - q, s * (s + 2.0 * t));
        let step = off * slope / (slope * slope - off * (s + s + t));
        t -= step;
        if step.abs() <= LAST * t {
            return t;
        }
    }
}

/// The root of [`cubic`] to a percent from t = c on, where [`continuous`] averages lie; below it a bound.
fn near_cubic(c: f64, q: f64) -> f64 {
    let inverse = near_inverse_cbrt(q);
    let part = c * inverse;
    if part < 1.0 {
        // Its series in c/∛q.
        q * inverse * inverse + c * (part * (1.0 / 9.0 + part * (2.0 / 81.0)) - 2.0 / 3.0)
    } else {
        q / (c * c)
    }
}

/// 1/∛q to 0.3 %: a third of the exponent, which leaves 3.5 %, and one step of Newton's method.
fn near_inverse_cbrt(q: f64) -> f64 {
    let inverse = f64::from_bits(0x553e_f0ff_289d_d796 - q.to_bits() / 3);
    inverse * (4.0 / 3.0 - q / 3.0 * inverse * inverse * inverse)
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
        fn the_start_is_near_the_root(ratio in 1.0..1e6_f64, c in decades()) {
            let t = ratio * c;
            prop_assert!((near_cubic(c, t * (c + t) * (c + t)) / t - 1.0).abs() < 0.01, "t = {t:e}");
        }

        #[test]
        fn the_whole_number_is_the_smallest_that_reaches(i in 1..4_usize, c in 0..1_000_u32, n in 1..1_000_u32) {
            // Exact in f64: 8·1000·2000³ < 2⁵³.
            let c = if i == 3 { 0.0 } else { f64::from(c) };
            let n = f64::from(n) + c;
            let exactly = growth(i, c, n);
            prop_assert_eq!(shortest_whole(i, c, exactly).to_bits(), n.to_bits());
            prop_assert_eq!(shortest_whole(i, c, exactly + 0.5).to_bits(), (n + 1.0).to_bits());
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
        assert!(whole(&[1.0, 1.0, MAX_SAMPLES - 64.0]).is_some());
        assert_eq!(whole(&[1.0, 1.0, MAX_SAMPLES + 64.0]), None);
        assert_eq!(whole(&[1e-150, 1.0, 1e30]), None);
    }
}
