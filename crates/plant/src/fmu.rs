//! An FMU as the mechanics, as plain data: which of its variables is what.
use crate::chain::Coordinate;
use std::path::PathBuf;
use std::time::Duration;

/// A functional mock-up unit (FMI 2.0 or 3.0, co-simulation) and which of its variables are the axis.
///
/// Units are those of its model description; a variable that has none counts in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct FmuModel {
    /// The file.
    pub path: PathBuf,
    /// Input that takes the torque (N·m) or force (N) of the motor, in the motor's coordinate.
    pub effort: FmuPort,
    /// The body that the motor moves, in the motor's own coordinate.
    pub motor: FmuBody,
    /// The load, in the axis coordinate; `None` if the motor's body is both.
    pub load: Option<FmuBody>,
    /// Input that takes a disturbance of the motor's body, in its coordinate. Without one it is added to the effort, which is
    /// the same for a body that both act on.
    pub motor_disturbance: Option<FmuPort>,
    /// Input that takes a disturbance of the load, in the axis coordinate. Without one a single body gets it through the
    /// transmission; a load of its own can have none.
    pub load_disturbance: Option<FmuPort>,
    /// Axis coordinate per motor coordinate.
    pub transmission: f64,
    /// What is set before it starts.
    pub start: Vec<FmuStart>,
    /// Base ticks between two exchanges with it, at least one.
    pub ticks: u32,
    /// How motion goes on between two exchanges.
    pub extrapolation: Extrapolation,
    /// Where it runs.
    pub isolation: Isolation,
}

/// A scalar of an FMU: a variable, or an element of an array.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FmuPort {
    /// Name of the variable.
    pub variable: String,
    /// Position in the array in row-major order, from 0; 0 for a scalar.
    pub element: usize,
}

/// Outputs of an FMU that are a body's motion.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FmuBody {
    /// Whether it turns or slides.
    pub coordinate: Coordinate,
    /// Its position.
    pub position: FmuPort,
    /// Its velocity. Without one it is taken from the last positions, and is late by half a step between two exchanges.
    pub velocity: Option<FmuPort>,
}

/// A parameter or an initial value.
#[derive(Debug, Clone, PartialEq)]
pub struct FmuStart {
    /// Name of the variable.
    pub variable: String,
    /// Its value, or those of its elements in row-major order.
    pub values: Vec<FmuValue>,
}

/// A value for an FMU.
#[derive(Debug, Clone, PartialEq)]
pub enum FmuValue {
    /// A number in the unit of the variable, an integer, or the value of an item of an enumeration.
    Number(f64),
    /// A number in SI units.
    Si(f64),
    /// A number with a unit, which may also be just a text.
    Quantity {
        /// As it was written.
        text: String,
        /// In SI units.
        si: f64,
        /// Exponents of kilogram, metre, second and ampere in its unit.
        exponents: [i32; 4],
    },
    /// TRUE or FALSE.
    Boolean(bool),
    /// Text.
    Text(String),
}

/// How motion goes on between two exchanges with an FMU.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Extrapolation {
    /// It stands still.
    Hold,
    /// With the velocity.
    #[default]
    Linear,
    /// With velocity and acceleration, by the last two or three exchanges.
    Quadratic,
}

/// Where an FMU runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Isolation {
    /// In this process: it is trusted.
    None,
    /// In a process of its own.
    Process {
        /// Real time that it may take for any one call.
        patience: Duration,
        /// Memory that it may have (B).
        memory: u64,
    },
}
