//! Where the motion task leaves its command and the link finds it.
//!
//! Two tasks, one slot and a number before and after (a sequence lock): the writer counts up before it writes and again when
//! it has written, so that the reader sees whether it looked in between.
//!
//! ```
//! use servobench_base::Tick;
//! use servobench_fieldbus::link::Mailbox;
//! use servobench_fieldbus::{AxisCommand, Task};
//! let mut mailbox = Mailbox::default();
//! mailbox.write(Tick(320), AxisCommand::of(Task::Effort(0.5)));
//! assert_eq!(mailbox.written(), 1);
//! ```
use crate::{AxisCommand, Task};
use servobench_base::{Stateful, Tick};
use servobench_motion::interpolate::Sample;

/// The command of the motion task with the cycle that it belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Mailbox {
    /// Number of writings that were begun.
    begun: u64,
    /// Number of those that are finished.
    written: u64,
    tick: Tick,
    command: AxisCommand,
}

impl Default for Mailbox {
    /// Nothing written: the axis is not powered.
    fn default() -> Self {
        let task = Task::Follow(Sample::default());
        Self { begun: 0, written: 0, tick: Tick(0), command: AxisCommand { power: false, ..AxisCommand::of(task) } }
    }
}

impl Mailbox {
    /// Leaves the command of the cycle of the motion task that was due at `tick`. It may come later than that.
    pub const fn write(&mut self, tick: Tick, command: AxisCommand) {
        self.begin();
        self.finish(tick, command);
    }

    /// Begins to write: who reads now finds the command torn. For a motion task that is interrupted by the link.
    pub const fn begin(&mut self) {
        self.begun += 1;
    }

    /// Ends what [`begin`](Self::begin) began.
    pub const fn finish(&mut self, tick: Tick, command: AxisCommand) {
        (self.tick, self.command) = (tick, command);
        self.written = self.begun;
    }

    /// Number of commands written so far.
    #[must_use]
    pub const fn written(&self) -> u64 {
        self.written
    }

    /// The command, when it is whole.
    pub(crate) const fn read(&self) -> Option<Letter> {
        if self.begun == self.written {
            Some(Letter { number: self.written, tick: self.tick.0, command: self.command })
        } else {
            None
        }
    }
}

/// A command as it was read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Letter {
    /// How many were written before and with it.
    pub(crate) number: u64,
    /// When its cycle was due (base ticks).
    pub(crate) tick: u64,
    pub(crate) command: AxisCommand,
}
