//! Numbers of 106 bits as unevaluated sums of two `f64`, for integrating segments without their rounding.
//!
//! Source: Dekker, "A floating-point technique for extending the available precision", 1971.
use std::ops::{Add, Div, Mul, Sub};

/// `hi + lo` with |lo| ≤ ulp(hi)/2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Dd {
    hi: f64,
    lo: f64,
}

impl Dd {
    pub(crate) const ZERO: Self = Self { hi: 0.0, lo: 0.0 };

    pub(crate) fn value(self) -> f64 {
        self.hi + self.lo
    }

    /// Sum of two numbers and its rounding error.
    fn two_sum(a: f64, b: f64) -> Self {
        let hi = a + b;
        let b_part = hi - a;
        Self { hi, lo: (a - (hi - b_part)) + (b - b_part) }
    }

    /// Product of two numbers and its rounding error.
    fn two_product(a: f64, b: f64) -> Self {
        let split = |a: f64| {
            let c = 134_217_729.0 * a;
            let high = c - (c - a);
            (high, a - high)
        };
        let hi = a * b;
        let ((a_hi, a_lo), (b_hi, b_lo)) = (split(a), split(b));
        Self { hi, lo: ((a_hi * b_hi - hi) + a_hi * b_lo + a_lo * b_hi) + a_lo * b_lo }
    }
}

impl From<f64> for Dd {
    fn from(value: f64) -> Self {
        Self { hi: value, lo: 0.0 }
    }
}

impl Add for Dd {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (high, low) = (Self::two_sum(self.hi, other.hi), Self::two_sum(self.lo, other.lo));
        let sum = Self::two_sum(high.hi, high.lo + low.hi);
        Self::two_sum(sum.hi, sum.lo + low.lo)
    }
}

impl Sub for Dd {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + Self { hi: -other.hi, lo: -other.lo }
    }
}

impl Mul for Dd {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let product = Self::two_product(self.hi, other.hi);
        Self::two_sum(product.hi, product.lo + self.hi * other.lo + self.lo * other.hi)
    }
}

impl Div for Dd {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let first = self.hi / other.hi;
        let rest = self - Self::from(first) * other;
        let second = rest.hi / other.hi;
        Self::from(first) + Self::from(second) + Self::from((rest - Self::from(second) * other).hi / other.hi)
    }
}

#[test]
fn a_third_is_known_to_32_digits() {
    let third = Dd::from(1.0) / Dd::from(3.0);
    let residue = third * Dd::from(3.0) - Dd::from(1.0);
    assert!(residue.value().abs() < 1e-31, "{residue:?}");
    assert!(third.lo.abs() > 1e-17, "a plain f64 would stop here");
}
