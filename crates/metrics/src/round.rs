//! Round numbers: 1, 2 or 5 times a power of ten.

/// Relative reduction by rounding that a round number may have.
const ROUNDING: f64 = 1e-9;

/// The largest round number that is at most `value`, which is finite and positive.
#[must_use]
pub fn round_below(value: f64) -> f64 {
    let value = value * (1.0 + ROUNDING);
    candidates(value).into_iter().rev().find(|round| *round <= value).unwrap_or(value)
}

/// The smallest round number that is at least `value`, which is finite and positive.
#[must_use]
pub fn round_above(value: f64) -> f64 {
    let value = value * (1.0 - ROUNDING);
    candidates(value).into_iter().find(|round| *round >= value).unwrap_or(value)
}

/// The round numbers around `value`, ascending: from the power of ten below to that above.
fn candidates(value: f64) -> [f64; 4] {
    // Powers from decimal text: 10^-4 computed is not 0.0001.
    let exponent: i32 = format!("{value:e}").split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    let power = |exponent: i32| format!("1e{exponent}").parse::<f64>().unwrap_or(1.0);
    let one = power(exponent);
    [one, 2.0 * one, 5.0 * one, power(exponent + 1)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn round_numbers_are_1_2_and_5() {
        for (value, below, above) in [
            (1.0, 1.0, 1.0),
            (1.9, 1.0, 2.0),
            (2.0, 2.0, 2.0),
            (4.9, 2.0, 5.0),
            (7.0, 5.0, 10.0),
            (99.0, 50.0, 100.0),
            (0.1, 0.1, 0.1),
            (0.3e-6, 0.2e-6, 0.5e-6),
            // The computed 0.1 + 0.2 − 0.1 counts as 0.2.
            (0.1 + 0.2 - 0.1, 0.2, 0.2),
            (0.7 - 0.5, 0.2, 0.2),
        ] {
            let close = |one: f64, two: f64| (one - two).abs() <= 1e-15 * two;
            assert!(close(round_below(value), below) && close(round_above(value), above), "{value}");
        }
    }

    proptest! {
        /// Neighbours among the round numbers are at most 2.5 times apart.
        #[test]
        fn both_are_near(mantissa in 1.0..10.0_f64, power in -200..200_i32) {
            let value = mantissa * 10_f64.powi(power);
            let (below, above) = (round_below(value), round_above(value));
            prop_assert!(below <= value * (1.0 + 1e-8) && above >= value * (1.0 - 1e-8) && above <= 2.500_001 * below);
        }
    }
}
