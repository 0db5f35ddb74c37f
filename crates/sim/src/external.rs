//! External influences on an axis.
use servobench_base::{Dq, Setpoint, Stateful};
use servobench_plant::BodyState;

/// External influences, held over a tick.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct External {
    /// True if the program of the scenario may run: it begins with the first tick at which this is set, and runs once.
    pub start: bool,
    /// Set-point to follow instead of the program (axis coordinate). Over a fieldbus the motion task sends it.
    pub setpoint: Option<Setpoint>,
    /// Effort on the motor body (its own coordinate, N·m or N), in addition to the disturbances of the scenario.
    pub motor_effort: f64,
    /// Effort on the load (axis coordinate, N or N·m), in addition to the disturbances of the scenario.
    pub load_effort: f64,
    /// Measured states of motor (its own coordinate) and load (axis coordinate); the loop's own mechanics do not move then.
    pub measured: Option<[BodyState; 2]>,
    /// Output that replaces the drive, or drive and motor.
    pub controller: Option<Controller>,
}

/// Output of an external controller.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub enum Controller {
    /// Effort of the motor (its own coordinate, N·m or N), which replaces drive and motor.
    Effort(f64),
    /// Stator voltage in the rotor's frame at the tick (V, peak), which replaces the drive.
    Voltage(Dq),
}

impl Default for External {
    /// The scenario without external influences.
    fn default() -> Self {
        Self { start: true, setpoint: None, motor_effort: 0.0, load_effort: 0.0, measured: None, controller: None }
    }
}
