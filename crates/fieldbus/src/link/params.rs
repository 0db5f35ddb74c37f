//! Settings of a link.
use super::buffer::{PREDICTED, Timing};
use super::course::Recovery;
use super::position_loop;
use super::stream::StreamParams;
use super::units::Scale;
use super::{PositionGains, Sequencing, Units};
use crate::FieldbusError;
use servobench_base::{Divider, Rate, finite, positive};
use servobench_motion::Limits;
use servobench_motion::Order;
use servobench_motion::interpolate::{Interval, Mode, Sample};
use servobench_motion::online::{DirectionalLimits, Effort, Target, Transition};

/// Commands to the drive while the axis follows set-points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Control {
    /// Positions (csp).
    Position {
        /// True if 60B1h carries the velocity of the set-point.
        velocity_offset: bool,
        /// True if 60B2h carries the torque of the sample.
        torque_offset: bool,
    },
    /// Velocities of a position loop in the master (csv): `v = gain·(x_set − x_actual) + feedforward·v_set`, within ±limit, with position
    /// and set-point of the time of measurement, which the [module documentation](super#the-position-loop-in-the-master) defines. The
    /// integral and the derivative of the difference are added if given.
    Velocity {
        /// Position gain K_v, integral and derivative.
        gains: PositionGains,
        /// Share of the set-point's velocity that is fed forward, 0 to 1.
        feedforward: f64,
        /// Largest commanded velocity (m/s or rad/s).
        limit: f64,
        /// True if 60B2h carries the torque of the sample.
        torque_offset: bool,
    },
}

/// Settings of a link. Times are whole base ticks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Base rate of the run.
    pub base_rate: Rate,
    /// Cycle of the bus, and of the link.
    pub bus_cycle: Divider,
    /// Cycle of the motion task.
    pub motion_cycle: Divider,
    /// Interpolation between two samples.
    pub interpolation: Mode,
    /// Tolerated lateness of a sample without a prediction (base ticks), at most two cycles of the motion task; adds to the delay.
    pub margin: u32,
    /// Cycles of the motion task by which its motion is predicted, which shortens the delay accordingly: at most two, and half of the
    /// samples that the interpolation uses.
    pub run_ahead: u32,
    /// Commands to the drive.
    pub control: Control,
    /// Sequence by which the drive is powered.
    pub sequencing: Sequencing,
    /// Longest silence of the drive, and longest time to execute a command (base ticks).
    pub drive_timeout: u64,
    /// Bus cycles from a command to the first answer that reflects it.
    pub round_trip: u32,
    /// Age of the actual position in the answer of a drive when the bus takes it (base ticks): a step of a drive that measures at its
    /// steps.
    pub answer_age: u32,
    /// True if limit and home switches are closed while not actuated.
    pub reverse_switches: bool,
    /// Units of the drive.
    pub units: Units,
    /// True if the actual velocity is computed from differences of positions, for a drive that does not report one.
    pub velocity_from_differences: bool,
    /// Velocity, acceleration and jerk with which the output is stopped, and a difference led to zero in addition to the motion; the snap
    /// is not used.
    pub recovery: Limits,
    /// Velocity of which the axis is capable (m/s or rad/s): the position command never moves faster. Samples with more than twice that
    /// velocity are refused.
    pub velocity_limit: f64,
}

/// Checked settings of a link, constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    pub(crate) settings: Settings,
    pub(crate) stream: StreamParams,
    pub(crate) scale: Scale,
    /// Cycle of the motion task (s).
    pub(crate) cycle: f64,
    /// Time from a command to the first answer that reflects it (base ticks).
    pub(crate) round_trip: u64,
    /// Age, at its reception, of the set-point that an actual position should match (base ticks).
    pub(crate) reference_delay: u64,
}

impl Params {
    /// # Errors
    /// [`FieldbusError`] names the refused setting, with its bound.
    pub fn new(settings: Settings) -> Result<Self, FieldbusError> {
        let scale = settings.units.scale()?;
        let (bus_cycle, cycle) = (u64::from(settings.bus_cycle.ticks()), u64::from(settings.motion_cycle.ticks()));
        let tick = settings.base_rate.period();
        let highest = PREDICTED as u64 * cycle;
        if u64::from(settings.margin) > highest {
            return Err(FieldbusError::Margin { margin: settings.margin, highest });
        }
        let round_trip = u64::from(settings.round_trip) * bus_cycle;
        if settings.drive_timeout <= round_trip {
            return Err(FieldbusError::ShortTimeout { timeout: settings.drive_timeout, round_trip });
        }
        let reference_delay = round_trip + u64::from(settings.answer_age);
        if let Control::Velocity { gains, feedforward, limit, .. } = settings.control {
            let highest = position_loop::LONGEST * bus_cycle;
            if reference_delay > highest {
                return Err(FieldbusError::OldAnswer { delay: reference_delay, highest });
            }
            gains.check()?;
            let lowest = (reference_delay as f64 + bus_cycle as f64 / 2.0) * tick;
            if let Some(time) = gains.integral_time.filter(|time| *time <= lowest) {
                return Err(FieldbusError::ShortIntegral { time, lowest });
            }
            finite("control.feedforward", feedforward)?;
            check_velocity(&scale, positive("control.limit", limit)?)?;
        }
        let velocity_limit = positive("velocity_limit", settings.velocity_limit)?;
        check_velocity(&scale, velocity_limit)?;
        let limits = DirectionalLimits::from(Limits { snap: 1.0, ..settings.recovery });
        let highest = PREDICTED.min(settings.interpolation.delay_samples());
        let ahead = settings.run_ahead as usize;
        if ahead > highest {
            return Err(FieldbusError::RunAhead { ahead: settings.run_ahead, highest });
        }
        let timing = Timing { mode: settings.interpolation, cycle, margin: settings.margin.into(), ahead, tick };
        // Plans once what the run will plan later, so that errors show now.
        Interval::new(timing.mode, cycle as f64 * tick, &[Sample::default(); 6])?;
        let moving = servobench_base::Setpoint { v: velocity_limit, ..Default::default() };
        Transition::plan(Order::Third, &moving, &Target::Velocity(0.0), &limits, Effort::Fast)?;
        let highest_acceleration = 2.0 * settings.recovery.acceleration;
        let recovery = Recovery {
            limits,
            highest_acceleration,
            resolution: scale.resolution() / 1000.0,
            cycle: cycle as f64,
            tick,
        };
        let (highest_step, count) = (velocity_limit * tick, scale.resolution());
        let creep = count / (cycle as f64 * tick);
        let stream = StreamParams { timing, recovery, highest_step, bus_cycle, count, creep };
        Ok(Self { settings, stream, scale, cycle: cycle as f64 * tick, round_trip, reference_delay })
    }

    /// The original settings.
    #[must_use]
    pub const fn settings(&self) -> &Settings {
        &self.settings
    }

    /// True if the torque of samples is sent as an offset to positions or velocities.
    pub(crate) const fn sends_torque(&self) -> bool {
        match self.settings.control {
            Control::Position { torque_offset, .. } | Control::Velocity { torque_offset, .. } => torque_offset,
        }
    }

    /// Constant delay of the output set-point behind the sample of the motion task (base ticks): the output at tick t is the motion that
    /// the samples describe at t − delay.
    #[must_use]
    pub const fn delay(&self) -> u64 {
        self.stream.timing.delay()
    }
}

fn check_velocity(scale: &Scale, v: f64) -> Result<(), FieldbusError> {
    match scale.drive_velocity(v) {
        Some(_) => Ok(()),
        None => Err(FieldbusError::FineVelocity { counts: scale.drive_velocity_exactly(v), highest: i32::MAX }),
    }
}
