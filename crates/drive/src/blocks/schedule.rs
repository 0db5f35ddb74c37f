//! Gains over speed: constant up to one speed and from another one on, with linear interpolation between them.
//!
//! ```text
//! s = sat((|ω| − ω_1)/(ω_2 − ω_1), 0…1)      K_v(ω) = K_v·(1 + s·(f_p − 1))      k_p(ω) = k_p·(1 + s·(f_v − 1))
//! ```
//! ω is the measured velocity of the velocity loop. The integrator holds an effort and keeps it while the gain changes.
//! Source: Åström & Wittenmark, *Adaptive Control*, 2nd ed., ch. 9 (gain scheduling).
use servobench_config::Kind::{Motor, Plain};
use servobench_config::quantities::{RATIO, VELOCITY};
use servobench_config::{ParameterError, not_negative, positive};

servobench_config::parameters! {
    /// A parameter of the gain schedule.
    pub enum Parameter {
        /// Speed of the motor up to which the gains are those of standstill
        FROM "speed from which gains change" = not_negative(Motor(&VELOCITY), "10 rpm");
        /// Speed of the motor from which the gains are those at speed
        TO "speed to which gains change" = positive(Motor(&VELOCITY), "100 rpm");
        /// Gain of the position loop at speed, as a multiple of that at standstill
        POSITION "factor of the position gain" = positive(Plain(&RATIO), "0.5");
        /// Gain of the velocity loop at speed, as a multiple of that at standstill
        VELOCITY_GAIN "factor of the velocity gain" = positive(Plain(&RATIO), "0.5");
    }
}

/// Parameters; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Speed ω_1 of the motor (rad/s or m/s).
    pub from: f64,
    /// Speed ω_2 of the motor (rad/s or m/s).
    pub to: f64,
    /// Factor f_p of the position gain.
    pub position: f64,
    /// Factor f_v of the velocity gain.
    pub velocity: f64,
}

impl Params {
    /// # Errors
    /// [`ParameterError`] names the first parameter out of its bound.
    pub fn check(&self) -> Result<(), ParameterError> {
        Parameter::FROM.check(self.from)?;
        Parameter::TO.check(self.to)?;
        if self.to <= self.from {
            let bound = "above the one from which they change";
            return Err(ParameterError { name: Parameter::TO, value: self.to, bound });
        }
        Parameter::POSITION.check(self.position)?;
        Parameter::VELOCITY_GAIN.check(self.velocity).map(|_| ())
    }

    /// Factors of position and velocity gain at the motor's `velocity`.
    #[must_use]
    pub fn factors(&self, velocity: f64) -> (f64, f64) {
        let share = ((velocity.abs() - self.from) / (self.to - self.from)).clamp(0.0, 1.0);
        (1.0 + share * (self.position - 1.0), 1.0 + share * (self.velocity - 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const P: Params = Params { from: 3.0, to: 8.0, position: 0.4, velocity: 1.7 };

    /// Oracle: by hand: 4.5 rad/s are at three tenths of the range.
    #[test]
    fn between_two_speeds_is_a_line() {
        for (velocity, position, gain) in [(0.0, 1.0, 1.0), (-3.0, 1.0, 1.0), (4.5, 0.82, 1.21), (-90.0, 0.4, 1.7)] {
            let found = P.factors(velocity);
            assert!((found.0 - position).abs() < 1e-15 && (found.1 - gain).abs() < 1e-15, "{velocity}: {found:?}");
        }
    }

    #[test]
    fn the_second_speed_is_above_the_first() {
        assert_eq!(P.check(), Ok(()));
        let said = Params { to: 3.0, ..P }.check().unwrap_err().to_string();
        assert_eq!(said, "`speed to which gains change` must be above the one from which they change, got 3");
    }
}
