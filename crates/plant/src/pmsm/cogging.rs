//! Cogging: the magnets pull the teeth, with or without current.
//!
//! ```text
//! F(x) = Σ F_n·sin(κ_n·x + φ_n)            κ_n = order of the harmonic per motor coordinate
//! mean over x … x + Δ:   F_n·sin(κ_n·(x + Δ/2) + φ_n)·sin(κ_n·Δ/2)/(κ_n·Δ/2)
//! ```
//! The mean is that of the energy of the magnets, −ΔW/Δ, and exact at constant speed however many teeth pass in a tick. So the
//! cogging does no work over a revolution. Orders: least common multiple of slots and poles and its multiples for an ideal motor,
//! slots or poles alone for a real one (Hanselman, *Brushless Permanent Magnet Motor Design*, 2nd ed.).
use servobench_base::ParamError;
use servobench_config::Kind::{Motor, Plain};
use servobench_config::quantities::{EFFORT, PHASE};
use servobench_config::{any, not_negative};

servobench_config::parameters! {
    /// A parameter of the cogging.
    pub enum CoggingParameter {
        /// Largest torque or force of this harmonic
        AMPLITUDE "cogging amplitude" = not_negative(Motor(&EFFORT), "20 mNm");
        /// Angle φ of this harmonic at the zero of the motor coordinate: F·sin(n·x + φ)
        PHASE "cogging phase" = any(Plain(&PHASE), "30 deg");
    }
}

/// One harmonic of the cogging.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cogging {
    /// Angle of the harmonic per motor coordinate: its order per revolution (rad/rad), or 2π over its period for a linear motor (rad/m).
    pub ratio: f64,
    /// Its amplitude (N·m or N).
    pub amplitude: f64,
    /// Its angle at the zero of the motor coordinate (rad).
    pub phase: f64,
}

impl Cogging {
    /// # Errors
    /// [`ParamError`] names the first parameter that is out of its bound.
    pub fn check(&self) -> Result<(), ParamError> {
        servobench_base::positive("cogging order", self.ratio)?;
        CoggingParameter::AMPLITUDE.check_in_words(self.amplitude)?;
        CoggingParameter::PHASE.check_in_words(self.phase)?;
        Ok(())
    }

    /// Mean effort (N·m or N) over a motion by `travel` from `position` (motor coordinate).
    #[must_use]
    pub fn mean_effort(&self, position: f64, travel: f64) -> f64 {
        let half = self.ratio * travel / 2.0;
        let middle = libm::sin(self.ratio * position + half + self.phase);
        let shortened = if half == 0.0 { 1.0 } else { libm::sin(half) / half };
        self.amplitude * middle * shortened
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    const OF_A_MOTOR: [Cogging; 2] = [
        Cogging { ratio: 36.0, amplitude: 0.031, phase: 0.4 },
        Cogging { ratio: 72.0, amplitude: 0.0073, phase: -1.1 },
    ];

    fn mean(position: f64, travel: f64) -> f64 {
        OF_A_MOTOR.iter().map(|one| one.mean_effort(position, travel)).sum()
    }

    /// Oracle: the integral of the sine by Simpson's rule with 2000 intervals, which leaves out (κ·Δ/2000)⁴/180 < 4e-8 of the amplitude.
    #[test]
    fn the_mean_is_that_of_the_effort_on_the_way() {
        let at = |x: f64| 0.031 * (36.0 * x + 0.4).sin() + 0.0073 * (72.0 * x - 1.1).sin();
        for (position, travel) in [(0.13, 0.0), (-2.7, 1e-9), (0.3, 0.0171), (0.91, -0.37), (41.0, 2.3)] {
            let n = 2_000;
            let weight = |k: i32| f64::from(if k == 0 || k == n { 1 } else { 2 + 2 * (k % 2) });
            let sum: f64 = (0..=n).map(|k| weight(k) * at(position + travel * f64::from(k) / f64::from(n))).sum();
            let expected = sum / (3.0 * f64::from(n));
            assert!((mean(position, travel) - expected).abs() < 4e-8 * 0.038, "{position} {travel}");
        }
    }

    /// Over a revolution, in ticks that divide neither it nor a tooth, the work is zero except for the rounding of its parts.
    #[test]
    fn a_revolution_costs_no_energy() {
        for ticks in [7, 101, 1_999] {
            let (mut work, mut turned) = (0.0, 0.0);
            for k in 0..ticks {
                let travel = TAU / f64::from(ticks);
                let position = 0.77 + travel * f64::from(k);
                let energy = mean(position, travel) * travel;
                (work, turned) = (work + energy, turned + energy.abs());
            }
            assert!(work.abs() < 1e-13 * turned.max(0.01), "{ticks}: {work} J of {turned} J");
        }
    }
}
