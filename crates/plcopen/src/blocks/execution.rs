//! The rules of Execute, which all blocks that have it share.
use crate::axis::Axis;
use crate::error::{BlockError, ErrorId};
use crate::ledger::{CommandId, Progress};
use servobench_base::Stateful;

/// What a block with Execute has to say in a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub enum Report {
    /// Nothing.
    #[default]
    Idle,
    /// Waits for the commands before it.
    Buffered,
    /// Commands the axis.
    Active,
    /// The same, and is at the velocity or effort that it was to reach.
    InTarget,
    /// Done.
    Done,
    /// Another command took the axis.
    Aborted,
    /// Refused or failed.
    Error(ErrorId),
}

impl Report {
    /// The output Busy.
    #[must_use]
    pub const fn is_busy(self) -> bool {
        matches!(self, Self::Buffered | Self::Active | Self::InTarget)
    }

    /// The output Active.
    #[must_use]
    pub const fn is_active(self) -> bool {
        matches!(self, Self::Active | Self::InTarget)
    }

    /// The output ErrorID.
    #[must_use]
    pub const fn error_id(self) -> ErrorId {
        match self {
            Self::Error(id) => id,
            _ => ErrorId::None,
        }
    }
}

/// What an instance remembers of its Execute.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub(crate) struct Execution {
    execute: bool,
    phase: Phase,
    error: Option<BlockError>,
}

#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
enum Phase {
    #[default]
    Idle,
    /// The command runs.
    Running(CommandId),
    /// What runs is not a command of the axis.
    Waiting,
    /// It is over, as was said at least once.
    Over(Report),
}

impl Execution {
    /// One call: `start` is asked at a rising edge; a block that starts no command of the axis says so with `None`.
    #[inline]
    pub(crate) fn step(
        &mut self,
        axis: &mut Axis,
        execute: bool,
        start: impl FnOnce(&mut Axis) -> Result<Option<CommandId>, BlockError>,
    ) -> Report {
        let is_rising = execute && !self.execute;
        self.execute = execute;
        if is_rising {
            self.error = None;
            self.phase = match start(axis) {
                Ok(Some(id)) => Phase::Running(id),
                Ok(None) => Phase::Waiting,
                Err(error) => self.failed(error),
            };
        } else if !execute && matches!(self.phase, Phase::Over(_)) {
            (self.phase, self.error) = (Phase::Idle, None);
        }
        self.report(axis)
    }

    /// One call of a block that does at a rising edge all it has to do.
    pub(crate) fn at_once(
        &mut self,
        axis: &mut Axis,
        execute: bool,
        act: impl FnOnce(&mut Axis) -> Result<(), BlockError>,
    ) -> Report {
        let mut is_done = false;
        let report = self.step(axis, execute, |axis| {
            act(axis)?;
            is_done = true;
            Ok(None)
        });
        if is_done { self.complete() } else { report }
    }

    /// What there is to say of the command.
    pub(super) fn report(&mut self, axis: &Axis) -> Report {
        let id = match self.phase {
            Phase::Idle => return Report::Idle,
            Phase::Waiting => return Report::Active,
            Phase::Over(report) => return report,
            Phase::Running(id) => id,
        };
        let report = match axis.progress(id) {
            Progress::Buffered => return Report::Buffered,
            Progress::Active => return Report::Active,
            Progress::InTarget => return Report::InTarget,
            Progress::Done => Report::Done,
            Progress::Aborted => Report::Aborted,
            Progress::Failed => {
                self.error = axis.ledger().failure(id);
                Report::Error(self.error.as_ref().map_or(ErrorId::State, BlockError::id))
            }
        };
        self.phase = Phase::Over(report);
        report
    }

    /// What was waited for has come.
    pub(crate) fn complete(&mut self) -> Report {
        self.phase = Phase::Over(Report::Done);
        Report::Done
    }

    /// What was waited for will not come.
    pub(crate) fn abort(&mut self) -> Report {
        self.phase = Phase::Over(Report::Aborted);
        Report::Aborted
    }

    /// The command, or what was waited for, failed.
    pub(crate) fn fail(&mut self, error: BlockError) -> Report {
        self.phase = self.failed(error);
        Report::Error(error.id())
    }

    fn failed(&mut self, error: BlockError) -> Phase {
        self.error = Some(error);
        Phase::Over(Report::Error(error.id()))
    }

    /// The command, while it waits or runs.
    pub(crate) const fn running(&self) -> Option<CommandId> {
        match self.phase {
            Phase::Running(id) => Some(id),
            Phase::Idle | Phase::Waiting | Phase::Over(_) => None,
        }
    }

    /// Why Error is TRUE.
    pub(crate) const fn error(&self) -> Option<&BlockError> {
        self.error.as_ref()
    }
}
