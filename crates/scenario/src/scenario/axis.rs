//! The mechanics: bodies and what couples them.
use super::fmu::{BodySignal, Fmu};
use servobench_base::Coordinate;
use std::path::PathBuf;

/// The mechanics of the axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Coordinate of the load.
    pub motion: Coordinate,
    /// Coordinate of the motor.
    pub motor_motion: Coordinate,
    /// Axis coordinate per motor coordinate: lead/2π (m/rad), 1/gear ratio, or 1.
    pub transmission: f64,
    /// The bodies.
    pub mechanics: AxisMechanics,
    /// The mechanics as an FMU, for the engine `fmu`.
    pub fmu: Option<Fmu<BodySignal>>,
    /// What the drive sees of its position besides encoders.
    pub switches: Switches,
    /// Period of a modulo axis; `None` for one with ends.
    pub modulo: Option<f64>,
}

/// Switches along an axis (axis coordinate) and the index pulse of its motor.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Switches {
    /// Active at and below it: the negative end.
    pub negative: Option<f64>,
    /// Active at and above it: the positive end.
    pub positive: Option<f64>,
    /// Home switch.
    pub home: Option<HomeSwitch>,
    /// Where in each revolution of the motor the index pulse comes (rad, from 0 to below 2π); `None` for a linear motor,
    /// which has none.
    pub index: Option<f64>,
}

/// Home switch: active between two positions, both included (axis coordinate).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HomeSwitch {
    /// Lower end.
    pub from: f64,
    /// Upper end.
    pub to: f64,
}

/// Where the bodies come from.
#[derive(Debug, Clone, PartialEq)]
pub enum AxisMechanics {
    /// Lumped bodies, the motor's first. Bodies that were coupled rigidly are merged already, the rotor's inertia is in.
    Bodies(Vec<Body>),
    /// A user's own MJCF file.
    Mjcf(Mjcf),
    /// Nothing that is known here: only the FMU of [`Axis::fmu`] knows.
    InTheFmu,
}

/// One lumped body; in the motor coordinate for the first, in the axis coordinate for the others.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// `motor`, `table` or `load`.
    pub name: &'static str,
    /// Mass (kg) or inertia (kg·m²).
    pub inertia: f64,
    /// Coupling to the body before it (axis coordinate); `None` for the first body only.
    pub coupling: Option<Coupling>,
    /// Viscous friction (N·s/m or N·m·s/rad).
    pub viscous: f64,
    /// Coulomb friction (N or N·m).
    pub coulomb: f64,
    /// Breakaway friction, at least `coulomb` (N or N·m).
    pub breakaway: f64,
    /// Stribeck velocity (m/s or rad/s); 0 for an immediate step.
    pub stribeck_velocity: f64,
    /// Constant resisting effort (N or N·m).
    pub bias: f64,
}

/// Spring and damper (axis coordinate).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coupling {
    /// N/m or N·m/rad.
    pub stiffness: f64,
    /// N·s/m or N·m·s/rad.
    pub damping: f64,
}

/// A user's own MJCF file and the parts of it that are the axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Mjcf {
    /// Text of the file.
    pub xml: String,
    /// The file.
    pub path: PathBuf,
    /// Motor joint.
    pub motor_joint: String,
    /// Load joint.
    pub load_joint: String,
    /// Actuator.
    pub actuator: String,
}
