//! An FMU as the mechanics of an axis: which of its variables are what.
use servobench_fmu_file::{FmuFile, SiPort};

/// An FMU that is the mechanics of an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct FmuModel {
    /// The FMU.
    pub file: FmuFile,
    /// Input that takes the torque (N·m) or force (N) of the motor, in the motor's coordinate.
    pub effort: SiPort,
    /// The body that the motor moves, in the motor's own coordinate.
    pub motor: FmuBody,
    /// The load, in the axis coordinate; `None` if the motor's body is both.
    pub load: Option<FmuBody>,
    /// Input that takes a disturbance of the motor's body, in its coordinate. Without one it is added to the effort, which is
    /// the same for a body that both act on.
    pub motor_disturbance: Option<SiPort>,
    /// Input that takes a disturbance of the load, in the axis coordinate. Without one a single body gets it through the
    /// transmission; a load of its own can have none.
    pub load_disturbance: Option<SiPort>,
    /// Axis coordinate per motor coordinate.
    pub transmission: f64,
    /// Base ticks between two exchanges with it, at least one. Between them its bodies go on with their velocities.
    pub ticks: u32,
}

/// Outputs of an FMU that are a body's motion.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FmuBody {
    /// Its position.
    pub position: SiPort,
    /// Its velocity. Without one it is taken from the last positions, and is late by half a step between two exchanges.
    pub velocity: Option<SiPort>,
}

impl FmuModel {
    /// Inputs in the order in which they are exchanged: effort, disturbance of the motor, of the load.
    pub fn inputs(&self) -> impl Iterator<Item = &SiPort> {
        std::iter::once(&self.effort).chain(&self.motor_disturbance).chain(&self.load_disturbance)
    }

    /// Outputs in the order in which they are exchanged: of each body position and velocity, if it has one.
    pub fn outputs(&self) -> impl Iterator<Item = &SiPort> {
        self.bodies().flat_map(|body| std::iter::once(&body.position).chain(&body.velocity))
    }

    /// The bodies: the motor's first.
    pub fn bodies(&self) -> impl Iterator<Item = &FmuBody> {
        std::iter::once(&self.motor).chain(&self.load)
    }
}
