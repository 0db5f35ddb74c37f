//! An input over a step: the polynomial through the last values of a signal.
//!
//! With the newest value y₀ at T₀, those before it at distances h, and s = t − T₀ (Newton's form):
//!
//! ```text
//! order 0: p = y₀
//! order 1: p = y₀ + d₁·s                        d₁ = (y₀ − y₁)/h
//! order 2: p = y₀ + d₁·s + d₂·s·(s + h)/2       d₂ = (y₀ − 2·y₁ + y₂)/h²
//! ```
//! Source: Kübler & Schiehlen, "Two methods of simulator coupling", Math. Comput. Model. Dyn. Syst. 6 (2000), §3;
//! Busch, *Zur effizienten Kopplung von Simulationsprogrammen*, Kassel 2012, ch. 2.
use crate::Input;

/// Degree of the polynomial that approximates a signal between two exchanges.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum Order {
    /// The newest value is held.
    Constant,
    /// A straight line through the two newest values.
    #[default]
    Linear,
    /// A parabola through the three newest values.
    Quadratic,
}

impl Order {
    /// All, ascending.
    pub const ALL: [Self; 3] = [Self::Constant, Self::Linear, Self::Quadratic];

    /// Degree: 0, 1 or 2.
    #[must_use]
    pub const fn degree(self) -> u8 {
        match self {
            Self::Constant => 0,
            Self::Linear => 1,
            Self::Quadratic => 2,
        }
    }
}

/// The polynomial of `degree` through the newest of `samples` (newest first, `spacing` apart), with its derivatives at
/// `since` after the newest.
pub(crate) fn through(samples: &[f64; 3], degree: u8, spacing: f64, since: f64) -> Input {
    let [y0, y1, y2] = *samples;
    match degree {
        0 => [y0, 0.0, 0.0],
        1 => {
            let d1 = (y0 - y1) / spacing;
            [y0 + d1 * since, d1, 0.0]
        }
        _ => {
            let d1 = (y0 - y1) / spacing;
            let d2 = ((y0 - y1) - (y1 - y2)) / (spacing * spacing);
            let value = y0 + since * (d1 + 0.5 * d2 * (since + spacing));
            [value, d1 + d2 * (since + 0.5 * spacing), d2]
        }
    }
}

/// Value of `input` at `after` the start of the step (s).
#[must_use]
pub fn value(input: &Input, after: f64) -> f64 {
    input[0] + after * (input[1] + 0.5 * after * input[2])
}

/// Mean of `input` over a step of `length` (s), u + u'·H/2 + u''·H²/6, for blocks that take no derivatives.
#[must_use]
pub fn mean(input: &Input, length: f64) -> f64 {
    input[0] + length * (input[1] / 2.0 + length * input[2] / 6.0)
}

/// `input` relative to a time `after` the start of the step (s).
#[must_use]
pub fn later(input: &Input, after: f64) -> Input {
    [value(input, after), input[1] + after * input[2], input[2]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Oracle: a parabola is its own interpolant. The second difference of values of 10 loses at most 4·10·2⁻⁵³,
        /// which s·(s + h)/(2·h²) ≤ 6 magnifies.
        #[test]
        fn a_parabola_is_met_everywhere(a in -3.0..3.0_f64, b in -3.0..3.0_f64, c in -3.0..3.0_f64, since in -1.0..1.0_f64) {
            let (y, h) = (|t: f64| a + t * (b + t * c), 0.5);
            let samples = [y(0.0), y(-h), y(-2.0 * h)];
            let p = through(&samples, 2, h, since);
            prop_assert!((p[0] - y(since)).abs() < 1e-13);
            prop_assert!((p[1] - (b + 2.0 * c * since)).abs() < 1e-12);
            prop_assert!((p[2] - 2.0 * c).abs() < 1e-12);
            let line = through(&samples, 1, h, since);
            prop_assert!((line[0] - (y(0.0) + (y(0.0) - y(-h)) / h * since)).abs() < 1e-13);
        }

        /// Oracle: Simpson's rule, exact for parabolas.
        #[test]
        fn the_mean_is_that_of_the_integral(u in -3.0..3.0_f64, du in -3.0..3.0_f64, ddu in -3.0..3.0_f64, length in 0.01..2.0_f64) {
            let input = [u, du, ddu];
            let simpson = (value(&input, 0.0) + 4.0 * value(&input, length / 2.0) + value(&input, length)) / 6.0;
            prop_assert!((mean(&input, length) - simpson).abs() < 1e-13);
        }

        #[test]
        fn seen_later_it_is_the_same(u in -3.0..3.0_f64, du in -3.0..3.0_f64, ddu in -3.0..3.0_f64, t in 0.0..2.0_f64) {
            let input = [u, du, ddu];
            prop_assert!((value(&later(&input, t), 0.7) - value(&input, t + 0.7)).abs() < 1e-13);
        }
    }
}
