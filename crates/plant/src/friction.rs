//! Dry friction between a body and the ground: Coulomb, static (Stribeck), and sticking that really sticks.
//!
//! ```text
//! |f|(v) = f_c + (f_s − f_c)·exp(−(v/v_s)²)      sliding, against the motion
//! stuck while |effort of everything else| ≤ f_s; a stuck body keeps its position to the bit
//! ```
//! Source: Armstrong-Hélouvry, Dupont, Canudas de Wit, *Automatica* 30(7), 1994, eq. (4). Viscous friction is linear
//! and belongs to the mechanics.
//!
//! The engine asks [`DryFriction::grip`] before each tick: a held body is locked for the tick, a sliding one gets a
//! constant force. After the tick it tells [`DryFriction::settle`] the new velocity; when that reversed, the body
//! came to rest within the tick and is stopped there. The crossing itself is met to first order in the step.
use servobench_base::{ParamError, non_negative};

/// Parameters of dry friction; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DryFriction {
    /// Coulomb friction, `f_c` (N or N·m).
    pub coulomb: f64,
    /// Static friction (breakaway), `f_s`, at least `f_c` (N or N·m).
    pub breakaway: f64,
    /// Stribeck velocity, `v_s` (m/s or rad/s); zero: the step from `f_s` to `f_c` is immediate.
    pub stribeck_velocity: f64,
}

/// What friction does to a body during one tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Grip {
    /// Holds it: neither position nor velocity changes.
    Held,
    /// Acts with this force (N or N·m), constant over the tick.
    Force(f64),
}

impl DryFriction {
    /// No dry friction.
    pub const NONE: Self = Self { coulomb: 0.0, breakaway: 0.0, stribeck_velocity: 0.0 };

    /// # Errors
    /// [`ParamError`] names the first parameter out of its bound.
    pub fn check(&self) -> Result<(), ParamError> {
        non_negative("coulomb", self.coulomb)?;
        non_negative("stribeck_velocity", self.stribeck_velocity)?;
        if !(self.breakaway.is_finite() && self.breakaway >= self.coulomb) {
            return Err(ParamError { name: "static", value: self.breakaway, bound: "finite and at least `coulomb`" });
        }
        Ok(())
    }

    /// Whether there is any.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.breakaway == 0.0
    }

    /// Magnitude of the sliding friction at `velocity` (N or N·m).
    #[must_use]
    pub fn sliding(&self, velocity: f64) -> f64 {
        if self.stribeck_velocity == 0.0 {
            return self.coulomb;
        }
        let ratio = velocity / self.stribeck_velocity;
        self.coulomb + (self.breakaway - self.coulomb) * libm::exp(-ratio * ratio)
    }

    /// What friction does in the coming tick, given the velocity and the effort of everything else at its start.
    #[must_use]
    pub fn grip(&self, velocity: f64, effort: f64) -> Grip {
        if self.is_none() {
            Grip::Force(0.0)
        } else if velocity != 0.0 {
            Grip::Force(-self.sliding(velocity).copysign(velocity))
        } else if effort.abs() <= self.breakaway {
            Grip::Held
        } else {
            Grip::Force(-self.sliding(0.0).copysign(effort))
        }
    }

    /// Whether a body that slid with `before` and arrived with `after` came to rest within the tick; its velocity is
    /// then to be set to zero.
    #[must_use]
    pub fn settle(&self, before: f64, after: f64) -> bool {
        !self.is_none() && before * after < 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DRY: DryFriction = DryFriction { coulomb: 2.0, breakaway: 3.0, stribeck_velocity: 0.1 };

    #[test]
    fn stribeck_curve_runs_from_static_to_coulomb() {
        assert!((DRY.sliding(0.0) - 3.0).abs() < 1e-15);
        assert!((DRY.sliding(0.1) - (2.0 + (-1.0_f64).exp())).abs() < 1e-15);
        assert!((DRY.sliding(-1.0) - 2.0).abs() < 1e-15, "exp(-100) is below the last bit of 2");
    }

    #[test]
    fn a_body_at_rest_is_held_until_the_breakaway_force() {
        assert_eq!(DRY.grip(0.0, 3.0), Grip::Held);
        assert_eq!(DRY.grip(0.0, -3.1), Grip::Force(3.0));
    }

    #[test]
    fn friction_never_reverses_a_motion() {
        assert!(DRY.settle(0.1, -0.2));
        assert!(!DRY.settle(0.0, 0.2), "a body that broke away goes on");
        assert!(!DryFriction::NONE.settle(0.1, -0.2));
    }

    #[test]
    fn static_below_coulomb_is_refused() {
        let e = DryFriction { breakaway: 1.0, ..DRY }.check().unwrap_err();
        assert_eq!(e.name, "static");
    }
}
