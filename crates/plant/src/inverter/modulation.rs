//! Space-vector modulation: from a voltage vector to the times for which the legs are at the upper rail.
//!
//! ```text
//! d_x = ½ + (u_x − ½·(max u + min u))/U_dc        |max u − min u| ≤ U_dc
//! ```
//! Both zero vectors share the remaining time equally, and the pulses lie symmetrically about the middle of the carrier:
//! the same as two neighbouring vectors for their times. Beyond the hexagon of the six vectors the voltage is shortened to it with its
//! direction kept, which is overmodulation with the smallest error of the phase. Source: Holmes & Lipo, *Pulse Width Modulation for
//! Power Converters*, ch. 6 (placement of the zero vectors), ch. 8 (overmodulation).
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use super::legs::{Legs, legs};
use servobench_base::AlphaBeta;

/// Share of the time for which each leg is at the upper rail.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Duties {
    pub(crate) of: Legs,
    /// True if the hexagon has shortened the voltage.
    pub(crate) shortened: bool,
}

/// The times that give `wanted` on a link of `u_dc` (V).
#[inline(always)]
pub(crate) fn duties(wanted: AlphaBeta, u_dc: f64) -> Duties {
    let u = legs(wanted);
    let (most, least) = (u[0].max(u[1]).max(u[2]), u[0].min(u[1]).min(u[2]));
    let span = most - least;
    // By more than the rounding of a drive that keeps to the limit itself.
    let shortened = span > u_dc * (1.0 + 1e-9);
    let per_volt = if span > u_dc { 1.0 / span } else { 1.0 / u_dc };
    let middle = 0.5 * (most + least);
    let per_volt = if per_volt.is_finite() { per_volt } else { 0.0 };
    Duties { of: u.map(|u| (0.5 + (u - middle) * per_volt).clamp(0.0, 1.0)), shortened }
}

#[cfg(test)]
mod tests {
    use super::super::legs::vector;
    use super::*;
    use core::f64::consts::PI;

    fn given(duties: &Duties, u_dc: f64) -> AlphaBeta {
        vector(duties.of.map(|d| d * u_dc))
    }

    /// Oracle: the mean of the output is the input, up to the hexagon; half of the rest is at either rail.
    #[test]
    fn the_mean_is_the_voltage_and_both_zero_vectors_last_as_long() {
        for k in 0..97 {
            let angle = 2.0 * PI * f64::from(k) / 97.0;
            for length in [0.0, 17.3, 184.7] {
                let wanted = AlphaBeta { alpha: length * angle.cos(), beta: length * angle.sin() };
                let found = duties(wanted, 320.0);
                let mean = given(&found, 320.0);
                assert!((mean.alpha - wanted.alpha).abs() < 1e-12 && (mean.beta - wanted.beta).abs() < 1e-12);
                let [low, high] = [f64::min, f64::max].map(|f| found.of.iter().copied().fold(found.of[0], f));
                assert!((low - (1.0 - high)).abs() < 1e-14 && !found.shortened, "{found:?}");
            }
        }
    }

    /// Oracle: the hexagon, ⅔·U_dc at its corners and U_dc/√3 in the middle of its sides.
    #[test]
    fn beyond_the_hexagon_the_direction_is_kept() {
        for k in 0..97 {
            let angle = 2.0 * PI * f64::from(k) / 97.0;
            let wanted = AlphaBeta { alpha: 400.0 * angle.cos(), beta: 400.0 * angle.sin() };
            let found = duties(wanted, 320.0);
            let mean = given(&found, 320.0);
            let from_the_side = angle.rem_euclid(PI / 3.0) - PI / 6.0;
            let length = 320.0 / 3.0_f64.sqrt() / from_the_side.cos();
            assert!(found.shortened && (mean.alpha.hypot(mean.beta) / length - 1.0).abs() < 1e-12, "{angle}");
            assert!((mean.alpha * wanted.beta - mean.beta * wanted.alpha).abs() < 1e-9, "{angle}");
        }
        assert_eq!(duties(AlphaBeta { alpha: 3.0, beta: 1.0 }, 0.0).of.map(f64::is_finite), [true; 3]);
    }
}
