//! Inverter. An ideal one, averaged over its carrier, gives the requested voltage, up to the limit of the DC link.
//!
//! ```text
//! |u| ≤ U_dc/√3      (linear range of space-vector modulation)
//! ```
//! Source: Holmes & Lipo, *Pulse Width Modulation for Power Converters*, §6.3.
//!
//! The effects of a real inverter have a file each; [`Params`] switches them on.
mod averaged;
mod held;
mod legs;
mod link;
mod modulation;
mod params;
mod switching;
mod tick;

pub(crate) use averaged::Averaged;
#[cfg(test)]
pub(crate) use legs::{legs, vector};
pub use link::{Brake, LinkParameter, LinkParams, LinkPower, LinkState, Sag};
pub use params::{MOST_DEAD, Modulation, Parameter, Params};
pub(crate) use switching::{Bridge, Switching};
pub use tick::Ripple;
pub(crate) use tick::{Input, Tick};

use servobench_base::AlphaBeta;

/// Largest phase voltage amplitude at the DC-link voltage `u_dc` (V).
#[must_use]
pub fn voltage_limit(u_dc: f64) -> f64 {
    const SQRT_3: f64 = 1.732_050_807_568_877_2;
    u_dc / SQRT_3
}

/// Output voltage when `wanted` is requested: shortened to the limit, direction kept.
#[must_use]
pub fn output(wanted: AlphaBeta, u_dc: f64) -> AlphaBeta {
    let (limit, squared) = (voltage_limit(u_dc), wanted.alpha * wanted.alpha + wanted.beta * wanted.beta);
    if squared <= limit * limit {
        return wanted;
    }
    let ratio = limit / libm::sqrt(squared);
    AlphaBeta { alpha: wanted.alpha * ratio, beta: wanted.beta * ratio }
}

/// True if `given` falls short of `wanted`, by more than the rounding of a drive that keeps to the limit itself.
pub(crate) fn falls_short(given: AlphaBeta, wanted: AlphaBeta) -> bool {
    let squared = |u: AlphaBeta| u.alpha * u.alpha + u.beta * u.beta;
    given != wanted && squared(given) < (1.0 - 1e-9) * squared(wanted)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn voltage_is_cut_at_the_circle_in_its_own_direction() {
        let limit = 540.0 / 3.0_f64.sqrt();
        let within = AlphaBeta { alpha: 100.0, beta: -200.0 };
        assert_eq!(output(within, 540.0), within);
        let cut = output(AlphaBeta { alpha: 300.0, beta: 400.0 }, 540.0);
        assert!((cut.alpha - 0.6 * limit).abs() < 1e-12 && (cut.beta - 0.8 * limit).abs() < 1e-12, "{cut:?}");
    }
}
