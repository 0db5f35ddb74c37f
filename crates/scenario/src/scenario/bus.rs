//! The fieldbus between the motion task and the drive, and what goes wrong on it.
use servobench_drive::EffortFeedforward;
use servobench_motion::interpolate::Mode as InterpolationMode;
use std::ops::Range;

/// What is between the motion task and the drive: a master, a bus and the door of the drive (CiA 402).
#[derive(Debug, Clone, PartialEq)]
pub struct Bus {
    /// Cycle of the bus (base ticks).
    pub cycle: u32,
    /// Mode of operation in which the axis moves.
    pub mode: BusMode,
    /// Cycle of the motion task (bus cycles).
    pub motion_every: u32,
    /// How the master fills the bus cycles between two of the motion task's.
    pub interpolation: InterpolationMode,
    /// How the drive fills the base ticks between two frames.
    pub drive_interpolation: DriveInterpolation,
    /// From the sampling of a frame to its effect (bus cycles).
    pub delay: u32,
    /// Whether the velocity offset (60B1h) carries the velocity of the set-point.
    pub velocity_offset: bool,
    /// Model of the effort that the torque offset (60B2h) carries.
    pub effort_offset: EffortFeedforward,
    /// How late a command of the motion task may come without being predicted (base ticks).
    pub margin: u32,
    /// How the master brings the drive to power.
    pub sequencing: Sequencing,
    /// How long the master waits for the drive (s).
    pub drive_timeout: f64,
    /// `K_v` of the master's position loop (1/s); `None` where the drive closes it.
    pub position_gain: Option<f64>,
    /// Counter of the positions on the bus.
    pub counter: Counter,
    /// Units of the positions on the bus.
    pub units: DriveUnits,
    /// Whether the master makes the actual velocity of differences of positions.
    pub velocity_from_differences: bool,
    /// Whether the switches are wired normally closed: what the drive reports of them is inverted by the master.
    pub reverse_switches: bool,
    /// How the points of a table get into the buffer of the drive, with interpolated position.
    pub trajectory_buffer: TrajectoryBuffer,
    /// What goes wrong, in the order of the file.
    pub faults: Vec<BusFault>,
    /// What the master writes into the drive's objects before the first cycle, in the order of the file.
    pub objects: Vec<ObjectWrite>,
}

/// Mode of operation in which the axis moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum BusMode {
    /// The master sends a position every cycle (csp).
    #[default]
    CyclicPosition,
    /// The master closes the position loop and sends a velocity every cycle (csv).
    CyclicVelocity,
    /// The drive plans a move to each target position (pp).
    ProfilePosition,
    /// The drive ramps to each target velocity (pv).
    ProfileVelocity,
    /// The drive interpolates between the points of a buffer (ip).
    InterpolatedPosition,
}

/// How the drive fills the ticks between two frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DriveInterpolation {
    /// Position linear.
    #[default]
    Linear,
    /// By positions and velocities.
    Cubic,
}

/// How the points of a table get into the buffer of the drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TrajectoryBuffer {
    /// The move segment command (2010h), eight bytes in a frame.
    #[default]
    MoveSegment,
    /// The interpolation data record (60C1h), in the sub-mode of 60C0h.
    DataRecord,
    /// Parameter 115h of the serial interface.
    Serial,
}

/// How the master brings the drive to power.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sequencing {
    /// State after state of the power state machine, each awaited.
    #[default]
    Strict,
    /// The last controlword at once, only the end awaited.
    Simplified,
}

/// Counter of positions: it wraps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Counter {
    /// Its width, 8 to 64.
    pub bits: u32,
    /// Whether it counts from −2^(bits−1).
    pub signed: bool,
}

/// So many units of the drive are so much of the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DriveUnits {
    /// Units of the drive, at least one.
    pub drive: u32,
    /// Axis coordinate (m or rad), above zero.
    pub axis: f64,
}

/// Something that goes wrong in some cycles of the bus or of the motion task.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BusFault {
    /// What.
    pub kind: BusFaultKind,
    /// In which cycles, the first of the run is 0; to `u64::MAX` where it does not end. Those of the motion task, where it is
    /// the task that something is wrong with.
    pub cycles: Range<u64>,
}

/// What goes wrong on the bus or with the motion task.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BusFaultKind {
    /// The frame does not arrive.
    Lost,
    /// The frame arrives late.
    Late {
        /// How late (base ticks).
        by: u32,
    },
    /// Each frame arrives late, by a random time.
    Jitter {
        /// The most (base ticks).
        by: u32,
        /// Seed of the random numbers.
        seed: u32,
    },
    /// The motion task does not run.
    MasterStopped,
    /// The drive does not answer.
    DriveSilent,
    /// The fault input of the master is set.
    ExternalFault,
    /// The motion task runs late.
    TaskLate {
        /// How late (base ticks).
        by: u32,
    },
    /// Each cycle of the motion task runs late, by a random time.
    TaskJitter {
        /// The most (base ticks).
        by: u32,
        /// Seed of the random numbers.
        seed: u32,
    },
    /// The command of the motion task is lost.
    TaskLost,
    /// The command of the motion task is read while it is written.
    TaskTorn,
    /// The cycle of the motion task is too short.
    TaskFast {
        /// By how much (base ticks), less than the cycle.
        by: u32,
    },
}

/// A value for an object of the drive. Whether the drive takes it is for its object dictionary to say.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ObjectWrite {
    /// Index.
    pub index: u16,
    /// Sub-index, 0 for a plain variable.
    pub subindex: u8,
    /// Value.
    pub value: i64,
    /// Key in the file, as [`Loaded::mistake`](crate::Loaded::mistake) takes it: `drive.objects.6099h.1`.
    pub key: String,
}
