//! Interpolated position (ip, mode 7): the drive follows points that the master keeps sending to a [`Buffer`].
//!
//! How points are written there is [`interpolated`](servobench_cia402::interpolated) of the drive profile; this mode reads them
//! from the frame (2010h), from the [`DataRecord`] and from the serial interface ([`serial::Port`]).
//!
//! # A move
//!
//! The rising edge of the controlword's bit 4 starts it, or the start move command of the serial interface; bit 12 of the
//! statusword is set as long as it lasts. What the first point means depends on the sub-mode:
//!
//! | sub-mode | |
//! |---|---|
//! | 0 | the buffer is emptied at the start; once three points are there, the axis goes to the first one in the time of a segment |
//! | −1 | the axis goes to the first point in the time of a segment |
//! | −2, −3, serial | the axis is at the first point, to a count, or the move is not started |
//!
//! In sub-mode 0 a segment is a period of the drive longer when fewer than three points wait as it begins, and one shorter when
//! more do: clocks may differ by one such period per segment.
//!
//! A move ends where its last point says, by a time of 0. It is broken off when bit 4 is taken back (unless it was started by the
//! serial interface), by a halt, when the buffer is cleared, and when the next point is not there, which is an underflow, moving or
//! not. Then, and at a last point that has a velocity, the axis is stopped within [`Params::stop`] from the state that it has:
//! position and velocity do not jump, with a jerk nor does the acceleration.
//!
//! The points may ask for no more than the highest velocity (6080h): what is beyond is cut, and the drive says so (bit 11). What is
//! missing of the way is made up for behind it, as far as the highest velocity allows, and a move whose last point is not reached in
//! time goes on until it is there.
//!
//! # Errors
//!
//! Underflow, overflow and a break in the sequence of 2010h are latched in the status of the buffer (2012h) until they are cleared:
//! bit by bit with 2010h, all by clearing the buffer through the serial interface, which has no other way. As long as one is
//! latched, no move is started; behind a point that was lost, none is added.
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

/// How the drive follows the points; constant while the mode runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// 60C0h.
    pub sub_mode: SubMode,
    /// 60C2h.
    pub period: TimePeriod,
    /// Metres or radians per count, negative where the counter runs the other way.
    pub count: f64,
    /// How a move that is broken off is stopped: quick stop deceleration (6085h) and its jerk.
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

/// State from tick to tick, beside the buffer.
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
    /// At rest, or on the way there.
    Resting,
    /// For the points of sub-mode 0.
    Waiting,
    Following {
        course: Course,
        pace: Pace,
        by_bus: bool,
    },
}

/// Why a move was not started.
#[derive(Debug, Clone, Copy, PartialEq, Error, Stateful)]
pub enum StartRefused {
    /// Errors of the buffer are latched.
    #[error("errors {errors:#04x} of the trajectory buffer are latched (2012h): clear them first")]
    Latched {
        /// As in the highest byte of 2012h.
        errors: u8,
    },
    /// A move runs.
    #[error("a move runs: wait for its end, or break it off")]
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
    /// The mode takes over, or goes on after a halt: a bit 4 that is set already starts nothing, nor does a start move command
    /// that came before.
    #[must_use]
    pub fn begin(now: &Moment) -> Self {
        Self { phase: Phase::TakingOver, asked: asks(now), refused: None, ramp: Ramp::default() }
    }

    /// Why the last start was refused, if it was.
    #[must_use]
    pub const fn refused(&self) -> Option<StartRefused> {
        self.refused
    }

    /// Whether a move runs (bit 12 of the statusword).
    #[must_use]
    pub const fn is_following(&self) -> bool {
        matches!(self.phase, Phase::Following { .. })
    }

    /// Whether the move is slower than its points ask for.
    #[must_use]
    pub const fn is_limited(&self) -> bool {
        matches!(&self.phase, Phase::Following { course, .. } if course.is_limited())
    }

    /// A start by the bus or the serial interface.
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

    /// To the first point in the time of a segment.
    fn approach(&mut self, p: &Params, buffer: &mut Buffer, now: &Moment, pace: Pace) {
        let at = now.demanded.x;
        let duration = f64::from(p.period.microseconds()) / 1e6;
        let course = Course::approach(at, nearest(at / p.count), duration, p, buffer);
        self.follow(course, pace, true, buffer);
    }

    /// From the first point, at which the axis is.
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

    /// Whether bit 4 keeps the move up.
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
    // What the loops follow is a state of motion; otherwise they hold the axis.
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

/// The nearest count, at the ends of the range beyond it.
#[expect(clippy::cast_possible_truncation, reason = "saturates, which is meant")]
fn nearest(counts: f64) -> i64 {
    libm::round(counts) as i64
}
