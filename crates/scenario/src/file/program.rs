//! `[[program]]` and `[[disturbance]]`: moves, pauses and external efforts.
use super::setpoint::{Rockwell, Shaper, TableOfPoints};
use crate::limit_table::LimitTable;
use crate::list::{Many, OneOrMany};
use crate::scenario::DisturbedBody;
use crate::simple::OneOf;
use crate::table::table;
use servobench_config::Kind::{Axis as InAxis, Plain};
use servobench_config::quantities::{FORCE, FREQUENCY, POSITION, TIME, TORQUE, VELOCITY};
use servobench_config::{any, not_negative, positive};
use servobench_motion::LimitParameter;
use servobench_motion::online::Effort;
use servobench_motion::sampled::Execution;
use servobench_planner::{Method, Sampling};

table! {
    /// A move or a pause: give one of `move_to`, `move_by`, `reach_velocity`, `table` and `wait`. The other keys override
    /// `[setpoint]`.
    pub(crate) struct ProgramStep {
        /// Moves to a position.
        move_to: f64 = any(InAxis(&POSITION), "250 mm"),
        /// Moves by a distance from the last target.
        move_by: f64 = any(InAxis(&POSITION), "-250 mm"),
        /// Changes to a velocity and holds it for `hold`; the next move takes over in motion.
        reach_velocity: f64 = any(InAxis(&VELOCITY), "10 m/min"),
        /// Moves through the points of a table.
        table: TableOfPoints = (),
        /// Waits.
        wait: f64 = not_negative(Plain(&TIME), "0.2 s"),
        /// Passes the target of `move_to` or `move_by` at this velocity; the next move takes over in motion.
        end_velocity: f64 = any(InAxis(&VELOCITY), "5 m/min"),
        /// Time for which `reach_velocity` holds its velocity; default: not at all.
        hold: f64 = not_negative(Plain(&TIME), "0.5 s"),
        /// Aborts the move before at this time after its start, and takes over from its state of motion there.
        aborts_after: f64 = positive(Plain(&TIME), "0.3 s"),
        /// Order of the profile.
        order: u32 = 2..=4,
        velocity: f64 = LimitParameter::VELOCITY,
        acceleration: f64 = LimitParameter::ACCELERATION,
        jerk: f64 = LimitParameter::JERK,
        snap: f64 = LimitParameter::SNAP,
        /// Profile of a move from rest to rest.
        method: Method = OneOf,
        /// Sample time of the plan, a whole number of base ticks.
        sample_time: f64 = positive(Plain(&TIME), "1 ms"),
        /// Rounding of the times to whole numbers of samples.
        sampling: Sampling = OneOf,
        /// Set-points made from the samples.
        execution: Execution = OneOf,
        /// Plans as if the axis were in motion, with this amount of work.
        online: Effort = OneOf,
        negative_velocity: f64 = LimitParameter::NEGATIVE_VELOCITY,
        negative_acceleration: f64 = LimitParameter::NEGATIVE_ACCELERATION,
        /// Moves by the operands of Rockwell's axis move.
        rockwell: Rockwell = (),
        /// Input shaper, or a list of them.
        shaper: OneOrMany<Shaper> = (),
        /// Lengths of moving averages behind the generator; `[]` for none.
        averages: Many<f64> = positive(Plain(&TIME), "10 ms"),
        /// Slows the move to last this long, every derivative in proportion; default: as fast as the limits allow.
        duration: f64 = positive(Plain(&TIME), "1.5 s"),
        /// Limits on the metrics of this move, in addition to those of the run.
        limits: LimitTable = (),
    }
}

table! {
    /// An external force or torque: a step, or a sine with `frequency`.
    pub(crate) struct Disturbance requires ["on"] {
        /// Body it acts on.
        on: DisturbedBody = OneOf,
        /// Start: it acts from the first tick that is not before it; default: 0.
        start: f64 = not_negative(Plain(&TIME), "0.5 s"),
        /// Duration: it acts up to the last tick before its end; default: the end of the run.
        duration: f64 = positive(Plain(&TIME), "0.2 s"),
        /// Amplitude, where the body moves along a line.
        force: f64 = any(Plain(&FORCE), "200 N"),
        /// Amplitude, where the body turns.
        torque: f64 = any(Plain(&TORQUE), "2 Nm"),
        /// Frequency of a sine that is zero at its first tick.
        frequency: f64 = positive(Plain(&FREQUENCY), "40 Hz"),
    }
}
