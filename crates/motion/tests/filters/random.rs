//! Seeded random numbers.
use proptest::prelude::*;
pub(crate) use servobench_testkit::Random;

/// Any `f64`, with the patterns that break arithmetic more often than chance would bring them.
pub(crate) fn any_number() -> impl Strategy<Value = f64> {
    const SPECIAL: [f64; 14] = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
        f64::MAX,
        f64::MIN,
        f64::MIN_POSITIVE,
        5e-324,
        1e-30,
        1e30,
        0.999_999_999_999_999_9,
    ];
    prop_oneof![
        any::<u64>().prop_map(f64::from_bits),
        (-31.0..31.0_f64).prop_map(|exponent| 10.0_f64.powf(exponent)),
        0.0..1.0_f64,
        (0..SPECIAL.len()).prop_map(|i| SPECIAL[i]),
    ]
}
