//! Blocks of the firmware for real hardware; all of them are absent by default.
//!
//! A block is a file in the folder `blocks` and its lines here: parameters, state, check, linearisation, and its call. The loops call
//! places of the cascade, each of which runs its blocks: position error, gains, measured velocity, feedforward effort, effort between
//! velocity loop and limit, limits of current and voltage, supervision.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use crate::current;
use servobench_base::{Dq, Stateful};
use servobench_config::Kind::{Motor, Plain};
use servobench_config::quantities::{RATIO, VELOCITY};
use servobench_config::{Bound, Measure, ParameterError, positive};

pub mod cogging;
pub mod derivative;
pub mod filter;
pub mod measurement;
pub mod overload;
pub mod position;
pub mod schedule;
pub mod supervision;

servobench_config::parameters! {
    /// A numeric parameter of a block.
    pub enum BlockParameter {
        /// Largest speed of the motor in the reference of the velocity loop
        MAX_SPEED "largest speed" = positive(Motor(&VELOCITY), "3000 rpm");
        /// Weight b of the velocity reference in the proportional part: 0 makes an IP controller, 1 a PI
        REFERENCE_WEIGHT "weight of the velocity reference" = Measure { kind: Plain(&RATIO), bound: Bound::Within(0.0, 1.0), example: "0.6" };
    }
}

/// Parameters of the blocks; constant during a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Blocks {
    /// Filters between velocity loop and effort limit.
    pub filters: filter::Params,
    /// Compensation of cogging.
    pub cogging: Option<cogging::Params>,
    /// I²t of the motor.
    pub motor_load: Option<overload::Params>,
    /// I²t of the drive.
    pub drive_load: Option<overload::Params>,
    /// Gains over speed.
    pub schedule: Option<schedule::Params>,
    /// Largest speed of the velocity reference (motor coordinate, rad/s or m/s); may be infinite.
    pub max_speed: f64,
    /// Weight of the velocity reference in the proportional part of the velocity loop.
    pub reference_weight: f64,
    /// Supervision of motor and power stage.
    pub supervision: Option<supervision::Params>,
    /// True if the voltage limit follows the measured DC link.
    pub measures_dc_link: bool,
    /// Velocity measurement; `None`: from the encoder if it provides a velocity, otherwise by differences.
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

/// State of the blocks from tick to tick.
#[derive(Debug, Clone, PartialEq, Default, Stateful)]
pub(crate) struct State {
    pub(crate) position: position::State,
    pub(crate) measurement: measurement::State,
    pub(crate) acceleration: derivative::State,
    pub(crate) filters: filter::State,
    /// Thermal loads of the motor and of the drive.
    pub(crate) loads: [overload::State; 2],
    pub(crate) supervision: supervision::State,
}

impl State {
    /// Resets all but the measurement and the thermal loads: without power the motor still moves and cools.
    pub(crate) fn power_off(&mut self) {
        *self = Self { measurement: self.measurement, loads: self.loads, ..Self::default() };
    }

    /// Resets the position loop when it is closed.
    pub(crate) fn close_position_loop(&mut self) {
        self.position = position::State::default();
    }
}

impl Blocks {
    /// # Errors
    /// [`ParameterError`] names the first parameter out of its bound.
    pub fn check(&self) -> Result<(), ParameterError> {
        for load in [&self.motor_load, &self.drive_load].into_iter().flatten() {
            load.check()?;
        }
        self.schedule.map_or(Ok(()), |schedule| schedule.check())?;
        self.supervision.map_or(Ok(()), |supervision| supervision.check())?;
        self.measurement.map_or(Ok(()), |measurement| measurement.check())?;
        let named = [derivative::Parameter::VELOCITY_TIME, derivative::Parameter::VELOCITY_FILTER_TIME];
        self.acceleration.map_or(Ok(()), |acceleration| acceleration.check(named))?;
        self.position.map_or(Ok(()), |position| position.check())?;
        BlockParameter::REFERENCE_WEIGHT.check(self.reference_weight)?;
        servobench_base::limit(BlockParameter::MAX_SPEED, self.max_speed).map(|_| ())
    }

    /// The blocks without their nonlinear parts: limits, and whatever depends on speed or position. A block that is not listed here does
    /// not compile.
    #[must_use]
    pub fn linearised(&self) -> Self {
        Self {
            filters: self.filters,
            cogging: None,
            motor_load: None,
            drive_load: None,
            schedule: None,
            max_speed: f64::INFINITY,
            reference_weight: self.reference_weight,
            supervision: None,
            measures_dc_link: false,
            measurement: self.measurement.map(measurement::Params::linearised),
            acceleration: self.acceleration,
            position: self.position,
        }
    }

    /// Delay by the blocks of a slowly changing effort (s).
    pub(crate) fn effort_delay(&self) -> f64 {
        self.filters.delay()
    }

    /// Position error that the position loop multiplies, in one of its cycles. `cut` has the sign in which a limit below cuts, 0 if none
    /// does.
    #[inline(always)]
    pub(crate) fn position_error(&self, x: &mut State, error: f64, cut: f64, h: f64) -> f64 {
        match &self.position {
            None => error,
            Some(position) => position::step(position, &mut x.position, error, cut, h),
        }
    }

    /// Gain factors of position and velocity loop at the motor's `velocity`, as multiples of those at standstill.
    #[inline(always)]
    pub(crate) fn gain_factors(&self, velocity: f64) -> (f64, f64) {
        match &self.schedule {
            None => (1.0, 1.0),
            Some(schedule) => schedule.factors(velocity),
        }
    }

    /// Measured velocity of the motor in a cycle of the velocity loop.
    #[inline(always)]
    pub(crate) fn measured_velocity(&self, x: &mut State, u: measurement::Input, h: f64) -> f64 {
        match &self.measurement {
            None => u.of_encoder.unwrap_or(u.travelled / h),
            Some(method) => measurement::step(method, &mut x.measurement, u, h),
        }
    }

    /// Age of the measured velocity (s), with the velocity `of_encoder` if the encoder provides one.
    #[inline(always)]
    pub(crate) fn velocity_age(&self, of_encoder: Option<f64>, h: f64) -> f64 {
        match &self.measurement {
            None if of_encoder.is_some() => 0.0,
            None => h / 2.0,
            Some(method) => method.age(h),
        }
    }

    /// Feedforward effort: `effort` plus the contributions of the blocks at the motor's `position` and `velocity`.
    #[inline(always)]
    pub(crate) fn feedforward(&self, x: &State, mut effort: f64, position: f64, velocity: f64) -> f64 {
        if let Some(cogging) = &self.cogging {
            effort += cogging.effort(position, velocity);
        }
        if let Some(method) = &self.measurement {
            effort += x.measurement.compensation(method);
        }
        effort
    }

    /// Derivative part that the velocity loop subtracts from its velocity error, in a cycle with the measured `velocity`.
    #[inline(always)]
    pub(crate) fn acceleration(&self, x: &mut State, velocity: f64, h: f64) -> f64 {
        match &self.acceleration {
            None => 0.0,
            Some(acceleration) => derivative::step(acceleration, &mut x.acceleration, velocity, h),
        }
    }

    /// Effort between velocity loop and limit. The blocks here are designed for the rate of the velocity loop.
    #[inline(always)]
    pub(crate) fn effort(&self, x: &mut State, effort: f64) -> f64 {
        filter::step(&self.filters, &mut x.filters, effort)
    }

    /// Largest current (A, peak), at most `most`, in a cycle of the velocity loop with the measured `current`.
    #[inline(always)]
    pub(crate) fn max_current(&self, x: &mut State, current: Dq, most: f64, h: f64) -> f64 {
        overload::limit([self.motor_load.as_ref(), self.drive_load.as_ref()], &mut x.loads, current, most, h)
    }

    /// True if a thermal load whose limit is a fault is reached.
    pub(crate) fn is_overloaded(&self, x: &State) -> bool {
        let is_fault = |load: &overload::Params| load.reaction == overload::Reaction::Fault;
        let loads = [&self.motor_load, &self.drive_load].into_iter().zip(&x.loads);
        loads.into_iter().any(|(load, state)| state.is_reached && load.as_ref().is_some_and(is_fault))
    }

    /// Largest voltage amplitude (V): that of the estimated DC link, or of the measured one.
    #[inline(always)]
    pub(crate) fn max_voltage(&self, p: &current::Params, dc_link: f64) -> f64 {
        if self.measures_dc_link { current::voltage_limit(dc_link) } else { p.max_voltage }
    }

    /// Supervises a cycle of the velocity loop with power.
    #[inline(always)]
    pub(crate) fn watch_motion(&self, x: &mut State, u: supervision::Motion, h: f64) {
        if let Some(supervision) = &self.supervision {
            supervision::watch_motion(supervision, &mut x.supervision, &u, h);
        }
    }

    /// Supervises a cycle of the current loop `p`, with the torque-producing current `q` measured at the motor's `velocity`.
    #[inline(always)]
    pub(crate) fn watch_currents(
        &self,
        x: &mut State,
        p: &current::Params,
        u: &current::Input,
        velocity: f64,
        q: f64,
        h: f64,
    ) {
        if let Some(supervision) = &self.supervision {
            let currents = supervision::Currents {
                velocity,
                q,
                reference: u.reference.to_alpha_beta(u.rotor),
                bandwidth: p.gains.k_p.q / p.motor.inductance.q,
                measured: u.current,
            };
            supervision::watch_currents(supervision, &mut x.supervision, &currents, h);
        }
    }
}
