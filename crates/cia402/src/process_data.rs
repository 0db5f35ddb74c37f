//! Process data: the contents of each frame on the bus, in the drive's own units.
//!
//! Positions, velocities and accelerations are in the user units of the [factor group](crate::units), torques in thousandths of the rated
//! torque (6076h).
use crate::{Controlword, Statusword};
use servobench_base::Stateful;

/// Data from the master.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub struct Commands {
    /// 6040h.
    pub controlword: Controlword,
    /// Requested mode of operation (6060h).
    pub mode: i8,
    /// 607Ah; with a position counter of more than 32 bits its lower half.
    pub target_position: i32,
    /// Upper half of the target position, in a manufacturer-specific object; 0 with 32 bits or fewer.
    pub target_position_high: i32,
    /// 60FFh.
    pub target_velocity: i32,
    /// 6071h.
    pub target_torque: i16,
    /// Offset of the target position in cyclic synchronous position (60B0h); the sum wraps like positions.
    pub position_offset: i32,
    /// Offset of the velocity from the position loop (60B1h).
    pub velocity_offset: i32,
    /// Offset of the torque from the velocity loop (60B2h).
    pub torque_offset: i16,
    /// 6081h.
    pub profile_velocity: u32,
    /// 6083h.
    pub profile_acceleration: u32,
    /// 6084h.
    pub profile_deceleration: u32,
    /// Position of the reference (607Ch).
    pub home_offset: i32,
    /// A point for the trajectory buffer, or a command to it (2010h); sent only if there is one.
    pub trajectory_point: Option<[u8; 8]>,
    /// Write to the interpolation data record (60C1h); sent only if there is one.
    pub interpolation_data: Option<InterpolationData>,
    /// Touch probe function (60B8h).
    pub touch_probe_function: u16,
    /// Digital outputs (60FEh:1).
    pub digital_outputs: u32,
    /// Largest torque in either direction (6072h); sent while the master limits it.
    pub max_torque: Option<u16>,
}

/// A point in the interpolation data record (60C1h). Values that the sub-mode (60C0h) does not use are not mapped and not written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Stateful)]
pub struct InterpolationData {
    /// Position (60C1h.1, counts).
    pub position: i32,
    /// Time to the next point (60C1h.2, ms), 0 at the end of a move.
    pub time: Option<u8>,
    /// Velocity (60C1h.3, 0.1 counts/s).
    pub velocity: Option<i32>,
}

/// Data from the drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub struct Actuals {
    /// 6041h.
    pub statusword: Statusword,
    /// Active mode of operation (6061h).
    pub mode: i8,
    /// 6064h; with a position counter of more than 32 bits its lower half.
    pub position: i32,
    /// Upper half of the position, in a manufacturer-specific object; 0 with 32 bits or fewer.
    pub position_high: i32,
    /// Position that the position loop follows (6062h), or the actual position without one. With a position counter of more than 32 bits
    /// its lower half.
    pub position_demand: i32,
    /// Upper half of that position, in a manufacturer-specific object; 0 with 32 bits or fewer.
    pub position_demand_high: i32,
    /// 606Ch.
    pub velocity: i32,
    /// 6077h.
    pub torque: i16,
    /// 60F4h.
    pub following_error: i32,
    /// Code of the last fault (603Fh), 0 without one.
    pub error_code: u16,
    /// 60FDh: bit 0 negative limit switch, bit 1 positive limit switch, bit 2 home switch; set while the input is closed.
    pub digital_inputs: u32,
    /// Free points of the trajectory buffer (2011h).
    pub buffer_free: u16,
    /// State of the trajectory buffer (2012h).
    pub buffer_status: u32,
    /// Touch probe status (60B9h).
    pub touch_probe_status: u16,
    /// Positions of touch probe 1 at the positive and the negative edge (60BAh, 60BBh).
    pub touch_probe_positions: [i32; 2],
}
