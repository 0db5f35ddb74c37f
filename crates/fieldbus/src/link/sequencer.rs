//! Sequence by which the master powers the drive and switches it off.
//!
//! Strict: one command per state of the power state machine, the next one when the statusword shows the next state, each with a time-out,
//! except while the axis comes to rest. Simplified, for drives that need no sequence: only the fault bit of the statusword is evaluated,
//! and the controlword switches between 0006h and 000Fh.
//!
//! | request | strict | simplified |
//! |---|---|---|
//! | power | Shutdown, Switch on, Enable operation | 000Fh; 0006h for a cycle after a fault |
//! | no power | Disable operation (605Ch defines the braking), Shutdown | 0006h |
//! | quick stop | Quick stop where the drive function is enabled, Disable voltage elsewhere | 0002h |
//! | fault reset | Fault reset until Fault is left or the time-out | the same, by the fault bit |
use servobench_base::Stateful;
use servobench_cia402::{Command, Controlword, Next, PowerState, StatusBit, Statusword, keeping, towards};

servobench_config::choices! {
    /// Sequence by which the master powers the drive.
    pub enum Sequencing default Strict {
        /// state after state of the power state machine, each awaited
        Strict = "strict",
        /// the last controlword at once, only the final state awaited
        Simplified = "simplified",
    }
}

/// Request to the drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wanted {
    Off,
    On,
    QuickStop,
}

/// State of the sequencer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Stateful)]
pub(crate) struct Sequencer {
    /// Last state in the statusword.
    state: PowerState,
    word: Controlword,
    /// Time at which that word was first sent (base ticks).
    told: u64,
    /// Time since which both the state and the word have been unchanged (base ticks).
    since: u64,
    resetting: bool,
    faulty: bool,
}

impl Sequencer {
    /// State for a drive that has not been received yet.
    pub(crate) const fn start(now: u64) -> Self {
        Self {
            state: PowerState::NotReadyToSwitchOn,
            word: Controlword::of(Command::DisableVoltage),
            told: now,
            since: now,
            resetting: false,
            faulty: false,
        }
    }

    pub(crate) const fn word(&self) -> Controlword {
        self.word
    }

    /// True if the drive function is enabled; the drive has received the commands up to `known`.
    pub(crate) fn is_enabled(&self, sequencing: Sequencing, known: u64) -> bool {
        let is_told = self.word.gives(Command::EnableOperation);
        match sequencing {
            Sequencing::Strict => is_told && self.told <= known && self.state == PowerState::OperationEnabled,
            Sequencing::Simplified => is_told && !self.faulty,
        }
    }

    /// True if the drive may still drive current through the motor.
    pub(crate) fn is_powered(&self, sequencing: Sequencing) -> bool {
        match sequencing {
            Sequencing::Strict => self.state.is_drive_function_enabled(),
            Sequencing::Simplified => !self.faulty && self.word.gives(Command::EnableOperation),
        }
    }

    pub(crate) const fn is_faulty(&self) -> bool {
        self.faulty
    }

    /// Requests the reset of a fault, if there is one.
    pub(crate) const fn reset(&mut self) {
        self.resetting = self.faulty;
    }

    /// Takes the answer of the drive.
    pub(crate) fn receive(&mut self, statusword: Statusword, now: u64) {
        let state = statusword.state().unwrap_or(self.state);
        if state != self.state {
            (self.state, self.since) = (state, now);
        }
        self.faulty = statusword.has(StatusBit::Fault);
        // Only the state Fault is reset: the reaction before it ends by itself.
        self.resetting &= self.faulty;
    }

    /// Computes the next word. Returns `false` if the drive has not executed its command for `timeout` ticks.
    pub(crate) fn step(&mut self, sequencing: Sequencing, wanted: Wanted, timeout: u64, now: u64) -> bool {
        let (word, arrived) = match sequencing {
            Sequencing::Strict => self.strict(wanted),
            Sequencing::Simplified => self.simplified(wanted),
        };
        if word != self.word {
            (self.word, self.told, self.since) = (word, now, now);
        }
        if self.brakes(wanted) {
            self.since = now;
        }
        let waited = now.saturating_sub(self.since);
        if waited > timeout {
            self.resetting = false;
        }
        arrived || waited <= timeout
    }

    /// True if the drive may be braking the axis, which has no time-out.
    fn brakes(&self, wanted: Wanted) -> bool {
        match self.state {
            PowerState::QuickStopActive | PowerState::FaultReactionActive => true,
            PowerState::OperationEnabled => wanted != Wanted::On,
            _ => false,
        }
    }

    /// Word of the strict sequence, and true if no transition is awaited.
    fn strict(&self, wanted: Wanted) -> (Controlword, bool) {
        if self.faulty {
            let command = if self.resetting && self.state == PowerState::Fault {
                Command::FaultReset
            } else {
                Command::DisableVoltage
            };
            return (Controlword::of(command), !self.resetting);
        }
        let goal = match wanted {
            Wanted::On => PowerState::OperationEnabled,
            // Two steps down: Disable operation brakes by default, Shutdown from Operation enabled does not.
            Wanted::Off if self.state == PowerState::OperationEnabled => PowerState::SwitchedOn,
            Wanted::Off => PowerState::ReadyToSwitchOn,
            Wanted::QuickStop if self.state.is_drive_function_enabled() => PowerState::QuickStopActive,
            Wanted::QuickStop => PowerState::SwitchOnDisabled,
        };
        match towards(self.state, goal) {
            Next::Arrived => (keeping(goal).map_or(self.word, Controlword::of), true),
            Next::Give(command) => (Controlword::of(command), false),
            // Without a power request, a drive that has not started yet is not awaited.
            Next::Wait | Next::Unreachable => (self.word, wanted != Wanted::On),
        }
    }

    fn simplified(&self, wanted: Wanted) -> (Controlword, bool) {
        let was_faulty = self.word.gives(Command::FaultReset) || self.word.gives(Command::DisableVoltage);
        let command = match wanted {
            _ if self.faulty && self.resetting => return (Controlword::of(Command::FaultReset), false),
            _ if self.faulty => Command::DisableVoltage,
            Wanted::QuickStop => Command::QuickStop,
            Wanted::On if !was_faulty => Command::EnableOperation,
            Wanted::On | Wanted::Off => Command::Shutdown,
        };
        (Controlword::of(command), true)
    }
}
