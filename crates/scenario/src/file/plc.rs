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
    /// What holds for all `[[call]]`s.
    pub(crate) struct Plc {
        /// Whether absolute moves of an axis that was not homed are refused; default: true.
        homing_required: bool = (),
        /// From which velocity the acceleration of each velocity counts that a drive in the mode "pv" is sent; default: "set-point".
        ramp_start: RampStart = OneOf,
    }
}

table! {
    /// A call of a function block (PLCopen Motion Control, part 1, version 2.0), with an instance of its own. The PLC
    /// executes the calls once per cycle in the order of the file. Inputs have the standard's names; "Blocks" says
    /// which block has which; default: velocity, acceleration, jerk and snap are those of `[setpoint]`.
    pub(crate) struct Call requires ["block"] {
        /// The function block.
        block: BlockName = (),
        /// Name of the instance; default: that of the block with a number from 0 ("MC_MoveAbsolute_0").
        name: String = (),
        /// When `Execute` or `Enable` becomes TRUE; default: in the first cycle.
        start: When = (),
        /// When it becomes FALSE. Unless given, `Execute` falls a cycle after the block has ended, and `Enable` stays.
        stop: When = (),
        /// Fails the run when `start` has not come by then, with the reason; default: the end of the run.
        timeout: f64 = positive(Plain(&TIME), "2 s"),
        /// Whether the requirement `executed` does without it. A call that waits in vain on `Error` or `CommandAborted` of
        /// another one is optional anyway.
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
        /// Where it becomes TRUE upwards; with `last` the lower end of the window, in which it is TRUE.
        first: f64 = any(InAxis(&POSITION), "10 mm"),
        /// The upper end of the window. Below `first` on a modulo axis, whose window goes over the zero then.
        last: f64 = any(InAxis(&POSITION), "20 mm"),
        /// How long it stays TRUE after the axis has passed `first`, wherever the axis goes then.
        duration: f64 = positive(Plain(&TIME), "5 ms"),
        /// In which direction of the axis it acts; default: "both".
        direction: CamDirection = OneOf,
    }
}

table! {
    /// What holds for all switches of a track of MC_DigitalCamSwitch.
    pub(crate) struct TrackOptions requires ["track"] {
        /// Track.
        track: u32 = 0..=31,
        /// How much later the output is switched on than the axis passes the edge, earlier where it is negative; default: 0.
        on_compensation: f64 = any(Plain(&TIME), "-2 ms"),
        /// The same of switching off; default: 0.
        off_compensation: f64 = any(Plain(&TIME), "-2 ms"),
        /// How far the axis has to go from an edge at which the output has switched before it switches again; default: 0.
        hysteresis: f64 = not_negative(InAxis(&POSITION), "0.1 mm"),
    }
}

table! {
    /// New inputs of a call; the others stay as they are.
    pub(crate) struct Update requires ["when"] {
        /// When.
        when: When = (),
        ..inputs: BlockInputs = Moment::Later
    }
}

table! {
    /// When something happens: give one of `at`, `after`, `above` and `below`.
    pub(crate) struct Condition {
        /// At a time of the run.
        at: f64 = not_negative(Plain(&TIME), "0.2 s"),
        /// When an output of another call has become TRUE ("first.Done").
        after: String = (),
        /// How long after that; default: at once.
        delay: f64 = not_negative(Plain(&TIME), "50 ms"),
        /// When the actual position passes this one upwards, or is above it already.
        above: f64 = any(InAxis(&POSITION), "50 mm"),
        /// When the actual position passes this one downwards, or is below it already.
        below: f64 = any(InAxis(&POSITION), "50 mm"),
    }
}
