//! The mechanics: bodies and what couples them.
use servobench_base::Coordinate;
use servobench_plant::{Chain, EndStops, FmuModel, MjcfModel, Switches};

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
    pub fmu: Option<FmuModel>,
    /// What the drive sees of its position besides encoders, wired normally open.
    pub switches: Switches,
    /// What the load meets at the ends of its travel.
    pub end_stops: Option<EndStops>,
    /// Period of a modulo axis; `None` for one with ends.
    pub modulo: Option<f64>,
}

/// Where the bodies come from.
#[derive(Debug, Clone, PartialEq)]
pub enum AxisMechanics {
    /// Lumped bodies. Those that were coupled rigidly are merged already, the rotor's inertia is in.
    Bodies(Chain),
    /// A user's own MJCF file; what it has to fit, [`MjcfModel::axis`], is known where the loop is built.
    Mjcf(MjcfModel),
    /// Nothing that is known here: only the FMU of [`Axis::fmu`] knows.
    InTheFmu,
}
