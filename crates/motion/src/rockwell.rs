//! The two profiles of Rockwell's Motion Axis Move: trapezoid and S-curve, with its forms of jerk.
//!
//! Velocity rises to the speed within the acceleration and its jerk, and falls within the deceleration and its own:
//!
//! ```text
//! v ≥ A²/J:  t_j = A/J,     t_a = v/A − A/J        lasting  v/A + A/J
//! v < A²/J:  t_j = √(v/J),  t_a = 0                lasting  2·√(v/J)
//! ```
//! in both cases over v/2 times its length. Jerk "in % of time" is the part of the ramp in which the acceleration changes, half
//! of it at each end: with t_a + 2·t_j = v/A + A/J and 2·t_j = %/100 of it, J = (A²/V)·(200/% − 1), where V is the requested
//! speed. It stays that when the distance is too short for this speed. A trapezoid uses the full jerk for which the axis
//! is configured.
//!
//! Jerk as a time t_j is J = A/t_j. The ramp to V lasts V/A + t_j then, of which t_j is half at most: for t_j > V/A it is V/A. A move
//! driven by a master is in master units instead of seconds: t_j = distance/speed of the master.
//!
//! Source: Rockwell Automation, *Logix5000 Controllers Motion Instructions*, MOTION-RM002, "Motion Axis Move" and "Time based
//! planning"; the distances that K. T. Erickson, *Programmable Logic Controllers*, §3.2.3.1, prints for its examples are not those of its
//! profiles.
use crate::limits::in_range;
use crate::online::Stretch;
use crate::root::increasing;
use crate::{Order, PlanError, Trajectory};
use servobench_base::{ParamError, Setpoint, Stateful, finite, positive};

/// Jerk of a move, in one of its forms.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub enum Jerk {
    /// As a value (m/s³ or rad/s³).
    Value(f64),
    /// As a share of the jerk for which the axis is configured (%, above 0 to 100).
    PercentOfMaximum(f64),
    /// As the share of the ramp in which the acceleration changes (%, above 0 to 100).
    PercentOfTime(f64),
    /// As the time in which the acceleration rises at the beginning of the ramp, and falls at its end (s). A time of more than half a ramp
    /// counts as half of it.
    Time(f64),
    /// The same in units of a master.
    MasterUnits {
        /// Distance of the master while the acceleration rises, or falls (master units).
        way: f64,
        /// Speed of the master (master units per second).
        speed: f64,
    },
}

servobench_config::choices! {
    /// Shape of the velocity over time.
    #[derive(Stateful)]
    pub enum Shape named ShapeKind {
        /// acceleration as rectangular as `maximum_jerk` allows
        Trapezoid = "trapezoid",
        /// acceleration with a separately given jerk
        SCurve {
            /// Jerk of the acceleration.
            acceleration: Jerk,
            /// Jerk of the deceleration.
            deceleration: Jerk,
        } = "s-curve",
    }
}

/// Operands of a move, in the axis unit (m or rad).
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Move {
    /// Distance; its sign is the direction.
    pub distance: f64,
    /// Speed (m/s or rad/s).
    pub speed: f64,
    /// Acceleration (m/s² or rad/s²).
    pub acceleration: f64,
    /// Deceleration (m/s² or rad/s²).
    pub deceleration: f64,
    /// Shape.
    pub shape: Shape,
}

/// Largest jerk for which an axis is configured (m/s³ or rad/s³).
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct MaximumJerk {
    /// For accelerations.
    pub acceleration: f64,
    /// For decelerations.
    pub deceleration: f64,
}

/// One ramp between rest and a speed.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Ramp {
    acceleration: f64,
    jerk: f64,
}

impl Move {
    /// Plans the move.
    ///
    /// # Errors
    /// [`PlanError`] when the distance is not finite, or another operand not positive, above 100 % where it is a part, or
    /// outside 1e-30 … 1e30 (SI).
    pub fn plan(&self, maximum: &MaximumJerk) -> Result<Trajectory<7>, PlanError> {
        let (speed, [up, down]) = (checked("speed", self.speed)?, self.ramps(maximum)?);

        let distance = finite("distance", self.distance)? + 0.0;
        if distance == 0.0 {
            return Ok(Trajectory::new(Order::Third, Setpoint::default(), [], |_| Setpoint::default()));
        }
        let length = in_range("distance", distance, "correct its unit, or request a distance of 0")?.abs();
        let ramps = |v: f64| 0.5 * v * (up.duration(v) + down.duration(v));
        let peak = if ramps(speed) <= length {
            speed
        } else {
            // A ramp lasts v/A and 2·√(v/J) at least and both together at most. So does the length: v is within a factor of
            // 2^(2/3) of the smaller of two bounds.
            let by_acceleration = libm::sqrt(2.0 * length / (1.0 / up.acceleration + 1.0 / down.acceleration));
            let by_jerk = libm::cbrt(length / (1.0 / libm::sqrt(up.jerk) + 1.0 / libm::sqrt(down.jerk)));
            let highest = speed.min(by_acceleration).min(by_jerk * by_jerk);
            increasing(0.5 * highest, highest, |v| ramps(v) - length)
        };
        let cruise = ((length - ramps(peak)) / peak).max(0.0);
        let sign = distance.signum();
        let ([j_1, a_1], [j_2, a_2]) = (up.times(peak), down.times(peak));
        let stretches = [
            Stretch { value: sign * up.jerk, length: j_1, zeros: 0 },
            Stretch { value: sign * up.jerk * j_1, length: a_1, zeros: 1 },
            Stretch { value: -sign * up.jerk, length: j_1, zeros: 0 },
            Stretch { value: sign * peak, length: cruise, zeros: 2 },
            Stretch { value: -sign * down.jerk, length: j_2, zeros: 0 },
            Stretch { value: -sign * down.jerk * j_2, length: a_2, zeros: 1 },
            Stretch { value: sign * down.jerk, length: j_2, zeros: 0 },
        ];
        Ok(Trajectory::new(Order::Third, Setpoint::default(), stretches, |_| Setpoint::at_rest(distance)))
    }
}

impl Move {
    /// The jerk of the acceleration and that of the deceleration (m/s³ or rad/s³).
    ///
    /// # Errors
    /// As [`plan`](Self::plan).
    pub fn jerks(&self, maximum: &MaximumJerk) -> Result<[f64; 2], PlanError> {
        Ok(self.ramps(maximum)?.map(|ramp| ramp.jerk))
    }

    /// The ramps up and down.
    fn ramps(&self, maximum: &MaximumJerk) -> Result<[Ramp; 2], PlanError> {
        let speed = checked("speed", self.speed)?;
        let (said_up, said_down) = match self.shape {
            Shape::Trapezoid => (Jerk::PercentOfMaximum(100.0), Jerk::PercentOfMaximum(100.0)),
            Shape::SCurve { acceleration, deceleration } => (acceleration, deceleration),
        };
        let ramp = |acceleration: f64, said: Jerk, maximum: f64| -> Result<Ramp, PlanError> {
            Ok(Ramp { acceleration, jerk: checked("jerk", said.value(acceleration, speed, maximum)?)? })
        };
        Ok([
            ramp(checked("acceleration", self.acceleration)?, said_up, maximum.acceleration)?,
            ramp(checked("deceleration", self.deceleration)?, said_down, maximum.deceleration)?,
        ])
    }
}

impl Jerk {
    /// The jerk (m/s³ or rad/s³) of a ramp with `acceleration` to `speed` on an axis configured for `maximum`.
    ///
    /// # Errors
    /// [`PlanError`] when a part is not above 0 and at most 100 %.
    pub fn value(self, acceleration: f64, speed: f64, maximum: f64) -> Result<f64, PlanError> {
        let part = |name: &'static str, percent: f64| {
            if percent > 0.0 && percent <= 100.0 {
                Ok(percent)
            } else {
                Err(PlanError::from(ParamError { name, value: percent, bound: "above 0 % and at most 100 %" }))
            }
        };
        match self {
            Self::Value(jerk) => Ok(jerk),
            Self::PercentOfMaximum(percent) => Ok(maximum * (part("jerk_percent_of_maximum", percent)? / 100.0)),
            Self::PercentOfTime(percent) => {
                let percent = part("jerk_percent_of_time", percent)?;
                Ok(acceleration * acceleration / speed * (200.0 / percent - 1.0))
            }
            Self::Time(time) => Ok(acceleration / checked("jerk_time", time)?.min(speed / acceleration)),
            Self::MasterUnits { way, speed: master } => {
                let time = checked("jerk_master_units", way)? / checked("master_speed", master)?;
                Self::Time(time).value(acceleration, speed, maximum)
            }
        }
    }
}

impl Ramp {
    /// Lengths of the jerk and of the constant acceleration up to `v` (s).
    fn times(&self, v: f64) -> [f64; 2] {
        let whole = self.acceleration / self.jerk;
        let constant = v / self.acceleration - whole;
        // A remainder of rounding does not count: 100 % of time leaves no constant acceleration.
        if constant > 1e-12 * whole { [whole, constant] } else { [libm::sqrt(v / self.jerk), 0.0] }
    }

    fn duration(&self, v: f64) -> f64 {
        let [jerk, constant] = self.times(v);
        2.0 * jerk + constant
    }
}

fn checked(name: &'static str, value: f64) -> Result<f64, PlanError> {
    in_range(name, positive(name, value)?, "correct its unit")
}
