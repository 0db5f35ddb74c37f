//! Commands of a drive to its power stage.
use crate::frames::AlphaBeta;
use crate::state::Stateful;

/// Command of the drive to the power stage, held from one tick to the next.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub enum PowerCommand {
    /// Stator voltage (V, peak).
    Voltage(AlphaBeta),
    /// Output of an ideal amplifier (V, or the effort itself).
    Output(f64),
    /// The power stage is off: the motor carries no current.
    Off,
}
