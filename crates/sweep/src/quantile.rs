//! Statistics of a sample: estimates for its population.
//!
//! ```text
//! quantile of share p     between the values of rank ⌊h⌋ and ⌊h⌋ + 1 in order, h = (n + 1/3) p + 1/3       (1)
//! P(x₍r₎ ≤ quantile ≤ x₍s₎) = P(r ≤ B < s),   B hits of n, each with probability p                        (2)
//! ```
//! (1) is type 8 of R. Hyndman & Y. Fan, *Sample quantiles in statistical packages*, The American Statistician 50 (1996), which they
//! recommend: about as often too high as too low, whatever the distribution. (Type 7, the default of spreadsheets and NumPy, is
//! too near the middle in the tails, where a tolerance is of interest: for 20 values the 95 % quantile lies below the largest by
//! nearly the whole distance to the next.) NumPy calls it `method="median_unbiased"`.
//! (2) needs no assumption about the distribution: W. Conover, *Practical Nonparametric Statistics*, 3rd ed. 1999, section 3.2.
use crate::binomial;

/// Finite numbers of one quantity, at least one.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Ascending.
    sorted: Vec<f64>,
    mean: f64,
    deviation: f64,
}

impl Sample {
    /// The finite numbers among `values`; others were not measured and are left out. `None` if no number is left.
    #[must_use]
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        Self::sorted_of(values.into_iter().filter(|value| value.is_finite()).collect())
    }

    /// The same for times: infinity, for a state that is never reached, is later than all others and not left out. Mean and deviation are
    /// then not numbers.
    #[must_use]
    pub fn of_times(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let is_time = |value: &f64| value.is_finite() || *value == f64::INFINITY;
        Self::sorted_of(values.into_iter().filter(is_time).collect())
    }

    fn sorted_of(mut sorted: Vec<f64>) -> Option<Self> {
        sorted.sort_unstable_by(f64::total_cmp);
        let largest = sorted.first()?.abs().max(sorted.last()?.abs());
        // Relative to the largest, so that no sum or square overflows, and about the mean in a second pass.
        let scale = if largest > 0.0 { largest } else { 1.0 };
        let n = sorted.len() as f64;
        let mean = sorted.iter().map(|x| x / scale).sum::<f64>() / n;
        let squares: f64 = sorted.iter().map(|x| (x / scale - mean) * (x / scale - mean)).sum();
        let deviation = if sorted.len() > 1 { scale * (squares / (n - 1.0)).sqrt() } else { f64::NAN };
        Some(Self { sorted, mean: scale * mean, deviation })
    }

    /// Number of values.
    #[must_use]
    pub const fn count(&self) -> usize {
        self.sorted.len()
    }

    /// The values, ascending.
    #[must_use]
    pub fn sorted(&self) -> &[f64] {
        &self.sorted
    }

    /// Their mean.
    #[must_use]
    pub const fn mean(&self) -> f64 {
        self.mean
    }

    /// Standard deviation of the population, with n − 1; NaN for a single number.
    #[must_use]
    pub const fn deviation(&self) -> f64 {
        self.deviation
    }

    /// Standard error of the mean, for independent draws; NaN for a single number. With a Latin hypercube the error of the mean is
    /// smaller.
    #[must_use]
    pub fn standard_error(&self) -> f64 {
        self.deviation / (self.count() as f64).sqrt()
    }

    /// Quantile of `share`, 0 to 1, by the definition (1). Beyond the outermost ranks it is the smallest or the largest number.
    #[must_use]
    pub fn quantile(&self, share: f64) -> f64 {
        let n = self.count();
        let h = (n as f64 + 1.0 / 3.0) * share + 1.0 / 3.0;
        // Number of ranks that are not above h, at least one.
        let rank = partition(n, |below| (below + 1) as f64 <= h).max(1);
        let within = (h - rank as f64).clamp(0.0, 1.0);
        let (one, next) = (self.sorted[rank - 1], self.sorted[rank.min(n - 1)]);
        if next.is_infinite() {
            return if within > 0.0 { next } else { one };
        }
        (one * (1.0 - within) + next * within).clamp(one, next)
    }

    /// Confidence interval of a quantile of the population, with probability `confidence` or more, half of the remainder on either side:
    /// (2). A side with too few numbers is `None`: an upper bound of the 95 % quantile at 95 % takes 72 of them.
    #[must_use]
    pub fn interval(&self, share: f64, confidence: f64) -> [Option<f64>; 2] {
        let (n, tail) = (self.count(), 0.5 * (1.0 - confidence));
        let count = n as u64;
        // The largest rank that the quantile is below with a small enough probability; rank 0 is not a number.
        let lower = partition(n, |rank| binomial::at_most(rank as u64, count, share) <= tail);
        // The smallest rank that the quantile is above with a small enough probability.
        let upper = partition(n, |rank| binomial::at_least(rank as u64 + 1, count, share) > tail);
        [lower.checked_sub(1).and_then(|place| self.sorted.get(place)).copied(), self.sorted.get(upper).copied()]
    }
}

/// Number of values below `count` for which the condition holds; it holds for the first ones.
fn partition(count: usize, holds: impl Fn(usize) -> bool) -> usize {
    let (mut low, mut high) = (0, count);
    while low < high {
        let middle = low.midpoint(high);
        if holds(middle) { low = middle + 1 } else { high = middle }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The numbers from 1 to `n`.
    fn ranks(n: u32) -> Sample {
        Sample::of((1..=n).map(f64::from)).unwrap()
    }

    /// Oracle: NumPy 2, `quantile(range(1, 11), shares, method="median_unbiased")`.
    #[test]
    fn quantiles_are_those_of_type_8() {
        let expected = [1.0, 1.366_666_666_666_667, 2.916_666_666_666_667, 5.5, 8.083_333_333_333_334, 10.0, 10.0];
        for (share, expected) in [0.0, 0.1, 0.25, 0.5, 0.75, 0.95, 1.0].into_iter().zip(expected) {
            let found = ranks(10).quantile(share);
            // A rounding of h, which is below 16.
            assert!((found - expected).abs() < 1e-14, "{share}: {found}, not {expected}");
        }
        assert!([0.0, 0.3, 1.0].iter().all(|share| ranks(1).quantile(*share).to_bits() == 1_f64.to_bits()));
    }

    /// Oracle: by hand. The numbers 1 to n have the mean (n + 1)/2 and the variance n(n + 1)/12.
    #[test]
    fn moments_are_those_by_hand() {
        let sample = ranks(99);
        assert!((sample.mean() - 50.0).abs() < 1e-13 && (sample.deviation() - 825_f64.sqrt()).abs() < 1e-13);
        assert!((sample.standard_error() - (825.0 / 99.0_f64).sqrt()).abs() < 1e-14);
        // A small scatter about a large mean: √(2/3 · 3/2) nm about 1 m. The numbers themselves are rounded to 1e-16.
        let far = Sample::of([1.0 - 1e-9, 1.0, 1.0 + 1e-9]).unwrap();
        assert!((far.deviation() - 1e-9).abs() < 3e-16, "{}", far.deviation());
        // No square overflows.
        let huge = Sample::of([-1e300, 1e300]).unwrap();
        assert!((huge.deviation() / 1e300 - 2_f64.sqrt()).abs() < 1e-15 && huge.mean() == 0.0);
        assert!(ranks(1).deviation().is_nan() && ranks(1).standard_error().is_nan());
    }

    #[test]
    fn what_was_not_measured_is_left_out() {
        let sample = Sample::of([f64::NAN, 2.0, f64::INFINITY, 1.0]).unwrap();
        assert_eq!((sample.count(), sample.sorted()), (2, &[1.0, 2.0][..]));
        assert_eq!((Sample::of([f64::NAN]), Sample::of([])), (None, None));
    }

    /// Published: of ten numbers the second and the ninth enclose the median with 97.9 %, of twenty the sixth and the fifteenth with 95.9 %
    /// (Conover, table A3); 59 is the smallest number whose maximum is above the 95 % quantile with 95 % (S. Wilks, *Determination of
    /// sample sizes for setting tolerance limits*, Annals of Mathematical Statistics 12, 1941).
    #[test]
    fn intervals_are_the_published_ones() {
        assert_eq!(ranks(10).interval(0.5, 0.95), [Some(2.0), Some(9.0)]);
        assert_eq!(ranks(20).interval(0.5, 0.95), [Some(6.0), Some(15.0)]);
        assert_eq!(ranks(58).interval(0.95, 0.9)[1], None);
        assert_eq!(ranks(59).interval(0.95, 0.9)[1], Some(59.0));
        assert_eq!((ranks(71).interval(0.95, 0.95)[1], ranks(72).interval(0.95, 0.95)[1]), (None, Some(72.0)));
        assert_eq!(ranks(5).interval(0.5, 0.95), [None, None]);
        assert_eq!(ranks(59).interval(0.05, 0.9)[0], Some(1.0));
    }

    proptest! {
        /// Between the ends, and never decreasing.
        #[test]
        fn quantiles_ascend(values in prop::collection::vec(-1e300..1e300_f64, 1..60), one in 0.0..=1.0_f64, other in 0.0..=1.0_f64) {
            let sample = Sample::of(values.iter().copied()).unwrap();
            let (low, high) = (sample.quantile(one.min(other)), sample.quantile(one.max(other)));
            // Both may be between the same two numbers, and each is rounded.
            prop_assert!(low <= high + 4.0 * f64::EPSILON * high.abs().max(low.abs()));
            prop_assert!(sample.sorted().first().unwrap() <= &low && &high <= sample.sorted().last().unwrap());
            if let [Some(low), Some(high)] = sample.interval(one, 0.9) {
                prop_assert!(low <= sample.quantile(one) && sample.quantile(one) <= high);
            }
        }
    }
}
