//! A master that follows the power sequence, and its drive.
use crate::drive::{AT_REST, Drive};
use servobench_cia402::{Command, Next, PowerParams, PowerState, QuickStopOption, keeping, towards};

/// States that a master can lead a drive to.
const GOALS: [PowerState; 5] = [
    PowerState::SwitchOnDisabled,
    PowerState::ReadyToSwitchOn,
    PowerState::SwitchedOn,
    PowerState::OperationEnabled,
    PowerState::QuickStopActive,
];
/// The longest sequence: from the fault reaction through its end, the reset and the three commands to Operation enabled, and a
/// quick stop.
const LONGEST: u32 = 6;

/// Oracle: the machine of the drive, with each option code of the quick stop.
#[test]
fn every_state_is_reached_from_every_state() {
    for code in QuickStopOption::CODES {
        let params = PowerParams { quick_stop: QuickStopOption::try_from(*code).unwrap(), ..PowerParams::default() };
        for start in PowerState::ALL {
            for goal in GOALS {
                let mut drive = Drive::led_to(start, params);
                let (mut steps, mut word) = (0, 0);
                loop {
                    match towards(drive.memory.state(), goal) {
                        Next::Arrived => break,
                        Next::Give(command) => word = servobench_cia402::Controlword::of(command).bits(),
                        Next::Wait => {}
                        Next::Unreachable => panic!("605Ah = {code}: {start} to {goal}"),
                    }
                    drive.step(word, AT_REST);
                    steps += 1;
                    assert!(steps <= LONGEST, "605Ah = {code}: {start} to {goal} is at {}", drive.memory.state());
                }
            }
        }
    }
}

#[test]
fn what_keeps_a_state_keeps_it() {
    for state in GOALS {
        // A quick stop that stays.
        let quick_stop = QuickStopOption::try_from(6).unwrap();
        let mut drive = Drive::led_to(state, PowerParams { quick_stop, ..PowerParams::default() });
        let word = servobench_cia402::Controlword::of(keeping(state).unwrap_or(Command::QuickStop)).bits();
        for _ in 0..3 {
            drive.step(word, AT_REST);
            assert_eq!(drive.memory.state(), state);
        }
    }
}
