//! What acts on an axis from outside the loop.
use servobench_base::{Dq, Setpoint, Stateful};
use servobench_plant::BodyState;

/// What comes from outside, held over a tick.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct External {
    /// Whether the program of the scenario may run: it begins with the first tick at which it may, and runs once.
    pub start: bool,
    /// What the axis is to follow instead of the program (axis coordinate). Over a fieldbus it is what the motion task sends.
    pub setpoint: Option<Setpoint>,
    /// Effort on the motor body (its own coordinate, N·m or N), beside the disturbances of the scenario.
    pub motor_effort: f64,
    /// Effort on the load (axis coordinate, N or N·m), beside the disturbances of the scenario.
    pub load_effort: f64,
    /// Where motor (its own coordinate) and load (axis coordinate) are measured to be; the loop's own mechanics do not move then.
    pub measured: Option<[BodyState; 2]>,
    /// What stands for the drive, or for drive and motor.
    pub controller: Option<Controller>,
}

/// What an external controller gives.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub enum Controller {
    /// Effort of the motor (its own coordinate, N·m or N), instead of drive and motor.
    Effort(f64),
    /// Stator voltage in the rotor's frame at the tick (V, peak), instead of the drive.
    Voltage(Dq),
}

impl Default for External {
    /// A run of the scenario as it is.
    fn default() -> Self {
        Self { start: true, setpoint: None, motor_effort: 0.0, load_effort: 0.0, measured: None, controller: None }
    }
}
