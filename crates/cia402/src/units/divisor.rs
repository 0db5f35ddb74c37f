//! Division by a number that is known in advance.
//!
//! For 2^(l−1) < d ≤ 2^l and m = ⌈2^(63+l)/d⌉, which has 64 bits, ⌊n/d⌋ = ⌊n·m/2^(63+l)⌋ for every n of 63 bits: m·d exceeds
//! 2^(63+l) by less than 2^l, so the quotient by less than n/2^63/d < 1/d. A multiplication and a shift take a third of the time
//! of a division (Granlund & Montgomery, *Division by invariant integers using multiplication*, PLDI 1994, theorem 4.2).

/// A divisor, at least 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Divisor {
    value: i64,
    /// m above.
    reciprocal: u64,
    /// l above.
    width: u32,
}

impl Divisor {
    pub(super) const ONE: Self = Self::new(1);

    /// A divisor of `value`, at least 1.
    pub(super) const fn new(value: i64) -> Self {
        let width = i64::BITS - (value - 1).leading_zeros();
        let power = 1_u128 << (63 + width);
        #[expect(clippy::cast_possible_truncation, reason = "from 2^63 to 2^64 − 1")]
        let reciprocal = power.div_ceil(value.unsigned_abs() as u128) as u64;
        Self { value, reciprocal, width }
    }

    #[inline]
    pub(super) const fn value(self) -> i64 {
        self.value
    }

    /// `numerator/self`, rounded down.
    #[inline]
    pub(super) const fn floor(self, numerator: i64) -> i64 {
        // −1 if negative: the quotient is then the complement of that of the complement, which is not negative.
        let sign = numerator >> 63;
        let magnitude = (numerator ^ sign).cast_unsigned();
        let [_, high] = halves((magnitude << 1) as u128 * self.reciprocal as u128);
        (high >> self.width).cast_signed() ^ sign
    }

    /// `numerator/self` to the nearest, a half upwards; `None` if an intermediate result leaves 64 bits.
    #[inline]
    pub(super) const fn nearest(self, numerator: i64) -> Option<i64> {
        match numerator.checked_add(self.value / 2) {
            Some(shifted) => Some(self.floor(shifted)),
            None => None,
        }
    }
}

/// Low and high 64 bits.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "both halves are kept")]
const fn halves(product: u128) -> [u64; 2] {
    [product as u64, (product >> 64) as u64]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 2^k and its neighbours, of both signs.
    fn beside_powers() -> impl Iterator<Item = i64> {
        let powers = (0..63).flat_map(|k| [(1_i64 << k) - 1, 1 << k, (1 << k) + 1]);
        powers.chain([i64::MAX - 1, i64::MAX]).flat_map(|n| [n, -n, !n])
    }

    #[test]
    fn quotients_are_rounded_down() {
        let small = (1..=100).flat_map(|d| (-300..=300).map(move |n| (n, d)));
        let positive = || beside_powers().filter(|d| *d > 0);
        let beside_powers = positive().flat_map(|d| beside_powers().map(move |n| (n, d)));
        // Just below and at a multiple, where a wrongly rounded reciprocal shows.
        let beside_multiples = positive().flat_map(|d| {
            let last = i64::MAX - i64::MAX % d;
            [last - 1, last, -last, -last - 1, last - d, last / 3 / d * d - 1].map(|n| (n, d))
        });
        for (n, d) in small.chain(beside_powers).chain(beside_multiples) {
            let below = i128::from(n) - i128::from(Divisor::new(d).floor(n)) * i128::from(d);
            assert!((0..i128::from(d)).contains(&below), "{n}/{d}");
        }
    }

    #[test]
    fn what_leaves_64_bits_on_the_way_is_not_rounded() {
        assert_eq!(Divisor::new(2).nearest(i64::MAX), None);
        assert_eq!(Divisor::new(2).nearest(i64::MAX - 1), Some(i64::MAX / 2));
        assert_eq!(Divisor::new(2).nearest(-3), Some(-1));
        assert_eq!(Divisor::ONE.nearest(i64::MAX), Some(i64::MAX));
        assert_eq!(Divisor::ONE.nearest(i64::MIN), Some(i64::MIN));
    }
}
