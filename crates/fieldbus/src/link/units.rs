//! Conversion between axis units and the drive's units.
use crate::FieldbusError;
use servobench_base::{ParamError, finite, positive};
use servobench_cia402::Actuals;
use servobench_cia402::counter::Counter;

/// Units of the drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Units {
    /// Number of position units of the drive …
    pub drive_units: f64,
    /// … in this travel of the axis (m or rad); negative for a motor that is mounted in the opposite direction. Such a drive has the switch
    /// of the axis' negative end at its input for the positive one.
    pub axis_units: f64,
    /// Velocity units of the drive in one of its position units per second (6096h).
    pub velocity_factor: f64,
    /// Rated torque or force (6076h; N·m or N), of which 6071h counts thousandths.
    pub rated_effort: f64,
    /// Counter of the positions (607Ah, 6064h; above 32 bits the drive has separate objects for the upper halves).
    pub counter: Counter,
}

/// Conversions, constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Scale {
    counter: Counter,
    /// True if the drive counts against the axis.
    is_reversed: bool,
    /// Counts per axis unit, a magnitude like the following ones.
    counts: f64,
    /// Axis units per count.
    count: f64,
    /// Velocity of the drive per axis unit per second.
    velocity: f64,
    /// Axis units per second per velocity unit of the drive.
    velocity_unit: f64,
    thousandths: f64,
    thousandth: f64,
}

impl Units {
    pub(crate) fn scale(&self) -> Result<Scale, FieldbusError> {
        let drive_units = positive("units.drive_units", self.drive_units)?;
        if !self.axis_units.is_normal() {
            let bound = "finite and not zero";
            return Err(ParamError { name: "units.axis_units", value: self.axis_units, bound }.into());
        }
        let factor = positive("units.velocity_factor", self.velocity_factor)?;
        let rated = positive("units.rated_effort", self.rated_effort)?;
        let axis_units = self.axis_units.abs();
        let (counts, count) = (drive_units / axis_units, axis_units / drive_units);
        finite("units.drive_units/axis_units", counts)?;
        finite("units.axis_units/drive_units", count)?;
        Ok(Scale {
            counter: self.counter,
            is_reversed: self.axis_units < 0.0,
            counts,
            count,
            velocity: counts * factor,
            velocity_unit: count / factor,
            thousandths: 1000.0 / rated,
            thousandth: rated / 1000.0,
        })
    }
}

impl Scale {
    pub(crate) const fn counter(&self) -> Counter {
        self.counter
    }

    /// Nearest count; `None` beyond 2⁵³ counts, where not every count is representable in 64 bits.
    pub(crate) fn counts(&self, x: f64) -> Option<i64> {
        Some(self.turned(whole(self.counts * x, 9_007_199_254_740_992.0)?))
    }

    /// True if the drive counts against the axis.
    pub(crate) const fn is_reversed(&self) -> bool {
        self.is_reversed
    }

    /// Converts counts along the axis to counts of the drive. Rounding comes first, so that a reversed motor moves exactly mirrored.
    const fn turned(&self, counted: i64) -> i64 {
        if self.is_reversed { -counted } else { counted }
    }

    /// Same conversion of a real number.
    const fn along(&self, value: f64) -> f64 {
        if self.is_reversed { -value } else { value }
    }

    /// Position at a count; beyond 2⁵³ counts the nearest representable number.
    pub(crate) const fn position(&self, counts: i128) -> f64 {
        self.along(self.count * counts as f64)
    }

    /// Size of a count (m or rad).
    pub(crate) const fn resolution(&self) -> f64 {
        self.count
    }

    /// Counts from the actual position to the one that the drive follows, by the shorter direction.
    pub(crate) fn ahead(&self, actuals: &Actuals) -> i128 {
        let range = self.counter.range();
        let way = (followed(self.counter, actuals) - reading(self.counter, actuals)).rem_euclid(range);
        if way > range / 2 { way - range } else { way }
    }

    /// Counts from the position in an object of 32 bits to that in another, by the shorter direction.
    pub(crate) fn away(&self, from: i32, to: i32) -> i128 {
        let range = self.counter.range().min(1 << i32::BITS);
        let way = (i128::from(to) - i128::from(from)).rem_euclid(range);
        if way > range / 2 { way - range } else { way }
    }

    /// Velocity in the drive's unit; `None` beyond 32 bits.
    pub(crate) fn drive_velocity(&self, v: f64) -> Option<i32> {
        whole(self.velocity * v, i32::MAX.into()).and_then(|v| i32::try_from(self.turned(v)).ok())
    }

    /// Nearest velocity in the drive's unit.
    pub(crate) fn nearest_velocity(&self, v: f64) -> i32 {
        #[expect(clippy::cast_possible_truncation, reason = "saturates, which is meant")]
        let nearest = self.along(libm::floor(self.velocity * v + 0.5)) as i32;
        nearest
    }

    /// Magnitude of a velocity, or of an acceleration in velocity units per second: the nearest, at least 1 if it is not zero, saturated at
    /// the largest.
    pub(crate) fn rate(&self, rate: f64) -> u32 {
        let units = (self.velocity * rate).abs();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, which is meant")]
        let nearest = (units + 0.5) as u32;
        if units > 0.0 { nearest.max(1) } else { 0 }
    }

    /// Velocity in units of the drive, neither rounded nor bounded.
    pub(crate) const fn drive_velocity_exactly(&self, v: f64) -> f64 {
        self.velocity * v
    }

    pub(crate) fn velocity(&self, v: i32) -> f64 {
        self.along(self.velocity_unit * f64::from(v))
    }

    /// Velocity for a rate of counts per second.
    pub(crate) const fn velocity_of(&self, counts_per_second: f64) -> f64 {
        self.along(self.count * counts_per_second)
    }

    pub(crate) fn thousandths(&self, effort: f64) -> Option<i16> {
        self.thousandths_with(effort, &mut 0.0)
    }

    /// Thousandths for `effort` plus the rounding remainder of the last one, `rest` (thousandths), which is then updated: the mean is the
    /// exact effort, however coarse the thousandths are. The remainder counts along the axis.
    pub(crate) fn thousandths_with(&self, effort: f64, rest: &mut f64) -> Option<i16> {
        let exact = self.thousandths * effort + *rest;
        let torque = whole(exact, i16::MAX.into())?;
        *rest = exact - torque as f64;
        i16::try_from(self.turned(torque)).ok()
    }

    /// Thousandths for a limit: the nearest, at least 1, saturated at the largest.
    pub(crate) fn max_torque(&self, limit: f64) -> u16 {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, which is meant")]
        let nearest = libm::floor(self.thousandths * limit + 0.5) as u16;
        nearest.max(1)
    }

    pub(crate) fn effort(&self, thousandths: i16) -> f64 {
        self.along(self.thousandth * f64::from(thousandths))
    }
}

/// Actual position as a reading of the counter.
pub(crate) fn reading(counter: Counter, actuals: &Actuals) -> i128 {
    counter.reading_of([actuals.position, actuals.position_high])
}

/// Position that the loops of the drive follow, as a reading of the counter.
fn followed(counter: Counter, actuals: &Actuals) -> i128 {
    counter.reading_of([actuals.position_demand, actuals.position_demand_high])
}

/// Nearest whole number, halves upwards as in `cia402::units`; `None` beyond `highest` or for NaN.
fn whole(x: f64, highest: f64) -> Option<i64> {
    let nearest = libm::floor(x + 0.5);
    #[expect(clippy::cast_possible_truncation, reason = "at most 2⁵³")]
    let counts = nearest as i64;
    (nearest.abs() <= highest).then_some(counts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use servobench_cia402::units::{AxisUnit, FactorGroup, Ratio};

    fn units(drive_units: f64, axis_units: f64) -> Units {
        let counter = Counter::signed(32).unwrap();
        Units { drive_units, axis_units, velocity_factor: 1.0, rated_effort: 2.4, counter }
    }

    proptest! {
        /// Oracle: the factor group in integers, rounded once. Two roundings here: a count may differ within 1e-6 of a half.
        #[test]
        fn counts_are_those_of_the_factor_group(
            encoder in 1_u32..1 << 24, gear in 1_u32..1000, feed in 1_u32..100_000, x in -100.0..100.0_f64,
            inverted: bool,
        ) {
            let factors = FactorGroup {
                position_encoder_resolution: [encoder, 1],
                gear_ratio: [gear, 7],
                feed_constant: [feed, 1],
                polarity: if inverted { 0x80 } else { 0 },
                ..FactorGroup::default()
            };
            let scaling = factors.scaling(AxisUnit::Metre(Ratio::new(1, 1_000_000).unwrap())).unwrap();
            let axis_units = f64::from(feed) * 7e-6 * if inverted { -1.0 } else { 1.0 };
            let scale = units(f64::from(encoder) * f64::from(gear), axis_units).scale().unwrap();
            let counts = scale.counts(x).unwrap();
            let expected = scaling.increments_at(x).unwrap();
            let exact = scale.counts * x;
            let is_half = ((exact - exact.floor()) - 0.5).abs() < 1e-6 + exact.abs() * 4.0 * f64::EPSILON;
            prop_assert!(i128::from(counts) == expected || is_half, "{counts} for {expected}");
            let back = scaling.metres_or_radians(counts.into()).unwrap();
            prop_assert!((scale.position(counts.into()) - back).abs() <= 4.0 * f64::EPSILON * back.abs());
        }

        /// Oracle: the difference itself, which is shorter than half the range.
        #[test]
        fn the_way_to_what_is_followed_is_found_in_counters_of_every_width(
            bits in 8_u32..=64, signed: bool, at: i64, ahead: i64,
        ) {
            let counter = if signed { Counter::signed(bits) } else { Counter::unsigned(bits) }.unwrap();
            let scale = Units { counter, ..units(1e6, 1.0) }.scale().unwrap();
            let ahead = i128::from(ahead) % (counter.range() / 2);
            let ([position, position_high], [position_demand, position_demand_high]) =
                (counter.words(at.into()), counter.words(i128::from(at) + ahead));
            let actuals =
                Actuals { position, position_high, position_demand, position_demand_high, ..Actuals::default() };
            prop_assert_eq!(scale.ahead(&actuals), ahead);
        }
    }

    #[test]
    fn efforts_and_velocities_are_in_the_drive_s_units() {
        let scale = Units { velocity_factor: 60.0, ..units(1e6, -1.0) }.scale().unwrap();
        assert_eq!((scale.drive_velocity(0.001), scale.thousandths(1.2)), (Some(-60_000), Some(-500)));
        assert!((scale.velocity(-60_000) - 0.001).abs() < 1e-15 && (scale.effort(-500) - 1.2).abs() < 1e-15);
        assert_eq!((scale.drive_velocity(40.0), scale.thousandths(80.0), scale.counts(1e10)), (None, None, None));
        assert_eq!(
            (scale.drive_velocity(f64::NAN), scale.thousandths(f64::NAN), scale.counts(f64::NAN)),
            (None, None, None)
        );
    }
}
