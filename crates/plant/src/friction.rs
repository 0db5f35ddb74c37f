//! Friction between a body and the ground: viscous, Coulomb, static (Stribeck), and sticking that really sticks.
//!
//! ```text
//! f(v) = b·v + sgn(v)·(f_c + (f_s − f_c)·exp(−(v/v_s)²))      sliding, against the motion
//! stuck while |effort of everything else| ≤ f_s; a stuck body keeps its position bit for bit
//! ```
//! Source: Armstrong-Hélouvry, Dupont, Canudas de Wit, *Automatica* 30(7), 1994, eq. (4).
//!
//! [`Friction`] is the whole interface for engines, previews and estimates. The part that is proportional to the velocity belongs to the
//! linear chain and is integrated with it ([`Friction::linear`]). The rest acts tick by tick ([`GroundFriction`](crate::GroundFriction)):
//! [`Friction::grip`] decides before a tick, a held body is locked for the tick, a sliding one gets a constant force;
//! [`Friction::settle`] sees the new velocity after it, and takes the [`Memory`] of the friction to the next tick. A body whose velocity
//! reversed came to rest within the tick and is stopped there; the crossing itself is met to first order in the step.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use servobench_base::{ParamError, Stateful};
use servobench_config::Kind::Axis;
use servobench_config::not_negative;
use servobench_config::quantities::{EFFORT, VELOCITY, VISCOUS};

servobench_config::parameters! {
    /// A parameter of the friction of a body, in the axis coordinate; those of the motor's body in the motor coordinate.
    pub enum FrictionParameter {
        /// Viscous friction
        VISCOUS "viscous" = not_negative(Axis(&VISCOUS), "200 N s/m");
        /// Coulomb friction
        COULOMB "coulomb" = not_negative(Axis(&EFFORT), "20 N");
        /// Static (breakaway) friction, at least `coulomb`
        BREAKAWAY "static" = not_negative(Axis(&EFFORT), "35 N");
        /// Velocity at which friction has mostly fallen from `static` to `coulomb`: exp(−(v/v_s)²)
        STRIBECK_VELOCITY "Stribeck velocity" = not_negative(Axis(&VELOCITY), "2 mm/s");
    }
}

/// Friction of a body against the ground, in its own coordinate; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// Viscous friction, `b` (N·s/m or N·m·s/rad).
    pub viscous: f64,
    /// Coulomb and static friction.
    pub dry: DryFriction,
}

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

/// Memory of the friction of a body from tick to tick: empty, its force follows from velocity and effort.
#[derive(Debug, Clone, PartialEq, Default, Stateful)]
pub(crate) struct Memory {}

/// Effect of friction on a body during one tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Grip {
    /// Holds it: neither position nor velocity changes.
    Held,
    /// Acts with this force (N or N·m), constant over the tick.
    Force(f64),
}

impl Friction {
    /// No friction.
    pub const NONE: Self = Self { viscous: 0.0, dry: DryFriction::NONE };

    /// Coulomb friction alone (N or N·m).
    #[must_use]
    pub const fn coulomb(coulomb: f64) -> Self {
        Self { dry: DryFriction { coulomb, breakaway: coulomb, stribeck_velocity: 0.0 }, ..Self::NONE }
    }

    /// # Errors
    /// [`ParamError`] names the first parameter out of its bound.
    pub fn check(&self) -> Result<(), ParamError> {
        FrictionParameter::VISCOUS.check_in_words(self.viscous)?;
        self.dry.check()
    }

    /// The part that is proportional to the velocity, per velocity (N·s/m or N·m·s/rad).
    #[must_use]
    #[inline]
    pub const fn linear(&self) -> f64 {
        self.viscous
    }

    /// True if friction is linear only: it then never holds the body, and adds nothing to that part.
    #[must_use]
    #[inline]
    pub fn is_linear(&self) -> bool {
        self.dry.is_none()
    }

    /// True if a body can be [held](Grip::Held).
    #[inline]
    pub(crate) fn holds(&self) -> bool {
        !self.is_linear()
    }

    /// Effect of the non-linear part in the coming tick of `step` (s), given the velocity and the effort of everything else at its
    /// start.
    #[inline(always)]
    pub(crate) fn grip(&self, _memory: &Memory, velocity: f64, effort: f64, _step: f64) -> Grip {
        if velocity != 0.0 {
            Grip::Force(-self.sliding(velocity).copysign(velocity))
        } else if effort.abs() <= self.breakaway() {
            Grip::Held
        } else {
            Grip::Force(-self.sliding(0.0).copysign(effort))
        }
    }

    /// Takes the memory over the past tick of `step` (s), from the velocity `before` to the one `after` it. True if the body came
    /// to rest within the tick; its velocity is then to be set to zero.
    #[inline(always)]
    pub(crate) fn settle(&self, _memory: &mut Memory, before: f64, after: f64, _step: f64) -> bool {
        self.holds() && before * after < 0.0
    }

    /// Magnitude of the non-linear part while the body slides with `velocity` (N or N·m).
    #[must_use]
    #[inline]
    pub fn sliding(&self, velocity: f64) -> f64 {
        self.dry.sliding(velocity)
    }

    /// The effort up to which a body at rest is held (N or N·m).
    #[must_use]
    #[inline]
    pub const fn breakaway(&self) -> f64 {
        self.dry.breakaway
    }

    /// The part of sliding that does not depend on the velocity, which a drive can feed forward (N or N·m).
    #[must_use]
    pub const fn constant(&self) -> f64 {
        self.dry.coulomb
    }

    /// The same friction, in a coordinate x for which this one is `ratio`·x.
    #[must_use]
    pub fn carried(&self, ratio: f64) -> Self {
        let DryFriction { coulomb, breakaway, stribeck_velocity } = self.dry;
        Self {
            viscous: ratio * ratio * self.viscous,
            dry: DryFriction {
                coulomb: ratio * coulomb,
                breakaway: ratio * breakaway,
                stribeck_velocity: stribeck_velocity / ratio,
            },
        }
    }

    /// The friction of two rigidly coupled bodies, in one coordinate; `None` if they
    /// differ in Stribeck velocity: two curves of different width do not add up to a third.
    #[must_use]
    pub fn joined(&self, other: &Self) -> Option<Self> {
        let has_stribeck = |dry: &DryFriction| dry.breakaway > dry.coulomb;
        let (one, two) = (&self.dry, &other.dry);
        let widest = one.stribeck_velocity.max(two.stribeck_velocity);
        let differ = (one.stribeck_velocity - two.stribeck_velocity).abs() > 1e-9 * widest;
        if has_stribeck(one) && has_stribeck(two) && differ {
            return None;
        }
        let stribeck_velocity = if has_stribeck(two) { two.stribeck_velocity } else { one.stribeck_velocity };
        Some(Self {
            viscous: self.viscous + other.viscous,
            dry: DryFriction {
                coulomb: one.coulomb + two.coulomb,
                breakaway: one.breakaway + two.breakaway,
                stribeck_velocity,
            },
        })
    }
}

impl DryFriction {
    /// No dry friction.
    pub const NONE: Self = Self { coulomb: 0.0, breakaway: 0.0, stribeck_velocity: 0.0 };

    fn check(&self) -> Result<(), ParamError> {
        FrictionParameter::COULOMB.check_in_words(self.coulomb)?;
        FrictionParameter::STRIBECK_VELOCITY.check_in_words(self.stribeck_velocity)?;
        if !(self.breakaway.is_finite() && self.breakaway >= self.coulomb) {
            return Err(ParamError {
                name: FrictionParameter::BREAKAWAY.name,
                value: self.breakaway,
                bound: "finite and at least `coulomb`",
            });
        }
        Ok(())
    }

    #[inline]
    fn is_none(&self) -> bool {
        self.breakaway == 0.0
    }

    /// Magnitude of the sliding friction at `velocity` (N or N·m).
    #[inline]
    fn sliding(&self, velocity: f64) -> f64 {
        if self.stribeck_velocity == 0.0 {
            return self.coulomb;
        }
        let ratio = velocity / self.stribeck_velocity;
        self.coulomb + (self.breakaway - self.coulomb) * libm::exp(-ratio * ratio)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DRY: Friction =
        Friction { viscous: 0.0, dry: DryFriction { coulomb: 2.0, breakaway: 3.0, stribeck_velocity: 0.1 } };

    #[test]
    fn stribeck_curve_runs_from_static_to_coulomb() {
        assert!((DRY.sliding(0.0) - 3.0).abs() < 1e-15);
        assert!((DRY.sliding(0.1) - (2.0 + (-1.0_f64).exp())).abs() < 1e-15);
        assert!((DRY.sliding(-1.0) - 2.0).abs() < 1e-15, "exp(-100) is below the last bit of 2");
    }

    #[test]
    fn a_body_at_rest_is_held_until_the_breakaway_force() {
        assert_eq!(DRY.grip(&Memory::default(), 0.0, 3.0, 1e-3), Grip::Held);
        assert_eq!(DRY.grip(&Memory::default(), 0.0, -3.1, 1e-3), Grip::Force(3.0));
    }

    #[test]
    fn friction_never_reverses_a_motion() {
        assert!(DRY.settle(&mut Memory::default(), 0.1, -0.2, 1e-3));
        assert!(!DRY.settle(&mut Memory::default(), 0.0, 0.2, 1e-3), "a body that broke away goes on");
    }

    #[test]
    fn static_below_coulomb_is_refused() {
        let dry = DryFriction { breakaway: 1.0, ..DRY.dry };
        assert_eq!(Friction { dry, ..DRY }.check().unwrap_err().name, "static");
        assert_eq!(Friction { viscous: -1.0, ..DRY }.check().unwrap_err().name, "viscous");
    }

    /// Oracle: power. Behind a ratio the same motion loses the same power, f·v.
    #[test]
    fn carried_friction_loses_the_same_power() {
        let (friction, ratio) = (Friction { viscous: 0.7, ..DRY }, 0.25);
        let carried = friction.carried(ratio);
        for velocity in [0.01, 0.1, 3.0] {
            let lost = |friction: &Friction, v: f64| v * (friction.linear() * v + friction.sliding(v));
            // The body moves with ratio·v when the coordinate moves with v.
            let (own, behind) = (lost(&friction, ratio * velocity), lost(&carried, velocity));
            assert!((own / behind - 1.0).abs() < 1e-15, "{velocity}: {own} {behind}");
        }
    }

    #[test]
    fn two_stribeck_curves_of_different_width_are_no_third() {
        let wide = Friction { dry: DryFriction { stribeck_velocity: 0.2, ..DRY.dry }, ..DRY };
        assert_eq!(DRY.joined(&wide), None);
        let sum = DRY.joined(&Friction { viscous: 0.5, ..Friction::coulomb(4.0) }).unwrap();
        assert_eq!(sum, Friction { viscous: 0.5, dry: DryFriction { coulomb: 6.0, breakaway: 7.0, ..DRY.dry } });
    }
}
