//! Every arrow of the state diagram by its number, and every absent one.
mod drive;
mod sequence;

use drive::{AT_REST, Drive, FAULTY, MOVING};
use servobench_cia402::DriveFunction::{Brake, Disabled, Follow};
use servobench_cia402::PowerState::{
    self, Fault, FaultReactionActive, NotReadyToSwitchOn, OperationEnabled, QuickStopActive, ReadyToSwitchOn,
    SwitchOnDisabled, SwitchedOn,
};
use servobench_cia402::{
    Controlword, Deceleration, DisableOperationOption, FaultReactionOption, HaltOption, PowerInputs, PowerMemory,
    PowerParams, QuickStopOption, ShutdownOption, step,
};

fn drive_in(state: PowerState) -> Drive {
    Drive::led_to(state, PowerParams::default())
}

#[test]
fn transition_0_starts_in_not_ready_to_switch_on() {
    assert_eq!(PowerMemory::default().state(), NotReadyToSwitchOn);
}

#[test]
fn transition_1_waits_for_the_initialisation() {
    let mut drive = drive_in(NotReadyToSwitchOn);
    assert_eq!(drive.step(0x06, PowerInputs { initialised: false, ..AT_REST }), (None, Disabled));
    assert_eq!(drive.step(0x06, AT_REST), (Some(1), Disabled));
    assert_eq!(drive.memory.state(), SwitchOnDisabled);
}

#[test]
fn transition_2_is_a_shutdown_of_a_disabled_drive() {
    let mut drive = drive_in(SwitchOnDisabled);
    assert_eq!(drive.step(0x06, AT_REST), (Some(2), Disabled));
    assert_eq!(drive.memory.state(), ReadyToSwitchOn);
}

#[test]
fn transition_3_switches_on() {
    let mut drive = drive_in(ReadyToSwitchOn);
    assert_eq!(drive.step(0x07, AT_REST), (Some(3), Disabled));
    assert_eq!(drive.memory.state(), SwitchedOn);
}

#[test]
fn transitions_3_and_4_follow_each_other_when_both_are_asked_for_in_one_word() {
    let mut drive = drive_in(ReadyToSwitchOn);
    assert_eq!(drive.step(0x0F, AT_REST), (Some(3), Disabled));
    assert_eq!(drive.step(0x0F, AT_REST), (Some(4), Follow));
}

#[test]
fn transition_4_enables_operation() {
    let mut drive = drive_in(SwitchedOn);
    assert_eq!(drive.step(0x0F, AT_REST), (Some(4), Follow));
    assert_eq!(drive.memory.state(), OperationEnabled);
}

#[test]
fn transition_5_brakes_on_the_ramp_and_is_taken_at_standstill() {
    let mut drive = drive_in(OperationEnabled);
    assert_eq!(drive.step(0x07, MOVING), (None, Brake(Deceleration::SlowDownRamp)));
    assert_eq!(drive.step(0x07, AT_REST), (Some(5), Disabled));
    assert_eq!(drive.memory.state(), SwitchedOn);
}

#[test]
fn transition_5_coasts_when_its_option_code_says_so() {
    let params = PowerParams { disable_operation: DisableOperationOption::Disable, ..PowerParams::default() };
    assert_eq!(Drive::led_to(OperationEnabled, params).step(0x07, MOVING), (Some(5), Disabled));
}

#[test]
fn transition_5_is_taken_back_by_enable_operation_before_standstill() {
    let mut drive = drive_in(OperationEnabled);
    drive.step(0x07, MOVING);
    assert_eq!(drive.step(0x0F, MOVING), (None, Follow));
}

#[test]
fn transition_6_is_a_shutdown_of_a_drive_that_is_switched_on() {
    let mut drive = drive_in(SwitchedOn);
    assert_eq!(drive.step(0x06, AT_REST), (Some(6), Disabled));
    assert_eq!(drive.memory.state(), ReadyToSwitchOn);
}

#[test]
fn transition_7_is_a_quick_stop_or_loss_of_voltage_of_a_ready_drive() {
    for word in [0x02, 0x00] {
        let mut drive = drive_in(ReadyToSwitchOn);
        assert_eq!(drive.step(word, AT_REST), (Some(7), Disabled));
        assert_eq!(drive.memory.state(), SwitchOnDisabled);
    }
}

#[test]
fn transition_8_coasts_or_brakes_as_its_option_code_says() {
    let mut coasting = drive_in(OperationEnabled);
    assert_eq!(coasting.step(0x06, MOVING), (Some(8), Disabled));
    assert_eq!(coasting.memory.state(), ReadyToSwitchOn);

    let params = PowerParams { shutdown: ShutdownOption::SlowDownRamp, ..PowerParams::default() };
    let mut braking = Drive::led_to(OperationEnabled, params);
    assert_eq!(braking.step(0x06, MOVING), (None, Brake(Deceleration::SlowDownRamp)));
    assert_eq!(braking.step(0x06, AT_REST), (Some(8), Disabled));
}

#[test]
fn transition_9_takes_the_power_from_a_moving_axis() {
    let mut drive = drive_in(OperationEnabled);
    assert_eq!(drive.step(0x00, MOVING), (Some(9), Disabled));
    assert_eq!(drive.memory.state(), SwitchOnDisabled);
}

#[test]
fn transition_10_is_a_quick_stop_or_loss_of_voltage_of_a_drive_that_is_switched_on() {
    for word in [0x02, 0x00] {
        let mut drive = drive_in(SwitchedOn);
        assert_eq!(drive.step(word, AT_REST), (Some(10), Disabled));
        assert_eq!(drive.memory.state(), SwitchOnDisabled);
    }
}

#[test]
fn transition_11_brakes_as_the_option_code_says() {
    let brakes = [
        (0, Disabled),
        (1, Brake(Deceleration::SlowDownRamp)),
        (2, Brake(Deceleration::QuickStopRamp)),
        (3, Brake(Deceleration::CurrentLimit)),
        (4, Brake(Deceleration::VoltageLimit)),
        (5, Brake(Deceleration::SlowDownRamp)),
        (6, Brake(Deceleration::QuickStopRamp)),
        (7, Brake(Deceleration::CurrentLimit)),
        (8, Brake(Deceleration::VoltageLimit)),
    ];
    for (code, brake) in brakes {
        let mut drive = Drive::led_to(OperationEnabled, quick_stop(code));
        assert_eq!(drive.step(0x02, MOVING), (Some(11), brake), "{code}");
        assert_eq!(drive.memory.state(), QuickStopActive);
    }
}

#[test]
fn transition_12_follows_at_standstill_by_codes_1_to_4_and_at_once_by_code_0() {
    for code in 1..=4 {
        let mut drive = Drive::led_to(QuickStopActive, quick_stop(code));
        assert_eq!(drive.step(0x02, MOVING).0, None, "{code}");
        assert_eq!(drive.step(0x02, AT_REST), (Some(12), Disabled), "{code}");
        assert_eq!(drive.memory.state(), SwitchOnDisabled);
    }
    assert_eq!(Drive::led_to(QuickStopActive, quick_stop(0)).step(0x02, MOVING), (Some(12), Disabled));
}

#[test]
fn transition_12_needs_disable_voltage_by_codes_5_to_8() {
    for code in 5..=8 {
        let mut drive = Drive::led_to(QuickStopActive, quick_stop(code));
        assert_eq!(drive.step(0x02, AT_REST).0, None, "{code}");
        assert_eq!(drive.step(0x00, MOVING), (Some(12), Disabled), "{code}");
    }
}

#[test]
fn transition_13_leads_out_of_every_state_before_any_command_and_powers_no_axis_that_was_not() {
    for state in PowerState::ALL {
        for word in [0x00, 0x02, 0x06, 0x07, 0x0F, 0x80] {
            let mut drive = drive_in(state);
            let (number, function) = drive.step(word, FAULTY);
            let (wanted, powered) = match state {
                FaultReactionActive => (None, true),
                Fault => (None, false),
                OperationEnabled | QuickStopActive => (Some(13), true),
                _ => (Some(13), false),
            };
            assert_eq!(number, wanted, "{state} {word:02X}h");
            let reaction = if powered { Brake(Deceleration::QuickStopRamp) } else { Disabled };
            assert_eq!(function, reaction, "{state} {word:02X}h");
        }
    }
}

#[test]
fn transition_13_lets_an_axis_coast_that_a_quick_stop_had_switched_off() {
    let mut drive = Drive::led_to(QuickStopActive, quick_stop(0));
    assert_eq!(drive.step(0x02, FAULTY), (Some(13), Disabled));
}

#[test]
fn transition_14_waits_for_the_reaction_and_not_for_one_that_coasts() {
    let mut braking = drive_in(FaultReactionActive);
    assert_eq!(braking.step(0x0F, MOVING), (None, Brake(Deceleration::QuickStopRamp)));
    assert_eq!(braking.step(0x0F, AT_REST), (Some(14), Disabled));
    assert_eq!(braking.memory.state(), Fault);

    let params = PowerParams { fault_reaction: FaultReactionOption::Disable, ..PowerParams::default() };
    assert_eq!(Drive::led_to(FaultReactionActive, params).step(0x0F, MOVING), (Some(14), Disabled));

    let mut unpowered = drive_in(SwitchedOn);
    unpowered.step(0x07, FAULTY);
    assert_eq!(unpowered.step(0x07, FAULTY), (Some(14), Disabled));
}

#[test]
fn transition_15_needs_the_rising_edge_of_bit_7_and_a_fault_that_is_gone() {
    let mut drive = drive_in(Fault);
    assert_eq!(drive.step(0x80, PowerInputs { fault: true, ..AT_REST }), (None, Disabled));
    assert_eq!(drive.step(0x80, AT_REST), (None, Disabled), "no edge");
    assert_eq!(drive.step(0x00, AT_REST), (None, Disabled));
    assert_eq!(drive.step(0x80, AT_REST), (Some(15), Disabled));
    assert_eq!(drive.memory.state(), SwitchOnDisabled);
    assert_eq!(drive.step(0x86, AT_REST), (None, Disabled), "no command beside bit 7");
    assert_eq!(drive.step(0x06, AT_REST), (Some(2), Disabled));
}

#[test]
fn transition_16_leads_back_by_codes_5_to_8_only() {
    for code in 0..=8 {
        let mut drive = Drive::led_to(QuickStopActive, quick_stop(code));
        let (number, _) = drive.step(0x0F, MOVING);
        let wanted = match code {
            0 => Some(12),
            1..=4 => None,
            _ => Some(16),
        };
        assert_eq!(number, wanted, "{code}");
    }
}

#[test]
fn halt_brakes_in_operation_enabled_and_its_end_goes_on() {
    let params = PowerParams { halt: HaltOption::CurrentLimit, ..PowerParams::default() };
    let mut drive = Drive::led_to(OperationEnabled, params);
    assert_eq!(drive.step(0x010F, MOVING), (None, Brake(Deceleration::CurrentLimit)));
    assert_eq!(drive.step(0x010F, AT_REST), (None, Brake(Deceleration::CurrentLimit)));
    assert_eq!(drive.step(0x000F, AT_REST), (None, Follow));
}

#[test]
fn a_word_that_comes_while_the_drive_is_local_is_not_processed() {
    let local = PowerInputs { remote: false, ..MOVING };
    let mut drive = drive_in(OperationEnabled);
    for word in [0x00, 0x02, 0x06, 0x07, 0x80, 0x010F] {
        assert_eq!(drive.step(word, local), (None, Follow), "{word:04X}h");
    }
}

#[test]
fn the_statusword_tells_what_the_drive_knows() {
    let quiet = PowerInputs { initialised: true, ..PowerInputs::default() };
    let told = [
        (quiet, 0x0040),
        (PowerInputs { main_voltage: true, ..quiet }, 0x0050),
        (PowerInputs { warning: true, ..quiet }, 0x00C0),
        (PowerInputs { remote: true, ..quiet }, 0x0240),
        (PowerInputs { target_reached: true, ..quiet }, 0x0440),
        (PowerInputs { internal_limit: true, ..quiet }, 0x0840),
    ];
    for (inputs, wanted) in told {
        let outputs = step(&PowerParams::default(), &mut PowerMemory::default(), Controlword::default(), inputs);
        assert_eq!(outputs.statusword.bits(), wanted, "{inputs:?}");
    }
}

/// Transitions that words trigger in a state, at standstill and with a quick stop that holds the axis: the patterns are those
/// printed at the arrows in manuals.
fn arrows(state: PowerState) -> &'static [(&'static str, u8)] {
    match state {
        NotReadyToSwitchOn | FaultReactionActive => &[],
        SwitchOnDisabled => &[("0xxxx110", 2)],
        ReadyToSwitchOn => &[("0xxxx111", 3), ("0xxxx01x", 7), ("0xxxxx0x", 7)],
        SwitchedOn => &[("0xxx1111", 4), ("0xxxx110", 6), ("0xxxx01x", 10), ("0xxxxx0x", 10)],
        OperationEnabled => &[("0xxx0111", 5), ("0xxxx110", 8), ("0xxxxx0x", 9), ("0xxxx01x", 11)],
        QuickStopActive => &[("0xxxxx0x", 12), ("0xxx1111", 16)],
        Fault => &[("1xxxxxxx", 15)],
    }
}

#[test]
fn every_word_takes_the_arrow_of_its_state_or_does_nothing() {
    for state in PowerState::ALL {
        let drive = Drive::led_to(state, quick_stop(6));
        let inputs = match state {
            NotReadyToSwitchOn => PowerInputs { initialised: false, ..AT_REST },
            FaultReactionActive => MOVING,
            _ => AT_REST,
        };
        for word in 0..=u16::MAX {
            let mut tried = drive;
            let (number, _) = tried.step(word, inputs);
            let wanted = arrows(state).iter().find(|(pattern, _)| matches(word, pattern)).map(|(_, number)| *number);
            assert_eq!(number, wanted, "{state} {word:04X}h");
            if number.is_none() {
                assert_eq!(tried.memory.state(), state, "{word:04X}h");
            }
        }
    }
}

/// True if the lower byte of `word` matches `pattern`, highest bit first, in which `x` is either value.
fn matches(word: u16, pattern: &str) -> bool {
    pattern.chars().rev().enumerate().all(|(bit, wanted)| match wanted {
        '0' => word >> bit & 1 == 0,
        '1' => word >> bit & 1 == 1,
        _ => true,
    })
}

fn quick_stop(code: i16) -> PowerParams {
    PowerParams { quick_stop: QuickStopOption::try_from(code).unwrap(), ..PowerParams::default() }
}
