//! Axis units against the drive's.
use crate::FieldbusError;
use servobench_base::{ParamError, finite, positive};
use servobench_cia402::counter::Counter;

/// How the drive counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Units {
    /// So many position units of the drive …
    pub drive_units: f64,
    /// … are so much of the axis (m or rad); negative for a motor that is mounted the other way round.
    pub axis_units: f64,
    /// Velocity units of the drive in one of its position units per second (6096h).
    pub velocity_factor: f64,
    /// Rated torque or force (6076h; N·m or N), of which 6071h counts thousandths.
    pub rated_effort: f64,
    /// Counter of the positions (607Ah, 6064h), up to 32 bits.
    pub counter: Counter,
}

/// The conversions, constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Scale {
    counter: Counter,
    /// Counts per axis unit.
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
        let (counts, count) = (drive_units / self.axis_units, self.axis_units / drive_units);
        finite("units.drive_units/axis_units", counts)?;
        finite("units.axis_units/drive_units", count)?;
        let bits = self.counter.range().trailing_zeros();
        if bits > 32 {
            return Err(FieldbusError::WideCounter { bits });
        }
        let sign = 1.0_f64.copysign(self.axis_units);
        Ok(Scale {
            counter: self.counter,
            counts,
            count,
            velocity: counts * factor,
            velocity_unit: count / factor,
            thousandths: sign * 1000.0 / rated,
            thousandth: sign * rated / 1000.0,
        })
    }
}

impl Scale {
    pub(crate) const fn counter(&self) -> Counter {
        self.counter
    }

    /// Nearest count; `None` beyond 2⁵³ counts, where they are no whole numbers any more.
    pub(crate) fn counts(&self, x: f64) -> Option<i64> {
        whole(self.counts * x, 9_007_199_254_740_992.0)
    }

    /// Position at a count.
    pub(crate) const fn position(&self, counts: i64) -> f64 {
        self.count * counts as f64
    }

    /// Size of a count (m or rad).
    pub(crate) const fn resolution(&self) -> f64 {
        self.count.abs()
    }

    /// What the counter shows at so many counts, in the 32 bits of its object.
    pub(crate) fn target(&self, counts: i64) -> i32 {
        let shown = self.counter.wrap(counts.into());
        #[expect(clippy::cast_possible_truncation, reason = "32 bits of an object, as an unsigned counter uses them")]
        let bits = shown as i32;
        bits
    }

    /// The reading in the 32 bits of its object.
    pub(crate) fn reading(&self, bits: i32) -> i128 {
        if self.counter.lowest() < 0 { bits.into() } else { bits.cast_unsigned().into() }
    }

    /// Velocity in the drive's unit; `None` beyond 32 bits.
    pub(crate) fn drive_velocity(&self, v: f64) -> Option<i32> {
        whole(self.velocity * v, i32::MAX.into()).and_then(|v| i32::try_from(v).ok())
    }

    /// The same, neither rounded nor bounded.
    pub(crate) const fn drive_velocity_exactly(&self, v: f64) -> f64 {
        self.velocity * v
    }

    pub(crate) fn velocity(&self, v: i32) -> f64 {
        self.velocity_unit * f64::from(v)
    }

    /// Velocity at a difference of counts per second.
    pub(crate) const fn velocity_of(&self, counts_per_second: f64) -> f64 {
        self.count * counts_per_second
    }

    pub(crate) fn thousandths(&self, effort: f64) -> Option<i16> {
        whole(self.thousandths * effort, i16::MAX.into()).and_then(|torque| i16::try_from(torque).ok())
    }

    pub(crate) fn effort(&self, thousandths: i16) -> f64 {
        self.thousandth * f64::from(thousandths)
    }
}

/// The nearest whole number, a half upwards as in `cia402::units`; `None` beyond `highest` or for NaN.
fn whole(x: f64, highest: f64) -> Option<i64> {
    let nearest = libm::floor(x + 0.5);
    #[expect(clippy::cast_possible_truncation, reason = "at most 2⁵³")]
    let counts = nearest as i64;
    (nearest.abs() <= highest).then_some(counts)
}
