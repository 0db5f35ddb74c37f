//! The transitions of the power state machine (IEC 61800-7-201, finite state automaton): the one table on which the machine runs, which the
//! tests cover and from which `docs/cia402.md` is generated.
use crate::controlword::{Command, Controlword};
use crate::state::PowerState::{
    self, Fault, FaultReactionActive, NotReadyToSwitchOn, OperationEnabled, QuickStopActive, ReadyToSwitchOn,
    SwitchOnDisabled, SwitchedOn,
};

/// Cause of a transition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Cause {
    /// The drive is powered on or its application reset.
    Start,
    /// The self-test is over.
    Initialised,
    /// The master commands it.
    Command(Command),
    /// The quick stop is over and its option code does not hold the axis.
    QuickStopCompleted,
    /// A fault is present.
    Fault,
    /// The fault reaction is over.
    FaultReactionCompleted,
}

impl Cause {
    /// Name in the words of the standard.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Start => "Power-on or reset of the application",
            Self::Initialised => "Initialisation completed",
            Self::Command(command) => command.name(),
            Self::QuickStopCompleted => "Quick stop completed (605Ah = 0 to 4)",
            Self::Fault => "Fault",
            Self::FaultReactionCompleted => "Fault reaction completed",
        }
    }
}

/// A transition of the state diagram.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Transition {
    /// Number in the standard.
    pub number: u8,
    /// States that the transition leaves; none for the start.
    pub from: &'static [PowerState],
    /// State that the transition enters.
    pub to: PowerState,
    /// Causes, any of which triggers the transition.
    pub causes: &'static [Cause],
    /// Condition in addition to the cause, such as a state of the axis or an option code; empty for none.
    pub condition: &'static str,
    /// Action of the drive.
    pub action: &'static str,
}

/// Every transition, at the place of its number.
pub const TRANSITIONS: [Transition; 17] = [
    Transition {
        number: 0,
        from: &[],
        to: NotReadyToSwitchOn,
        causes: &[Cause::Start],
        condition: "",
        action: "self-test, initialisation",
    },
    Transition {
        number: 1,
        from: &[NotReadyToSwitchOn],
        to: SwitchOnDisabled,
        causes: &[Cause::Initialised],
        condition: "",
        action: "communication activated",
    },
    Transition {
        number: 2,
        from: &[SwitchOnDisabled],
        to: ReadyToSwitchOn,
        causes: &[Cause::Command(Command::Shutdown)],
        condition: "",
        action: "none",
    },
    Transition {
        number: 3,
        from: &[ReadyToSwitchOn],
        to: SwitchedOn,
        causes: &[Cause::Command(Command::SwitchOn)],
        condition: "",
        action: "high-level power switched on, if possible",
    },
    Transition {
        number: 4,
        from: &[SwitchedOn],
        to: OperationEnabled,
        causes: &[Cause::Command(Command::EnableOperation)],
        condition: "",
        action: "drive function enabled, internal set-points cleared",
    },
    Transition {
        number: 5,
        from: &[OperationEnabled],
        to: SwitchedOn,
        causes: &[Cause::Command(Command::DisableOperation)],
        condition: "standstill, unless 605Ch = 0",
        action: "drive function disabled",
    },
    Transition {
        number: 6,
        from: &[SwitchedOn],
        to: ReadyToSwitchOn,
        causes: &[Cause::Command(Command::Shutdown)],
        condition: "",
        action: "high-level power switched off, if possible",
    },
    Transition {
        number: 7,
        from: &[ReadyToSwitchOn],
        to: SwitchOnDisabled,
        causes: &[Cause::Command(Command::QuickStop), Cause::Command(Command::DisableVoltage)],
        condition: "",
        action: "none",
    },
    Transition {
        number: 8,
        from: &[OperationEnabled],
        to: ReadyToSwitchOn,
        causes: &[Cause::Command(Command::Shutdown)],
        condition: "standstill, unless 605Bh = 0",
        action: "drive function disabled, high-level power switched off, if possible",
    },
    Transition {
        number: 9,
        from: &[OperationEnabled],
        to: SwitchOnDisabled,
        causes: &[Cause::Command(Command::DisableVoltage)],
        condition: "",
        action: "drive function disabled, high-level power switched off, if possible",
    },
    Transition {
        number: 10,
        from: &[SwitchedOn],
        to: SwitchOnDisabled,
        causes: &[Cause::Command(Command::QuickStop), Cause::Command(Command::DisableVoltage)],
        condition: "",
        action: "high-level power switched off, if possible",
    },
    Transition {
        number: 11,
        from: &[OperationEnabled],
        to: QuickStopActive,
        causes: &[Cause::Command(Command::QuickStop)],
        condition: "",
        action: "quick stop started (605Ah)",
    },
    Transition {
        number: 12,
        from: &[QuickStopActive],
        to: SwitchOnDisabled,
        causes: &[Cause::QuickStopCompleted, Cause::Command(Command::DisableVoltage)],
        condition: "",
        action: "drive function disabled, high-level power switched off, if possible",
    },
    Transition {
        number: 13,
        from: &[NotReadyToSwitchOn, SwitchOnDisabled, ReadyToSwitchOn, SwitchedOn, OperationEnabled, QuickStopActive],
        to: FaultReactionActive,
        causes: &[Cause::Fault],
        condition: "",
        action: "fault reaction started (605Eh)",
    },
    Transition {
        number: 14,
        from: &[FaultReactionActive],
        to: Fault,
        causes: &[Cause::FaultReactionCompleted],
        condition: "",
        action: "drive function disabled, high-level power switched off, if possible",
    },
    Transition {
        number: 15,
        from: &[Fault],
        to: SwitchOnDisabled,
        causes: &[Cause::Command(Command::FaultReset)],
        condition: "no fault is present",
        action: "fault condition reset",
    },
    Transition {
        number: 16,
        from: &[QuickStopActive],
        to: OperationEnabled,
        causes: &[Cause::Command(Command::EnableOperation)],
        condition: "605Ah = 5 to 8",
        action: "drive function enabled",
    },
];

/// Several causes at once, a bit each: the drive evaluates them in each of its cycles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Causes(u16);

impl Causes {
    pub(crate) const NONE: Self = Self(0);

    pub(crate) const fn with(self, cause: Cause, is_given: bool) -> Self {
        Self(self.0 | (is_given as u16) << cause.place())
    }

    /// Commands of a controlword.
    pub(crate) const fn of(word: Controlword) -> Self {
        // Bits 7 and 3 to 0 decide.
        const GIVEN: [Causes; 32] = {
            let mut given = [Causes::NONE; 32];
            let mut place: u16 = 0;
            while place < 32 {
                let word = Controlword::from_bits((place & 0x10) << 3 | place & 0x0F);
                let mut command = 0;
                while command < Command::ALL.len() {
                    let asked = Command::ALL[command];
                    let known = given[place as usize];
                    given[place as usize] = known.with(Cause::Command(asked), word.gives(asked));
                    command += 1;
                }
                place += 1;
            }
            given
        };
        let bits = word.bits();
        GIVEN[(bits >> 3 & 0x10 | bits & 0x0F) as usize]
    }

    pub(crate) const fn without(self, cause: Cause) -> Self {
        Self(self.0 & !(1 << cause.place()))
    }

    const fn has_any_of(self, others: Self) -> bool {
        self.0 & others.0 != 0
    }
}

impl Cause {
    const fn place(self) -> u32 {
        match self {
            Self::Start => 0,
            Self::Initialised => 1,
            Self::QuickStopCompleted => 2,
            Self::Fault => 3,
            Self::FaultReactionCompleted => 4,
            Self::Command(command) => 5 + command as u32,
        }
    }
}

/// Transitions out of `state` that are triggered by one of `given`, by number.
pub(crate) fn set_off(state: PowerState, given: Causes) -> impl Iterator<Item = &'static Transition> {
    let mut left = LEAVING[state as usize];
    core::iter::from_fn(move || {
        loop {
            let number = left.trailing_zeros() as usize;
            let transition = TRANSITIONS.get(number)?;
            left &= left - 1;
            if given.has_any_of(CAUSES[number]) {
                return Some(transition);
            }
        }
    })
}

/// Causes of each transition.
const CAUSES: [Causes; TRANSITIONS.len()] = {
    let mut causes = [Causes::NONE; TRANSITIONS.len()];
    let mut number = 0;
    while number < TRANSITIONS.len() {
        let mut place = 0;
        while place < TRANSITIONS[number].causes.len() {
            causes[number] = causes[number].with(TRANSITIONS[number].causes[place], true);
            place += 1;
        }
        number += 1;
    }
    causes
};

/// Per state, a bit for each transition that leaves it.
const LEAVING: [u32; PowerState::ALL.len()] = {
    let mut leaving = [0; PowerState::ALL.len()];
    let mut number = 0;
    while number < TRANSITIONS.len() {
        let from = TRANSITIONS[number].from;
        let mut place = 0;
        while place < from.len() {
            leaving[from[place] as usize] |= 1 << number;
            place += 1;
        }
        number += 1;
    }
    leaving
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_transition_stands_at_the_place_of_its_number_and_leads_elsewhere() {
        for (place, transition) in TRANSITIONS.iter().enumerate() {
            assert_eq!(usize::from(transition.number), place);
            assert!(!transition.from.contains(&transition.to), "{place}");
            assert!(!transition.causes.is_empty(), "{place}");
        }
    }

    #[test]
    fn a_command_sets_off_the_transitions_that_drive_manuals_list_for_it() {
        // 6040h: the column "transitions" of the command table, as Synapticon's and ABB's manuals print it.
        let listed = |command| {
            let sets_off = move |t: &&Transition| t.causes.contains(&Cause::Command(command));
            TRANSITIONS.iter().filter(sets_off).map(|transition| transition.number)
        };
        assert!(listed(Command::Shutdown).eq([2, 6, 8]));
        assert!(listed(Command::SwitchOn).eq([3]));
        assert!(listed(Command::DisableVoltage).eq([7, 9, 10, 12]));
        assert!(listed(Command::QuickStop).eq([7, 10, 11]));
        assert!(listed(Command::DisableOperation).eq([5]));
        assert!(listed(Command::EnableOperation).eq([4, 16]));
        assert!(listed(Command::FaultReset).eq([15]));
    }

    #[test]
    fn a_controlword_gives_the_causes_that_its_commands_are() {
        for bits in 0..=u16::MAX {
            let word = Controlword::from_bits(bits);
            for transition in &TRANSITIONS {
                let is_commanded = |cause: &Cause| matches!(cause, Cause::Command(command) if word.gives(*command));
                let is_given = Causes::of(word).has_any_of(CAUSES[usize::from(transition.number)]);
                assert_eq!(is_given, transition.causes.iter().any(is_commanded), "{bits:04X}h, {}", transition.number);
            }
        }
    }

    #[test]
    fn a_state_is_left_by_the_transitions_that_name_it() {
        for state in PowerState::ALL {
            let named = TRANSITIONS.iter().filter(|transition| transition.from.contains(&state));
            assert!(set_off(state, Causes(u16::MAX)).eq(named), "{state}");
        }
    }
}
