//! `[bus]`: the fieldbus between the motion task and the drive.
use crate::list::Many;
use crate::scenario::{BusMode, DriveInterpolation, Sequencing, TrajectoryBuffer};
use crate::simple::OneOf;
use crate::table::table;
use servobench_config::Choice;
use servobench_config::Kind::{Axis as InAxis, Plain};
use servobench_config::quantities::{POSITION, POSITION_GAIN, TIME};
use servobench_config::{not_negative, positive};
use servobench_drive::EffortFeedforward;
use servobench_motion::interpolate::Mode as InterpolationMode;

impl Choice for BusMode {
    const ALL: &'static [(&'static str, Self, &'static str)] = &[
        ("csp", Self::CyclicPosition, "cyclic synchronous position: the master sends a position every cycle"),
        ("csv", Self::CyclicVelocity, "cyclic synchronous velocity: the master closes the position loop"),
        ("pp", Self::ProfilePosition, "profile position: the drive plans the way to each target"),
        ("pv", Self::ProfileVelocity, "profile velocity: the drive ramps to each velocity"),
        ("ip", Self::InterpolatedPosition, "interpolated position: the drive goes through the points of a buffer"),
    ];
}

impl Choice for DriveInterpolation {
    const ALL: &'static [(&'static str, Self, &'static str)] =
        &[("linear", Self::Linear, "position linear"), ("cubic", Self::Cubic, "by positions and velocities")];
}

impl Choice for TrajectoryBuffer {
    const ALL: &'static [(&'static str, Self, &'static str)] = &[
        ("2010h", Self::MoveSegment, "move segment command of the drive: eight bytes of a frame"),
        ("60C1h", Self::DataRecord, "interpolation data record, in the sub-mode (60C0h) of `[drive.objects]`"),
        (
            "115h",
            Self::Serial,
            "parameter of the serial interface, with trajectory mode 3 (C8h) and the start by op-code 17",
        ),
    ];
}

impl Choice for Sequencing {
    const ALL: &'static [(&'static str, Self, &'static str)] = &[
        ("strict", Self::Strict, "state after state of the power state machine, each awaited"),
        ("simplified", Self::Simplified, "the last controlword at once, only the end awaited"),
    ];
}

/// What goes wrong, by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FaultName {
    Lost,
    Late,
    Jitter,
    MasterStopped,
    DriveSilent,
    ExternalFault,
    TaskLate,
    TaskJitter,
    TaskLost,
    TaskTorn,
    TaskFast,
}

impl Choice for FaultName {
    const ALL: &'static [(&'static str, Self, &'static str)] = &[
        ("lost", Self::Lost, "the frame does not arrive"),
        ("late", Self::Late, "the frame arrives late"),
        ("jitter", Self::Jitter, "each frame arrives late by a random time"),
        ("master-stopped", Self::MasterStopped, "the motion task does not run"),
        ("drive-silent", Self::DriveSilent, "the drive does not answer"),
        ("external-fault", Self::ExternalFault, "the fault input of the master is set"),
        ("task-late", Self::TaskLate, "the motion task runs late, and with it the cycles that it holds up"),
        ("task-jitter", Self::TaskJitter, "each cycle of the motion task runs late by a random time"),
        ("task-lost", Self::TaskLost, "the command of the motion task is lost"),
        ("task-torn", Self::TaskTorn, "the master reads the command while the motion task writes it"),
        ("task-fast", Self::TaskFast, "the clock of the motion task runs fast: its cycles are too short"),
    ];
}

impl FaultName {
    /// Whether it is the motion task that something is wrong with.
    pub(crate) const fn is_of_task(self) -> bool {
        match self {
            Self::TaskLate | Self::TaskJitter | Self::TaskLost | Self::TaskTorn | Self::TaskFast => true,
            Self::Lost | Self::Late | Self::Jitter | Self::MasterStopped | Self::DriveSilent | Self::ExternalFault => {
                false
            }
        }
    }
}

table! {
    /// The fieldbus between the motion task and the drive (CiA 402). Without it the drive has a set-point at every tick.
    pub(crate) struct Bus requires ["cycle"] {
        /// Cycle of the bus, a whole number of base ticks.
        cycle: f64 = positive(Plain(&TIME), "1 ms"),
        /// Mode of operation in which the axis moves; "csp" unless given.
        mode: BusMode = OneOf,
        /// Cycle of the motion task, with `[[call]]` of the PLC, a whole number of bus cycles; one unless given.
        motion_cycle: f64 = positive(Plain(&TIME), "4 ms"),
        /// How the master fills the bus cycles between two of the motion task's; "cubic" unless given.
        interpolation: InterpolationMode = OneOf,
        /// How the drive fills the ticks between two frames; "linear" unless given.
        drive_interpolation: DriveInterpolation = OneOf,
        /// How points get into the buffer of the drive, with the mode "ip"; "2010h" unless given.
        trajectory_buffer: TrajectoryBuffer = OneOf,
        /// Bus cycles from the sampling of a frame to its effect; 1 unless given.
        delay: u32 = 0..=15,
        /// Whether the velocity offset (60B1h) carries the velocity of the set-point; it does not unless given.
        velocity_offset: bool = (),
        /// Model of the torque or force that the torque offset (60B2h) carries, by the drive's `estimate`; "off" unless given.
        effort_offset: EffortFeedforward = OneOf,
        /// How late a command of the motion task may come without being predicted, a whole number of base ticks and two of the
        /// task's cycles at most; it makes the way to the drive longer. None unless given.
        margin: f64 = positive(Plain(&TIME), "1 ms"),
        /// How the master brings the drive to power; "strict" unless given.
        sequencing: Sequencing = OneOf,
        /// How long the master waits for the drive; 0.5 s unless given.
        drive_timeout: f64 = positive(Plain(&TIME), "0.5 s"),
        /// Proportional gain of the master's position loop, with "csv".
        position_gain: f64 = positive(Plain(&POSITION_GAIN), "100 1/s"),
        /// Counter of the positions on the bus: it wraps.
        counter: Counter = (),
        /// Units of the positions on the bus; increments of the encoder that closes the position loop unless given.
        units: DriveUnits = (),
        /// Whether the master makes the actual velocity of differences of positions; the drive sends it unless given.
        velocity_from_differences: bool = (),
        /// Whether the switches are wired normally closed and drive and master invert their inputs, of which one without a switch
        /// then reads as met; they are wired normally open unless given.
        reverse_switches: bool = (),
        /// What goes wrong; `[[bus.fault]]` for each.
        fault: Many<BusFault> = (),
    }
}

table! {
    /// Counter of the positions on the bus: it wraps.
    pub(crate) struct Counter {
        /// Its width; 32 unless given.
        bits: u32 = 8..=32,
        /// Whether it counts from −2^(bits−1); it does unless given.
        signed: bool = (),
    }
}

table! {
    /// Units of the positions on the bus: so many of them are so much of the axis.
    pub(crate) struct DriveUnits requires ["drive", "axis"] {
        /// Units of the drive.
        drive: u32 = 1..=u32::MAX,
        /// What they are of the axis.
        axis: f64 = positive(InAxis(&POSITION), "5 mm"),
    }
}

table! {
    /// Something that goes wrong on the bus or with the motion task, for so many `cycles` or so long a `duration`: of the
    /// motion task for the kinds "task-…", of the bus for the others. What is lost, late or torn is one unless given, anything
    /// else lasts to the end of the run.
    pub(crate) struct BusFault requires ["kind"] {
        /// What goes wrong.
        kind: FaultName = OneOf,
        /// Start: from the first cycle that is not before it; 0 unless given.
        start: f64 = not_negative(Plain(&TIME), "0.5 s"),
        /// How many cycles it concerns.
        cycles: u32 = 1..=u32::MAX,
        /// How long it lasts: it concerns the cycles that begin before its end.
        duration: f64 = positive(Plain(&TIME), "20 ms"),
        /// How late what is "late" is, what has "jitter" at most, or how much too short a cycle is with "task-fast"; a whole
        /// number of base ticks.
        by: f64 = positive(Plain(&TIME), "250 us"),
        /// Seed of the random numbers of "jitter" and "task-jitter"; 1 unless given.
        seed: u32 = 0..=u32::MAX,
    }
}
