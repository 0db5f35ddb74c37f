//! The set-points of the motion task on their way to the drive.
use super::buffer::{Buffer, Reading, Taken, Timing};
use super::course::{Course, Recovery};
use crate::Interpolation;
use servobench_base::{Setpoint, Stateful};
use servobench_motion::interpolate::{Command, Sample};

/// Parameters of a stream, constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct StreamParams {
    pub(crate) timing: Timing,
    pub(crate) recovery: Recovery,
    /// Largest step of the output in a base tick (m or rad).
    pub(crate) highest_step: f64,
    /// Cycle of the bus (base ticks).
    pub(crate) bus_cycle: u64,
    /// Size of a count (m or rad).
    pub(crate) count: f64,
    /// Velocity below which the motion counts as standstill: a count per cycle of the motion task.
    pub(crate) creep: f64,
}

/// A sample that was read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Arrival {
    pub(crate) sample: Sample,
    /// Due time (base ticks).
    pub(crate) due: u64,
    /// Number of unread samples between it and the previous one.
    pub(crate) missed: u64,
}

/// Content of the mailbox for the stream.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Post {
    /// Nothing new.
    Nothing,
    /// A torn command.
    Torn,
    /// A sample.
    Sample(Arrival),
}

/// Output and its source.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(crate) struct Stream {
    buffer: Buffer,
    course: Course,
    output: Command,
    /// Time of that output (base ticks).
    at: u64,
    /// Present trouble of the interpolation.
    trouble: Option<Interpolation>,
    state: Interpolation,
    limited: bool,
}

/// Failure to plan a transition from the output to the motion that is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct NoWay;

impl Stream {
    pub(crate) const OFF: Self = Self {
        buffer: Buffer::EMPTY,
        course: Course::Rest(0.0),
        output: Command { setpoint: Setpoint::at_rest(0.0), torque: 0.0 },
        at: 0,
        trouble: None,
        state: Interpolation::Off,
        limited: false,
    };

    pub(crate) const fn state(&self) -> Interpolation {
        self.state
    }

    /// Last output.
    pub(crate) const fn output(&self) -> &Command {
        &self.output
    }

    /// Time of the last output (base ticks).
    pub(crate) const fn put_out_at(&self) -> u64 {
        self.at
    }

    /// True if the velocity limit held back the last output.
    pub(crate) const fn is_limited(&self) -> bool {
        self.limited
    }

    /// Output at `now`, not before the last step.
    pub(crate) fn at(&self, p: &StreamParams, now: u64) -> Command {
        self.course.at(|| self.buffer.at(&p.timing, now), now, p.timing.tick).unwrap_or(self.output)
    }

    /// True if the stream moves in the direction of `sign`, ±1: by the motion that is read, by a recovery of more than two counts or by a
    /// stop. Less than that is the error of an axis at rest on a switch.
    pub(crate) fn goes(&self, p: &StreamParams, sign: f64) -> bool {
        if self.state == Interpolation::Off {
            return false;
        }
        let output = &self.output.setpoint;
        match self.buffer.at(&p.timing, self.at) {
            Some(Command { setpoint: read, .. }) if self.course.reads() => {
                sign * read.v > p.creep || sign * (read.x - output.x) > 2.0 * p.count
            }
            _ => sign * output.v > p.creep,
        }
    }

    /// Outputs the axis' own motion.
    pub(crate) fn switch_off(&mut self, own: Command, now: u64) {
        if self.state != Interpolation::Off {
            *self = Self::OFF;
        }
        self.course = Course::Rest(own.setpoint.x);
        self.output = own;
        self.at = now;
    }

    /// Takes the samples that have come and computes the present output.
    ///
    /// # Errors
    /// [`NoWay`]: the output then brakes to standstill.
    pub(crate) fn step(&mut self, p: &StreamParams, post: Post, now: u64) -> Result<(), NoWay> {
        let elapsed = now.saturating_sub(self.at);
        let expected = self.expected(p, elapsed);
        let taken = self.take(p, post, now);
        let reading = self.buffer.advance(&p.timing, now);
        let read = self.buffer.at(&p.timing, now);
        let mut result = Ok(());
        if let (Reading::Interval(_), Some(read)) = (reading, read) {
            if !self.course.reads() || taken != Taken::Kept {
                result = self.join(p, expected, read, now);
            }
            self.trouble = self.trouble.filter(|trouble| *trouble != Interpolation::Underflow);
        } else {
            if reading == Reading::Underflow {
                self.trouble = Some(Interpolation::Underflow);
            }
            if self.course.reads() {
                self.trouble = self.trouble.or(Some(Interpolation::Underflow));
                self.course = Course::stop(expected, &p.recovery, now);
            } else if self.state == Interpolation::Off && (expected.setpoint.v != 0.0 || expected.torque != 0.0) {
                // The axis moves, or has an effort, when the drive begins to follow.
                self.course = Course::stop(expected, &p.recovery, now);
            }
        }
        self.state = if post == Post::Torn { Interpolation::Busy } else { self.trouble.unwrap_or(state_of(reading)) };
        result.and(self.put_out(p, read, now, elapsed))
    }

    /// The output continued by its own motion.
    fn expected(&mut self, p: &StreamParams, elapsed: u64) -> Command {
        if elapsed > 2 * p.bus_cycle {
            // The link stood still, and with it the drive, at the last target.
            self.course = Course::Rest(self.output.setpoint.x);
            return Command { setpoint: Setpoint::at_rest(self.output.setpoint.x), ..self.output };
        }
        Command { setpoint: self.output.setpoint.after(elapsed as f64 * p.timing.tick), ..self.output }
    }

    fn take(&mut self, p: &StreamParams, post: Post, now: u64) -> Taken {
        let Post::Sample(Arrival { sample, due, missed }) = post else { return Taken::Kept };
        let taken = self.buffer.take(&p.timing, sample, due, missed, now);
        self.trouble = match taken {
            _ if missed > 0 => Some(Interpolation::Slow),
            Taken::Overflow => Some(Interpolation::Overflow),
            Taken::Kept | Taken::Corrected => self.trouble.filter(|trouble| *trouble == Interpolation::Underflow),
        };
        taken
    }

    fn join(&mut self, p: &StreamParams, output: Command, read: Command, now: u64) -> Result<(), NoWay> {
        // The first samples are echoes of the actual position: an acceleration from their noise is over with their interval, whereas
        // leading it to zero by the jerk of the recovery would carry the axis away.
        let output = match self.state {
            Interpolation::Off | Interpolation::Wait => {
                Command { setpoint: Setpoint { a: read.setpoint.a, ..output.setpoint }, ..output }
            }
            _ => output,
        };
        let course = Course::join(output, read, &p.recovery, now);
        self.course = course.unwrap_or_else(|| Course::stop(output, &p.recovery, now));
        if course.is_some() { Ok(()) } else { Err(NoWay) }
    }

    /// Advances the output, limited by the highest velocity.
    fn put_out(&mut self, p: &StreamParams, read: Option<Command>, now: u64, elapsed: u64) -> Result<(), NoWay> {
        self.course.settle(now, p.timing.tick);
        let due = self.course.at(|| read, now, p.timing.tick).unwrap_or(self.output);
        let step = due.setpoint.x - self.output.setpoint.x;
        let highest = p.highest_step * elapsed.min(2 * p.bus_cycle) as f64;
        self.at = now;
        self.limited = step.abs() > highest;
        if !self.limited {
            self.output = due;
            return Ok(());
        }
        let x = self.output.setpoint.x + highest.copysign(step);
        let v = (p.highest_step / p.timing.tick).copysign(step);
        self.output = Command { setpoint: Setpoint { v, ..Setpoint::at_rest(x) }, ..due };
        match read {
            Some(read) if self.course.reads() => self.join(p, self.output, read, now),
            _ => {
                self.course = Course::stop(self.output, &p.recovery, now);
                Ok(())
            }
        }
    }
}

const fn state_of(reading: Reading) -> Interpolation {
    match reading {
        Reading::Waiting => Interpolation::Wait,
        Reading::Interval(0) => Interpolation::Run1,
        Reading::Interval(1) => Interpolation::Run2,
        Reading::Interval(_) => Interpolation::Run3,
        Reading::Underflow => Interpolation::Underflow,
    }
}
