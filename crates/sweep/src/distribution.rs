//! Distribution of a value over machines.
use core::f64::consts::{PI, SQRT_2};

/// Largest deviation of a draw in standard deviations: the smallest share, half of 2⁻⁵², lies within.
const FURTHEST: f64 = 40.0;

/// Distribution of a value over machines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Distribution {
    /// Uniform between two values.
    Uniform {
        /// The smallest.
        low: f64,
        /// The largest.
        high: f64,
    },
    /// Uniform over the whole numbers from one to another: seeds.
    Whole {
        /// The smallest.
        low: f64,
        /// The largest.
        high: f64,
    },
    /// Normal (Gaussian).
    Normal {
        /// Mean.
        mean: f64,
        /// Standard deviation.
        sigma: f64,
    },
    /// Triangular: most likely at its mode, linearly less towards both ends.
    Triangular {
        /// The smallest.
        low: f64,
        /// The most likely.
        mode: f64,
        /// The largest.
        high: f64,
    },
}

impl Distribution {
    /// Reason why it is not a valid distribution; `None` if it is.
    #[must_use]
    pub fn objection(&self) -> Option<String> {
        let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
        match *self {
            Self::Uniform { low, high } if !(finite(&[low, high]) && low <= high) => {
                Some(format!("a uniform distribution goes from a lower to a higher value, not from {low} to {high}"))
            }
            Self::Whole { low, high } if !(is_whole(low) && is_whole(high) && low <= high) => {
                Some(format!("whole numbers go from a lower to a higher whole number, not from {low} to {high}"))
            }
            Self::Normal { mean, sigma } if !(finite(&[mean.abs() + FURTHEST * sigma]) && sigma >= 0.0) => {
                Some(format!("the standard deviation {sigma} about {mean} must be finite and not negative"))
            }
            Self::Triangular { low, mode, high } if !(finite(&[high - low, mode]) && low <= mode && mode <= high) => {
                Some(format!(
                    "a triangular distribution has its most likely value between its ends, not {mode} between {low} and {high}"
                ))
            }
            Self::Uniform { .. } | Self::Whole { .. } | Self::Normal { .. } | Self::Triangular { .. } => None,
        }
    }

    /// The quantile of the share `share`, 0 < share < 1.
    #[must_use]
    pub fn quantile(&self, share: f64) -> f64 {
        match *self {
            Self::Uniform { low, high } => low * (1.0 - share) + high * share,
            Self::Whole { low, high } => (low + libm::floor(share * (high - low + 1.0))).min(high),
            Self::Normal { mean, sigma } => mean + sigma * standard_quantile(share),
            Self::Triangular { low, mode, high } => {
                let (rise, fall, width) = (mode - low, high - mode, high - low);
                if share * width < rise {
                    low + (share * width).sqrt() * rise.sqrt()
                } else {
                    high - ((1.0 - share) * width).sqrt() * fall.sqrt()
                }
            }
        }
    }
}

/// Largest magnitude in a distribution of whole numbers: 2⁵², above which halves, and so shares of one, are rounded away.
const LARGEST_WHOLE: f64 = 4_503_599_627_370_496.0;

fn is_whole(value: f64) -> bool {
    value.abs() <= LARGEST_WHOLE && libm::floor(value).to_bits() == value.to_bits()
}

/// The quantile of the normal distribution with mean 0 and standard deviation 1: a rational approximation, accurate to 4.5e-4, refined
/// by Halley's method on the complementary error function, which triples its digits twice.
///
/// Source: Abramowitz & Stegun, *Handbook of Mathematical Functions*, 26.2.23.
fn standard_quantile(share: f64) -> f64 {
    // In the nearer tail, so that small shares keep their digits.
    let tail = share.min(1.0 - share);
    let t = (-2.0 * libm::log(tail)).sqrt();
    let numerator = 2.515_517 + t * (0.802_853 + t * 0.010_328);
    let denominator = 1.0 + t * (1.432_788 + t * (0.189_269 + t * 0.001_308));
    let mut x = t - numerator / denominator;
    for _ in 0..2 {
        // Share above x minus the wanted share, divided by the density.
        let off = (0.5 * libm::erfc(x / SQRT_2) - tail) * (2.0 * PI).sqrt() * libm::exp(x * x / 2.0);
        x += off / (1.0 - x * off / 2.0);
    }
    if share < 0.5 { -x } else { x }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the share below the quantile, by the error function.
    #[test]
    fn a_quantile_of_gauss_has_its_share_below() {
        for exponent in 1..300 {
            let tail = 10_f64.powi(-exponent) * 4.9;
            for share in [tail, 0.5 * tail] {
                let x = standard_quantile(share);
                let found = 0.5 * libm::erfc(-x / SQRT_2);
                // The rounding of x counts x² as much in the tail.
                let rounding = 8.0 * f64::EPSILON * (1.0 + x * x);
                assert!((found / share - 1.0).abs() < rounding, "{share}: {x} has {found}");
                if exponent < 15 {
                    assert!((standard_quantile(1.0 - share) + x).abs() < 2e-16 / share * x.abs().max(1.0), "{share}");
                }
            }
        }
        assert!(standard_quantile(0.5).abs() < 1e-15);
        // Published: 97.5 % lies below 1.959963984540054.
        assert!((standard_quantile(0.975) - 1.959_963_984_540_054).abs() < 1e-14);
    }

    /// Oracle: the inverse by hand. Half of a symmetric triangle lies below its middle, an eighth below a quarter of its width.
    #[test]
    fn quantiles_of_the_others_are_what_they_are_by_hand() {
        let triangle = Distribution::Triangular { low: 2.0, mode: 4.0, high: 6.0 };
        for (share, value) in [(0.125, 3.0), (0.5, 4.0), (0.875, 5.0)] {
            assert!((triangle.quantile(share) - value).abs() < 1e-14, "{share}");
        }
        // The whole triangle on one side.
        let right = Distribution::Triangular { low: 0.0, mode: 0.0, high: 1.0 };
        assert!((right.quantile(0.75) - 0.5).abs() < 1e-15);
        let uniform = Distribution::Uniform { low: -1.0, high: 3.0 };
        assert!((uniform.quantile(0.25)).abs() < 1e-15);
        // A die.
        let die = Distribution::Whole { low: 1.0, high: 6.0 };
        for (share, value) in [(1e-9, 1.0), (0.1666, 1.0), (0.1667, 2.0), (0.5, 4.0), (1.0 - 1e-16, 6.0)] {
            assert!((die.quantile(share) - value).abs() < 1e-15, "{share}");
        }
        let none = Distribution::Uniform { low: 5.0, high: 5.0 };
        assert!((none.quantile(0.3) - 5.0).abs() < 1e-14 && none.objection().is_none());
    }

    #[test]
    fn what_is_no_distribution_says_why() {
        let objects = |distribution: Distribution| distribution.objection().is_some();
        assert!(objects(Distribution::Uniform { low: 2.0, high: 1.0 }));
        assert!(objects(Distribution::Uniform { low: f64::NAN, high: 1.0 }));
        assert!(objects(Distribution::Normal { mean: 0.0, sigma: -1.0 }));
        assert!(objects(Distribution::Normal { mean: f64::INFINITY, sigma: 1.0 }));
        assert!(objects(Distribution::Triangular { low: 0.0, mode: 2.0, high: 1.0 }));
        assert!(!objects(Distribution::Triangular { low: 0.0, mode: 0.5, high: 1.0 }));
        assert!(objects(Distribution::Whole { low: 0.5, high: 3.0 }));
        assert!(objects(Distribution::Whole { low: 4.0, high: 3.0 }));
        assert!(objects(Distribution::Whole { low: 0.0, high: 1e16 }));
        assert!(!objects(Distribution::Whole { low: -3.0, high: 4_294_967_295.0 }));
        // Values that overflow, or whose draws would.
        assert!(objects(Distribution::Triangular { low: -1e308, mode: 0.5, high: 1e308 }));
        assert!(objects(Distribution::Normal { mean: 0.0, sigma: 1e307 }));
        let wide = Distribution::Triangular { low: 0.0, mode: 0.5, high: 1e157 };
        assert!(wide.objection().is_none() && wide.quantile(0.5).is_finite());
    }
}
