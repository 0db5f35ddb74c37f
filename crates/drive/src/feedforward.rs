//! Feedforward: the reference of the loops, and the effort that makes the axis follow it without their action.
//!
//! ```text
//! rigid:     F = m·a + k·v
//! two-mass:  F = (m1·m2/c)·s + ((m1·k2 + m2·k1)/c)·j + (m1 + m2 + k1·k2/c)·a + (k1 + k2)·v
//!            x_m = x + (m2·a + k2·v)/c        v_m = v + (m2·j + k2·a)/c
//! ```
//! The set-point `x` is that of the load. Loops that measure on the motor must follow the motor's own reference `x_m`: with `x` itself they
//! counteract the feedforward. Axis coordinate throughout.
//! Source: Lambrechts, Boerlage, Steinbuch, *Control Engineering Practice* 13, 2005.
use servobench_base::{Setpoint, Stateful, finite};
use servobench_config::Kind::{Axis, Plain};
use servobench_config::quantities::{EFFORT, INERTIAL, RATIO, STIFFNESS, VISCOUS};
use servobench_config::{ParameterError, any, not_negative, positive};

servobench_config::parameters! {
    /// A parameter of the feedforward.
    pub enum Parameter {
        /// Share of the reference velocity that is added to the velocity command
        VELOCITY "share of the velocity that is fed forward" = any(Plain(&RATIO), "1");
        /// Coulomb friction of all bodies
        COULOMB "estimate of the Coulomb friction" = not_negative(Axis(&EFFORT), "20 N");
        /// Constant resisting force or torque on all bodies
        BIAS "estimate of the constant effort" = any(Axis(&EFFORT), "-3 N");
        /// Mass or inertia on the motor's side of the softest spring, rotor included
        MOTOR_INERTIA "estimate of the motor's inertia" = not_negative(Axis(&INERTIAL), "20 kg");
        /// Mass or inertia beyond that spring
        LOAD_INERTIA "estimate of the load's inertia" = not_negative(Axis(&INERTIAL), "10 kg");
        /// Stiffness of that spring
        STIFFNESS "estimate of the stiffness" = positive(Axis(&STIFFNESS), "0.6 N/um");
        /// Viscous friction on the motor's side
        MOTOR_VISCOUS "estimate of the motor's viscous friction" = not_negative(Axis(&VISCOUS), "10 N s/m");
        /// Viscous friction on the load
        LOAD_VISCOUS "estimate of the load's viscous friction" = not_negative(Axis(&VISCOUS), "10 N s/m");
    }
}

/// Model behind the effort feedforward, as the firmware estimates it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Model {
    /// No effort feedforward.
    Off,
    /// One body.
    Rigid {
        /// Mass or inertia (kg or kg·m²).
        inertia: f64,
        /// Viscous friction (N·s/m or N·m·s/rad).
        viscous: f64,
    },
    /// Two bodies and a spring.
    TwoMass {
        /// Motor side, `m1` (kg or kg·m²).
        motor_inertia: f64,
        /// Load side, `m2` (kg or kg·m²).
        load_inertia: f64,
        /// Spring, `c` (N/m or N·m/rad).
        stiffness: f64,
        /// Viscous friction of the motor side, `k1`.
        motor_viscous: f64,
        /// Viscous friction of the load, `k2`.
        load_viscous: f64,
    },
}

/// Parameters; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Share of the reference velocity added to the velocity command, 0 to 1.
    pub velocity: f64,
    /// True if that share follows the reference's own polynomial from one velocity-loop cycle to the next, instead of being held until the
    /// next cycle of the position loop.
    pub interpolate: bool,
    /// Model of the effort.
    pub model: Model,
    /// Coulomb friction to compensate (N or N·m).
    pub coulomb: f64,
    /// Constant resisting effort to compensate (N or N·m).
    pub bias: f64,
}

/// Reference of the motor-side loops.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct MotorReference {
    /// Position of the motor, in the axis coordinate (m or rad).
    pub position: f64,
    /// Velocity of the motor (m/s or rad/s).
    pub velocity: f64,
}

impl Params {
    /// # Errors
    /// [`ParameterError`] names the first parameter out of its bound.
    pub fn check(&self) -> Result<(), ParameterError> {
        if !(0.0..=1.0).contains(&self.velocity) {
            return Err(ParameterError { name: Parameter::VELOCITY, value: self.velocity, bound: "from 0 to 1" });
        }
        Parameter::COULOMB.check(self.coulomb)?;
        finite(Parameter::BIAS, self.bias)?;
        match self.model {
            Model::Off => Ok(()),
            Model::Rigid { inertia, viscous } => {
                Parameter::MOTOR_INERTIA.check(inertia)?;
                Parameter::MOTOR_VISCOUS.check(viscous).map(|_| ())
            }
            Model::TwoMass { motor_inertia, load_inertia, stiffness, motor_viscous, load_viscous } => {
                Parameter::MOTOR_INERTIA.check(motor_inertia)?;
                Parameter::LOAD_INERTIA.check(load_inertia)?;
                Parameter::STIFFNESS.check(stiffness)?;
                Parameter::MOTOR_VISCOUS.check(motor_viscous)?;
                Parameter::LOAD_VISCOUS.check(load_viscous).map(|_| ())
            }
        }
    }

    /// Effort for the motion `r` of the load (axis coordinate, N or N·m).
    #[must_use]
    pub fn effort(&self, r: Setpoint) -> f64 {
        let friction = self.bias + if r.v == 0.0 { 0.0 } else { self.coulomb.copysign(r.v) };
        friction
            + match self.model {
                Model::Off => 0.0,
                Model::Rigid { inertia, viscous } => inertia * r.a + viscous * r.v,
                Model::TwoMass {
                    motor_inertia: m1,
                    load_inertia: m2,
                    stiffness: c,
                    motor_viscous: k1,
                    load_viscous: k2,
                } => {
                    m1 * m2 / c * r.s + (m1 * k2 + m2 * k1) / c * r.j + (m1 + m2 + k1 * k2 / c) * r.a + (k1 + k2) * r.v
                }
            }
    }

    /// Motion of the motor while the load follows `r`.
    #[inline]
    #[must_use]
    pub fn motor_reference(&self, r: Setpoint) -> MotorReference {
        match self.model {
            Model::TwoMass { load_inertia: m2, stiffness: c, load_viscous: k2, .. } => {
                MotorReference { position: r.x + (m2 * r.a + k2 * r.v) / c, velocity: r.v + (m2 * r.j + k2 * r.a) / c }
            }
            Model::Off | Model::Rigid { .. } => MotorReference { position: r.x, velocity: r.v },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lambrechts' motor–load system.
    const LAMBRECHTS: Params = Params {
        velocity: 1.0,
        interpolate: true,
        model: Model::TwoMass {
            motor_inertia: 20.0,
            load_inertia: 10.0,
            stiffness: 6e5,
            motor_viscous: 10.0,
            load_viscous: 10.0,
        },
        coulomb: 0.0,
        bias: 0.0,
    };

    /// Oracle: Newton on each body by hand: c·(x_m − x) = m2·a + k2·v and F = m1·a_m + k1·v_m + c·(x_m − x), with the
    /// motor's acceleration from differentiating x_m twice.
    #[test]
    fn two_mass_feedforward_satisfies_newton_on_both_bodies() {
        let r = Setpoint { x: 0.3, v: 0.8, a: 4.0, j: -30.0, s: 900.0 };
        let m = LAMBRECHTS.motor_reference(r);
        let spring = 6e5 * (m.position - r.x);
        assert!((spring - (10.0 * r.a + 10.0 * r.v)).abs() < 1e-9, "a difference of 1e-5 m loses 5 digits: {spring}");
        let motor_acceleration = r.a + (10.0 * r.s + 10.0 * r.j) / 6e5;
        let effort = 20.0 * motor_acceleration + 10.0 * m.velocity + (10.0 * r.a + 10.0 * r.v);
        assert!((LAMBRECHTS.effort(r) - effort).abs() < 1e-12, "{} {effort}", LAMBRECHTS.effort(r));
    }

    #[test]
    fn a_very_stiff_spring_is_a_rigid_axis() {
        let stiff = Params {
            model: Model::TwoMass {
                motor_inertia: 20.0,
                load_inertia: 10.0,
                stiffness: 1e18,
                motor_viscous: 4.0,
                load_viscous: 6.0,
            },
            ..LAMBRECHTS
        };
        let rigid = Params { model: Model::Rigid { inertia: 30.0, viscous: 10.0 }, ..LAMBRECHTS };
        let r = Setpoint { x: 0.3, v: 0.8, a: 4.0, j: -30.0, s: 900.0 };
        assert!((stiff.effort(r) - rigid.effort(r)).abs() < 1e-12);
    }

    #[test]
    fn friction_is_compensated_in_the_direction_of_motion_only_while_moving() {
        let p = Params { model: Model::Off, coulomb: 20.0, bias: -3.0, ..LAMBRECHTS };
        let at = |v| p.effort(Setpoint { v, ..Setpoint::default() });
        assert_eq!([at(0.0), at(0.1), at(-0.1)].map(f64::to_bits), [-3.0_f64, 17.0, -23.0].map(f64::to_bits));
    }
}
