//! `[setpoint]`: limits of all moves, and the generation, filtering and interpolation of set-points.
use crate::list::{Automatic, Many, OneOrMany};
use crate::simple::{OneOf, OneOfOrNone};
use crate::table::table;
use servobench_config::Kind::{Axis as InAxis, Plain};
use servobench_config::quantities::{ACCELERATION, FREQUENCY, JERK, RATIO, TIME};
use servobench_config::{not_negative, positive};
use servobench_motion::LimitParameter;
use servobench_motion::interpolate::Mode;
use servobench_motion::online::Effort;
use servobench_motion::rockwell::ShapeKind;
use servobench_motion::sampled::Execution;
use servobench_motion::shape::ShaperKind;
use servobench_planner::{FollowKind, Method, Sampling, VelocitiesKind};

table! {
    /// Limits and profile of every move, unless the move overrides them.
    pub(crate) struct Setpoint {
        /// Order of the profile: 2 limits velocity and acceleration, 3 jerk too, 4 snap too.
        order: u32 = 2..=4,
        velocity: f64 = LimitParameter::VELOCITY,
        acceleration: f64 = LimitParameter::ACCELERATION,
        jerk: f64 = LimitParameter::JERK,
        snap: f64 = LimitParameter::SNAP,
        /// Profile of moves from rest to rest; default: "published".
        method: Method = OneOf,
        /// Sample time of moves from rest to rest, a whole number of base ticks; default: continuous.
        sample_time: f64 = positive(Plain(&TIME), "1 ms"),
        /// Rounding of the times to whole numbers of samples; default: "published".
        sampling: Sampling = OneOf,
        /// Set-points made from the samples; default: "hold".
        execution: Execution = OneOf,
        /// Plans every move as one that may start in motion, with this amount of work; a move that does start in motion is planned
        /// "fast" by default.
        online: Effort = OneOf,
        /// default: as `velocity`.
        negative_velocity: f64 = LimitParameter::NEGATIVE_VELOCITY,
        /// default: as `acceleration`.
        negative_acceleration: f64 = LimitParameter::NEGATIVE_ACCELERATION,
        /// Moves by the operands of Rockwell's axis move.
        rockwell: Rockwell = (),
        /// Input shaper, against one mode of the axis; a list of them for several modes.
        shaper: OneOrMany<Shaper> = (),
        /// Lengths of moving averages behind the generator, one after the other, whole numbers of base ticks.
        averages: Many<f64> = positive(Plain(&TIME), "10 ms"),
        /// Interpolation between the set-points of a slow task; default: none, the drive has a new set-point at every tick.
        interpolation: Interpolation = (),
    }
}

table! {
    /// Rockwell's axis move: velocity from rest to the speed and back, with jerk as a value (`jerk` of the move) or as a part.
    pub(crate) struct Rockwell requires ["shape"] {
        /// Shape of the velocity.
        shape: ShapeKind = OneOf,
        /// Largest deceleration; default: as `acceleration`.
        deceleration: f64 = positive(InAxis(&ACCELERATION), "8 m/s2"),
        /// Jerk as the part of the ramp in which the acceleration changes, above 0 to 100 %.
        jerk_of_time: f64 = positive(Plain(&RATIO), "25 %"),
        /// Jerk as a part of `maximum_jerk`, above 0 to 100 %.
        jerk_of_maximum: f64 = positive(Plain(&RATIO), "60 %"),
        /// Jerk as the time in which the acceleration rises at the beginning of the ramp, and falls at its end; at most half of it counts.
        jerk_time: f64 = positive(Plain(&TIME), "2 ms"),
        /// The same time as the distance of a master in its units, at `master_speed`.
        jerk_master_units: f64 = positive(Plain(&RATIO), "1.5"),
        /// Jerk of the deceleration, by one of these five keys; default: as for the acceleration.
        deceleration_jerk: f64 = positive(InAxis(&JERK), "80 m/s3"),
        /// Jerk of the deceleration as the part of its ramp in which it changes.
        deceleration_jerk_of_time: f64 = positive(Plain(&RATIO), "50 %"),
        /// Jerk of the deceleration as a part of `maximum_deceleration_jerk`.
        deceleration_jerk_of_maximum: f64 = positive(Plain(&RATIO), "60 %"),
        /// Jerk of the deceleration as the time in which it changes at either end.
        deceleration_jerk_time: f64 = positive(Plain(&TIME), "2 ms"),
        /// Jerk of the deceleration as the distance of the master in that time.
        deceleration_jerk_master_units: f64 = positive(Plain(&RATIO), "1.5"),
        /// Speed of the master, in its units per second.
        master_speed: f64 = positive(Plain(&RATIO), "360"),
        /// Largest jerk of accelerations that the axis is configured for: that of a trapezoid.
        maximum_jerk: f64 = positive(InAxis(&JERK), "500 m/s3"),
        /// Largest jerk of decelerations; default: as `maximum_jerk`.
        maximum_deceleration_jerk: f64 = positive(InAxis(&JERK), "500 m/s3"),
    }
}

table! {
    /// An input shaper: the move in parts, each half a period of a mode later than the one before, so that their vibrations
    /// cancel.
    pub(crate) struct Shaper requires ["kind"] {
        /// Kind of shaper.
        kind: Option<ShaperKind> = OneOfOrNone("no shaper, where `[setpoint]` has one; in a list this one is left out"),
        /// Natural frequency of the mode.
        frequency: f64 = positive(Plain(&FREQUENCY), "17.5 Hz"),
        /// Damping ratio of the mode; default: 0.
        damping: f64 = not_negative(Plain(&RATIO), "0.02"),
        /// Part of the vibration that an EI shaper may leave; default: 0.05.
        tolerable: f64 = positive(Plain(&RATIO), "5 %"),
    }
}

table! {
    /// Interpolation between the set-points of a slow task.
    pub(crate) struct Interpolation requires ["mode", "period"] {
        /// Method of interpolation between two commands.
        mode: Mode = OneOf,
        /// Time between two commands, a whole number of base ticks.
        period: f64 = positive(Plain(&TIME), "4 ms"),
    }
}

table! {
    /// A table of points to follow. It starts and ends at rest unless its first and last point have a velocity.
    pub(crate) struct TableOfPoints requires ["file"] {
        /// A CSV file, relative to this one, with the heading `time [ms],position [mm],velocity [mm/s]`: any units, velocity
        /// left out where there is none; `step` in place of `position` counts from the point before; over a bus also in `counts`.
        /// Columns `acceleration`, `jerk` and `snap` are not used.
        file: String = (),
        /// Counts the positions from the position of the axis at the start of the move.
        relative: bool = (),
        /// Source of the velocities; default: "given".
        velocities: VelocitiesKind = OneOf,
        /// Number of passes of "smooth"; default: 2.
        passes: u32 = 0..=1_000_000,
        /// Method of following the table; default: "segments".
        follow: FollowKind = OneOf,
        /// Share of a segment at either end in which the velocity of "plateaus" changes, up to 0.5; "auto" is the share that needs the
        /// smallest part of the velocity and acceleration allowed to the move; default: 0.25.
        plateau_share: Automatic = positive(Plain(&RATIO), "0.25"),
        /// Commands per second of "steps".
        command_rate: f64 = positive(Plain(&FREQUENCY), "100 Hz"),
    }
}
