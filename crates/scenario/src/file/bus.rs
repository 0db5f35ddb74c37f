//! `[bus]`: the fieldbus between the motion task and the drive.
use crate::list::Many;
use crate::scenario::BusMode;
use crate::simple::OneOf;
use crate::table::table;
use servobench_config::Choice;
use servobench_config::Kind::{Axis as InAxis, Plain};
use servobench_config::quantities::{POSITION, POSITION_GAIN, TIME};
use servobench_config::{any, not_negative, positive};
use servobench_drive::EffortFeedforward;
use servobench_fieldbus::bus::BusFaultName;
use servobench_fieldbus::link::Sequencing;
use servobench_fieldbus::task::TaskFaultName;
use servobench_fieldbus::trajectory::PointTransfer;
use servobench_motion::interpolate::Mode as InterpolationMode;

servobench_config::choices! {
    /// How the drive fills the ticks between two frames.
    pub(crate) enum DriveInterpolation default Linear {
        /// position linear
        Linear = "linear",
        /// by positions and velocities
        Cubic = "cubic",
    }
}

/// Kind of a fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FaultName {
    /// Fault of the bus.
    Bus(BusFaultName),
    /// Fault of the motion task.
    Task(TaskFaultName),
}

impl Choice for FaultName {
    const ALL: &'static [(&'static str, Self, &'static str)] = &{
        const OF_BUS: usize = BusFaultName::ALL.len();
        let mut all = [("", Self::Bus(BusFaultName::Lost), ""); OF_BUS + TaskFaultName::ALL.len()];
        let mut i = 0;
        while i < all.len() {
            all[i] = if i < OF_BUS {
                let (name, value, meaning) = BusFaultName::ALL[i];
                (name, Self::Bus(value), meaning)
            } else {
                let (name, value, meaning) = TaskFaultName::ALL[i - OF_BUS];
                (name, Self::Task(value), meaning)
            };
            i += 1;
        }
        all
    };
}

table! {
    /// The fieldbus between the motion task and the drive (CiA 402). Without it the drive has a set-point at every tick.
    pub(crate) struct Bus requires ["cycle"] {
        /// Cycle of the bus, a whole number of base ticks.
        cycle: f64 = positive(Plain(&TIME), "1 ms"),
        /// Mode of operation in which the axis moves; default: "csp".
        mode: BusMode = OneOf,
        /// Cycle of the motion task, with `[[call]]` of the PLC, a whole number of bus cycles; default: one.
        motion_cycle: f64 = positive(Plain(&TIME), "4 ms"),
        /// How the master fills the bus cycles between two of the motion task's; default: "cubic".
        interpolation: InterpolationMode = OneOf,
        /// How the drive fills the ticks between two frames; default: "linear".
        drive_interpolation: DriveInterpolation = OneOf,
        /// How points get into the buffer of the drive, with the mode "ip"; default: "2010h".
        trajectory_buffer: PointTransfer = OneOf,
        /// Time from point to point of a move that is no table, with the mode "ip": whole milliseconds up to 255, or what 60C2h says;
        /// default: 10 ms.
        point_time: f64 = positive(Plain(&TIME), "10 ms"),
        /// Bus cycles from the sampling of a frame to its effect; default: 1.
        delay: u32 = 0..=15,
        /// Whether the velocity offset (60B1h) carries the velocity of the set-point; default: false.
        velocity_offset: bool = (),
        /// Model of the torque or force that the torque offset (60B2h) carries, by the drive's `estimate`; default:
        /// "off".
        effort_offset: EffortFeedforward = OneOf,
        /// How late a command of the motion task may come without being predicted, a whole number of base ticks and two
        /// of the task's cycles at most; it makes the way to the drive longer; default: none.
        margin: f64 = positive(Plain(&TIME), "1 ms"),
        /// By how many cycles of the motion task the master predicts its motion, which makes the way to the drive as much shorter and
        /// costs what the motion does meanwhile (docs/fieldbus.md); 2 with B-splines, otherwise 1 at most; default: 0.
        run_ahead: u32 = 0..=2,
        /// How the master brings the drive to power; default: "strict".
        sequencing: Sequencing = OneOf,
        /// How long the master waits for the drive; default: 0.5 s.
        drive_timeout: f64 = positive(Plain(&TIME), "0.5 s"),
        /// Proportional gain of the master's position loop, with "csv".
        position_gain: f64 = positive(Plain(&POSITION_GAIN), "100 1/s"),
        /// Integral time of the master's position loop, with "csv": what is constant of its error goes to zero. It must be well above
        /// the age of the position (docs/fieldbus.md). Default: none.
        position_integral_time: f64 = positive(Plain(&TIME), "0.1 s"),
        /// Derivative time of the master's position loop, with "csv"; default: none.
        position_derivative_time: f64 = positive(Plain(&TIME), "2 ms"),
        /// Time constant of the low-pass in front of the derivative; default: a tenth of `position_derivative_time`.
        position_derivative_filter: f64 = not_negative(Plain(&TIME), "0.5 ms"),
        /// Counter of the positions on the bus: it wraps.
        counter: Counter = (),
        /// Units of the positions on the bus; default: increments of the encoder that closes the position loop.
        units: DriveUnits = (),
        /// Whether the master makes the actual velocity of differences of positions; default: false, the drive sends
        /// it.
        velocity_from_differences: bool = (),
        /// Whether the switches are wired normally closed and drive and master invert their inputs, of which one
        /// without a switch then reads as met; default: false, they are wired normally open.
        reverse_switches: bool = (),
        /// What goes wrong; `[[bus.fault]]` for each.
        fault: Many<BusFault> = (),
    }
}

table! {
    /// Counter of the positions on the bus: it wraps.
    pub(crate) struct Counter {
        /// Its width; default: 32. The objects of CiA 402 (607Ah, 6064h, 6062h) have 32 bits: of a wider counter they hold the
        /// lower half, and objects of the manufacturer the upper one.
        bits: u32 = 8..=64,
        /// Whether it counts from −2^(bits−1); default: true.
        signed: bool = (),
    }
}

table! {
    /// Units of the positions on the bus: so many of them are so much of the axis.
    pub(crate) struct DriveUnits requires ["drive", "axis"] {
        /// Units of the drive.
        drive: u32 = 1..=u32::MAX,
        /// What they are of the axis. Negative for a motor that is mounted the other way round: it turns against the axis, and its
        /// drive counts so; the input for a switch of its positive end has the switch of the axis' negative end, and the other
        /// way round.
        axis: f64 = any(InAxis(&POSITION), "5 mm"),
    }
}

table! {
    /// Something that goes wrong on the bus or with the motion task, for so many `cycles` or so long a `duration`: of the
    /// motion task for the kinds "task-…", of the bus for the others. What is lost, late or torn is one unless given, anything
    /// else lasts to the end of the run.
    pub(crate) struct BusFault requires ["kind"] {
        /// What goes wrong.
        kind: FaultName = OneOf,
        /// Start: from the first cycle that is not before it; default: 0.
        start: f64 = not_negative(Plain(&TIME), "0.5 s"),
        /// How many cycles it concerns.
        cycles: u32 = 1..=u32::MAX,
        /// How long it lasts: it concerns the cycles that begin before its end.
        duration: f64 = positive(Plain(&TIME), "20 ms"),
        /// How late what is "late" is, what has "jitter" at most, or how much too short a cycle is with "task-fast"; a whole
        /// number of base ticks.
        by: f64 = positive(Plain(&TIME), "250 us"),
        /// Seed of the random numbers of "jitter" and "task-jitter"; default: 1.
        seed: u32 = 0..=u32::MAX,
    }
}
