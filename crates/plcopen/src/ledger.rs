//! What became of the commands: each block asks for its own by number.
use crate::error::BlockError;
use crate::name::BlockName;

/// The number of a command, counted from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct CommandId(u32);

impl CommandId {
    /// The axis's own: stops that no block asked for.
    pub(crate) const OWN: Self = Self(0);
}

/// What became of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Progress {
    /// Waits for those before it.
    Buffered,
    /// Commands the axis.
    Active,
    /// The same, and is at the velocity or effort that it was to reach.
    InTarget,
    /// Is done.
    Done,
    /// Another one, or the loss of power that was asked for, took the axis from it.
    #[default]
    Aborted,
    /// The axis stopped with an error.
    Failed,
}

/// Number of commands that are remembered.
const REMEMBERED: u32 = 64;

/// The last 64 commands. A block that is not called while 64 others are given hears that its own was aborted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ledger {
    last: u32,
    progress: [Progress; REMEMBERED as usize],
    /// The blocks that gave them.
    blocks: [BlockName; REMEMBERED as usize],
    /// Why the last one failed that did.
    failure: Option<BlockError>,
}

impl Ledger {
    pub(crate) const fn new() -> Self {
        const PLACES: usize = REMEMBERED as usize;
        Self { last: 0, progress: [Progress::Aborted; PLACES], blocks: [BlockName::Home; PLACES], failure: None }
    }

    /// The next command, of `block`, which waits.
    pub(crate) fn issue(&mut self, block: BlockName) -> CommandId {
        self.last = self.last.wrapping_add(1).max(1);
        let id = CommandId(self.last);
        (self.progress[Self::place(id)], self.blocks[Self::place(id)]) = (Progress::Buffered, block);
        id
    }

    /// The command that runs, and whatever waits or moves with it, fails for this reason.
    pub(crate) const fn fail(&mut self, error: BlockError) {
        self.failure = Some(error);
    }

    /// Why the command failed: each block speaks for itself of an error of the axis.
    pub(crate) fn failure(&self, id: CommandId) -> Option<BlockError> {
        match self.failure? {
            BlockError::Axis { error, .. } => Some(BlockError::Axis { block: self.blocks[Self::place(id)], error }),
            other => Some(other),
        }
    }

    #[inline]
    pub(crate) fn set(&mut self, id: CommandId, progress: Progress) {
        if id != CommandId::OWN {
            self.progress[Self::place(id)] = progress;
        }
    }

    #[inline]
    pub(crate) fn progress(&self, id: CommandId) -> Progress {
        if self.last.wrapping_sub(id.0) < REMEMBERED { self.progress[Self::place(id)] } else { Progress::Aborted }
    }

    const fn place(id: CommandId) -> usize {
        (id.0 % REMEMBERED) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_became_of_a_command_is_known_until_64_others_are_given() {
        let mut ledger = Ledger::new();
        let id = ledger.issue(BlockName::Halt);
        ledger.set(id, Progress::Done);
        for _ in 1..REMEMBERED {
            let other = ledger.issue(BlockName::Halt);
            ledger.set(other, Progress::Active);
            assert_eq!(ledger.progress(id), Progress::Done);
        }
        let other = ledger.issue(BlockName::Halt);
        ledger.set(other, Progress::Active);
        assert_eq!(ledger.progress(id), Progress::Aborted);
    }

    #[test]
    fn what_the_axis_does_on_its_own_is_not_kept() {
        let mut ledger = Ledger::new();
        ledger.set(CommandId::OWN, Progress::Done);
        assert_eq!(ledger.progress(CommandId::OWN), Progress::Aborted);
    }
}
