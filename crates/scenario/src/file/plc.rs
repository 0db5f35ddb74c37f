//! `[plc]` and `[[call]]`: the PLC program.
use crate::block::{BlockInputs, Moment};
use crate::list::Many;
use crate::simple::OneOf;
use crate::table::table;
use crate::when::When;
use servobench_config::Kind::{Axis as InAxis, Plain};
use servobench_config::quantities::{POSITION, TIME};
use servobench_config::{any, not_negative, positive};
use servobench_plcopen::{BlockName, RampStart};

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
        /// New inputs while `Execute` is TRUE, of a block with `continuous_update`, or while `Enable` is, of MC_Power and
        /// MC_SetOverride.
        updates: Many<Update> = (),
        ..inputs: BlockInputs = Moment::Start
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
