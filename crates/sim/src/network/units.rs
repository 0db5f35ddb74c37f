//! The drive units of a scenario as the objects of the factor group.
//!
//! A drive holds whole numbers (608Fh: increments per revolution, 6092h: units per revolution); a scenario gives lengths and
//! angles. A value that is not a fraction of whole numbers to 13 digits is refused: a unit with a rounding error would drift away
//! from the axis with every revolution.
use crate::error::BuildError;
use core::f64::consts::TAU;
use servobench_base::Coordinate;
use servobench_base::ParamError;
use servobench_cia402::units::{AxisUnit, FactorGroup, Ratio};
use servobench_drive::device::Units;
use servobench_scenario as scenario;

/// The encoder that closes the position loop, and its ratio to the axis.
#[derive(Debug, Clone, Copy)]
pub(super) struct Counted {
    /// Coordinate of the encoder.
    pub(super) motion: Coordinate,
    /// One increment (m or rad); `None` for an ideal encoder.
    pub(super) increment: Option<f64>,
    /// Axis coordinate per coordinate of the encoder.
    pub(super) transmission: f64,
}

/// The units of a drive in every form.
#[derive(Debug, Clone, Copy)]
pub(super) struct DriveUnits {
    /// The objects of the factor group.
    pub(super) factors: FactorGroup,
    /// User-defined position unit.
    pub(super) unit: AxisUnit,
    /// The conversions.
    pub(super) conversions: Units,
    /// Length of an increment in the encoder's coordinate (m or rad).
    pub(super) increment: f64,
}

/// Units of a drive whose user-defined unit is `unit`, on an axis of `motion`.
pub(super) fn units(
    counted: &Counted,
    motion: Coordinate,
    unit: scenario::DriveUnits,
    rated_effort: f64,
) -> Result<DriveUnits, BuildError> {
    // For a linear encoder a metre stands for a revolution.
    let revolution = match counted.motion {
        Coordinate::Rotary => TAU,
        Coordinate::Linear => 1.0,
    };
    let length = unit.axis / f64::from(unit.drive);
    let feed = fraction("bus.units", counted.transmission * revolution / length).map_err(BuildError::Key)?;
    let increments = match counted.increment {
        Some(increment) => fraction("encoder", revolution / increment)?,
        // An ideal encoder: finer than the units.
        None => [feed[0].saturating_mul(FINER), feed[1]],
    };
    let [numerator, denominator] = match motion {
        Coordinate::Linear => fraction("bus.units.axis", unit.axis),
        Coordinate::Rotary => fraction("bus.units.axis", unit.axis / TAU),
    }
    .map_err(BuildError::Key)?;
    let ratio = Ratio::new(numerator.into(), i64::from(denominator) * i64::from(unit.drive))?;
    let unit = match motion {
        Coordinate::Linear => AxisUnit::Metre(ratio),
        Coordinate::Rotary => AxisUnit::Revolution(ratio),
    };
    let factors =
        FactorGroup { position_encoder_resolution: increments, feed_constant: feed, ..FactorGroup::default() };
    let increment = revolution * f64::from(increments[1]) / f64::from(increments[0]);
    Ok(DriveUnits { factors, unit, conversions: Units::new(&factors, unit, rated_effort)?, increment })
}

/// Increments of an ideal encoder per unit.
const FINER: u32 = 64;

/// `value` as a fraction of whole numbers of 32 bits, by its continued fraction.
fn fraction(name: &'static str, value: f64) -> Result<[u32; 2], ParamError> {
    let refused = ParamError { name, value, bound: "a ratio of whole numbers below 2³²" };
    let (mut before, mut last) = ([0.0, 1.0], [1.0, 0.0]);
    let mut rest = value;
    // The denominators grow at least as fast as the Fibonacci numbers: 2³² is passed after 47 terms.
    for _ in 0..48 {
        let whole = rest.floor();
        let next = [whole * last[0] + before[0], whole * last[1] + before[1]];
        if !next.iter().all(|term| (0.0..=f64::from(u32::MAX)).contains(term)) {
            return Err(refused);
        }
        (before, last) = (last, next);
        if (last[0] / last[1] - value).abs() <= 1e-13 * value && last[0] > 0.0 {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 2³² − 1")]
            return Ok(last.map(|term| term as u32));
        }
        rest = 1.0 / (rest - whole);
    }
    Err(refused)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_become_the_fractions_that_they_were_meant_as() {
        for (value, expected) in [
            (0.005, [1, 200]),
            (1_048_576.0, [1_048_576, 1]),
            (1.0 / 3.0, [1, 3]),
            (TAU / (TAU / 2500.0), [2500, 1]),
            (5e-3 / TAU * TAU / 1e-6, [5000, 1]),
            (355.0 / 113.0, [355, 113]),
        ] {
            assert_eq!(fraction("value", value), Ok(expected), "{value}");
        }
        for value in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e10, 1e-10] {
            assert!(fraction("value", value).is_err(), "{value}");
        }
    }

    /// A screw of 5 mm, an encoder of 2²⁰ increments per revolution, a unit of a micrometre.
    #[test]
    fn a_micrometre_is_what_the_screw_moves_in_a_fraction_of_a_turn() {
        let counted =
            Counted { motion: Coordinate::Rotary, increment: Some(TAU / 1_048_576.0), transmission: 5e-3 / TAU };
        let unit = scenario::DriveUnits { drive: 1000, axis: 1e-3 };
        let DriveUnits { conversions: units, increment, .. } = units(&counted, Coordinate::Linear, unit, 1.0).unwrap();
        assert!((increment - TAU / 1_048_576.0).abs() < 1e-20);
        assert_eq!(units.position(1_048_576), 5000);
        assert!((units.from_position(250_000) - 0.25).abs() < 1e-15);
    }
}
