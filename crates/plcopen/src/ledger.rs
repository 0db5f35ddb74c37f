//! Progress of the commands: each block looks up its own by number.
use crate::axis::MOST_BUFFERED;
use crate::blocks::BlockName;
use crate::error::BlockError;
use servobench_base::Stateful;

/// Number of a command, counted from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Stateful)]
pub struct CommandId(u32);

impl CommandId {
    /// The axis's own command: stops without a request from a block.
    pub(crate) const OWN: Self = Self(0);
}

/// Progress of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Stateful)]
pub enum Progress {
    /// Waits for the commands before it.
    Buffered,
    /// Commands the axis.
    Active,
    /// Commands the axis, at the velocity or effort that it was to reach.
    InTarget,
    /// Is done.
    Done,
    /// Another command, or requested loss of power, took the axis from it.
    #[default]
    Aborted,
    /// The axis stopped with an error.
    Failed,
}

/// Most commands that are open at a time: waiting ones, the active one, a superimposed one, and the one that it replaces.
const MOST_OPEN: usize = MOST_BUFFERED + 3;
/// Number of finished commands that are remembered.
const REMEMBERED: usize = 64;

/// A command and its progress.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
struct Entry {
    id: CommandId,
    /// Block that gave the command.
    block: BlockName,
    progress: Progress,
    /// Cause of the failure.
    failure: Option<BlockError>,
}

/// All waiting and active commands, and the last 64 that ended. A block that is not called while 64 others end sees its own as
/// aborted.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(crate) struct Ledger {
    last: u32,
    open: [Option<Entry>; MOST_OPEN],
    ended: [Option<Entry>; REMEMBERED],
    /// Place of the next finished command.
    place: usize,
    /// Cause of the failures set next.
    failure: Option<BlockError>,
}

impl Ledger {
    pub(crate) const fn new() -> Self {
        Self { last: 0, open: [None; MOST_OPEN], ended: [None; REMEMBERED], place: 0, failure: None }
    }

    /// Issues the next command, of `block`, as buffered.
    pub(crate) fn issue(&mut self, block: BlockName) -> CommandId {
        self.last = self.last.wrapping_add(1).max(1);
        let entry = Entry { id: CommandId(self.last), block, progress: Progress::Buffered, failure: None };
        let free = self.open.iter_mut().find(|place| place.is_none());
        debug_assert!(free.is_some(), "a command that is over was not reported");
        if let Some(place) = free {
            *place = Some(entry);
        }
        entry.id
    }

    /// Sets the cause of all failures from now on.
    pub(crate) const fn fail(&mut self, error: BlockError) {
        self.failure = Some(error);
    }

    /// Cause of the command's failure; an error of the axis names the block of this command.
    pub(crate) fn failure(&self, id: CommandId) -> Option<BlockError> {
        let entry = self.entry(id)?;
        match entry.failure? {
            BlockError::Axis { error, .. } => Some(BlockError::Axis { block: entry.block, error }),
            other => Some(other),
        }
    }

    #[inline]
    pub(crate) fn set(&mut self, id: CommandId, progress: Progress) {
        let of_id = |place: &&mut Option<Entry>| place.as_ref().is_some_and(|entry| entry.id == id);
        let Some(place) = self.open.iter_mut().find(of_id) else { return };
        match progress {
            Progress::Buffered | Progress::Active | Progress::InTarget => {
                if let Some(entry) = place {
                    entry.progress = progress;
                }
            }
            Progress::Done | Progress::Aborted | Progress::Failed => {
                let failure = self.failure.filter(|_| progress == Progress::Failed);
                self.ended[self.place] = place.take().map(|entry| Entry { progress, failure, ..entry });
                self.place = (self.place + 1) % REMEMBERED;
            }
        }
    }

    #[inline]
    pub(crate) fn progress(&self, id: CommandId) -> Progress {
        self.entry(id).map_or(Progress::Aborted, |entry| entry.progress)
    }

    fn entry(&self, id: CommandId) -> Option<&Entry> {
        self.open.iter().chain(&self.ended).flatten().find(|entry| entry.id == id)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_of_a_command_is_known_until_64_others_have_ended() {
        let mut ledger = Ledger::new();
        let id = ledger.issue(BlockName::Halt);
        ledger.set(id, Progress::Done);
        for _ in 0..REMEMBERED {
            assert_eq!(ledger.progress(id), Progress::Done);
            let other = ledger.issue(BlockName::Halt);
            ledger.set(other, Progress::Active);
            assert_eq!(ledger.progress(id), Progress::Done);
            ledger.set(other, Progress::Failed);
        }
        assert_eq!(ledger.progress(id), Progress::Aborted);
    }

    #[test]
    fn what_runs_or_waits_is_known_whatever_else_is_asked_for() {
        let mut ledger = Ledger::new();
        let [running, waiting] = [BlockName::MoveVelocity, BlockName::Halt].map(|block| ledger.issue(block));
        ledger.set(running, Progress::InTarget);
        for _ in 0..10 * REMEMBERED {
            let other = ledger.issue(BlockName::MoveSuperimposed);
            ledger.set(other, Progress::Aborted);
        }
        assert_eq!([running, waiting].map(|id| ledger.progress(id)), [Progress::InTarget, Progress::Buffered]);
    }

    #[test]
    fn each_command_keeps_the_reason_of_its_own_failure() {
        let mut ledger = Ledger::new();
        let refusals = [BlockName::MoveAbsolute, BlockName::MoveVelocity].map(|block| {
            let id = ledger.issue(block);
            let error = BlockError::Input { block, input: "Velocity", value: 0.0, bound: "positive" };
            ledger.fail(error);
            ledger.set(id, Progress::Failed);
            (id, error)
        });
        for (id, error) in refusals {
            assert_eq!(ledger.failure(id), Some(error));
        }
    }

    #[test]
    fn what_the_axis_does_on_its_own_is_not_kept() {
        let mut ledger = Ledger::new();
        ledger.set(CommandId::OWN, Progress::Done);
        assert_eq!(ledger.progress(CommandId::OWN), Progress::Aborted);
    }
}
