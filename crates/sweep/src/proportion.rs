//! Counted shares and their confidence bounds.
//!
//! Bounds are the exact ones of C. Clopper & E. Pearson, *The use of confidence or fiducial limits illustrated in the case of the
//! binomial*, Biometrika 26 (1934): the share at which the count, or a more extreme one, has a probability of 1 − confidence. Whatever
//! the share is, they are wrong at most that often.
use crate::binomial;

/// Counts of hits and misses in independent trials.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Proportion {
    hits: u64,
    misses: u64,
}

impl Proportion {
    /// A number of hits and a number of misses.
    #[must_use]
    pub const fn new(hits: u64, misses: u64) -> Self {
        Self { hits, misses }
    }

    /// Number of hits.
    #[must_use]
    pub const fn hits(self) -> u64 {
        self.hits
    }

    /// Number of trials.
    #[must_use]
    pub const fn trials(self) -> u64 {
        self.hits + self.misses
    }

    /// The share of hits, 0 to 1; NaN without trials.
    #[must_use]
    pub fn share(self) -> f64 {
        self.hits as f64 / self.trials() as f64
    }

    /// Lower bound of the true share with probability `confidence` (one-sided): 0.99701 for 1000 of 1000 at 95 %; 0 without hits.
    #[must_use]
    pub fn at_least(self, confidence: f64) -> f64 {
        if self.hits == 0 {
            return 0.0;
        }
        bisected(|p| binomial::at_least(self.hits, self.trials(), p) < 1.0 - confidence)
    }

    /// Upper bound of the true share with probability `confidence` (one-sided); 1 without misses.
    #[must_use]
    pub fn at_most(self, confidence: f64) -> f64 {
        if self.misses == 0 {
            return 1.0;
        }
        bisected(|p| binomial::at_most(self.hits, self.trials(), p) > 1.0 - confidence)
    }

    /// Bounds of the true share with probability `confidence`, half of the remainder on either side.
    #[must_use]
    pub fn interval(self, confidence: f64) -> [f64; 2] {
        let one_sided = 0.5 * (1.0 + confidence);
        [self.at_least(one_sided), self.at_most(one_sided)]
    }
}

/// The point between 0 and 1 up to which the condition holds, to the last digit.
fn bisected(holds: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    loop {
        let middle = f64::midpoint(low, high);
        if middle <= low || middle >= high {
            return middle;
        }
        if holds(middle) { low = middle } else { high = middle }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn of(hits: u64, trials: u64) -> Proportion {
        Proportion::new(hits, trials - hits)
    }

    /// Published to four digits: R. Newcombe, *Two-sided confidence intervals for the single proportion*, Statistics in Medicine 17 (1998),
    /// table I, method 5; and 10 of 100, from many tables.
    #[test]
    fn intervals_are_the_published_ones() {
        for (hits, trials, low, high) in [
            (81, 263, 0.2527, 0.3676),
            (15, 148, 0.0578, 0.1617),
            (0, 20, 0.0, 0.1684),
            (1, 29, 0.0009, 0.1776),
            (10, 100, 0.0490, 0.1762),
        ] {
            let [found_low, found_high] = of(hits, trials).interval(0.95);
            let is_near = |found: f64, published: f64| (found - published).abs() <= 0.5e-4;
            assert!(is_near(found_low, low) && is_near(found_high, high), "{hits}/{trials}: {found_low}, {found_high}");
        }
        assert!((of(1000, 1000).at_least(0.95) - 0.99701).abs() < 0.5e-5);
    }

    /// Oracle: the closed forms. All of n: the n-th root of α; none: 1 minus that. The rounding of 1 − 0.95 is 1e-15 of it.
    #[test]
    fn all_and_none_have_closed_forms() {
        for n in [1_u64, 2, 10, 1000, 123_456, 10_000_000] {
            for confidence in [0.5, 0.9, 0.95, 0.975, 0.999] {
                let logarithm = libm::log(1.0 - confidence) / n as f64;
                let (all, none) = (libm::exp(logarithm), -libm::expm1(logarithm));
                let (found_all, found_none) = (of(n, n).at_least(confidence), of(0, n).at_most(confidence));
                assert!((found_all - all).abs() <= 4.0 * f64::EPSILON, "{n} {confidence}: {found_all}, not {all}");
                assert!(
                    (found_none / none - 1.0).abs() < 8.0 * f64::EPSILON,
                    "{n} {confidence}: {found_none}, not {none}"
                );
                assert_eq!((of(n, n).at_most(confidence), of(0, n).at_least(confidence)), (1.0, 0.0));
            }
        }
    }

    /// Oracle: mpmath 1.4 with 50 digits, the tail as a sum and its root. A part in 1e13 is a thousand roundings; SciPy 1.17 has the
    /// upper bound of 3 to a part in 1e10.
    #[test]
    fn bounds_of_ten_million_trials_are_those_of_another_program() {
        for (hits, low, high) in [
            (5_000_000, 0.499_739_875_830_165_811_17, 1.0 - 0.499_739_875_830_165_811_17),
            (9_999_000, 0.999_894_639_970_175_221_62, 0.999_905_143_775_827_670_31),
            (3, 8.176_914_955_021_388_903_2e-8, 7.753_654_685_021_900_296_1e-7),
        ] {
            let (found_low, found_high) = (of(hits, 10_000_000).at_least(0.95), of(hits, 10_000_000).at_most(0.95));
            assert!((found_low / low - 1.0).abs() < 1e-13, "{hits}: {found_low}, not {low}");
            assert!((found_high / high - 1.0).abs() < 1e-13, "{hits}: {found_high}, not {high}");
        }
    }

    /// Oracle: the definition, a count at the bound has a tail of 1 − confidence.
    #[test]
    fn a_bound_leaves_what_it_says() {
        for (hits, trials) in [(1, 2), (7, 9), (50, 100), (999, 1000), (3, 100_000)] {
            let (low, high) = (of(hits, trials).at_least(0.95), of(hits, trials).at_most(0.95));
            // The tail changes by a part in 1e16 of the bound times its slope, which is below the number of trials.
            let tolerance = 4.0 * f64::EPSILON * trials as f64;
            assert!((binomial::at_least(hits, trials, low) - 0.05).abs() < tolerance);
            assert!((binomial::at_most(hits, trials, high) - 0.05).abs() < tolerance);
        }
    }

    #[test]
    fn of_nothing_nothing_is_known() {
        let nothing = Proportion::new(0, 0);
        assert!(nothing.share().is_nan());
        assert_eq!((nothing.interval(0.95), nothing.trials()), ([0.0, 1.0], 0));
    }
}
