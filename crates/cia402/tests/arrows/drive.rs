//! A drive on the test's desk.
use servobench_cia402::{Controlword, DriveFunction, PowerInputs, PowerMemory, PowerParams, PowerState, step};

/// Inputs of a healthy drive at standstill.
pub(crate) const AT_REST: PowerInputs = PowerInputs {
    initialised: true,
    fault: false,
    standstill: true,
    remote: true,
    main_voltage: true,
    warning: false,
    target_reached: false,
    internal_limit: false,
};

/// The same, moving.
pub(crate) const MOVING: PowerInputs = PowerInputs { standstill: false, ..AT_REST };

/// The same, moving, with a fault.
pub(crate) const FAULTY: PowerInputs = PowerInputs { fault: true, ..MOVING };

/// Option codes and memory of a drive.
#[derive(Clone, Copy)]
pub(crate) struct Drive {
    pub(crate) params: PowerParams,
    pub(crate) memory: PowerMemory,
}

impl Drive {
    /// A drive that was led to `state` as by a master.
    pub(crate) fn led_to(state: PowerState, params: PowerParams) -> Self {
        let way: &[(u16, PowerInputs)] = match state {
            PowerState::NotReadyToSwitchOn => &[],
            PowerState::SwitchOnDisabled => &[(0, AT_REST)],
            PowerState::ReadyToSwitchOn => &[(0, AT_REST), (0x06, AT_REST)],
            PowerState::SwitchedOn => &[(0, AT_REST), (0x06, AT_REST), (0x07, AT_REST)],
            PowerState::OperationEnabled => &[(0, AT_REST), (0x06, AT_REST), (0x07, AT_REST), (0x0F, MOVING)],
            PowerState::QuickStopActive => {
                &[(0, AT_REST), (0x06, AT_REST), (0x07, AT_REST), (0x0F, MOVING), (0x02, MOVING)]
            }
            PowerState::FaultReactionActive => {
                &[(0, AT_REST), (0x06, AT_REST), (0x07, AT_REST), (0x0F, MOVING), (0x0F, FAULTY)]
            }
            PowerState::Fault => {
                &[(0, AT_REST), (0x06, AT_REST), (0x07, AT_REST), (0x0F, MOVING), (0x0F, FAULTY), (0x0F, AT_REST)]
            }
        };
        let mut drive = Self { params, memory: PowerMemory::default() };
        for (word, inputs) in way {
            drive.step(*word, *inputs);
        }
        assert_eq!(drive.memory.state(), state);
        drive
    }

    /// Number of the transition taken, and the function of the power stage from now on.
    pub(crate) fn step(&mut self, word: u16, inputs: PowerInputs) -> (Option<u8>, DriveFunction) {
        let outputs = step(&self.params, &mut self.memory, Controlword::from_bits(word), inputs);
        assert_eq!(outputs.statusword.state(), Some(self.memory.state()));
        (outputs.transition.map(|transition| transition.number), outputs.drive)
    }
}
