//! Powering the drive, and stopping it at faults.
use crate::rig::{BUS, MOTION, Rig, follow, settings};
use servobench_cia402::{PowerState, Statusword};
use servobench_fieldbus::link::{Sequencing, Settings};
use servobench_fieldbus::{AxisCommand, Fault, Interpolation, LinkFault, Power, ProfileCommand, Switches, Task};
use servobench_motion::interpolate::Sample;

/// At `x`, moving at `v`.
fn at(x: f64, v: f64) -> AxisCommand {
    follow(Sample { x, v, a: 0.0, torque: 0.0 })
}

const REST: AxisCommand = AxisCommand::of(REST_TASK);
const REST_TASK: servobench_fieldbus::Task =
    servobench_fieldbus::Task::Follow(Sample { x: 0.0, v: 0.0, a: 0.0, torque: 0.0 });
const OFF: AxisCommand = AxisCommand { power: false, ..REST };
const RESET: AxisCommand = AxisCommand { reset: true, ..REST };

impl Rig {
    /// Runs cycles of the bus with one command; returns each new controlword and each new `Power`.
    fn words(&mut self, cycles: u32, command: AxisCommand) -> (Vec<u16>, Vec<Power>) {
        let (mut words, mut powers) = (Vec::new(), Vec::new());
        self.write(self.tick, command);
        for _ in 0..cycles {
            let word = self.cycle().controlword.bits();
            if words.last() != Some(&word) {
                words.push(word);
            }
            let power = self.feedback().power;
            if powers.last() != Some(&power) {
                powers.push(power);
            }
        }
        (words, powers)
    }

    fn powered(settings: Settings) -> Self {
        let mut rig = Self::new(settings);
        rig.run(3, |_| REST);
        assert_eq!(rig.feedback().power, Power::On);
        rig
    }

    fn fault(&self) -> Option<Fault> {
        self.feedback().fault
    }
}

/// Oracle: 0006h, 0007h, 000Fh and back by 0007h, 0006h, as printed in manuals.
#[test]
fn strict_sequencing_gives_one_command_per_state() {
    let mut rig = Rig::new(settings());
    let (words, powers) = rig.words(50, REST);
    assert_eq!(words, [0x0000, 0x0006, 0x0007, 0x000F]);
    assert_eq!(powers, [Power::Switching, Power::On]);
    let (words, powers) = rig.words(50, OFF);
    assert_eq!(words, [0x0007, 0x0006]);
    assert_eq!(powers, [Power::Switching, Power::Off]);
    assert_eq!(rig.drive.memory.state(), PowerState::ReadyToSwitchOn);
    assert_eq!(rig.fault(), None);
}

#[test]
fn simplified_sequencing_switches_the_word_at_once() {
    let mut rig = Rig::new(Settings { sequencing: Sequencing::Simplified, ..settings() });
    assert_eq!(rig.words(50, REST).0, [0x0006, 0x000F]);
    assert_eq!(rig.words(50, OFF).0, [0x0006]);
    assert_eq!(rig.words(50, REST).0, [0x000F]);
    assert_eq!(rig.drive.memory.state(), PowerState::OperationEnabled);
    rig.drive.fault = true;
    assert_eq!(rig.words(50, REST).0, [0x000F, 0x0000]);
    assert_eq!(rig.fault(), Some(Fault::Drive(0x7121)));
    rig.drive.fault = false;
    assert_eq!(rig.words(50, RESET).0, [0x0080, 0x0006, 0x000F]);
    assert_eq!(rig.fault(), None);
}

#[test]
fn a_fault_of_the_drive_waits_for_the_edge_of_a_reset() {
    let mut rig = Rig::powered(settings());
    rig.drive.fault = true;
    assert_eq!(rig.words(20, REST).0, [0x000F, 0x0000]);
    assert_eq!((rig.fault(), rig.feedback().power), (Some(Fault::Drive(0x7121)), Power::Off));
    rig.drive.fault = false;
    assert_eq!(rig.words(20, REST).0, [0x0000]);
    let (words, powers) = rig.words(20, RESET);
    assert_eq!(words, [0x0080, 0x0006, 0x0007, 0x000F]);
    assert_eq!(powers, [Power::Off, Power::Switching, Power::On]);
    // The same level again is not an edge, not even for a fault that is over at once.
    rig.drive.fault = true;
    rig.words(1, RESET);
    rig.drive.fault = false;
    rig.words(20, RESET);
    assert_eq!(rig.fault(), Some(Fault::Drive(0x7121)));
}

#[test]
fn a_fault_that_persists_is_not_reset_for_ever() {
    let mut rig = Rig::powered(settings());
    rig.drive.fault = true;
    rig.words(20, REST);
    // 1600 ticks are 100 cycles.
    assert_eq!(rig.words(150, RESET).0, [0x0080, 0x0000]);
    rig.drive.fault = false;
    rig.words(20, REST);
    rig.words(20, RESET);
    assert_eq!((rig.fault(), rig.feedback().power), (None, Power::On));
}

#[test]
fn a_drive_that_does_not_do_what_it_is_told_times_out() {
    let mut rig = Rig::new(settings());
    rig.run(1, |_| OFF);
    rig.drive.deaf = true;
    let told = rig.tick;
    rig.write(told, REST);
    while rig.fault().is_none() {
        rig.cycle();
    }
    assert_eq!(rig.fault(), Some(Fault::Link(LinkFault::DriveTimeout)));
    // 1600 ticks after the command, at the first cycle after that.
    assert_eq!(rig.tick - BUS - told, 1_600 + BUS);
    rig.drive.deaf = false;
    rig.words(20, OFF);
    rig.words(20, RESET);
    assert_eq!((rig.fault(), rig.feedback().power), (None, Power::On));
}

#[test]
fn braking_takes_as_long_as_it_takes() {
    let mut rig = Rig::powered(settings());
    rig.drive.rolls = true;
    // 300 cycles are three time-outs.
    assert_eq!(rig.words(300, OFF), (vec![0x0007], vec![Power::Switching]));
    rig.drive.rolls = false;
    assert_eq!(rig.words(20, OFF), (vec![0x0007, 0x0006], vec![Power::Switching, Power::Off]));
    assert_eq!(rig.fault(), None);

    // Reset while the quick stop brakes: the drive returns to power when it is over.
    rig.words(20, REST);
    rig.drive.rolls = true;
    rig.external_fault = true;
    rig.words(20, REST);
    assert_eq!(rig.drive.memory.state(), PowerState::QuickStopActive);
    rig.external_fault = false;
    rig.words(300, RESET);
    assert_eq!(rig.fault(), None);
    rig.drive.rolls = false;
    rig.words(20, REST);
    assert_eq!((rig.fault(), rig.feedback().power), (None, Power::On));

    // Reset while the fault reaction brakes.
    rig.drive.rolls = true;
    rig.drive.fault = true;
    rig.words(20, REST);
    rig.drive.fault = false;
    rig.words(300, RESET);
    assert_eq!(rig.drive.memory.state(), PowerState::FaultReactionActive);
    rig.drive.rolls = false;
    rig.words(20, RESET);
    assert_eq!((rig.fault(), rig.feedback().power), (None, Power::On));
}

#[test]
fn a_silent_drive_is_told_to_stop_quickly() {
    let mut rig = Rig::powered(settings());
    let silent = rig.tick;
    while rig.fault().is_none() {
        rig.answer = None;
        rig.cycle();
    }
    assert_eq!(rig.fault(), Some(Fault::Link(LinkFault::DriveTimeout)));
    assert_eq!(rig.tick - BUS - (silent - BUS), 1_600 + BUS);
    assert_eq!(rig.commands.controlword.bits(), 0x0002);
    // The drive is heard again: nothing happens before a reset.
    rig.words(20, REST);
    assert_eq!(rig.fault(), Some(Fault::Link(LinkFault::DriveTimeout)));
    rig.words(20, RESET);
    assert_eq!((rig.fault(), rig.feedback().power), (None, Power::On));
}

#[test]
fn a_drive_that_leaves_operation_enabled_does_not_come_back_by_itself() {
    let mut rig = Rig::powered(settings());
    rig.answer = rig
        .answer
        .map(|actuals| servobench_cia402::Actuals { statusword: Statusword::of(PowerState::SwitchedOn), ..actuals });
    let (words, _) = rig.words(20, REST);
    assert_eq!(rig.fault(), Some(Fault::Link(LinkFault::DriveLeftOperation)));
    assert!(!words.contains(&0x000F), "{words:04X?}");
    rig.words(20, RESET);
    assert_eq!((rig.fault(), rig.feedback().power), (None, Power::On));
}

#[test]
fn an_answer_to_an_earlier_word_is_no_answer() {
    for cycles in 1..6 {
        let mut rig = Rig::powered(settings());
        let mut on_the_way = rig.answer;
        let mut words = |rig: &mut Rig, cycles, command| {
            rig.write(rig.tick, command);
            for _ in 0..cycles {
                core::mem::swap(&mut rig.answer, &mut on_the_way);
                rig.cycle();
            }
        };
        // Off and on again before the drive can have reported off.
        words(&mut rig, cycles, OFF);
        words(&mut rig, 30, REST);
        assert_eq!((rig.fault(), rig.feedback().power), (None, Power::On), "{cycles}");
    }
}

#[test]
fn the_external_fault_stops_quickly_for_as_long_as_it_is_there() {
    let mut rig = Rig::powered(settings());
    rig.external_fault = true;
    let (words, _) = rig.words(20, REST);
    // Quick stop; the default option code disables the drive when it is over.
    assert_eq!(words, [0x0002, 0x0000]);
    assert_eq!(rig.fault(), Some(Fault::Link(LinkFault::External)));
    assert_eq!(rig.feedback().interpolation, Interpolation::Off);
    rig.words(20, RESET);
    assert_eq!(rig.fault(), Some(Fault::Link(LinkFault::External)));
    rig.external_fault = false;
    rig.words(20, REST);
    assert_eq!(rig.fault(), Some(Fault::Link(LinkFault::External)));
    rig.words(20, RESET);
    assert_eq!((rig.fault(), rig.feedback().power), (None, Power::On));
}

/// Moves the axis at 0.1 m/s in the direction of `sign` for `cycles` of the motion task, from its present position.
fn moves(rig: &mut Rig, sign: f64, cycles: u64) {
    let (x, start) = (rig.feedback().position, rig.tick / MOTION);
    rig.run(cycles, |cycle| at(x + sign * 0.1 * 0.02 * (cycle - start) as f64, sign * 0.1));
}

#[test]
fn a_limit_switch_halts_what_moves_into_it_and_nothing_else() {
    let wired = |closed: u32, reverse: bool| if reverse { closed ^ 0b111 } else { closed };
    for (sign, bit, fault) in [(-1.0, 0b001, LinkFault::NegativeLimit), (1.0, 0b010, LinkFault::PositiveLimit)] {
        for reverse_switches in [false, true] {
            // Linear interpolation: an abrupt start must not swing back.
            let interpolation = servobench_motion::interpolate::Mode::Linear;
            let mut rig = Rig::new(Settings { reverse_switches, interpolation, ..settings() });
            rig.drive.actuals.digital_inputs = wired(0, reverse_switches);
            rig.run(3, |_| REST);
            moves(&mut rig, sign, 10);
            assert_eq!(rig.fault(), None);
            rig.drive.actuals.digital_inputs = wired(bit, reverse_switches);
            moves(&mut rig, sign, 5);
            assert_eq!(rig.fault(), Some(Fault::Link(fault)));
            assert_eq!(rig.commands.controlword.bits(), 0x010F, "halted, still powered");
            let x = rig.feedback().position;
            let switches = rig.feedback().switches;
            let expected = Switches { negative_limit: sign < 0.0, home: false, positive_limit: sign > 0.0 };
            assert_eq!(switches, expected);

            // Reset at rest, a count and a half into the switch, ten counts, out of it, back in.
            let reset = |rig: &mut Rig, counts: f64| {
                let rest = at(x + sign * counts * 1e-6, 0.0);
                rig.run(2, |_| AxisCommand { reset: true, ..rest });
                rig.run(3, |_| rest);
            };
            reset(&mut rig, 1.5);
            assert_eq!(rig.fault(), None);
            reset(&mut rig, 10.0);
            assert_eq!(rig.fault(), Some(Fault::Link(fault)));
            reset(&mut rig, 0.0);
            assert_eq!(rig.fault(), None);
            moves(&mut rig, -sign, 10);
            assert_eq!(rig.fault(), None);
            assert!(sign * (rig.feedback().position - x) < -1e-3);
            moves(&mut rig, sign, 20);
            assert_eq!(rig.fault(), Some(Fault::Link(fault)));

            // A halt does not mask a fault that needs a quick stop.
            rig.external_fault = true;
            rig.run(1, |_| at(x, 0.0));
            assert_eq!(rig.fault(), Some(Fault::Link(LinkFault::External)));
        }
    }
}

#[test]
fn an_effort_into_a_limit_switch_halts_the_axis() {
    let effort = |value| AxisCommand { task: servobench_fieldbus::Task::Effort(value), ..REST };
    let mut rig = Rig::powered(settings());
    rig.drive.actuals.digital_inputs = 0b010;
    rig.run(3, |_| effort(-2.0));
    assert_eq!(rig.fault(), None);
    rig.run(1, |_| effort(2.0));
    assert_eq!(rig.fault(), Some(Fault::Link(LinkFault::PositiveLimit)));
}

#[test]
fn a_sample_that_is_no_number_is_refused_and_stops_the_axis() {
    for sample in [f64::NAN, f64::INFINITY, 1e30] {
        let mut rig = Rig::powered(settings());
        rig.run(1, |_| at(sample, 0.0));
        assert_eq!(rig.fault(), Some(Fault::Link(LinkFault::Command)));
        assert_eq!(rig.drive.counts, 0);
    }
    for velocity in [f64::NAN, f64::INFINITY, 1e30] {
        let mut rig = Rig::powered(settings());
        let told = Task::Drive(ProfileCommand::Velocity { velocity, acceleration: 1.0 });
        rig.run(1, |_| AxisCommand::of(told));
        assert_eq!(rig.fault(), Some(Fault::Link(LinkFault::Command)), "{velocity}");
        assert_eq!(rig.drive.counts, 0);
    }
    for v in [f64::NAN, -8.001] {
        let mut rig = Rig::powered(settings());
        rig.run(1, |_| at(0.0, v));
        assert_eq!(rig.fault(), Some(Fault::Link(LinkFault::Command)));
    }
}
