//! The mechanics: bodies and their couplings.
use servobench_base::{AxisName, Coordinate};
use servobench_plant::{Chain, EndStops, FmuModel, MjcfModel, Switches};

/// The mechanics of the axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Its name, where it has one.
    pub name: Option<AxisName>,
    /// Coordinate of the load.
    pub motion: Coordinate,
    /// Coordinate of the motor.
    pub motor_motion: Coordinate,
    /// Axis coordinate per motor coordinate: lead/2π (m/rad), 1/gear ratio, or 1.
    pub transmission: f64,
    /// The bodies.
    pub mechanics: AxisMechanics,
    /// The mechanics as an FMU, for the engine `fmu`.
    pub fmu: Option<FmuModel>,
    /// Switches on the axis that the drive reads, wired normally open.
    pub switches: Switches,
    /// Stops at the ends of the load's travel.
    pub end_stops: Option<EndStops>,
    /// Period of a modulo axis; `None` for one with ends.
    pub modulo: Option<f64>,
}

/// Source of the bodies.
#[derive(Debug, Clone, PartialEq)]
pub enum AxisMechanics {
    /// Lumped bodies. Rigidly coupled bodies are already merged, the rotor's inertia is included.
    Bodies(Chain),
    /// A user's own MJCF file; [`MjcfModel::axis`], which it has to fit, is known where the loop is built.
    Mjcf(MjcfModel),
    /// None known here: only the FMU of [`Axis::fmu`] knows the mechanics.
    InTheFmu,
}
