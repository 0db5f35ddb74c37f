//! Axis model of the firmware.
use crate::feedforward::Model;

servobench_config::choices! {
    /// Model behind an effort feedforward, of the drive or of a master on the bus.
    pub enum EffortFeedforward default Off {
        /// none
        Off = "off",
        /// inertia and viscous friction of one body
        Rigid = "rigid",
        /// two bodies and a spring: velocity, acceleration, jerk and snap
        TwoMass = "two-mass",
    }
}

/// Axis model as estimated by the firmware, in the axis coordinate unless stated otherwise.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Axis coordinate per motor coordinate (m/rad, or 1).
    pub transmission: f64,
    /// Mass or inertia on the motor's side of the spring (two-mass), rotor included.
    pub motor_inertia: f64,
    /// Mass or inertia beyond the spring; 0 for a rigid axis.
    pub load_inertia: f64,
    /// Spring stiffness (N/m or N·m/rad); infinite for a rigid axis.
    pub stiffness: f64,
    /// Viscous friction on the motor's side.
    pub motor_viscous: f64,
    /// Viscous friction on the load.
    pub load_viscous: f64,
    /// Coulomb friction, all bodies.
    pub coulomb: f64,
    /// Constant resisting effort, all bodies.
    pub bias: f64,
}

impl Estimate {
    /// Total inertia at the motor (motor coordinate).
    #[must_use]
    pub fn inertia_at_the_motor(&self) -> f64 {
        self.transmission * self.transmission * (self.motor_inertia + self.load_inertia)
    }

    /// Model of the axis for a feedforward by `effort`.
    #[must_use]
    pub fn model(&self, effort: EffortFeedforward) -> Model {
        match effort {
            EffortFeedforward::Off => Model::Off,
            EffortFeedforward::Rigid => Model::Rigid {
                inertia: self.motor_inertia + self.load_inertia,
                viscous: self.motor_viscous + self.load_viscous,
            },
            EffortFeedforward::TwoMass => Model::TwoMass {
                motor_inertia: self.motor_inertia,
                load_inertia: self.load_inertia,
                stiffness: self.stiffness,
                motor_viscous: self.motor_viscous,
                load_viscous: self.load_viscous,
            },
        }
    }
}
