//! Blocks of the firmware that answer real hardware; by default none of them is there.
use crate::{cogging, derivative, filter, measurement, overload, position, schedule, supervision};
use servobench_config::Kind::{Motor, Plain};
use servobench_config::quantities::{RATIO, VELOCITY};
use servobench_config::{Bound, Measure, ParameterError, positive};

servobench_config::parameters! {
    /// A parameter of a block that is one number.
    pub enum Parameter {
        /// Largest speed of the motor that the velocity loop is given to follow
        MAX_SPEED "largest speed" = positive(Motor(&VELOCITY), "3000 rpm");
        /// Weight b of the velocity reference in the proportional part: 0 makes an IP controller, 1 a PI
        REFERENCE_WEIGHT "weight of the velocity reference" = Measure { kind: Plain(&RATIO), bound: Bound::Within(0.0, 1.0), example: "0.6" };
    }
}

/// The blocks; constant during a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Blocks {
    /// Filters between velocity loop and effort limit.
    pub filters: filter::Params,
    /// Compensation of cogging.
    pub cogging: Option<cogging::Params>,
    /// I²t of the motor.
    pub motor_load: Option<overload::Params>,
    /// I²t of the drive itself.
    pub drive_load: Option<overload::Params>,
    /// Gains over speed.
    pub schedule: Option<schedule::Params>,
    /// Largest speed of the velocity reference (motor coordinate, rad/s or m/s); may be infinite.
    pub max_speed: f64,
    /// Weight of the velocity reference in the proportional part of the velocity loop.
    pub reference_weight: f64,
    /// What is watched of motor and power stage.
    pub supervision: Option<supervision::Params>,
    /// Whether the voltage limit is that of the measured DC link.
    pub measures_dc_link: bool,
    /// How the velocity is measured; `None`: by an encoder that gives it, by differences of any other.
    pub measurement: Option<measurement::Params>,
    /// Derivative part of the velocity loop, of the measured velocity.
    pub acceleration: Option<derivative::Params>,
    /// Integral and derivative parts of the position loop.
    pub position: Option<position::Params>,
}

impl Default for Blocks {
    fn default() -> Self {
        Self {
            filters: filter::Params::default(),
            cogging: None,
            motor_load: None,
            drive_load: None,
            schedule: None,
            max_speed: f64::INFINITY,
            reference_weight: 1.0,
            supervision: None,
            measures_dc_link: false,
            measurement: None,
            acceleration: None,
            position: None,
        }
    }
}

impl Blocks {
    /// The observer that measures the velocity, where it is one.
    #[must_use]
    pub fn observer(&self) -> Option<&measurement::observer::Params> {
        self.measurement.as_ref().and_then(measurement::Params::observer)
    }

    /// # Errors
    /// [`ParameterError`] names the first parameter out of its bound.
    pub fn check(&self) -> Result<(), ParameterError> {
        for load in [&self.motor_load, &self.drive_load].into_iter().flatten() {
            load.check()?;
        }
        if let Some(schedule) = &self.schedule {
            schedule.check()?;
        }
        if let Some(supervision) = &self.supervision {
            supervision.check()?;
        }
        if let Some(measurement) = &self.measurement {
            measurement.check()?;
        }
        if let Some(acceleration) = &self.acceleration {
            acceleration.check([derivative::Parameter::VELOCITY_TIME, derivative::Parameter::VELOCITY_FILTER_TIME])?;
        }
        if let Some(position) = &self.position {
            position.check()?;
        }
        Parameter::REFERENCE_WEIGHT.check(self.reference_weight)?;
        servobench_base::limit(Parameter::MAX_SPEED, self.max_speed).map(|_| ())
    }
}
