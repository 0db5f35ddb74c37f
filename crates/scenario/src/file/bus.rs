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
    /// Interpolation by the drive for the ticks between two frames.
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
        /// Interpolation by the master for the bus cycles between two cycles of the motion task; default: "cubic".
        interpolation: InterpolationMode = OneOf,
        /// Interpolation by the drive for the ticks between two frames; default: "linear".
        drive_interpolation: DriveInterpolation = OneOf,
        /// Transfer of points into the buffer of the drive, with the mode "ip"; default: "2010h".
        trajectory_buffer: PointTransfer = OneOf,
        /// Time from point to point of a move that is not a table, with the mode "ip": whole milliseconds up to 255, or the value of 60C2h;
        /// default: 10 ms.
        point_time: f64 = positive(Plain(&TIME), "10 ms"),
        /// Bus cycles from the sampling of a frame to its effect; default: 1.
        delay: u32 = 0..=15,
        /// Sends the velocity of the set-point as velocity offset (60B1h); default: false.
        velocity_offset: bool = (),
        /// Model of the torque or force in the torque offset (60B2h), with the drive's `estimate`; default: "off".
        effort_offset: EffortFeedforward = OneOf,
        /// Time by which a command of the motion task may be late without being predicted, a whole number of base ticks and two of the
        /// task's cycles at most; it adds to the delay to the drive; default: none.
        margin: f64 = positive(Plain(&TIME), "1 ms"),
        /// Cycles of the motion task by which the master predicts its motion: they shorten the delay to the drive, and cost the change
        /// of the motion meanwhile (docs/fieldbus.md); at most 2 with B-splines, otherwise 1; default: 0.
        run_ahead: u32 = 0..=2,
        /// Sequence by which the master powers the drive; default: "strict".
        sequencing: Sequencing = OneOf,
        /// Longest time that the master waits for the drive; default: 0.5 s.
        drive_timeout: f64 = positive(Plain(&TIME), "0.5 s"),
        /// Proportional gain of the master's position loop, with "csv".
        position_gain: f64 = positive(Plain(&POSITION_GAIN), "100 1/s"),
        /// Integral time of the master's position loop, with "csv": a constant error goes to zero. It must be well above
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
        /// Actual velocity from differences of positions in the master; default: false, the drive sends it.
        velocity_from_differences: bool = (),
        /// Switches wired normally closed: drive and master invert their inputs, and an input without a switch reads as active;
        /// default: false, they are wired normally open.
        reverse_switches: bool = (),
        /// Faults of the bus and of the motion task; `[[bus.fault]]` for each.
        fault: Many<BusFault> = (),
    }
}

table! {
    /// Counter of the positions on the bus: it wraps.
    pub(crate) struct Counter {
        /// Width of the counter; default: 32. The objects of CiA 402 (607Ah, 6064h, 6062h) have 32 bits: of a wider counter they hold the
        /// lower half, and objects of the manufacturer the upper one.
        bits: u32 = 8..=64,
        /// Signed counter, from −2^(bits−1); default: true.
        signed: bool = (),
    }
}

table! {
    /// Units of the positions on the bus: so many units of the `drive` are this much of the `axis`.
    pub(crate) struct DriveUnits requires ["drive", "axis"] {
        /// Units of the drive.
        drive: u32 = 1..=u32::MAX,
        /// Their length or angle on the axis. Negative for a motor that is mounted the other way round: it turns and counts against the
        /// axis, so that the input for its positive limit switch has the switch of the axis' negative end, and vice versa.
        axis: f64 = any(InAxis(&POSITION), "5 mm"),
    }
}

table! {
    /// A fault of the bus or of the motion task, for a number of `cycles` or a `duration`; the cycles are those of the motion task for
    /// the kinds "task-…", of the bus for the others. Default: one cycle for the kinds lost, late and torn, to the end of the run for
    /// the others.
    pub(crate) struct BusFault requires ["kind"] {
        /// Kind of the fault.
        kind: FaultName = OneOf,
        /// Start: from the first cycle that is not before it; default: 0.
        start: f64 = not_negative(Plain(&TIME), "0.5 s"),
        /// Number of cycles that it affects.
        cycles: u32 = 1..=u32::MAX,
        /// Duration of the fault: it affects the cycles that begin before its end.
        duration: f64 = positive(Plain(&TIME), "20 ms"),
        /// Delay of the kinds "late", largest delay of the kinds "jitter", or time by which a cycle is too short with "task-fast"; a
        /// whole number of base ticks.
        by: f64 = positive(Plain(&TIME), "250 us"),
        /// Seed of the random numbers of "jitter" and "task-jitter"; default: 1.
        seed: u32 = 0..=u32::MAX,
    }
}
