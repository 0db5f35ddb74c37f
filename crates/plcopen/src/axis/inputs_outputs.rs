//! Digital outputs and the touch probe of the drive.
use super::Axis;
use servobench_fieldbus::{ProbeTrigger, TouchProbe};

/// Result of a touch probe request.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Probed {
    /// The trigger has not come.
    Waiting,
    /// The axis was at this position, as the program sees it.
    At(f64),
    /// Another request, or none, is active.
    Aborted,
}

impl Axis {
    /// The bits of the digital outputs.
    pub(crate) const fn digital_outputs(&self) -> u32 {
        self.digital_outputs
    }

    /// Sets the outputs of `mask`.
    pub(crate) const fn set_digital_output(&mut self, mask: u32, value: bool) {
        self.digital_outputs = if value { self.digital_outputs | mask } else { self.digital_outputs & !mask };
    }

    /// Requests the position at the next trigger; returns the number of the request.
    pub(crate) fn probe(&mut self, trigger: ProbeTrigger) -> u32 {
        self.probes = self.probes.wrapping_add(1).max(1);
        self.probe = Some(TouchProbe { number: self.probes, trigger });
        self.probes
    }

    /// Withdraws the request.
    pub(crate) const fn end_probe(&mut self) {
        self.probe = None;
    }

    /// Result of request `number`.
    pub(crate) fn probed(&self, number: u32) -> Probed {
        let answer = self.feedback.touch_probe;
        match self.probe {
            Some(probe) if probe.number == number => match answer.position.filter(|_| answer.number == number) {
                Some(position) => Probed::At(self.actual_position(position)),
                None => Probed::Waiting,
            },
            _ => Probed::Aborted,
        }
    }
}
