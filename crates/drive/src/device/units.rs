//! Conversion of drive units by the factor group.
//!
//! The loops count from the encoder's zero in the encoder's direction; polarity (607Eh) and user-defined units apply to bus values only. A
//! reversed axis has all three bits of the polarity: with those of position and velocity alone, the two in the standard, a torque offset
//! (60B2h) would act against the motion. Velocities are in the user-defined velocity unit, accelerations in that unit per second, efforts
//! in thousandths of the rated one (6076h).
use core::f64::consts::TAU;
use servobench_base::{ParamError, positive};
use servobench_cia402::units::{
    AxisUnit, FactorGroup, POLARITY_POSITION, POLARITY_TORQUE, POLARITY_VELOCITY, Ratio, Scaling, UnitError,
};

/// Conversions between the bus and the loops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Units {
    scaling: Scaling,
    /// Metres or radians per increment.
    increment: f64,
    /// Metres or radians per user-defined position unit, with the sign of the polarity.
    position: f64,
    /// m/s or rad/s per user-defined velocity unit, with the sign of the polarity.
    velocity: f64,
    /// N·m or N per thousandth, with the sign of the polarity.
    effort: f64,
}

impl Units {
    /// Conversions by a factor group, with the user-defined position unit `unit` and the motor's rated effort (N·m or N).
    ///
    /// # Errors
    /// [`UnitError`] if the factor group is refused.
    pub fn new(factors: &FactorGroup, unit: AxisUnit, rated_effort: f64) -> Result<Self, UnitError> {
        let scaling = factors.scaling(unit)?;
        let length = match unit {
            AxisUnit::Metre(length) => as_f64(length),
            AxisUnit::Revolution(length) => as_f64(length) * TAU,
        };
        let [numerator, denominator] = factors.velocity_factor.map(f64::from);
        let sign = |bit| if factors.polarity & bit == 0 { 1.0 } else { -1.0 };
        Ok(Self {
            scaling,
            increment: scaling.metres_or_radians(1)?.abs(),
            position: sign(POLARITY_POSITION) * length,
            velocity: sign(POLARITY_VELOCITY) * length * (denominator / numerator),
            effort: sign(POLARITY_TORQUE) * rated_effort / 1000.0,
        })
    }

    /// Same factor group on an axis whose increment is as long as that of `axis`, regardless of the group: a unit stays the same number
    /// of increments, so that a wrong gear ratio scales target (607Ah) and actual positions (6064h) alike.
    pub(super) fn on_axis_of(self, axis: &Self) -> Self {
        let scale = axis.increment / self.increment;
        Self { increment: axis.increment, position: scale * self.position, velocity: scale * self.velocity, ..self }
    }

    /// # Errors
    /// [`ParamError`] unless the rated effort is positive.
    pub fn check(&self) -> Result<(), ParamError> {
        positive("rated_effort", self.rated_effort()).map(|_| ())
    }

    /// Rated effort (6076h; N·m or N).
    #[must_use]
    pub const fn rated_effort(&self) -> f64 {
        1000.0 * self.effort.abs()
    }

    /// True if the master counts efforts in the opposite direction to the loops.
    pub(super) fn turn_effort(&self) -> bool {
        self.effort < 0.0
    }

    /// Metres or radians at a number of increments.
    #[inline]
    #[must_use]
    pub fn metres_or_radians(&self, increments: i64) -> f64 {
        increments as f64 * self.increment
    }

    /// Nearest number of increments to a position (m or rad).
    #[must_use]
    pub fn increments(&self, metres_or_radians: f64) -> i64 {
        nearest(metres_or_radians / self.increment)
    }

    /// Position in user-defined units.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "wraps, which is meant")]
    pub fn position(&self, increments: i64) -> i64 {
        // 64 bits of increments times a ratio of 63 bits fit the 127 bits of the computation; beyond 64 bits the result wraps like the
        // counters of the bus.
        self.scaling.position(increments.into()).unwrap_or_default() as i64
    }

    /// Position in user-defined units nearest to a position (m or rad).
    #[inline]
    #[must_use]
    pub fn position_at(&self, metres_or_radians: f64) -> i64 {
        nearest(metres_or_radians / self.position)
    }

    /// Metres or radians at a position in user-defined units.
    #[inline]
    #[must_use]
    pub fn from_position(&self, units: i64) -> f64 {
        units as f64 * self.position
    }

    /// Difference of positions (m or rad) in user-defined units, rounded to nearest, saturated at the range of the object.
    #[inline]
    #[must_use]
    pub fn distance(&self, metres_or_radians: f64) -> i32 {
        saturated(nearest(metres_or_radians / self.position))
    }

    /// m/s or rad/s at a velocity in user-defined units.
    #[inline]
    #[must_use]
    pub fn from_velocity(&self, units: i32) -> f64 {
        f64::from(units) * self.velocity
    }

    /// Velocity in user-defined units, rounded to nearest, saturated at the range of the object.
    #[inline]
    #[must_use]
    pub fn velocity(&self, velocity: f64) -> i32 {
        saturated(nearest(velocity / self.velocity))
    }

    /// Magnitude of a velocity (m/s or rad/s) or an acceleration (m/s² or rad/s²) of a profile.
    #[inline]
    #[must_use]
    pub fn from_rate(&self, units: u32) -> f64 {
        f64::from(units) * self.velocity.abs()
    }

    /// Effort (N·m or N) at a number of thousandths of the rated one.
    #[inline]
    #[must_use]
    pub fn from_effort(&self, thousandths: i16) -> f64 {
        f64::from(thousandths) * self.effort
    }

    /// Magnitude of an effort (N·m or N).
    #[must_use]
    pub const fn effort_magnitude(&self, thousandths: u16) -> f64 {
        thousandths as f64 * self.effort.abs()
    }

    /// Effort in thousandths of the rated one, rounded to nearest, saturated at the range of the object.
    #[inline]
    #[must_use]
    pub fn effort(&self, effort: f64) -> i16 {
        let thousandths = saturated(nearest(effort / self.effort));
        i16::try_from(thousandths).unwrap_or(if thousandths < 0 { i16::MIN } else { i16::MAX })
    }
}

fn as_f64(ratio: Ratio) -> f64 {
    ratio.numerator() as f64 / ratio.denominator() as f64
}

/// Nearest whole number, halves away from zero, saturated at the range.
#[expect(clippy::cast_possible_truncation, reason = "saturates, which is meant")]
fn nearest(value: f64) -> i64 {
    (value + 0.5_f64.copysign(value)) as i64
}

fn saturated(value: i64) -> i32 {
    i32::try_from(value).unwrap_or(if value < 0 { i32::MIN } else { i32::MAX })
}
