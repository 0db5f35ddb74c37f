//! Settings of the drive: the objects that do not come with every frame, in SI.
use super::{Rotary, Units, Window, cycle};
use crate::EffortLimits;
use crate::modes::profile::Ramp;
use crate::modes::{Moment, Steepness, cyclic, homing, interpolated, profile};
use core::cmp::Ordering;
use servobench_base::{ParamError, limit, positive};
use servobench_cia402::PowerParams;
use servobench_cia402::counter::Counter;
use servobench_cia402::interpolated::{SubMode, TimePeriod};
use servobench_cia402::units::{AxisUnit, FactorGroup, Ratio};
use servobench_motion::interpolate;

/// Settings of the drive; constant while it runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Time between two steps (s): the period of the position loop.
    pub period: f64,
    /// Timing of the targets of the cyclic modes.
    pub cycle: cycle::Params,
    /// Interpolation of cyclic positions.
    pub interpolation: interpolate::Mode,
    /// The option codes.
    pub power: PowerParams,
    /// Drive units.
    pub units: Units,
    /// Counter of the positions on the bus (607Ah, 6064h), up to 32 bits.
    pub counter: Counter,
    /// Positions within a range (607Bh, 60F2h).
    pub rotary: Rotary,
    /// Limits of all modes.
    pub limits: Limits,
    /// Default profile, whose values are replaced by nonzero values of a frame.
    pub profile: Profile,
    /// Following error window and time-out (6065h, 6066h).
    pub following_error: Window,
    /// Position window and time (6067h, 6068h).
    pub position: Window,
    /// Velocity window and time (606Dh, 606Eh).
    pub velocity: Window,
    /// Velocity threshold and time of standstill (606Fh, 6070h).
    pub standstill: Window,
    /// Homing of the drive; the home offset comes with the frame.
    pub homing: homing::Params,
    /// Interpolation between points of the buffer (60C0h).
    pub sub_mode: SubMode,
    /// Default time of a segment between two points (60C2h).
    pub segment: TimePeriod,
    /// True if limit and home switches are wired normally closed: a switch is then met when its input is open.
    pub reverse_switches: bool,
}

/// Limits of all modes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Velocity of any demand (6080h); may be infinite.
    pub velocity: f64,
    /// Velocity of a profile (607Fh); may be infinite.
    pub profile_velocity: f64,
    /// Acceleration of a profile (60C5h); may be infinite.
    pub acceleration: f64,
    /// Deceleration of a profile (60C6h); may be infinite.
    pub deceleration: f64,
    /// Effort of the loops in any mode (the lower of 6072h and 60E0h or 60E1h).
    pub effort: EffortLimits,
    /// Lowest and highest position (607Dh); `None` without software limits.
    pub position: Option<[f64; 2]>,
}

/// Profile of the drive's own motions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Profile {
    /// 6081h.
    pub velocity: f64,
    /// 6083h.
    pub acceleration: f64,
    /// 6084h.
    pub deceleration: f64,
    /// 6085h.
    pub quick_stop_deceleration: f64,
    /// Motion profile type (6086h).
    pub ramp: Ramp,
    /// Velocity at which a target position is passed (6082h); zero to stop there.
    pub end_velocity: f64,
    /// Torque slope (6087h; N·m/s or N/s); infinite for steps.
    pub effort_slope: f64,
}

impl Default for Params {
    /// A linear axis of 1 µm per increment and per unit under a position loop of 4 kHz and frames of 1 kHz, without limits.
    fn default() -> Self {
        let millionth = Ratio::new(1, 1_000_000).map(AxisUnit::Metre);
        let units = millionth.and_then(|unit| Units::new(&FactorGroup::default(), unit, 1.0));
        Self {
            period: 250e-6,
            cycle: cycle::Params { steps: 4, shift: 0, bridged: 2 },
            interpolation: interpolate::Mode::Linear,
            power: PowerParams::default(),
            units: units.expect("ratios of ones and a million are in range"),
            counter: Counter::signed(32).expect("a width from 8 to 64"),
            rotary: Rotary::default(),
            limits: Limits {
                velocity: f64::INFINITY,
                profile_velocity: f64::INFINITY,
                acceleration: f64::INFINITY,
                deceleration: f64::INFINITY,
                effort: EffortLimits::NONE,
                position: None,
            },
            profile: Profile {
                velocity: 0.1,
                acceleration: 1.0,
                deceleration: 1.0,
                quick_stop_deceleration: 10.0,
                ramp: Ramp::Linear,
                end_velocity: 0.0,
                effort_slope: f64::INFINITY,
            },
            following_error: Window { width: f64::INFINITY, time: 0.0 },
            position: Window { width: 1e-5, time: 0.01 },
            velocity: Window { width: 1e-3, time: 0.01 },
            standstill: Window { width: 1e-3, time: 0.01 },
            homing: homing::Params {
                method: homing::Method::from_number(35).expect("a method of the profile"),
                switch_speed: 0.05,
                zero_speed: 0.005,
                acceleration: 1.0,
                jerk: None,
                home_offset: 0.0,
            },
            sub_mode: SubMode::LinearAdapted,
            segment: TimePeriod::new(1, -3).expect("a millisecond is in range"),
            reverse_switches: false,
        }
    }
}

impl Params {
    /// # Errors
    /// [`ParamError`] names the first setting out of its bound, by the name of its object.
    pub fn check(&self) -> Result<(), ParamError> {
        positive("period", self.period)?;
        positive("interpolation_time_period", f64::from(self.cycle.steps))?;
        self.units.check()?;
        self.check_rotary()?;
        self.cyclic_position().check()?;
        let Limits {
            velocity,
            profile_velocity,
            acceleration,
            deceleration,
            effort: EffortLimits { forward, backward },
            position,
        } = self.limits;
        limit("max_motor_speed", velocity)?;
        limit("max_profile_velocity", profile_velocity)?;
        limit("max_acceleration", acceleration)?;
        limit("max_deceleration", deceleration)?;
        limit("positive_torque_limit", forward)?;
        limit("negative_torque_limit", backward)?;
        if let Some([lowest, highest]) = position
            && lowest.partial_cmp(&highest) != Some(Ordering::Less)
        {
            let bound = "above the lowest one";
            return Err(ParamError { name: "software_position_limit.max", value: highest, bound });
        }
        positive("profile_velocity", self.profile.velocity)?;
        positive("profile_acceleration", self.profile.acceleration)?;
        positive("profile_deceleration", self.profile.deceleration)?;
        positive("quick_stop_deceleration", self.profile.quick_stop_deceleration)?;
        limit("torque_slope", self.profile.effort_slope)?;
        self.profile_position().check()?;
        self.homing.check()?;
        self.following_error.check(["following_error_window", "following_error_time_out"])?;
        self.position.check(["position_window", "position_window_time"])?;
        self.velocity.check(["velocity_window", "velocity_window_time"])?;
        self.standstill.check(["velocity_threshold", "velocity_threshold_time"])
    }

    /// Highest velocity of a profile.
    pub(super) const fn profile_limit(&self) -> f64 {
        self.limits.profile_velocity.min(self.limits.velocity)
    }

    pub(super) fn profile_position(&self) -> profile::position::Params {
        profile::position::Params {
            ramp: self.profile.ramp,
            end_velocity: self.profile.end_velocity,
            window: self.position,
            range: self.limits.position,
            turn: self.turn(),
        }
    }

    pub(super) const fn profile_velocity(&self) -> profile::velocity::Params {
        profile::velocity::Params {
            ramp: self.profile.ramp,
            limit: self.profile_limit(),
            window: self.velocity,
            threshold: self.standstill,
        }
    }

    pub(super) const fn profile_effort(&self) -> profile::effort::Params {
        profile::effort::Params { slope: self.profile.effort_slope }
    }

    pub(super) const fn homing(&self, now: &Moment) -> homing::Params {
        homing::Params { home_offset: now.targets.home_offset, ..self.homing }
    }

    pub(super) fn interpolated(&self) -> interpolated::Params {
        let jerk = match self.profile.ramp {
            Ramp::Linear => None,
            Ramp::JerkLimited(jerk) => Some(jerk),
        };
        interpolated::Params {
            sub_mode: self.sub_mode,
            period: self.segment,
            count: self.units.from_position(1),
            stop: Steepness { acceleration: self.profile.quick_stop_deceleration, jerk },
            velocity: self.limits.velocity,
        }
    }

    pub(super) const fn cyclic_position(&self) -> cyclic::position::Params {
        cyclic::position::Params {
            interpolation: self.interpolation,
            steps: self.cycle.steps,
            velocity: self.limits.velocity,
        }
    }

    pub(super) const fn cyclic_velocity(&self) -> cyclic::velocity::Params {
        cyclic::velocity::Params { steps: self.cycle.steps, velocity: self.limits.velocity }
    }

    pub(super) const fn cyclic_effort(&self) -> cyclic::effort::Params {
        cyclic::effort::Params { steps: self.cycle.steps }
    }
}
