//! Interpolated position (ip, mode 7): the drive follows points that the master keeps sending to a [`Buffer`].
//!
//! The formats of points are defined by [`interpolated`](servobench_cia402::interpolated) of the drive profile; this mode reads them from
//! the frame (2010h), from the [`DataRecord`] and from the serial interface ([`serial::Port`]).
//!
//! # A move
//!
//! The rising edge of the controlword's bit 4 starts it, or the start move command of the serial interface; bit 12 of the statusword is set
//! while it lasts. The meaning of the first point depends on the sub-mode:
//!
//! | sub-mode | |
//! |---|---|
//! | 0 | the buffer is emptied at the start; once three points are there, the axis goes to the first one in the time of a segment |
//! | −1 | the axis goes to the first point in the time of a segment |
//! | −2, −3, serial | the axis is at the first point, to a count, or the move is not started |
//!
//! In sub-mode 0 a segment is longer by a period of the drive if fewer than three points wait at its beginning, and shorter by one if more
//! do: clocks may differ by one such period per segment.
//!
//! A move ends at its last point, which has a time of 0. It is aborted when bit 4 is cleared (unless the serial interface started it), by a
//! halt, when the buffer is cleared, and when the next point is missing, which is an underflow, moving or not. Then, and at a last point
//! that has a velocity, the axis is stopped within [`Params::stop`] from its present state: position and velocity do not jump, nor does the
//! acceleration if there is a jerk.
//!
//! The highest velocity (6080h) limits the points: an excess is cut, and the drive reports it (bit 11). The missing distance is caught up
//! afterwards, as far as the highest velocity allows, and a move whose last point is not reached in time continues to it.
//!
//! # Errors
//!
//! Underflow, overflow and a break in the sequence of 2010h are latched in the status of the buffer (2012h) until they are cleared:
//! individually with 2010h, or all by clearing the buffer through the serial interface, which has no other command for it. While an error
//! is latched, no move is started; behind a lost point, none is added.
//!
//! Sources: Copley Controls, *PVT Trajectory Calculations*, rev. 00 (2020); *CANopen Programmer's Manual*, 95-00271-000 rev. 7
//! (2012), pp. 209–218, 2010h to 2013h; IEC 61800-7-201, interpolated position mode.
mod buffer;
mod course;
mod data_record;
pub mod serial;

use super::ramp::{Ramp, Steepness};
use super::{Answer, Moment};
use crate::Demand;
use course::{Course, HELD, Pace, Step, next_knot};
use servobench_base::{ParamError, Setpoint, Stateful, limit};
use servobench_cia402::ControlBit;
use servobench_cia402::interpolated::{BufferError, SubMode, TimePeriod};
use thiserror::Error;

pub use buffer::{Buffer, Refusal};
pub use data_record::{DataRecord, RecordError};

/// Settings for following the points; constant while the mode is active.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// 60C0h.
    pub sub_mode: SubMode,
    /// 60C2h.
    pub period: TimePeriod,
    /// Metres or radians per count, negative if the counter runs in the opposite direction.
    pub count: f64,
    /// Stop of an aborted move: quick stop deceleration (6085h) and its jerk.
    pub stop: Steepness,
    /// Highest velocity (6080h), a magnitude; may be infinite.
    pub velocity: f64,
}

impl Params {
    /// # Errors
    /// [`ParamError`] names the first value out of its bound.
    pub fn check(&self) -> Result<(), ParamError> {
        if !(self.count != 0.0 && self.count.is_finite()) {
            return Err(ParamError { name: "count", value: self.count, bound: "finite and not zero" });
        }
        self.stop.check()?;
        limit("max_motor_speed", self.velocity).map(|_| ())
    }
}

/// State from tick to tick, apart from the buffer.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct State {
    phase: Phase,
    /// Bit 4 at the last step.
    asked: bool,
    refused: Option<StartRefused>,
    ramp: Ramp,
}

#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
enum Phase {
    /// Before the first step.
    TakingOver,
    /// At rest, or braking to it.
    Resting,
    /// Waits for the points of sub-mode 0.
    Waiting,
    Following {
        course: Course,
        pace: Pace,
        by_bus: bool,
    },
}

/// Cause of a refused start.
#[derive(Debug, Clone, Copy, PartialEq, Error, Stateful)]
pub enum StartRefused {
    /// Errors of the buffer are latched.
    #[error("errors {errors:#04x} of the trajectory buffer are latched (2012h): clear them first")]
    Latched {
        /// Errors as in the highest byte of 2012h.
        errors: u8,
    },
    /// A move is active.
    #[error("a move is active: wait for it to finish, or abort it")]
    Running,
    /// The axis would jump to the first point.
    #[error(
        "the first point is at {first} counts, the axis at {axis}: begin within a count of the axis, or relative to it"
    )]
    FarPoint {
        /// Position of the first point (counts).
        first: i64,
        /// Commanded position of the axis (counts).
        axis: i64,
    },
}

impl State {
    /// Begins the mode, or continues after a halt: neither a bit 4 that is already set nor an earlier start move command starts a move.
    #[must_use]
    pub fn begin(now: &Moment) -> Self {
        Self { phase: Phase::TakingOver, asked: asks(now), refused: None, ramp: Ramp::default() }
    }

    /// Cause of the last refused start, if any.
    #[must_use]
    pub const fn refused(&self) -> Option<StartRefused> {
        self.refused
    }

    /// True while a move is active (bit 12 of the statusword).
    #[must_use]
    pub const fn is_following(&self) -> bool {
        matches!(self.phase, Phase::Following { .. })
    }

    /// True if the move is slower than its points request.
    #[must_use]
    pub const fn is_limited(&self) -> bool {
        matches!(&self.phase, Phase::Following { course, .. } if course.is_limited())
    }

    /// Starts a move by the bus or the serial interface.
    fn start(&mut self, p: &Params, buffer: &mut Buffer, now: &Moment, by_bus: bool) {
        self.refused = None;
        if buffer.errors() != 0 {
            self.refused = Some(StartRefused::Latched { errors: buffer.errors() });
        } else if by_bus && p.sub_mode == SubMode::LinearAdapted {
            buffer.flush();
            self.phase = Phase::Waiting;
        } else if by_bus && p.sub_mode == SubMode::Linear {
            self.approach(p, buffer, now, Pace::Given);
        } else {
            self.set_out(p, buffer, now, by_bus);
        }
    }

    /// Moves to the first point in the time of a segment.
    fn approach(&mut self, p: &Params, buffer: &mut Buffer, now: &Moment, pace: Pace) {
        let at = now.demanded.x;
        let duration = f64::from(p.period.microseconds()) / 1e6;
        let course = Course::approach(at, nearest(at / p.count), duration, p, buffer);
        self.follow(course, pace, true, buffer);
    }

    /// Moves from the first point, at which the axis is.
    fn set_out(&mut self, p: &Params, buffer: &mut Buffer, now: &Moment, by_bus: bool) {
        let at = now.demanded.x;
        let here = nearest(at / p.count);
        let as_before = *buffer;
        let Some(first) = next_knot(buffer, here) else {
            return buffer.latch(BufferError::Underflow);
        };
        if first.counts.abs_diff(here) > 1 {
            *buffer = as_before;
            self.refused = Some(StartRefused::FarPoint { first: first.counts, axis: here });
        } else if !first.is_last() {
            self.follow(Course::from_knot(first, at, p, buffer), Pace::Given, by_bus, buffer);
        }
    }

    fn follow(&mut self, course: Option<Course>, pace: Pace, by_bus: bool, buffer: &mut Buffer) {
        match course {
            Some(course) => self.phase = Phase::Following { course, pace, by_bus },
            None => buffer.latch(BufferError::Underflow),
        }
    }

    /// True if the move ends when bit 4 is cleared.
    const fn needs_bit(&self) -> bool {
        matches!(self.phase, Phase::Waiting | Phase::Following { by_bus: true, .. })
    }
}

/// Follows the points.
///
/// The parameters must have passed [`Params::check`].
pub fn step(p: &Params, x: &mut State, buffer: &mut Buffer, now: &Moment) -> Answer {
    let asked = asks(now);
    let is_halted = now.targets.controlword.has(ControlBit::Halt);
    let rises = asked && !x.asked && !is_halted;
    x.asked = asked;
    let takes_over = matches!(x.phase, Phase::TakingOver);
    let starts = buffer.take_start() && !takes_over && !is_halted || rises;
    let breaks_off = buffer.take_abort() || takes_over || is_halted;
    if breaks_off || !asked && x.needs_bit() {
        x.phase = Phase::Resting;
    }
    if let Phase::Following { course, pace, .. } = &mut x.phase {
        if starts {
            x.refused = Some(StartRefused::Running);
        }
        match course.step(now.period, p, *pace, buffer) {
            Step::Along(setpoint) => return answer(setpoint, true),
            Step::Ended(end) => {
                x.phase = Phase::Resting;
                if end.v == 0.0 {
                    return answer(end, false);
                }
            }
            Step::Starved => {
                buffer.latch(BufferError::Underflow);
                x.phase = Phase::Resting;
            }
        }
    } else if starts {
        x.start(p, buffer, now, rises);
    }
    if matches!(x.phase, Phase::Waiting) && buffer.count() >= HELD {
        x.approach(p, buffer, now, Pace::Adapted);
    }
    if let Phase::Following { course, .. } = &x.phase {
        return answer(course.start(), true);
    }
    let rest = x.ramp.step(&p.stop, 0.0, now);
    // The ramp fails if the demand is not a valid state of motion: then the axis is held.
    answer(rest.unwrap_or(Setpoint::at_rest(now.demanded.x)), false)
}

fn answer(setpoint: Setpoint, is_following: bool) -> Answer {
    Answer {
        demand: Demand::position(setpoint),
        target_reached: !is_following && setpoint.v == 0.0 && setpoint.a == 0.0,
        bit_12: is_following,
        bit_13: false,
    }
}

const fn asks(now: &Moment) -> bool {
    now.targets.controlword.has(ControlBit::ModeSpecific4)
}

/// Nearest count, saturated at the range.
#[expect(clippy::cast_possible_truncation, reason = "saturates, which is meant")]
fn nearest(counts: f64) -> i64 {
    libm::round(counts) as i64
}
