//! How the master brings the drive to power and back.
//!
//! Strict: one command per state of the power state machine, the next one when the statusword tells the next state, and a
//! time-out for each that does not wait for the axis to come to rest. Simplified, for drives that want no sequence: of the statusword only the fault bit is looked at, and the
//! controlword switches between 0006h and 000Fh.
//!
//! | what is wanted | strict | simplified |
//! |---|---|---|
//! | power | Shutdown, Switch on, Enable operation | 000Fh; 0006h for a cycle after a fault |
//! | no power | Disable operation (605Ch says how it brakes), Shutdown | 0006h |
//! | quick stop | Quick stop where the drive function is enabled, Disable voltage elsewhere | 0002h |
//! | fault reset | Fault reset until Fault is left or the time is over | the same, by the fault bit |
use servobench_base::Stateful;
use servobench_cia402::{Command, Controlword, Next, PowerState, StatusBit, Statusword, keeping, towards};

servobench_config::choices! {
    /// How the master brings the drive to power.
    pub enum Sequencing default Strict {
        /// state after state of the power state machine, each awaited
        Strict = "strict",
        /// the last controlword at once, only the end awaited
        Simplified = "simplified",
    }
}

/// What is wanted of the drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wanted {
    Off,
    On,
    QuickStop,
}

/// What the sequencer remembers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Stateful)]
pub(crate) struct Sequencer {
    /// The last state that the statusword told.
    state: PowerState,
    word: Controlword,
    /// When that word was given first (base ticks).
    told: u64,
    /// Since when the drive is in that state and has been given that word (base ticks).
    since: u64,
    resetting: bool,
    faulty: bool,
}

impl Sequencer {
    /// Of a drive that was not received yet.
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

    /// Whether the drive function may be used: of what was told up to `known` the drive has received.
    pub(crate) fn is_enabled(&self, sequencing: Sequencing, known: u64) -> bool {
        let is_told = self.word.gives(Command::EnableOperation);
        match sequencing {
            Sequencing::Strict => is_told && self.told <= known && self.state == PowerState::OperationEnabled,
            Sequencing::Simplified => is_told && !self.faulty,
        }
    }

    /// Whether the drive may still drive current through the motor.
    pub(crate) fn is_powered(&self, sequencing: Sequencing) -> bool {
        match sequencing {
            Sequencing::Strict => self.state.is_drive_function_enabled(),
            Sequencing::Simplified => !self.faulty && self.word.gives(Command::EnableOperation),
        }
    }

    pub(crate) const fn is_faulty(&self) -> bool {
        self.faulty
    }

    /// A fault is to be reset, where there is one.
    pub(crate) const fn reset(&mut self) {
        self.resetting = self.faulty;
    }

    /// The drive has answered.
    pub(crate) fn receive(&mut self, statusword: Statusword, now: u64) {
        let state = statusword.state().unwrap_or(self.state);
        if state != self.state {
            (self.state, self.since) = (state, now);
        }
        self.faulty = statusword.has(StatusBit::Fault);
        // What is reset is the state Fault: the reaction before it ends by itself.
        self.resetting &= self.faulty;
    }

    /// The next word. `false` when the drive has not done for `timeout` ticks what it was told.
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

    /// Whether the drive may be bringing the axis to rest, which takes as long as it takes.
    fn brakes(&self, wanted: Wanted) -> bool {
        match self.state {
            PowerState::QuickStopActive | PowerState::FaultReactionActive => true,
            PowerState::OperationEnabled => wanted != Wanted::On,
            _ => false,
        }
    }

    /// The word of the strict sequence, and whether nothing has to happen.
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
            // Without power nobody waits for a drive that has not started yet.
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
