//! Supervision by the drive: faults and standstill.
use super::{CycleEvent, Fault, Inputs, Measured, Params, Running, State};
use crate::Demand;
use crate::supervision::Finding;
use servobench_cia402::{FaultReactionOption, Mode, PowerParams, PowerState, Transition};

impl Measured {
    /// True if the measurements suffice to close a loop.
    const fn is_valid(&self) -> bool {
        self.velocity.is_finite() && self.effort.is_finite() && !self.motor_encoder_error
    }
}

impl State {
    /// Present fault, the gravest first.
    pub(super) fn find_fault(&mut self, p: &Params, u: &Inputs, event: CycleEvent) -> Option<Fault> {
        let is_enabled = self.power.state().is_drive_function_enabled();
        let follows_position = matches!(self.last, Demand::Position { .. });
        let is_beyond = follows_position && !p.following_error.holds(u.measured.following_error);
        let has_lost_position = self.beyond_following_error.step(is_beyond, p.following_error.time, p.period);
        let lacks_frames = event == CycleEvent::Missed
            && self.cycle.missed() > p.cycle.bridged
            && self.running.as_ref().is_some_and(Running::follows_master);
        if let Some(code) = u.fault {
            Some(Fault::External(code))
        } else if is_enabled && !u.main_voltage {
            Some(Fault::MainsMissing)
        } else if !u.measured.is_valid() {
            Some(Fault::Encoder)
        } else if u.measured.load_encoder_error {
            Some(Fault::LoadEncoder)
        } else if let Some(finding) = u.measured.finding.filter(|_| is_enabled) {
            Some(Fault::Supervision(finding))
        } else if is_enabled && u.measured.is_overloaded {
            Some(Fault::Overload)
        } else if lacks_frames {
            Some(Fault::FramesMissing)
        } else {
            has_lost_position.then_some(Fault::FollowingError)
        }
    }

    /// Power parameters for the stop: by the option codes, unless a failure leaves no loop to brake with.
    pub(super) fn reactions(&mut self, p: &Params, measured: &Measured) -> PowerParams {
        let finding = measured.finding.filter(|_| self.power.state().is_drive_function_enabled());
        self.cannot_brake |= !measured.is_valid() || finding.is_some_and(Finding::leaves_no_brake);
        self.has_lost_load |= measured.load_encoder_error;
        if self.cannot_brake {
            PowerParams { fault_reaction: FaultReactionOption::Disable, ..p.power }
        } else {
            p.power
        }
    }

    /// Keeps the first fault until it is reset; returns it at the step at which it acts.
    pub(super) fn remember(&mut self, found: Option<Fault>, transition: Option<&Transition>) -> Option<Fault> {
        match transition?.to {
            PowerState::FaultReactionActive => {
                self.fault = found;
                found
            }
            PowerState::SwitchOnDisabled => {
                (self.fault, self.cannot_brake, self.has_lost_load) = (None, false, false);
                None
            }
            _ => None,
        }
    }

    /// True if bit 13 reports that the following error has been out of its window (6065h) for the time-out (6066h), in the modes that
    /// define it so: during the resulting fault (8611h), until it is reset.
    pub(super) const fn tells_following_error(&self) -> bool {
        matches!(self.fault, Some(Fault::FollowingError))
            && matches!(self.mode, Some(Mode::ProfilePosition | Mode::CyclicSynchronousPosition))
    }

    /// True if the axis has been standing, by its measured and demanded velocity, for long enough.
    pub(super) fn stands_still(&mut self, p: &Params) -> bool {
        let stands = p.standstill.holds(self.now.actual.velocity) && p.standstill.holds(self.now.demanded.v);
        self.at_standstill.step(stands, p.standstill.time, p.period)
    }
}
