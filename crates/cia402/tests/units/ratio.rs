//! Ratios: the oracles compare cross products of integers and never divide.
use servobench_cia402::units::Ratio;

use crate::random::{Random, magnitude, sign};

/// True if `whole` is `numerator/denominator` rounded to the nearest, a half upwards: −1/2 < whole − numerator/denominator ≤ 1/2.
fn is_nearest(whole: i128, numerator: i128, denominator: i128) -> bool {
    let twice_off = 2 * (whole * denominator - numerator);
    -denominator < twice_off && twice_off <= denominator
}

#[test]
fn fractions_are_reduced() {
    let ratio = Ratio::new(360_000, 1 << 20).unwrap();
    assert_eq!((ratio.numerator(), ratio.denominator()), (5625, 1 << 14));
    assert_eq!(ratio.times(ratio.inverse(), "one"), Ok(Ratio::ONE));
    assert_eq!(Ratio::new(i64::MAX, i64::MAX), Ok(Ratio::ONE));
}

#[test]
fn counts_are_rounded_to_the_nearest_and_halves_upwards() {
    let half = Ratio::new(1, 2).unwrap();
    let rounded: Vec<_> = (-3..=3).map(|count| half.of(count).unwrap()).collect();
    assert_eq!(rounded, [-1, -1, 0, 0, 1, 1, 2]);
    let mut random = Random::seeded(1);
    for _ in 0..20_000 {
        let ratio = Ratio::new(magnitude(&mut random, 62), magnitude(&mut random, 62)).unwrap();
        let count = sign(&mut random) * i128::from(magnitude(&mut random, 62));
        let (n, d) = (i128::from(ratio.numerator()), i128::from(ratio.denominator()));
        assert!(is_nearest(ratio.of(count).unwrap(), count * n, d), "{count}·{ratio:?}");
    }
}

#[test]
fn numbers_are_rounded_to_the_nearest() {
    let mut random = Random::seeded(2);
    for _ in 0..20_000 {
        // x = m/2^20: with 53 and 60 bits its product with the ratio is an exact fraction of integers.
        let mantissa = sign(&mut random) * i128::from(magnitude(&mut random, 53));
        let ratio = Ratio::new(magnitude(&mut random, 60), magnitude(&mut random, 60)).unwrap();
        let x = mantissa as f64 / f64::from(1 << 20);
        let (n, d) = (i128::from(ratio.numerator()), i128::from(ratio.denominator()));
        let whole = ratio.of_f64(x).unwrap();
        let twice_off = 2 * ((whole << 20) * d - mantissa * n);
        assert!(-(d << 20) < twice_off && twice_off <= d << 20, "{x}·{ratio:?}");
    }
    let ratio = Ratio::new(3, 2).unwrap();
    assert_eq!(ratio.of_f64(1e-300), Some(0));
    assert_eq!(ratio.of_f64(-1e-300), Some(0));
    assert_eq!(ratio.of_f64(2.0_f64.powi(100)), Some(3 << 99));
    for exponent in 126..1024 {
        assert_eq!(ratio.of_f64(2.0_f64.powi(exponent)), None, "3·2^{}", exponent - 1);
    }
    assert_eq!(ratio.of_f64(f64::NAN), None);
    assert_eq!(ratio.of_f64(f64::NEG_INFINITY), None);
}

/// Values as near to a half as an `f64` gets, at which rounding by `f64` arithmetic fails.
#[test]
fn numbers_beside_a_half_are_rounded_to_the_nearest() {
    let mut random = Random::seeded(7);
    let mut halves = 0;
    for _ in 0..5_000 {
        let ratio = Ratio::new(magnitude(&mut random, 20), magnitude(&mut random, 20)).unwrap();
        let (n, d) = (i128::from(ratio.numerator()), i128::from(ratio.denominator()));
        let half = sign(&mut random) as f64 * (magnitude(&mut random, 20) as f64 - 0.5);
        let nearly = half * ratio.denominator() as f64 / ratio.numerator() as f64;
        for x in [nearly.next_down(), nearly, nearly.next_up()] {
            // x = mantissa/2^shift, of 53 bits: the products below take at most 53 + 20 and 20 + 20 + 73 bits.
            let shift = 1075 - i128::from((x.to_bits() >> 52) & 0x7ff);
            #[expect(clippy::cast_possible_truncation, reason = "a whole number of 53 bits")]
            let mantissa = (x * 2.0_f64.powi(i32::try_from(shift).unwrap())) as i128;
            assert!(is_nearest(ratio.of_f64(x).unwrap(), mantissa * n, d << shift), "{x}·{ratio:?}");
            halves += u32::from((2 * mantissa * n).rem_euclid(d << shift) == 0);
        }
    }
    assert!(halves > 500, "{halves} exact halves");
}

/// Products at the bounds of 64 bits, where the computation changes to 128.
#[test]
fn counts_beside_the_bounds_of_64_bits_are_rounded_to_the_nearest() {
    for (numerator, denominator) in [(1, 1), (1, 2), (1, 3), (3, 2), (7, 1 << 20), (i64::MAX, 2), (1, i64::MAX), (5, 7)]
    {
        let ratio = Ratio::new(numerator, denominator).unwrap();
        let bound = i128::from(i64::MAX) / i128::from(numerator);
        for count in (bound - 4..=bound + 4).flat_map(|count| [count, -count]) {
            let product = count * i128::from(numerator);
            assert!(is_nearest(ratio.of(count).unwrap(), product, denominator.into()), "{count}·{ratio:?}");
        }
    }
}

#[test]
fn no_other_f64_is_nearer() {
    let mut random = Random::seeded(3);
    for _ in 0..20_000 {
        // Numbers of 1 to 2^22 with a denominator of 40 bits: x and its neighbours are m/2^52 exactly.
        let denominator = i128::from(magnitude(&mut random, 40));
        let count = denominator + i128::from(magnitude(&mut random, 62)) % (denominator << 21);
        let ratio = Ratio::new(1, i64::try_from(denominator).unwrap()).unwrap();
        let x = ratio.of_as_f64(count).unwrap();
        let off = |x: f64| {
            #[expect(clippy::cast_possible_truncation, reason = "a whole number of 74 bits at most")]
            let mantissa = (x * 4_503_599_627_370_496.0) as i128;
            (mantissa * denominator - (count << 52)).abs()
        };
        assert!(off(x) <= off(x.next_up()) && off(x) <= off(x.next_down()), "{count}/{denominator}");
        assert_eq!(ratio.of_as_f64(-count), Ok(-x));
    }
    // 2^53 + 1 lies halfway between two numbers; what is above by less than 2^−62 is rounded up, not to the even one.
    let denominator = (1 << 62) + 1;
    let above = Ratio::new(1, denominator).unwrap().of_as_f64(((1 << 53) + 1) * i128::from(denominator) + 1);
    assert_eq!(above, Ok(9_007_199_254_740_994.0));
    assert_eq!(Ratio::ONE.of_as_f64(0), Ok(0.0));
    assert_eq!(Ratio::ONE.of_as_f64(i128::MIN), Ok(-(2.0_f64.powi(127))));
}
