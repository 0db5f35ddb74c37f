//! The fieldbus between the motion task and the drive, and its faults.
use servobench_cia402::counter::Counter;
use servobench_cia402::units::Object;
use servobench_drive::EffortFeedforward;
use servobench_fieldbus::bus::BusFault;
use servobench_fieldbus::link::{PositionGains, Sequencing};
use servobench_fieldbus::task::TaskFault;
use servobench_fieldbus::trajectory::PointTransfer;
use servobench_motion::interpolate::Mode as InterpolationMode;

/// Connection of the motion task to the drive: a master, a bus and the bus interface of the drive (CiA 402).
#[derive(Debug, Clone, PartialEq)]
pub struct Bus {
    /// Cycle of the bus (base ticks).
    pub cycle: u32,
    /// Mode of operation in which the axis moves.
    pub mode: BusMode,
    /// Cycle of the motion task (bus cycles).
    pub motion_every: u32,
    /// Interpolation by the master for the bus cycles between two cycles of the motion task.
    pub interpolation: InterpolationMode,
    /// Interpolation by the drive for the base ticks between two frames: linear or cubic.
    pub drive_interpolation: InterpolationMode,
    /// Delay from the sampling of a frame to its effect (bus cycles).
    pub delay: u32,
    /// True if the velocity offset (60B1h) carries the velocity of the set-point.
    pub velocity_offset: bool,
    /// Model of the effort that the torque offset (60B2h) carries.
    pub effort_offset: EffortFeedforward,
    /// Largest delay of a motion task command that is accepted without prediction (base ticks).
    pub margin: u32,
    /// Number of motion task cycles over which the master predicts its motion.
    pub run_ahead: u32,
    /// Sequence in which the master enables the drive.
    pub sequencing: Sequencing,
    /// Time that the master waits for the drive (s).
    pub drive_timeout: f64,
    /// The master's position loop; `None` where the drive closes it.
    pub position_loop: Option<PositionGains>,
    /// Counter of the positions on the bus.
    pub counter: Counter,
    /// Units of the positions on the bus.
    pub units: DriveUnits,
    /// True if the master derives the actual velocity from differences of positions.
    pub velocity_from_differences: bool,
    /// True if the switches are wired normally closed: the master inverts the drive's report of them.
    pub reverse_switches: bool,
    /// Transfer of the points of a table into the buffer of the drive, with interpolated position.
    pub point_transfer: PointTransfer,
    /// Time from point to point of a move without a table (s), with interpolated position.
    pub point_time: f64,
    /// Faults of the bus, in the order of the file.
    pub faults: Vec<BusFault>,
    /// Faults of the motion task, in the order of the file.
    pub task_faults: Vec<TaskFault>,
    /// Values that the master writes to the drive's objects before the first cycle, in the order of the file.
    pub objects: Vec<ObjectWrite>,
}

servobench_config::choices! {
    /// Mode of operation in which the axis moves.
    pub enum BusMode default CyclicPosition {
        /// cyclic synchronous position: the master sends a position every cycle
        CyclicPosition = "csp",
        /// cyclic synchronous velocity: the master closes the position loop
        CyclicVelocity = "csv",
        /// profile position: the drive plans the profile to each target
        ProfilePosition = "pp",
        /// profile velocity: the drive ramps to each velocity
        ProfileVelocity = "pv",
        /// interpolated position: the drive moves through the points of a buffer
        InterpolatedPosition = "ip",
    }
}

impl BusMode {
    /// True if the master sends a set-point every cycle.
    #[must_use]
    pub const fn is_cyclic(self) -> bool {
        matches!(self, Self::CyclicPosition | Self::CyclicVelocity)
    }
}

/// Ratio of drive units to the axis coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DriveUnits {
    /// Drive units, at least one, that equal `axis`.
    pub drive: u32,
    /// Axis coordinate (m or rad); negative for a motor mounted the other way round.
    pub axis: f64,
}

impl DriveUnits {
    /// −1 where positions on the bus count against the axis, otherwise 1.
    #[must_use]
    pub const fn direction(&self) -> f64 {
        1.0_f64.copysign(self.axis)
    }
}

/// A value for an object of the drive. The drive's object dictionary decides if the drive accepts it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ObjectWrite {
    /// The object.
    pub object: Object,
    /// Value.
    pub value: i64,
    /// Key in the file, as [`Loaded::mistake`](crate::Loaded::mistake) takes it: `drive.objects.6099h.1`.
    pub key: String,
}
