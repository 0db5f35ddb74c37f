//! Conversion between the settings of a drive and its object dictionary.
//!
//! A drive reads the objects at power-on and whenever the [generation](Dictionary::generation) has changed. Objects without a setting here:
//! those that come with every frame, and 6073h, 6075h and 6088h.
//!
//! An object holds whole units within its range, and that range may be too narrow for a setting: 65 535 velocity units of 1 nm/s are a
//! velocity window (606Dh) of 66 µm/s. Then it shows the nearest possible value. An object changes a setting only if it shows another value
//! than the setting would, or if the master has written it ([`Dictionary::is_written`]): neither the range nor the unit of an object
//! changes a setting that was never written.
use super::{Params, Rotary, Units, cycle};
use crate::modes::homing;
use crate::modes::profile::Ramp;
use servobench_base::ParamError;
use servobench_cia402::SdoError;
use servobench_cia402::interpolated::{SettingError, SubMode, TimePeriod};
use servobench_cia402::modulo::{PositionRange, RotaryAxisOption};
use servobench_cia402::objects::{Dictionary, Value, entry_of, parameter as p};
use servobench_cia402::units::{AxisUnit, Object, UnitError};
use thiserror::Error;

/// Inconsistent objects and settings.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum ObjectsError {
    /// A refused factor group.
    #[error(transparent)]
    Unit(#[from] UnitError),
    /// A setting that the drive refuses.
    #[error(transparent)]
    Setting(#[from] ParamError),
    /// An unsupported homing method.
    #[error(transparent)]
    Homing(#[from] homing::UnknownMethod),
    /// An unsupported sub-mode or time of interpolated position.
    #[error(transparent)]
    Interpolation(#[from] SettingError),
    /// A value that its object refuses.
    #[error(transparent)]
    Refused(#[from] SdoError),
    /// A time between two frames that is not a multiple of the drive's period.
    #[error("interpolation time period (60C2h) must be a multiple of the drive's period, {period:e} s, got {time:e} s")]
    Cycle {
        /// Time by the object (s).
        time: f64,
        /// Time between two steps of the drive (s).
        period: f64,
    },
}

/// Unit of an object.
#[derive(Debug, Clone, Copy)]
enum Scale {
    /// User-defined position unit.
    Position,
    /// User-defined velocity unit, or its derivatives per second and per second².
    Rate,
    /// One revolution of the motor per minute.
    Revolution,
    /// Thousandth of the rated effort, or that per second.
    Effort,
    /// Millisecond.
    Time,
}

/// An object that holds a quantity.
#[derive(Debug, Clone, Copy)]
struct Quantity {
    object: Object,
    scale: Scale,
    /// True if the largest value of the object stands for infinity: no limit, or no supervision (IEC 61800-7-201, 6065h).
    is_open: bool,
}

/// A quantity and its setting.
type Binding = (Quantity, fn(&mut Params) -> &mut f64);

const fn value(index: u16, subindex: u8, scale: Scale) -> Quantity {
    Quantity { object: Object { index, subindex }, scale, is_open: false }
}

const fn open(index: u16, scale: Scale) -> Quantity {
    Quantity { is_open: true, ..value(index, 0, scale) }
}

const MAX_TORQUE: Quantity = open(0x6072, Scale::Effort);
const PROFILE_JERK: Quantity = value(0x60A4, 1, Scale::Rate);
const RATED_TORQUE: Object = Object { index: 0x6076, subindex: 0 };
const MIN_POSITION_RANGE_LIMIT: Object = Object { index: 0x607B, subindex: 1 };
const MAX_POSITION_RANGE_LIMIT: Object = Object { index: 0x607B, subindex: 2 };
const MIN_POSITION_LIMIT: Object = Object { index: 0x607D, subindex: 1 };
const MAX_POSITION_LIMIT: Object = Object { index: 0x607D, subindex: 2 };
/// Motion profile types (6086h).
const LINEAR: i16 = 0;
const JERK_LIMITED: i16 = 3;

/// Settings of the quantities.
static BINDINGS: [Binding; 23] = [
    (open(0x6065, Scale::Position), |s| &mut s.following_error.width),
    (value(0x6066, 0, Scale::Time), |s| &mut s.following_error.time),
    (open(0x6067, Scale::Position), |s| &mut s.position.width),
    (value(0x6068, 0, Scale::Time), |s| &mut s.position.time),
    (value(0x606D, 0, Scale::Rate), |s| &mut s.velocity.width),
    (value(0x606E, 0, Scale::Time), |s| &mut s.velocity.time),
    (value(0x606F, 0, Scale::Rate), |s| &mut s.standstill.width),
    (value(0x6070, 0, Scale::Time), |s| &mut s.standstill.time),
    (open(0x607F, Scale::Rate), |s| &mut s.limits.profile_velocity),
    (open(0x6080, Scale::Revolution), |s| &mut s.limits.velocity),
    (value(0x6081, 0, Scale::Rate), |s| &mut s.profile.velocity),
    (value(0x6082, 0, Scale::Rate), |s| &mut s.profile.end_velocity),
    (value(0x6083, 0, Scale::Rate), |s| &mut s.profile.acceleration),
    (value(0x6084, 0, Scale::Rate), |s| &mut s.profile.deceleration),
    (value(0x6085, 0, Scale::Rate), |s| &mut s.profile.quick_stop_deceleration),
    (open(0x6087, Scale::Effort), |s| &mut s.profile.effort_slope),
    (value(0x6099, 1, Scale::Rate), |s| &mut s.homing.switch_speed),
    (value(0x6099, 2, Scale::Rate), |s| &mut s.homing.zero_speed),
    (value(0x609A, 0, Scale::Rate), |s| &mut s.homing.acceleration),
    (open(0x60C5, Scale::Rate), |s| &mut s.limits.acceleration),
    (open(0x60C6, Scale::Rate), |s| &mut s.limits.deceleration),
    (open(0x60E0, Scale::Effort), |s| &mut s.limits.effort.forward),
    (open(0x60E1, Scale::Effort), |s| &mut s.limits.effort.backward),
];

impl Params {
    /// Replaces these settings by those of the objects; `unit` is the user-defined position unit.
    ///
    /// # Errors
    /// [`ObjectsError`] for objects that the drive does not support.
    pub fn with_objects(&self, objects: &Dictionary, unit: AxisUnit) -> Result<Self, ObjectsError> {
        self.with_units(objects, self.units_of(objects, unit)?)
    }

    /// Replaces the settings on the same axis: the length of an increment stays, regardless of the factor group.
    ///
    /// # Errors
    /// [`ObjectsError`] for objects that the drive does not support.
    pub fn with_objects_on_axis(&self, objects: &Dictionary, unit: AxisUnit) -> Result<Self, ObjectsError> {
        self.with_units(objects, self.units_of(objects, unit)?.on_axis_of(&self.units))
    }

    fn units_of(&self, objects: &Dictionary, unit: AxisUnit) -> Result<Units, ObjectsError> {
        let rated_effort = if shows(objects, RATED_TORQUE, self.rated_torque())? {
            self.units.rated_effort()
        } else {
            f64::from(objects.get(p::MOTOR_RATED_TORQUE)) / 1000.0
        };
        Ok(Units::new(&objects.factor_group(), unit, rated_effort)?)
    }

    fn with_units(&self, objects: &Dictionary, units: Units) -> Result<Self, ObjectsError> {
        let cycle = cycle::Params { steps: self.steps_per_frame(objects)?, ..self.cycle };
        let mut settings = Self { cycle, power: objects.power_params(), units, ..*self };
        settings.turn_limits(&units);
        for (quantity, setting) in &BINDINGS {
            let setting = setting(&mut settings);
            *setting = quantity.read(objects, &units, *setting)?;
        }
        settings.turn_limits(&units);
        let max_effort = MAX_TORQUE.read(objects, &units, self.limits.effort.largest())?;
        settings.limits.effort = settings.limits.effort.at_most(max_effort);
        settings.limits.position = self.software_limits(objects, &units)?;
        settings.profile.ramp = match (objects.get(p::MOTION_PROFILE_TYPE), self.profile.ramp) {
            (JERK_LIMITED, Ramp::JerkLimited(jerk)) => Ramp::JerkLimited(PROFILE_JERK.read(objects, &units, jerk)?),
            (JERK_LIMITED, Ramp::Linear) => Ramp::JerkLimited(PROFILE_JERK.units(objects)? * units.from_rate(1)),
            _ => Ramp::Linear,
        };
        let range = objects.position_range();
        settings.rotary = Rotary {
            range: (range != PositionRange::default()).then_some(range),
            direction: RotaryAxisOption::of_code(objects.get(p::POSITIONING_OPTION_CODE)),
        };
        settings.homing.method = homing::Method::from_number(objects.get(p::HOMING_METHOD))?;
        settings.sub_mode = SubMode::from_code(objects.get(p::INTERPOLATION_SUB_MODE))?;
        settings.segment = segment(objects)?;
        settings.check()?;
        Ok(settings)
    }

    /// Presets the objects to these settings, each to the nearest whole unit within the range of the object. The factor group of the
    /// objects must be the one from which these settings' units were made.
    ///
    /// # Errors
    /// [`ObjectsError`] for the first object that cannot be preset; those before it are.
    pub fn store_in(&self, objects: &mut Dictionary) -> Result<(), ObjectsError> {
        let (mut settings, units) = (*self, &self.units);
        settings.turn_limits(units);
        for (quantity, setting) in &BINDINGS {
            quantity.write(objects, units, *setting(&mut settings))?;
        }
        MAX_TORQUE.write(objects, units, self.limits.effort.largest())?;
        objects.preset(RATED_TORQUE, nearest(RATED_TORQUE, self.rated_torque())?)?;
        let ramp = match self.profile.ramp {
            Ramp::Linear => LINEAR,
            Ramp::JerkLimited(jerk) => {
                PROFILE_JERK.write(objects, units, jerk)?;
                JERK_LIMITED
            }
        };
        let power = &self.power;
        for (index, code) in [
            (0x605A, power.quick_stop.code()),
            (0x605B, power.shutdown.code()),
            (0x605C, power.disable_operation.code()),
            (0x605D, power.halt.code()),
            (0x605E, power.fault_reaction.code()),
            (0x6086, ramp),
            (0x60C0, self.sub_mode.code()),
        ] {
            objects.preset(Object { index, subindex: 0 }, code.into())?;
        }
        objects.preset(Object { index: 0x6098, subindex: 0 }, self.homing.method.number().into())?;
        let Rotary { range, direction } = self.rotary;
        let range = range.unwrap_or_default();
        objects.preset(Object { index: 0x60F2, subindex: 0 }, direction.code().into())?;
        // Out of the way first: the ends do not change places.
        objects.preset(MIN_POSITION_RANGE_LIMIT, i32::MIN.into())?;
        objects.preset(MAX_POSITION_RANGE_LIMIT, range.max().into())?;
        objects.preset(MIN_POSITION_RANGE_LIMIT, range.min().into())?;
        let [min, max] = software_limits_shown(units, self.limits.position)?;
        objects.preset(MIN_POSITION_LIMIT, i32::MIN.into())?;
        objects.preset(MAX_POSITION_LIMIT, max)?;
        Ok(objects.preset(MIN_POSITION_LIMIT, min)?)
    }

    /// Swaps the effort limits between the directions of the master and of the loops, if they differ.
    fn turn_limits(&mut self, units: &Units) {
        if units.turn_effort() {
            self.limits.effort = self.limits.effort.turned();
        }
    }

    /// 6076h (mN·m or mN).
    fn rated_torque(&self) -> f64 {
        1e3 * self.units.rated_effort()
    }

    /// Number of steps between two frames (60C2h).
    fn steps_per_frame(&self, objects: &Dictionary) -> Result<u32, ObjectsError> {
        let time = f64::from(segment(objects)?.microseconds()) / 1e6;
        let steps = libm::rint(time / self.period);
        // Decimal fractions of a second are not exact in binary.
        if steps >= 1.0 && (steps * self.period - time).abs() <= 1e-9 * time {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole, and at least one")]
            return Ok(steps as u32);
        }
        Err(ObjectsError::Cycle { time, period: self.period })
    }

    /// Software position limits (607Dh) in the direction of the axis; `None` if they span the whole range of positions.
    fn software_limits(&self, objects: &Dictionary, units: &Units) -> Result<Option<[f64; 2]>, ObjectsError> {
        let limits = [MIN_POSITION_LIMIT, MAX_POSITION_LIMIT];
        let values = [objects.read(limits[0])?, objects.read(limits[1])?];
        let is_written = limits.into_iter().any(|limit| objects.is_written(limit));
        if !is_written && values == software_limits_shown(units, self.limits.position)? {
            return Ok(self.limits.position);
        }
        let [min, max] = [p::MIN_POSITION_LIMIT, p::MAX_POSITION_LIMIT].map(|limit| objects.get(limit));
        let [one, other] = [min, max].map(|limit| units.from_position(limit.into()));
        Ok(([min, max] != [i32::MIN, i32::MAX]).then_some([one.min(other), one.max(other)]))
    }
}

impl Quantity {
    /// Quantity in SI: `setting` if the object shows that, the value of the object otherwise.
    fn read(self, objects: &Dictionary, units: &Units, setting: f64) -> Result<f64, ObjectsError> {
        let unit = self.scale.unit(objects, units);
        if shows(objects, self.object, self.shown(setting / unit))? {
            Ok(setting)
        } else {
            Ok(self.units(objects)? * unit)
        }
    }

    /// Value of the object, in its units.
    fn units(self, objects: &Dictionary) -> Result<f64, ObjectsError> {
        let value = objects.read(self.object)?;
        let stands_for_none = self.is_open && value.number() == value.data_type().highest();
        Ok(if stands_for_none { f64::INFINITY } else { value.number() as f64 })
    }

    fn write(self, objects: &mut Dictionary, units: &Units, quantity: f64) -> Result<(), ObjectsError> {
        let shown = self.shown(quantity / self.scale.unit(objects, units));
        Ok(objects.preset(self.object, nearest(self.object, shown)?)?)
    }

    /// Units to be stored in the object: the value that stands for infinity is reserved.
    fn shown(self, units: f64) -> f64 {
        match bounds(self.object) {
            Ok([_, highest]) if self.is_open && units.is_finite() => units.min(highest - 1.0),
            _ => units,
        }
    }
}

impl Scale {
    /// One unit in SI.
    fn unit(self, objects: &Dictionary, units: &Units) -> f64 {
        match self {
            Self::Position => units.from_position(1).abs(),
            Self::Rate => units.from_rate(1),
            Self::Revolution => {
                let [increments, revolutions] = objects.factor_group().position_encoder_resolution.map(f64::from);
                units.metres_or_radians(1) * (increments / revolutions) / 60.0
            }
            Self::Effort => units.rated_effort() / 1000.0,
            Self::Time => 1e-3,
        }
    }
}

/// Interpolation time period (60C2h).
fn segment(objects: &Dictionary) -> Result<TimePeriod, ObjectsError> {
    let (units, index) = (objects.get(p::INTERPOLATION_TIME_PERIOD), objects.get(p::INTERPOLATION_TIME_INDEX));
    Ok(TimePeriod::new(units, index)?)
}

/// Software position limits as shown by 607Dh.
fn software_limits_shown(units: &Units, limits: Option<[f64; 2]>) -> Result<[Value; 2], ObjectsError> {
    let unit = units.from_position(1);
    let [min, max] = match limits {
        None => [f64::NEG_INFINITY, f64::INFINITY],
        Some([lowest, highest]) if unit > 0.0 => [lowest / unit, highest / unit],
        Some([lowest, highest]) => [highest / unit, lowest / unit],
    };
    Ok([nearest(MIN_POSITION_LIMIT, min)?, nearest(MAX_POSITION_LIMIT, max)?])
}

/// True if an object that the master has not written holds the value nearest to `units`.
fn shows(objects: &Dictionary, object: Object, units: f64) -> Result<bool, ObjectsError> {
    Ok(!objects.is_written(object) && objects.read(object)? == nearest(object, units)?)
}

/// Smallest and largest value of an object.
fn bounds(object: Object) -> Result<[f64; 2], SdoError> {
    let entry = entry_of(object).ok_or(SdoError::NoObject { index: object.index })?;
    Ok(match entry.range() {
        Some((lowest, highest)) => [lowest as f64, highest as f64],
        None => [entry.data_type.lowest() as f64, entry.data_type.highest() as f64],
    })
}

/// Nearest whole number of units within the range of an object.
fn nearest(object: Object, units: f64) -> Result<Value, SdoError> {
    let entry = entry_of(object).ok_or(SdoError::NoObject { index: object.index })?;
    let [lowest, highest] = bounds(object)?;
    #[expect(clippy::cast_possible_truncation, reason = "whole, and of at most 32 bits")]
    let whole = libm::rint(units.clamp(lowest, highest)) as i64;
    let (name, data_type, bytes) = (entry.name, entry.data_type, whole.to_le_bytes());
    Value::of_bytes(data_type, &bytes[..data_type.size()]).ok_or(SdoError::Length {
        object,
        name,
        data_type,
        length: bytes.len(),
    })
}
