//! A positive fraction of integers.
//!
//! For speed, a product that fits into 64 bits is divided by a multiplication, and a number whose rounding is beyond doubt is rounded as an
//! `f64`; the results are the same, in a third of the time.
use super::UnitError;
use super::divisor::Divisor;

/// A positive fraction, always reduced: numerator and denominator up to 2⁶³ − 1 without a common divisor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Ratio {
    numerator: Divisor,
    denominator: Divisor,
}

impl Ratio {
    /// 1/1.
    pub const ONE: Self = Self { numerator: Divisor::ONE, denominator: Divisor::ONE };

    /// A fraction, reduced.
    ///
    /// # Errors
    /// [`UnitError::NotPositive`] if the numerator or the denominator is zero or negative.
    pub fn new(numerator: i64, denominator: i64) -> Result<Self, UnitError> {
        for (name, value) in [("numerator", numerator), ("denominator", denominator)] {
            if value < 1 {
                return Err(UnitError::NotPositive { name, value });
            }
        }
        Self::reduced("ratio", numerator.unsigned_abs().into(), denominator.unsigned_abs().into())
    }

    /// The fraction of two positive numbers of any size; `name` is its name in an error.
    pub(crate) fn reduced(name: &'static str, numerator: u128, denominator: u128) -> Result<Self, UnitError> {
        let divisor = greatest_common_divisor(numerator, denominator);
        let kept = |part: u128| {
            i64::try_from(part / divisor).map(Divisor::new).map_err(|_| UnitError::RatioTooLarge {
                name,
                value: numerator.max(denominator) / divisor,
                highest: i64::MAX,
            })
        };
        Ok(Self { numerator: kept(numerator)?, denominator: kept(denominator)? })
    }

    /// Numerator, at least 1.
    #[must_use]
    pub const fn numerator(self) -> i64 {
        self.numerator.value()
    }

    /// Denominator, at least 1.
    #[must_use]
    pub const fn denominator(self) -> i64 {
        self.denominator.value()
    }

    /// Denominator over numerator.
    #[must_use]
    pub const fn inverse(self) -> Self {
        Self { numerator: self.denominator, denominator: self.numerator }
    }

    /// The product; `name` is its name in an error.
    ///
    /// # Errors
    /// [`UnitError::RatioTooLarge`] if the reduced product does not fit.
    pub fn times(self, other: Self, name: &'static str) -> Result<Self, UnitError> {
        let product = |a: i64, b: i64| u128::from(a.unsigned_abs()) * u128::from(b.unsigned_abs());
        Self::reduced(
            name,
            product(self.numerator(), other.numerator()),
            product(self.denominator(), other.denominator()),
        )
    }

    /// `count` times the ratio to the nearest integer, a half upwards.
    ///
    /// # Errors
    /// [`UnitError::CountOverflow`] if the product with the numerator leaves 127 bits.
    #[inline]
    pub fn of(self, count: i128) -> Result<i128, UnitError> {
        let narrow = i64::try_from(count).ok().and_then(|count| count.checked_mul(self.numerator()));
        if let Some(whole) = narrow.and_then(|product| self.denominator.nearest(product)) {
            return Ok(whole.into());
        }
        Ok(nearest(product(count, self.numerator().into())?, self.denominator().into()))
    }

    /// `count` times the ratio to the nearest `f64`: one rounding.
    ///
    /// The quotient is computed to at least 65 bits and its last one stands for the rest, so that the conversion to 53 bits rounds like the
    /// exact fraction.
    ///
    /// # Errors
    /// [`UnitError::CountOverflow`] as [`of`](Self::of).
    #[inline]
    pub fn of_as_f64(self, count: i128) -> Result<f64, UnitError> {
        let narrow = i64::try_from(count).ok().and_then(|count| count.checked_mul(self.numerator()));
        if let Some(numerator) = narrow.filter(|numerator| numerator.unsigned_abs() <= EXACT)
            && self.denominator().unsigned_abs() <= EXACT
        {
            // A quotient of two exact numbers is rounded once.
            return Ok(numerator as f64 / self.denominator() as f64);
        }
        let numerator = product(count, self.numerator().into())?;
        let denominator = u128::from(self.denominator().unsigned_abs());
        let shift = numerator.unsigned_abs().leading_zeros();
        let shifted = numerator.unsigned_abs() << shift;
        let quotient = (shifted / denominator) | u128::from(!shifted.is_multiple_of(denominator));
        let magnitude = quotient as f64 / (1_u128 << shift) as f64;
        Ok(if numerator < 0 { -magnitude } else { magnitude })
    }

    /// The number `x` times the ratio to the nearest integer, a half upwards: one rounding, since `x` is a fraction itself. `None` if `x`
    /// is not finite or the result leaves 127 bits.
    #[must_use]
    #[inline]
    pub fn of_f64(self, x: f64) -> Option<i128> {
        if let Some(whole) = self.of_f64_beyond_doubt(x) {
            return Some(whole.into());
        }
        let (mantissa, exponent) = mantissa_and_exponent(x)?;
        // 53 and 63 bits: no overflow.
        let numerator = i128::from(mantissa) * i128::from(self.numerator());
        let denominator = i128::from(self.denominator());
        if let Ok(shift) = u32::try_from(exponent) {
            // The sign bit, 2^127, does no harm: every mantissa but 0 overflows with it, and 0 has a negative exponent.
            let scaled = numerator.checked_mul(1_i128.checked_shl(shift)?)?;
            return Some(nearest(scaled, denominator));
        }
        let halves = (2 * numerator).div_euclid(denominator) >> exponent.unsigned_abs().min(127);
        Some((halves + 1) >> 1)
    }

    /// [`of_f64`](Self::of_f64) in `f64`, unless the two roundings of the quotient could lead to another integer.
    #[inline]
    fn of_f64_beyond_doubt(self, x: f64) -> Option<i64> {
        if self.numerator().unsigned_abs() > EXACT || self.denominator().unsigned_abs() > EXACT {
            return None;
        }
        let quotient = x * self.numerator() as f64 / self.denominator() as f64;
        // Product and quotient are off by 2^−53 each, so are the sums below: the doubt covers four of them, with a margin. From 2^49 on,
        // and for values that are not finite, it always exceeds its bound.
        let doubt = (quotient.abs() + 1.0) * EPSILON;
        if doubt < 0.5 {
            let [lowest, highest] = [floor(quotient - doubt + 0.5), floor(quotient + doubt + 0.5)];
            return (lowest == highest).then_some(lowest);
        }
        None
    }
}

/// Largest integer up to which every one is an `f64`.
const EXACT: u64 = 1 << f64::MANTISSA_DIGITS;
/// 2^−50.
const EPSILON: f64 = 4.0 * f64::EPSILON;

/// Largest integer not above `x`, which is far from the bounds of 64 bits.
fn floor(x: f64) -> i64 {
    #[expect(clippy::cast_possible_truncation, reason = "far from the bounds; towards zero, which is mended")]
    let towards_zero = x as i64;
    towards_zero - i64::from(towards_zero as f64 > x)
}

/// `numerator/denominator` to the nearest integer, a half upwards; the denominator is positive.
pub(crate) fn nearest(numerator: i128, denominator: i128) -> i128 {
    if let (Ok(numerator), Ok(denominator)) = (i64::try_from(numerator), i64::try_from(denominator)) {
        let (whole, remainder) = (numerator.div_euclid(denominator), numerator.rem_euclid(denominator));
        return i128::from(whole) + i128::from(remainder >= denominator - remainder);
    }
    let remainder = numerator.rem_euclid(denominator);
    numerator.div_euclid(denominator) + i128::from(remainder >= denominator - remainder)
}

/// Product, refused beyond 127 bits.
pub(crate) fn product(value: i128, numerator: i128) -> Result<i128, UnitError> {
    value.checked_mul(numerator).ok_or(UnitError::CountOverflow { value, numerator })
}

/// `x = mantissa·2^exponent`, exactly. `None` if `x` is not finite.
fn mantissa_and_exponent(x: f64) -> Option<(i64, i32)> {
    if !x.is_finite() {
        return None;
    }
    // libm splits off a mantissa in [1/2, 1); 53 bits more make it an integer.
    let (fraction, exponent) = libm::frexp(x);
    #[expect(clippy::cast_possible_truncation, reason = "an integer of at most 53 bits")]
    let mantissa = (fraction * 9_007_199_254_740_992.0) as i64;
    Some((mantissa, exponent - 53))
}

/// Euclid's algorithm.
const fn greatest_common_divisor(mut a: u128, mut b: u128) -> u128 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}
