//! Faults that stop the axis, and the kind of stop.
use super::sequencer::Wanted;
use super::{Params, State};
use crate::{Interpolation, LinkFault, Task};

impl State {
    /// Detects faults that stop the axis.
    pub(super) fn supervise(&mut self, p: &Params, external_fault: bool, now: u64) {
        let enabled = self.is_enabled(p);
        let silent = self.command.power && now.saturating_sub(self.received_at) > p.settings.drive_timeout;
        let found = if external_fault {
            Some(LinkFault::External)
        } else if silent {
            Some(LinkFault::DriveTimeout)
        } else if self.was_on && !enabled && !self.sequencer.is_faulty() {
            Some(LinkFault::DriveLeftOperation)
        } else {
            self.runs_into(p)
        };
        // A halt does not hide a fault that needs a quick stop.
        if self.fault.is_none() || (self.halts() && found.is_some_and(|fault| !is_halt(fault))) {
            self.fault = found;
        }
    }

    /// Fault of the limit switch into which the axis is commanded, if any.
    fn runs_into(&self, p: &Params) -> Option<LinkFault> {
        let switches = self.switches(p);
        let goes = |sign: f64| match self.command.task {
            Task::Follow(_) => self.stream.goes(&p.stream, sign),
            Task::Effort(effort) => self.ramp.state() != Interpolation::Off && sign * effort > 0.0,
            // The drive itself observes its switches.
            Task::Home { .. } | Task::Drive(_) => false,
        };
        if switches.negative_limit && goes(-1.0) {
            Some(LinkFault::NegativeLimit)
        } else if switches.positive_limit && goes(1.0) {
            Some(LinkFault::PositiveLimit)
        } else {
            None
        }
    }

    pub(super) const fn wanted(&self) -> Wanted {
        match self.fault {
            _ if !self.command.power => Wanted::Off,
            Some(fault) if !is_halt(fault) => Wanted::QuickStop,
            _ => Wanted::On,
        }
    }

    pub(super) const fn halts(&self) -> bool {
        matches!(self.fault, Some(fault) if is_halt(fault))
    }
}

const fn is_halt(fault: LinkFault) -> bool {
    matches!(fault, LinkFault::NegativeLimit | LinkFault::PositiveLimit)
}
