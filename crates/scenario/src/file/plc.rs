//! `[plc]` and `[[call]]`: the PLC program.
use crate::block::{BlockInputs, Moment};
use crate::list::Many;
use crate::simple::OneOf;
use crate::table::table;
use crate::when::When;
use servobench_config::Kind::{Axis as InAxis, Plain};
use servobench_config::quantities::{POSITION, TIME};
use servobench_config::{any, not_negative, positive};
use servobench_plcopen::{BlockName, CamDirection, RampStart};

table! {
    /// Settings of all `[[call]]`s.
    pub(crate) struct Plc {
        /// Refuses absolute moves of an axis that is not homed; default: true.
        homing_required: bool = (),
        /// Velocity from which the acceleration of each velocity command counts, for a drive in the mode "pv"; default: "set-point".
        ramp_start: RampStart = OneOf,
    }
}

table! {
    /// A call of a function block (PLCopen Motion Control, part 1, version 2.0), with a separate instance. The PLC executes the calls
    /// once per cycle in the order of the file. Inputs have the standard's names; "Blocks" lists those of each block; default:
    /// velocity, acceleration, jerk and snap are those of `[setpoint]`.
    pub(crate) struct Call requires ["block"] {
        /// The function block.
        block: BlockName = (),
        /// Name of the instance; default: that of the block with a number from 0 ("MC_MoveAbsolute_0").
        name: String = (),
        /// Condition on which `Execute` or `Enable` becomes TRUE; default: in the first cycle.
        start: When = (),
        /// Condition on which it becomes FALSE; default: `Execute` falls a cycle after the block has ended, and `Enable` stays.
        stop: When = (),
        /// Fails the run when `start` has not come by then, with the reason; default: the end of the run.
        timeout: f64 = positive(Plain(&TIME), "2 s"),
        /// Exempts the call from the requirement `executed`. A call that waits in vain for `Error` or `CommandAborted` of another one
        /// is exempt anyway.
        optional: bool = (),
        /// New inputs while `Execute` is TRUE, of a block with `continuous_update`, or while `Enable` is, of MC_Power,
        /// MC_SetOverride and MC_DigitalCamSwitch.
        updates: Many<Update> = (),
        ..inputs: BlockInputs = Moment::Start
    }
}

table! {
    /// A switch of MC_DigitalCamSwitch: TRUE from `first` to `last`, or for a `duration` from `first` on.
    pub(crate) struct CamSwitch requires ["track", "first"] {
        /// Track, which is the bit of the digital outputs of the drive (60FEh) that it switches; switches of one track are ORed.
        track: u32 = 0..=31,
        /// Position at which it becomes TRUE upwards; with `last` the lower end of the window in which it is TRUE.
        first: f64 = any(InAxis(&POSITION), "10 mm"),
        /// The upper end of the window. Below `first` on a modulo axis, the window extends over the zero.
        last: f64 = any(InAxis(&POSITION), "20 mm"),
        /// Time for which it stays TRUE after the axis has passed `first`, whatever the axis does then.
        duration: f64 = positive(Plain(&TIME), "5 ms"),
        /// Direction of the axis in which it acts; default: "both".
        direction: CamDirection = OneOf,
    }
}

table! {
    /// Settings of all switches of a track of MC_DigitalCamSwitch.
    pub(crate) struct TrackOptions requires ["track"] {
        /// Track.
        track: u32 = 0..=31,
        /// Delay from the passing of the edge to switching the output on, negative to switch earlier; default: 0.
        on_compensation: f64 = any(Plain(&TIME), "-2 ms"),
        /// The same for switching off; default: 0.
        off_compensation: f64 = any(Plain(&TIME), "-2 ms"),
        /// Distance of the axis from an edge at which the output has switched before it switches again; default: 0.
        hysteresis: f64 = not_negative(InAxis(&POSITION), "0.1 mm"),
    }
}

table! {
    /// New inputs of a call; the others stay as they are.
    pub(crate) struct Update requires ["when"] {
        /// Condition of the change.
        when: When = (),
        ..inputs: BlockInputs = Moment::Later
    }
}

table! {
    /// A condition: give one of `at`, `after`, `above` and `below`.
    pub(crate) struct Condition {
        /// Time of the run.
        at: f64 = not_negative(Plain(&TIME), "0.2 s"),
        /// Output of another call that has become TRUE ("first.Done").
        after: String = (),
        /// Delay after that; default: at once.
        delay: f64 = not_negative(Plain(&TIME), "50 ms"),
        /// Position that the actual position passes upwards, or is above already.
        above: f64 = any(InAxis(&POSITION), "50 mm"),
        /// Position that the actual position passes downwards, or is below already.
        below: f64 = any(InAxis(&POSITION), "50 mm"),
    }
}
