//! Compensation of cogging: subtracts the effort of the motor's teeth and magnets, given by harmonics of its position.
//!
//! ```text
//! τ_c = −Σ_k A_k·sin(n_k·(θ + t_a·ω) + φ_k)          t_a: delay until the effort acts
//! ```
//! with the harmonics of the cogging itself, Σ_k A_k·sin(n_k·θ + φ_k) in the direction of the motor. θ is the measured position, n_k counts
//! periods in a revolution of the motor, of a linear motor in two pole pitches.
//! Source: Hanselman, *Brushless Permanent Magnet Motor Design*, 2nd ed., ch. 7 (periods of cogging); the lead by hand: at constant speed,
//! a sine of the position lags as much as the position.
use servobench_config::Kind::{Motor, Plain};
use servobench_config::quantities::{EFFORT, POSITION};
use servobench_config::{ParameterError, any, positive};

servobench_config::parameters! {
    /// A parameter of the cogging compensation.
    pub enum Parameter {
        /// Amplitude of the harmonic
        AMPLITUDE "amplitude of the cogging that is compensated" = positive(Motor(&EFFORT), "0.05 Nm");
        /// Angle φ of the harmonic where the motor's position is 0
        PHASE "phase of the cogging that is compensated" = any(Plain(&POSITION.rotary), "30 deg");
    }
}

/// Most harmonics.
pub const MOST: usize = 8;

/// A harmonic of the cogging.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Harmonic {
    /// Angle of the harmonic per position of the motor (rad/rad or rad/m).
    pub ratio: f64,
    /// Amplitude A (N·m or N).
    pub amplitude: f64,
    /// Phase φ (rad).
    pub phase: f64,
}

/// Harmonics of the cogging; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Params {
    harmonics: [Harmonic; MOST],
    count: usize,
    /// Delay until the effort acts (s).
    lead: f64,
}

impl Params {
    /// Parameters for these harmonics and an effort that takes `lead` (s) to act.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter out of its bound.
    ///
    /// # Panics
    /// With more than [`MOST`] harmonics.
    pub fn new(harmonics: &[Harmonic], lead: f64) -> Result<Self, ParameterError> {
        assert!(harmonics.len() <= MOST, "{MOST} harmonics at most");
        let mut params = Self { count: harmonics.len(), lead, ..Self::default() };
        for (place, harmonic) in params.harmonics.iter_mut().zip(harmonics) {
            Parameter::AMPLITUDE.check(harmonic.amplitude)?;
            Parameter::PHASE.check(harmonic.phase)?;
            *place = *harmonic;
        }
        Ok(params)
    }

    /// Assumed delay until the effort acts (s).
    #[must_use]
    pub const fn lead(&self) -> f64 {
        self.lead
    }

    /// Effort that cancels the cogging at the measured `position` and `velocity` of the motor (N·m or N).
    #[must_use]
    pub fn effort(&self, position: f64, velocity: f64) -> f64 {
        let ahead = position + self.lead * velocity;
        let of = |harmonic: &Harmonic| harmonic.amplitude * libm::sin(harmonic.ratio * ahead + harmonic.phase);
        -self.harmonics[..self.count].iter().map(of).sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEETH: [Harmonic; 2] = [
        Harmonic { ratio: 12.0, amplitude: 0.043, phase: 0.61 },
        Harmonic { ratio: 36.0, amplitude: 0.011, phase: -1.9 },
    ];

    /// Oracle: the cogging itself, at the position of the motor when the effort acts.
    #[test]
    fn it_is_the_cogging_of_a_while_later_turned_round() {
        let (p, velocity) = (Params::new(&TEETH, 0.37e-3).unwrap(), 31.7);
        for position in [0.0, 0.123, -4.56, 77.7] {
            let then: f64 = position + 0.37e-3 * velocity;
            let cogging = 0.043 * (12.0 * then + 0.61).sin() + 0.011 * (36.0 * then - 1.9).sin();
            assert!((p.effort(position, velocity) + cogging).abs() < 1e-15, "{position}");
        }
    }

    #[test]
    fn errors_name_the_parameter() {
        let none = Harmonic { amplitude: 0.0, ..TEETH[0] };
        let said = Params::new(&[TEETH[1], none], 0.0).unwrap_err().to_string();
        assert!(
            said.starts_with("`amplitude of the cogging that is compensated` must be finite and positive"),
            "{said}"
        );
    }
}
