//! The tables of a scenario file, as written: every key optional, every quantity in SI, not resolved yet.
//!
//! The single description of the format. Keys in the motor coordinate follow the motor (rad, N·m for a rotary one), those in the
//! axis coordinate the load.

mod axis;
mod bus;
mod drive;
mod drive_blocks;
mod drive_filters;
mod fmu;
mod inverter;
mod motor;
mod motor_effects;
mod plc;
mod program;
mod requirements;
mod sensors;
mod setpoint;
mod supervision;

pub(crate) use axis::{Axis, Body, FrictionKeys, Mjcf};
pub(crate) use bus::{Bus, BusFault, DriveInterpolation, FaultName};
pub(crate) use drive::{Current, Drive, Estimate, FeedbackEncoder, Velocity, VelocityKind};
pub(crate) use drive_blocks::{CoggingHarmonic, DeadTimeCompensation, GainSchedule, I2t, ThermalLoad};
pub(crate) use drive_filters::{FilterKind, TorqueFilter};
pub(crate) use fmu::{Coupling, Fmu};
pub(crate) use motor::{Motor, MotorKind};
pub(crate) use motor_effects::{Cogging, FluxHarmonic, IronLoss, Temperature, Thermal};
pub(crate) use plc::{Call, CamSwitch, Condition, Plc, TrackOptions, Update};
pub(crate) use program::{Disturbance, ProgramStep};
pub(crate) use requirements::{Expect, ExpectedOn, RequirementTable, Tolerance};
pub(crate) use sensors::{CurrentSensor, Encoder, Mount};
pub(crate) use setpoint::{Rockwell, Setpoint, Shaper, TableOfPoints};

use crate::format::FORMAT;
use crate::limit_table::LimitTable;
use crate::list::{BoundOrNone, Many, OneOrMany};
use crate::simple::OneOf;
use crate::table::table;
use servobench_base::Rate;
use servobench_config::Kind::{Axis as InAxis, Plain};
use servobench_config::quantities::{FREQUENCY, POSITION, TIME, VELOCITY};
use servobench_config::{any, not_negative, positive};
use servobench_plant::EngineName;
use servobench_signals::Signal;

table! {
    /// A scenario of servobench: an axis, a program of moves, what to measure and the limits that make it pass or fail.
    /// Physical quantities are strings with a unit: "250 mm", "30 m/min", "8 kHz", "4.2 Arms".
    pub(crate) struct File requires ["run", "axis", "motor"] {
        /// Number of the format that the file is written in; default: the newest. CHANGELOG.md lists the changes of each.
        format: u32 = 1..=FORMAT,
        /// Name in tables and results; default: the file's name.
        name: String = (),
        /// Purpose of the scenario, in a sentence.
        description: String = (),
        /// Engine or engines to run it on; default: "exact".
        engine: OneOrMany<EngineName> = OneOf,
        /// Time base of the run.
        run: Run = (),
        /// The mechanics.
        axis: Axis = (),
        /// The motor of the axis.
        motor: Motor = (),
        /// The firmware of the drive.
        drive: Drive = (),
        /// Limits and profile of every move, unless the move overrides them.
        setpoint: Setpoint = (),
        /// Moves and pauses, one after the other from time 0; `[[program]]` for each.
        program: Many<ProgramStep> = (),
        /// The fieldbus between the motion task and the drive; without it the drive has a set-point at every tick.
        bus: Bus = (),
        /// Settings of all `[[call]]`s.
        plc: Plc = (),
        /// Calls of PLCopen function blocks instead of a program; `[[call]]` for each.
        call: Many<Call> = (),
        /// Parts that FMUs simulate beside the axis: a load, a controller, a source of signals; `[[fmu]]` for each.
        fmu: Many<Fmu> = (),
        /// Exchange of signals between FMUs and the axis.
        coupling: Coupling = (),
        /// External forces and torques; `[[disturbance]]` for each.
        disturbance: Many<Disturbance> = (),
        /// State of the load at time 0; the motor is at rest at zero.
        initial: Initial = (),
        /// Rows and channels to record.
        record: Record = (),
        /// Settings of the metrics.
        measure: Measures = (),
        /// Requirements on the run beside its limits; each applies unless it is `false`.
        requirements: RequirementTable = (),
        /// Tolerances between the axis and its requests.
        tolerance: Tolerance = (),
        /// Faults that belong to the run; `[[expect]]` for each.
        expect: Many<Expect> = (),
        /// Limits by metric: the largest allowed magnitude, or a range `{ min = …, max = … }`. Those of an axis named `x` may stand in
        /// `[limits.x]`.
        limits: LimitTable = (),
    }
}

table! {
    /// Time base of the run.
    pub(crate) struct Run requires ["base_rate"] {
        /// One tick of mechanics; every task rate divides it.
        base_rate: Rate = "16 kHz",
        /// Length of the run, 1e6 s at most; default: the program and half a second.
        duration: f64 = positive(Plain(&TIME), "2 s"),
        /// Longest time of the run by the clock, "none" for no limit; default: ten minutes and a hundred times the time
        /// that `check` estimates. A longer run is an error. The simulation does not depend on it.
        time_limit: BoundOrNone = positive(Plain(&TIME), "5 min"),
    }
}

table! {
    /// State of the load at time 0; the motor is at rest at zero.
    pub(crate) struct Initial {
        /// Position of the load (axis coordinate).
        load_position: f64 = any(InAxis(&POSITION), "0.1 mm"),
        /// Velocity of the load (axis coordinate).
        load_velocity: f64 = any(InAxis(&VELOCITY), "10 mm/s"),
    }
}

table! {
    /// Rows and channels to record.
    pub(crate) struct Record {
        /// Rate of the recorded rows; default: the base rate. It divides the base rate. Metrics are measured at every tick.
        rate: Rate = "4 kHz",
        /// Channels to record; default: all that the axis has.
        channels: OneOrMany<Signal> = (),
    }
}

table! {
    /// Settings of the metrics.
    pub(crate) struct Measures {
        /// Settling window around the target, ± (axis coordinate). Without it the settling time is absent.
        window: f64 = positive(InAxis(&POSITION), "10 um"),
        /// Position in the machine at which homing must put the task's zero (axis coordinate); default: any.
        home_at: f64 = any(InAxis(&POSITION), "-2 mm"),
        /// Start of the measurement of residual vibration; default: the end of the last profile.
        from: f64 = not_negative(Plain(&TIME), "0.2 s"),
        /// Frequency of the residual mode to look for; default: any.
        mode: f64 = positive(Plain(&FREQUENCY), "38.985 Hz"),
    }
}
