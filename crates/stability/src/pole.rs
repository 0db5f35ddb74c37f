//! A pole in continuous time: growth and frequency, derived from the base ticks.
//!
//! Over a period of N ticks λ gives the growth ln|λ|/(N·h), but the angle only up to whole turns: with a loop of 4 kHz a mode at
//! 2.65 kHz looks like one at 1.35 kHz. The eigenvector resolves this. From tick to tick, p_k, with the growth removed, it turns by
//!
//! ```text
//! φ = arg Σ_k ⟨p_k, p_{k+1}⟩                      of a pair of poles
//! cos φ = Σ_k ⟨p_k, p_{k+1}⟩ / Σ_k |p_k|²         of a real pole, whose eigenvector swings without turning
//! ```
//! per tick on average, and the branch of arg λ is the one nearest to N·φ. ⟨ ⟩ is the kinetic energy, or if nothing moves
//! the currents. Frequencies above half the base rate are folded there: the run itself cannot resolve them.
use crate::eigen::Eigenvalue;
use crate::equations::Equations;
use crate::period::{ComplexVector, Period};
use nalgebra::Complex;
use std::f64::consts::TAU;

/// A pole of the loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pole {
    /// |λ| over the common period of the loops.
    pub magnitude: f64,
    /// The common period (s).
    pub period: f64,
    /// Growth (1/s): ln|λ|/period; negative if it decays.
    pub growth: f64,
    /// Frequency (Hz).
    pub frequency: f64,
}

impl Pole {
    /// A pair of poles with less damping than this, 1/√2, has a resonance peak: its oscillation is visible.
    pub const RESONANT: f64 = std::f64::consts::FRAC_1_SQRT_2;

    /// Damping ratio of a second-order system with this growth and frequency; negative if it grows.
    #[must_use]
    pub fn damping(&self) -> f64 {
        let omega = TAU * self.frequency;
        let natural = self.growth.hypot(omega);
        if natural == 0.0 { 0.0 } else { -self.growth / natural }
    }

    /// True if its oscillation is visible.
    #[must_use]
    pub fn oscillates(&self) -> bool {
        self.damping() < Self::RESONANT
    }

    pub(crate) fn new(period: &Period, equations: &Equations, eigenvalue: &Eigenvalue) -> Self {
        let seconds = period.seconds();
        let magnitude = eigenvalue.value.norm();
        let ticks = (eigenvalue.states.len() - 1) as f64;
        let turn = nearest_branch(eigenvalue.value, ticks * turn_per_tick(equations, eigenvalue));
        Self { magnitude, period: seconds, growth: magnitude.ln() / seconds, frequency: turn.abs() / (TAU * seconds) }
    }
}

/// The angle of `value` on the branch nearest to `turn`.
fn nearest_branch(value: Complex<f64>, turn: f64) -> f64 {
    value.arg() + TAU * ((turn - value.arg()) / TAU).round()
}

fn turn_per_tick(equations: &Equations, eigenvalue: &Eigenvalue) -> f64 {
    let weights = weights(equations, &eigenvalue.states);
    let ticks = (eigenvalue.states.len() - 1) as f64;
    let growth = eigenvalue.value.norm().powf(1.0 / ticks);
    let (mut turned, mut energy, mut scale) = (Complex::<f64>::default(), 0.0_f64, 1.0);
    for pair in eigenvalue.states.windows(2) {
        let next = scale / growth;
        for ((from, to), weight) in pair[0].iter().zip(pair[1].iter()).zip(&weights) {
            turned += from.conj() * to * (weight * scale * next);
            energy += weight * ((scale * from).norm_sqr() + (next * to).norm_sqr()) / 2.0;
        }
        scale = next;
    }
    if energy == 0.0 {
        return 0.0;
    }
    if eigenvalue.value.im == 0.0 { (turned.re / energy).clamp(-1.0, 1.0).acos() } else { turned.arg() }
}

/// Inertia of each velocity, or 1 for each current if no body moves.
fn weights(equations: &Equations, states: &[ComplexVector]) -> Vec<f64> {
    let mut weights = vec![0.0; equations.states()];
    for (index, share) in equations.velocities().zip(equations.model().mechanics.energies()) {
        weights[index] = share;
    }
    let moves =
        states.iter().any(|state| state.iter().zip(&weights).any(|(entry, weight)| weight * entry.norm() > 0.0));
    if !moves {
        equations.currents().into_iter().flatten().for_each(|index| weights[index] = 1.0);
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Oracle: by hand, 2.65 kHz at 4 kHz: 0.6625 of a turn, which is −0.3375 of one.
    #[test]
    fn the_branch_is_the_one_next_to_what_the_ticks_turn() {
        let folded = Complex::from_polar(0.97, -0.3375 * TAU);
        for estimate in [0.6, 0.7, 0.9] {
            assert!((nearest_branch(folded, estimate * TAU) - 0.6625 * TAU).abs() < 1e-12, "{estimate}");
        }
        assert!((nearest_branch(Complex::new(-1.1, 0.0), 2.5 * PI) - 3.0 * PI).abs() < 1e-12);
    }

    /// Oracle: by hand: s = −σ ± iω has the damping σ/|s|.
    #[test]
    fn damping_is_decay_over_natural_frequency() {
        let pole = Pole { magnitude: 0.5, period: 1.0, growth: -3.0, frequency: 4.0 / TAU };
        assert!((pole.damping() - 0.6).abs() < 1e-15);
        assert!((Pole { growth: 3.0, ..pole }.damping() + 0.6).abs() < 1e-15);
        assert!((Pole { growth: 0.0, frequency: 0.0, ..pole }.damping()).abs() < 1e-15);
    }
}
