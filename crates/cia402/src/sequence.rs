//! Command sequences by which a master moves a drive from state to state.
//!
//! Shortest paths through the [table of transitions](crate::TRANSITIONS), computed at compile time. No path uses a fault, so a drive is not
//! moved to Fault, to Fault reaction active, or back to Not ready to switch on.
//!
//! One command per state: the [next one](towards) is sent until the statusword shows another state. The command for Operation enabled
//! leaves Quick stop active; if the option code 605Ah = 0 to 4 does not allow that, the drive continues to Switch on disabled by itself,
//! from which there is a path as well.
//!
//! ```
//! use servobench_cia402::{Command, Next, PowerState, towards};
//! let goal = PowerState::OperationEnabled;
//! assert_eq!(towards(PowerState::SwitchOnDisabled, goal), Next::Give(Command::Shutdown));
//! assert_eq!(towards(PowerState::FaultReactionActive, goal), Next::Wait);
//! assert_eq!(towards(goal, goal), Next::Arrived);
//! ```
use crate::controlword::Command;
use crate::state::PowerState;
use crate::transitions::{Cause, TRANSITIONS};

/// Next step of a master that moves a drive to a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Next {
    /// Nothing: the drive has reached the state.
    Arrived,
    /// Gives a command. A fault reset is given by the rising edge of its bit.
    Give(Command),
    /// Waits: the drive continues by itself.
    Wait,
    /// No command of a master leads there.
    Unreachable,
}

/// Next step on the path from `state` to `goal`.
#[must_use]
pub const fn towards(state: PowerState, goal: PowerState) -> Next {
    WAYS[goal as usize][state as usize]
}

/// Command that keeps the drive in a state; `None` if that does not depend on the master.
#[must_use]
pub const fn keeping(state: PowerState) -> Option<Command> {
    match state {
        PowerState::SwitchOnDisabled => Some(Command::DisableVoltage),
        PowerState::ReadyToSwitchOn => Some(Command::Shutdown),
        PowerState::SwitchedOn => Some(Command::SwitchOn),
        PowerState::OperationEnabled => Some(Command::EnableOperation),
        PowerState::QuickStopActive => Some(Command::QuickStop),
        PowerState::NotReadyToSwitchOn | PowerState::FaultReactionActive | PowerState::Fault => None,
    }
}

const STATES: usize = PowerState::ALL.len();

/// Next steps per goal and state.
const WAYS: [[Next; STATES]; STATES] = {
    let mut ways = [[Next::Unreachable; STATES]; STATES];
    let mut goal = 0;
    while goal < STATES {
        ways[goal] = ways_to(goal);
        goal += 1;
    }
    ways
};

/// Next steps per state; by the shortest distances, which `STATES` rounds over all transitions settle (Bellman & Ford).
const fn ways_to(goal: usize) -> [Next; STATES] {
    let (mut ways, mut distances) = ([Next::Unreachable; STATES], [STATES; STATES]);
    (ways[goal], distances[goal]) = (Next::Arrived, 0);
    let mut round = 0;
    while round < STATES {
        let mut number = 0;
        while number < TRANSITIONS.len() {
            let transition = &TRANSITIONS[number];
            let distance = distances[transition.to as usize] + 1;
            if let Some(next) = taken_by(transition.causes) {
                let mut place = 0;
                while place < transition.from.len() {
                    let from = transition.from[place] as usize;
                    if distance < distances[from] {
                        (ways[from], distances[from]) = (next, distance);
                    }
                    place += 1;
                }
            }
            number += 1;
        }
        round += 1;
    }
    ways
}

/// Step of a master for a transition with these causes: it waits if only the drive decides. Of several commands the last one is taken,
/// Disable voltage, which has the same effect in every state.
const fn taken_by(causes: &[Cause]) -> Option<Next> {
    let (mut next, mut place) = (None, 0);
    while place < causes.len() {
        match causes[place] {
            Cause::Command(command) => next = Some(Next::Give(command)),
            Cause::Initialised | Cause::QuickStopCompleted | Cause::FaultReactionCompleted if next.is_none() => {
                next = Some(Next::Wait);
            }
            _ => {}
        }
        place += 1;
    }
    next
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the sequences that every manual prints, 0006h – 0007h – 000Fh and back.
    #[test]
    fn a_start_up_is_that_of_the_manuals() {
        let (mut state, mut words) = (PowerState::SwitchOnDisabled, Vec::new());
        for told in [PowerState::ReadyToSwitchOn, PowerState::SwitchedOn, PowerState::OperationEnabled] {
            let Next::Give(command) = towards(state, PowerState::OperationEnabled) else { panic!("{state}") };
            words.push(crate::Controlword::of(command).bits());
            state = told;
        }
        assert_eq!(words, [0x0006, 0x0007, 0x000F]);
        assert_eq!(towards(PowerState::Fault, PowerState::OperationEnabled), Next::Give(Command::FaultReset));
        assert_eq!(towards(state, PowerState::SwitchedOn), Next::Give(Command::DisableOperation));
        assert_eq!(towards(state, PowerState::ReadyToSwitchOn), Next::Give(Command::Shutdown));
        assert_eq!(towards(state, PowerState::SwitchOnDisabled), Next::Give(Command::DisableVoltage));
        assert_eq!(towards(state, PowerState::QuickStopActive), Next::Give(Command::QuickStop));
    }

    #[test]
    fn no_way_leads_where_only_the_drive_goes() {
        for goal in [PowerState::NotReadyToSwitchOn, PowerState::FaultReactionActive, PowerState::Fault] {
            for state in PowerState::ALL.into_iter().filter(|state| *state != goal) {
                // The fault reaction ends in Fault by itself.
                let ends = state == PowerState::FaultReactionActive && goal == PowerState::Fault;
                let next = if ends { Next::Wait } else { Next::Unreachable };
                assert_eq!(towards(state, goal), next, "{state} to {goal}");
            }
        }
    }
}
