//! Numbers with the errors of people and machines.
use crate::splice::below;
use bolero::Driver;
use bolero::generator::ValueGenerator;

/// Any `f64`: every bit pattern may occur. Most are plausible values of a request, within thirty decades or within three, many of them
/// round, so that two are equal now and then; values that break arithmetic occur more often than by chance.
#[derive(Debug, Clone, Copy)]
pub struct Number {
    signs: Signs,
}

#[derive(Debug, Clone, Copy)]
enum Signs {
    /// Half of the numbers negative.
    Both,
    /// One in 64 negative.
    HardlyEverNegative,
}

impl Number {
    /// Numbers of both signs.
    #[must_use]
    pub const fn any() -> Self {
        Self { signs: Signs::Both }
    }

    /// Numbers of which one in 64 is negative, for values that must be positive.
    #[must_use]
    pub const fn magnitude() -> Self {
        Self { signs: Signs::HardlyEverNegative }
    }
}

/// Ends of ranges.
const SPECIAL: [f64; 16] = [
    0.0,
    f64::NAN,
    f64::INFINITY,
    f64::MAX,
    f64::MIN_POSITIVE,
    5e-324,
    f64::EPSILON,
    1.0 - f64::EPSILON / 2.0,
    1.0 + f64::EPSILON,
    1e-30,
    1e30,
    1e150,
    4294967296.0,
    9007199254740992.0,
    1e-150,
    0.5,
];

/// Numbers that people type.
const ROUND: [f64; 8] = [1.0, 1.25, 1.5, 2.0, 3.0, 4.0, 5.0, 7.5];

impl ValueGenerator for Number {
    type Output = f64;

    fn generate<D: Driver>(&self, driver: &mut D) -> Option<f64> {
        // An exhausted input continues with zeros: the number 1.
        let value = match below(driver, 64)? {
            0..=23 => ROUND[below(driver, ROUND.len())?] * [1.0, 0.1, 10.0, 0.01, 100.0, 1e-3][below(driver, 6)?],
            24..=52 => decades(driver, 3.0)?,
            53..=60 => decades(driver, 31.0)?,
            61 => f64::from_bits(driver.produce()?),
            _ => SPECIAL[below(driver, SPECIAL.len())?],
        };
        let is_negative = match self.signs {
            Signs::Both => driver.produce()?,
            Signs::HardlyEverNegative => below(driver, 64)? == 63,
        };
        Some(if is_negative { -value } else { value })
    }
}

/// A number between 10^−`most` and 10^`most`, all decades equally likely.
fn decades<D: Driver>(driver: &mut D, most: f64) -> Option<f64> {
    let part = f64::from(driver.produce::<u32>()?) / f64::from(u32::MAX);
    Some(10.0_f64.powf(most * (2.0 * part - 1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seeded::Seeded;
    use bolero::TestTarget;
    use std::sync::Mutex;

    fn drawn(numbers: Number) -> Vec<f64> {
        let seen = Mutex::new(vec![]);
        TestTarget::new(Seeded { inputs: 10_000 })
            .with_generator([numbers; 4])
            .for_each(|drawn: &[f64; 4]| seen.lock().unwrap().extend(drawn));
        seen.into_inner().unwrap()
    }

    fn share(numbers: &[f64], is_one: impl Fn(f64) -> bool) -> f64 {
        numbers.iter().filter(|number| is_one(**number)).count() as f64 / numbers.len() as f64
    }

    #[test]
    fn every_kind_comes() {
        let numbers = drawn(Number::any());
        for (kind, is_one) in [
            ("no number", (|x| x.is_nan()) as fn(f64) -> bool),
            ("infinite", f64::is_infinite),
            ("subnormal", f64::is_subnormal),
            ("zero", |x| x == 0.0),
            ("huge", |x| x.is_finite() && x.abs() > 1e100),
            ("tiny", |x| x.abs() > 0.0 && x.abs() < 1e-100),
            ("round", |x| ["0.125", "75"].contains(&x.to_string().as_str())),
            ("negative", |x| x < 0.0),
        ] {
            assert!(share(&numbers, is_one) > 1e-3, "{kind}");
        }
        assert!(share(&numbers, |x| (1e-3..1e3).contains(&x.abs())) > 0.7, "most are ordinary");
        assert!(share(&drawn(Number::magnitude()), f64::is_sign_negative) < 0.03, "magnitudes are not negative");
    }
}
