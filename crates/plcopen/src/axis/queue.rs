//! Waiting commands.
use crate::command::Command;
use crate::ledger::CommandId;
use servobench_base::Stateful;

/// Most commands that an axis can hold behind the active one.
pub const MOST_BUFFERED: usize = 8;

/// Waiting commands, in the order in which they were given.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(crate) struct Queue {
    waiting: [Option<(CommandId, Command)>; MOST_BUFFERED],
    count: usize,
}

impl Queue {
    pub(crate) const EMPTY: Self = Self { waiting: [None; MOST_BUFFERED], count: 0 };

    pub(crate) const fn len(&self) -> usize {
        self.count
    }

    /// Adds a command; the caller has checked that there is room.
    pub(crate) fn push(&mut self, id: CommandId, command: Command) {
        self.waiting[self.count] = Some((id, command));
        self.count += 1;
    }

    pub(crate) fn last(&self) -> Option<&Command> {
        self.get(self.count.checked_sub(1)?)
    }

    pub(crate) fn first(&self) -> Option<&Command> {
        self.get(0)
    }

    pub(crate) fn get(&self, place: usize) -> Option<&Command> {
        self.waiting.get(place)?.as_ref().map(|(_, command)| command)
    }

    /// Removes the last command.
    pub(crate) fn drop_last(&mut self) {
        self.count = self.count.saturating_sub(1);
        self.waiting[self.count] = None;
    }

    pub(crate) fn pop(&mut self) -> Option<(CommandId, Command)> {
        let first = self.waiting[0].take()?;
        self.waiting.rotate_left(1);
        self.count -= 1;
        Some(first)
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &(CommandId, Command)> {
        self.waiting.iter().flatten()
    }

    pub(crate) fn get_mut(&mut self, id: CommandId) -> Option<&mut Command> {
        self.waiting.iter_mut().flatten().find(|(waiting, _)| *waiting == id).map(|(_, command)| command)
    }
}
