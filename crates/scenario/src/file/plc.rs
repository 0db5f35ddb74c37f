//! `[plc]` and `[[call]]`: the PLC program.
use super::setpoint::TableOfPoints;
use crate::block::BlockName;
use crate::list::Many;
use crate::scenario::{BufferMode, Direction};
use crate::simple::OneOf;
use crate::table::table;
use crate::when::When;
use servobench_config::Choice;
use servobench_config::Kind::{Axis as InAxis, Motor as InMotor, Plain};
use servobench_config::quantities::{ACCELERATION, EFFORT, EFFORT_RATE, JERK, POSITION, RATIO, SNAP, TIME, VELOCITY};
use servobench_config::{any, not_negative, positive};

impl Choice for BufferMode {
    const ALL: &'static [(&'static str, Self, &'static str)] = &[
        ("aborting", Self::Aborting, "the motion under way is broken off"),
        ("buffered", Self::Buffered, "the motion under way ends first"),
        ("blending-low", Self::BlendingLow, "its target is passed at the lower of both velocities"),
        ("blending-previous", Self::BlendingPrevious, "its target is passed at its own velocity"),
        ("blending-next", Self::BlendingNext, "its target is passed at the velocity of the next"),
        ("blending-high", Self::BlendingHigh, "its target is passed at the higher of both velocities"),
    ];
}

impl Choice for Direction {
    const ALL: &'static [(&'static str, Self, &'static str)] = &[
        ("positive", Self::Positive, "upwards"),
        ("negative", Self::Negative, "downwards"),
        ("shortest", Self::Shortest, "the shorter way of a modulo axis"),
        ("current", Self::Current, "as the axis goes already"),
    ];
}

table! {
    /// What holds for all `[[call]]`s.
    pub(crate) struct Plc {
        /// Whether absolute moves of an axis that was not homed are refused; they are unless given.
        homing_required: bool = (),
    }
}

table! {
    /// A call of a function block (PLCopen Motion Control, part 1, version 2.0), with an instance of its own. The PLC executes
    /// the calls once per cycle in the order of the file. Inputs have the standard's names; "Blocks" says which block has
    /// which. Velocity, acceleration, jerk and snap are those of `[setpoint]` unless given.
    pub(crate) struct Call requires ["block"] {
        /// The function block.
        block: BlockName = (),
        /// Name of the instance; that of the block with a number from 0 unless given ("MC_MoveAbsolute_0").
        name: String = (),
        /// When `Execute` or `Enable` becomes TRUE; in the first cycle unless given.
        start: When = (),
        /// When it becomes FALSE. Unless given, `Execute` falls a cycle after the block has ended, and `Enable` stays.
        stop: When = (),
        /// Fails the run when `start` has not come by then, with the reason; the end of the run unless given.
        timeout: f64 = positive(Plain(&TIME), "2 s"),
        /// Whether the requirement `executed` does without it. A call that waits in vain on `Error` or `CommandAborted` of
        /// another one is optional anyway.
        optional: bool = (),
        /// New inputs while `Execute` is TRUE, of a block with `continuous_update`, or while `Enable` is, of MC_Power and
        /// MC_SetOverride.
        updates: Many<Update> = (),
        /// Target position, of MC_Home and MC_SetPosition the position that the axis is given.
        position: f64 = any(InAxis(&POSITION), "250 mm"),
        /// Distance.
        distance: f64 = any(InAxis(&POSITION), "-250 mm"),
        /// Velocity; of MC_MoveVelocity it may be negative.
        velocity: f64 = any(InAxis(&VELOCITY), "30 m/min"),
        /// Velocity at the target, kept afterwards; of MC_PositionProfile at its last position, 0 unless given.
        end_velocity: f64 = any(InAxis(&VELOCITY), "5 m/min"),
        /// Largest velocity on top of the motion under way.
        velocity_difference: f64 = positive(InAxis(&VELOCITY), "5 m/min"),
        /// Largest acceleration.
        acceleration: f64 = positive(InAxis(&ACCELERATION), "5 m/s2"),
        /// Largest deceleration; as `acceleration` unless given.
        deceleration: f64 = positive(InAxis(&ACCELERATION), "8 m/s2"),
        /// Largest jerk.
        jerk: f64 = positive(InAxis(&JERK), "50 m/s3"),
        /// Largest snap, an input beside those of the standard.
        snap: f64 = positive(InAxis(&SNAP), "1000 m/s4"),
        /// Which way the axis goes. Of a move to a position on a modulo axis, "shortest" unless given; otherwise "positive", and
        /// a negative velocity or torque goes the other way.
        direction: Direction = OneOf,
        /// What becomes of the motion under way; "aborting" unless given.
        buffer_mode: BufferMode = OneOf,
        /// Whether `updates` count while `Execute` is TRUE; they do not unless given.
        continuous_update: bool = (),
        /// Torque, of a linear motor the force.
        torque: f64 = any(InMotor(&EFFORT), "2 Nm"),
        /// Largest change of the torque; at once unless given.
        torque_ramp: f64 = positive(InMotor(&EFFORT_RATE), "10 Nm/s"),
        /// Factor of all velocities; 1 unless given.
        velocity_factor: f64 = not_negative(Plain(&RATIO), "50 %"),
        /// Factor of all accelerations and decelerations; 1 unless given.
        acceleration_factor: f64 = positive(Plain(&RATIO), "50 %"),
        /// Factor of all jerks; 1 unless given.
        jerk_factor: f64 = positive(Plain(&RATIO), "50 %"),
        /// Whether MC_SetPosition shifts the position by the given one; it does not unless given.
        relative: bool = (),
        /// From the end of a profile until the generator is ready for the next.
        settling_time: f64 = positive(Plain(&TIME), "50 ms"),
        /// Whether the motor is mounted the other way round; it is not unless given.
        reversed: bool = (),
        /// Whether MC_Power permits motion upwards; it does unless given.
        enable_positive: bool = (),
        /// Whether MC_Power permits motion downwards; it does unless given.
        enable_negative: bool = (),
        /// Table of a profile, whose times count from its start; a first row at 0 says where the axis is then. The file of
        /// MC_PositionProfile has the columns `time` and `position`, that of MC_VelocityProfile `velocity`, that of
        /// MC_AccelerationProfile `acceleration`. Positions are followed along the cubic spline, or by `follow = "plateaus"`.
        table: TableOfPoints = (),
        /// Factor of the times of a table; 1 unless given.
        time_scale: f64 = positive(Plain(&RATIO), "2"),
        /// Factor of the values of a table, not 0; 1 unless given.
        value_scale: f64 = any(Plain(&RATIO), "-0.5"),
        /// What is then added to the positions of a table; nothing unless given.
        position_offset: f64 = any(InAxis(&POSITION), "10 mm"),
        /// What is then added to the velocities of a table; nothing unless given.
        velocity_offset: f64 = any(InAxis(&VELOCITY), "1 m/min"),
        /// What is then added to the accelerations of a table; nothing unless given.
        acceleration_offset: f64 = any(InAxis(&ACCELERATION), "1 m/s2"),
    }
}

table! {
    /// New inputs of a call; the others stay as they are.
    pub(crate) struct Update requires ["when"] {
        /// When.
        when: When = (),
        /// Target position.
        position: f64 = any(InAxis(&POSITION), "250 mm"),
        /// Distance.
        distance: f64 = any(InAxis(&POSITION), "-250 mm"),
        /// Velocity; of MC_MoveVelocity it may be negative.
        velocity: f64 = any(InAxis(&VELOCITY), "30 m/min"),
        /// Velocity at the target, kept afterwards.
        end_velocity: f64 = any(InAxis(&VELOCITY), "5 m/min"),
        /// Largest velocity on top of the motion under way.
        velocity_difference: f64 = positive(InAxis(&VELOCITY), "5 m/min"),
        /// Largest acceleration.
        acceleration: f64 = positive(InAxis(&ACCELERATION), "5 m/s2"),
        /// Largest deceleration.
        deceleration: f64 = positive(InAxis(&ACCELERATION), "8 m/s2"),
        /// Largest jerk.
        jerk: f64 = positive(InAxis(&JERK), "50 m/s3"),
        /// Largest snap.
        snap: f64 = positive(InAxis(&SNAP), "1000 m/s4"),
        /// Which way the axis goes.
        direction: Direction = OneOf,
        /// Torque, of a linear motor the force.
        torque: f64 = any(InMotor(&EFFORT), "2 Nm"),
        /// Largest change of the torque.
        torque_ramp: f64 = positive(InMotor(&EFFORT_RATE), "10 Nm/s"),
        /// Factor of all velocities.
        velocity_factor: f64 = not_negative(Plain(&RATIO), "50 %"),
        /// Factor of all accelerations and decelerations.
        acceleration_factor: f64 = positive(Plain(&RATIO), "50 %"),
        /// Factor of all jerks.
        jerk_factor: f64 = positive(Plain(&RATIO), "50 %"),
        /// Whether MC_Power permits motion upwards.
        enable_positive: bool = (),
        /// Whether MC_Power permits motion downwards.
        enable_negative: bool = (),
    }
}

table! {
    /// When something happens: give one of `at`, `after`, `above` and `below`.
    pub(crate) struct Condition {
        /// At a time of the run.
        at: f64 = not_negative(Plain(&TIME), "0.2 s"),
        /// When an output of another call has become TRUE ("first.Done").
        after: String = (),
        /// How long after that; at once unless given.
        delay: f64 = not_negative(Plain(&TIME), "50 ms"),
        /// When the actual position passes this one upwards, or is above it already.
        above: f64 = any(InAxis(&POSITION), "50 mm"),
        /// When the actual position passes this one downwards, or is below it already.
        below: f64 = any(InAxis(&POSITION), "50 mm"),
    }
}
