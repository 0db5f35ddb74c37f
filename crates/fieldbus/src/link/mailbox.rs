//! Mailbox in which the motion task leaves its command for the link.
//!
//! Two tasks, one slot and a number before and after (a sequence lock): the writer increments one number before it writes and the other
//! after it, so that the reader can detect a write in progress.
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

/// Command of the motion task, with its cycle.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Mailbox {
    /// Number of writes begun.
    begun: u64,
    /// Number of writes finished.
    written: u64,
    tick: Tick,
    command: AxisCommand,
}

impl Default for Mailbox {
    /// Empty: the axis is not powered.
    fn default() -> Self {
        let task = Task::Follow(Sample::default());
        Self { begun: 0, written: 0, tick: Tick(0), command: AxisCommand { power: false, ..AxisCommand::of(task) } }
    }
}

impl Mailbox {
    /// Leaves the command of the motion task's cycle that was due at `tick`. It may come later than that.
    pub const fn write(&mut self, tick: Tick, command: AxisCommand) {
        self.begin();
        self.finish(tick, command);
    }

    /// Begins a write: a reader finds the command torn meanwhile. For a motion task that is interrupted by the link.
    pub const fn begin(&mut self) {
        self.begun += 1;
    }

    /// Finishes the write that [`begin`](Self::begin) began.
    pub const fn finish(&mut self, tick: Tick, command: AxisCommand) {
        (self.tick, self.command) = (tick, command);
        self.written = self.begun;
    }

    /// Number of commands written so far.
    #[must_use]
    pub const fn written(&self) -> u64 {
        self.written
    }

    /// The command, if it is complete.
    pub(crate) const fn read(&self) -> Option<Letter> {
        if self.begun == self.written {
            Some(Letter { number: self.written, tick: self.tick.0, command: self.command })
        } else {
            None
        }
    }
}

/// A command that was read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Letter {
    /// Number of the command, from 1.
    pub(crate) number: u64,
    /// Due time of its cycle (base ticks).
    pub(crate) tick: u64,
    pub(crate) command: AxisCommand,
}
