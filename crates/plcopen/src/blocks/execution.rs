//! The rules of Execute, shared by all blocks that have it.
use crate::axis::Axis;
use crate::error::{BlockError, ErrorId};
use crate::ledger::{CommandId, Progress};
use servobench_base::Stateful;

/// Status of a block with Execute in a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub enum Report {
    /// Nothing.
    #[default]
    Idle,
    /// Waits for the commands before it.
    Buffered,
    /// Commands the axis.
    Active,
    /// Commands the axis, at the velocity or effort that it was to reach.
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

/// State of an instance's Execute.
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
    /// The command is active.
    Running(CommandId),
    /// A task that is not a command of the axis is active.
    Waiting,
    /// The command is over and was reported at least once.
    Over(Report),
}

impl Execution {
    /// Handles one call: calls `start` at a rising edge, which returns `None` if the block starts no command of the axis.
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

    /// Handles one call of a block that completes its work at a rising edge.
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

    /// Report of the command.
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

    /// Completes the task.
    pub(crate) fn complete(&mut self) -> Report {
        self.phase = Phase::Over(Report::Done);
        Report::Done
    }

    /// Aborts the task.
    pub(crate) fn abort(&mut self) -> Report {
        self.phase = Phase::Over(Report::Aborted);
        Report::Aborted
    }

    /// Fails the command or task.
    pub(crate) fn fail(&mut self, error: BlockError) -> Report {
        self.phase = self.failed(error);
        Report::Error(error.id())
    }

    fn failed(&mut self, error: BlockError) -> Phase {
        self.error = Some(error);
        Phase::Over(Report::Error(error.id()))
    }

    /// The command, while it waits or is active.
    pub(crate) const fn running(&self) -> Option<CommandId> {
        match self.phase {
            Phase::Running(id) => Some(id),
            Phase::Idle | Phase::Waiting | Phase::Over(_) => None,
        }
    }

    /// Error behind Error = TRUE.
    pub(crate) const fn error(&self) -> Option<&BlockError> {
        self.error.as_ref()
    }
}
