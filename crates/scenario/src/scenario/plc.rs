//! The PLC program: calls of function blocks (PLCopen Motion Control, part 1, version 2.0).
use servobench_plcopen::RampStart;
use servobench_plcopen::program::Call;

/// The PLC program. Its cycle is that of the motion task, [`Bus::motion_every`](super::Bus::motion_every). Positions and velocities are
/// in the axis coordinate, torques in the motor's.
#[derive(Debug, Clone, PartialEq)]
pub struct Plc {
    /// True if absolute moves of an axis that was not homed are refused.
    pub homing_required: bool,
    /// Start of the velocity ramps sent to the drive, in the mode [`ProfileVelocity`](super::BusMode::ProfileVelocity).
    pub velocity_ramps: Option<RampStart>,
    /// Limits of every command, from `[setpoint]`: |velocity|, |acceleration|, |jerk|, |snap|; infinite without a limit.
    pub limits: [f64; 4],
    /// The calls, at least one, in the order in which every cycle executes them.
    pub calls: Vec<Call>,
}
