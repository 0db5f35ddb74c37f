//! Counters that wrap, the position loop in the master, efforts and homing.
use crate::rig::{BUS, HOMING, MOTION, RATE, Rig, follow, settings};
use core::f64::consts::TAU;
use servobench_cia402::counter::Counter;
use servobench_cia402::{Actuals, StatusBit};
use servobench_fieldbus::link::{Control, PositionGains, Settings, Units};
use servobench_fieldbus::{AxisCommand, Fault, Homing, Interpolation, LinkFault, Power, Task};
use servobench_motion::interpolate::Sample;

const REST: AxisCommand = AxisCommand::of(REST_TASK);
const REST_TASK: Task = Task::Follow(Sample { x: 0.0, v: 0.0, a: 0.0, torque: 0.0 });

/// Ten turns of the counter to one side, back, and ten to the other; the oracle is the drive's count in 127 bits.
fn through_a_counter(counter: Counter, drive_units: f64, axis_units: f64) {
    const CYCLES: u64 = 400;
    let units = Units { drive_units, axis_units, velocity_factor: 1e-3, counter, ..settings().units };
    let mut rig = Rig::new(Settings { units, velocity_from_differences: true, ..settings() });
    let turns = 10.0 * counter.range() as f64 * axis_units / drive_units;
    let omega = TAU / (CYCLES * MOTION) as f64 * RATE;
    // sin φ·(1 − cos φ) peaks at 1.299 on either side, and starts and ends at rest.
    let motion = |cycle: u64| {
        let phase = TAU * cycle.saturating_sub(5) as f64 / CYCLES as f64;
        let (x, v) = (phase.sin() * (1.0 - phase.cos()), omega * (phase.cos() - (2.0 * phase).cos()));
        follow(Sample { x: turns * x / 1.29, v: turns * v / 1.29, a: 0.0, torque: 0.0 })
    };
    // The drive's counts of the cycles before, the newest first.
    let mut counts = [0_i128; 6];
    let (mut highest, mut lowest) = (0, 0);
    while rig.tick < (CYCLES + 5) * MOTION {
        if rig.tick.is_multiple_of(MOTION) {
            rig.write(rig.tick, motion(rig.tick / MOTION));
        }
        rig.cycle();
        let feedback = rig.feedback();
        assert_eq!(feedback.fault, None);
        // The received position is a cycle old. Three roundings.
        let axis = |counts: i128| counts as f64 * axis_units / drive_units;
        let expected = axis(counts[0]);
        assert!((feedback.position - expected).abs() <= 1e-15 * expected.abs(), "{} {expected}", feedback.position);
        let expected = axis(counts[0] - counts[4]) / (4 * BUS) as f64 * RATE;
        assert!((feedback.velocity - expected).abs() <= 1e-15 * expected.abs(), "{} {expected}", feedback.velocity);
        let step = axis(rig.drive.counts - counts[0]);
        assert!(step.abs() <= 4.0 * BUS as f64 / RATE, "a jump of {step}");
        counts.rotate_right(1);
        counts[0] = rig.drive.counts;
        (highest, lowest) = (highest.max(counts[0]), lowest.min(counts[0]));
    }
    assert!(highest > 10 * counter.range(), "{highest}");
    assert!(lowest < -10 * counter.range(), "{lowest}");
}

#[test]
fn no_count_is_lost_through_ten_turns_of_a_counter() {
    for bits in [16, 32] {
        for counter in [Counter::signed(bits).unwrap(), Counter::unsigned(bits).unwrap()] {
            // Ten turns are 0.6 m.
            let per_metre = counter.range() as f64 / 0.06;
            through_a_counter(counter, per_metre, 1.0);
            through_a_counter(counter, per_metre, -1.0);
        }
    }
}

#[test]
fn the_position_loop_of_the_master_lags_by_velocity_over_gain() {
    for (feedforward, lag) in [(0.0, 0.1 / 20.0), (1.0, 0.0), (0.5, 0.05 / 20.0)] {
        let control = Control::Velocity {
            gains: PositionGains::proportional(20.0),
            feedforward,
            limit: 0.2,
            torque_offset: false,
        };
        let mut rig = Rig::new(Settings { control, ..settings() });
        rig.run(5, |_| REST);
        rig.run(100, |cycle| follow(Sample { x: 0.002 * (cycle - 5) as f64, v: 0.1, a: 0.0, torque: 0.0 }));
        assert_eq!(rig.commands.mode, 9);
        // The received position is compared with the output a round trip before: two cycles.
        let error = rig.setpoint().x - 0.1 * 2.0 * BUS as f64 / RATE - rig.feedback().position;
        // The drive takes whole counts per cycle: 1 mm/s, of which the gain makes 50 µm.
        assert!((error - lag).abs() < 51e-6, "{error} for {lag}");
        assert!((f64::from(rig.commands.target_velocity) - 1e5).abs() < 1_001.0);
        assert!(!rig.state.is_limited());
        // A step of 0.1 m requires 2 m/s without the limit.
        let x = rig.feedback().position + 0.1;
        rig.run(2, |_| follow(Sample { x, v: 0.0, a: 0.0, torque: 0.0 }));
        let mut limited = false;
        for _ in 0..MOTION / BUS {
            limited |= rig.state.is_limited();
            assert!(rig.cycle().target_velocity <= 200_000);
        }
        assert!(limited);
    }
}

#[test]
fn efforts_are_reached_in_a_line_and_let_go_when_none_comes() {
    let effort = |value| AxisCommand::of(Task::Effort(value));
    let mut rig = Rig::new(settings());
    rig.run(5, |_| effort(0.0));
    assert_eq!((rig.commands.mode, rig.feedback().interpolation), (10, Interpolation::Run1));
    // Rated 10 N: 5 N are 500 thousandths, reached within the 20 cycles of the bus.
    rig.write(rig.tick, effort(5.0));
    for cycle in 0..20 {
        assert_eq!(rig.cycle().target_torque, 25 * cycle);
    }
    let mut states = Vec::new();
    for _ in 0..100 {
        rig.cycle();
        let state = rig.feedback().interpolation;
        if states.last() != Some(&state) {
            states.push(state);
        }
    }
    assert_eq!(states, [Interpolation::Run2, Interpolation::Run3, Interpolation::Underflow]);
    assert_eq!((rig.commands.target_torque, rig.feedback().effort), (0, 0.0));
}

#[test]
fn an_effort_from_before_a_fault_is_forgotten() {
    let effort = AxisCommand::of(Task::Effort(5.0));
    let mut rig = Rig::new(settings());
    rig.run(5, |_| effort);
    assert_eq!(rig.commands.target_torque, 500);
    rig.external_fault = true;
    rig.run(2, |_| effort);
    rig.external_fault = false;
    rig.write(rig.tick, AxisCommand { reset: true, ..effort });
    for _ in 0..2 * MOTION / BUS {
        assert_eq!(rig.cycle().target_torque, 0, "not before the next one");
    }
    assert_eq!((rig.feedback().power, rig.feedback().interpolation), (Power::On, Interpolation::Off));
    rig.run(2, |_| effort);
    assert_eq!(rig.commands.target_torque, 500);
}

#[test]
fn an_effort_within_the_margin_is_in_time() {
    let mut rig = Rig::new(Settings { margin: 64, ..settings() });
    let effort = AxisCommand::of(Task::Effort(1.0));
    rig.run(3, |_| effort);
    for late in [0, 1, 4, 2, 3, 0] {
        for cycle in 0..MOTION / BUS {
            if cycle == late {
                rig.write(rig.tick / MOTION * MOTION, effort);
            }
            rig.cycle();
            assert_eq!(rig.feedback().interpolation, Interpolation::Run1);
        }
    }
}

#[test]
fn a_torque_does_not_jump() {
    let mut rig = Rig::new(settings());
    let holding = |torque| follow(Sample { torque, ..Sample::default() });
    let mut last = 0;
    for (cycles, torque) in [(10, 5.0), (4, -5.0), (10, 5.0)] {
        for cycle in 0..cycles * MOTION / BUS {
            // The last time no command comes, and the torque ends with the motion.
            if rig.tick.is_multiple_of(MOTION) && (torque > 0.0 || cycle == 0) {
                rig.write(rig.tick, holding(torque));
            }
            let offset = rig.cycle().torque_offset;
            // At most from 500 thousandths to the opposite within the 20 cycles of the bus.
            assert!((offset - last).abs() <= 51, "{last} to {offset}");
            last = offset;
        }
    }
    assert_eq!(last, 500);
}

#[test]
fn homing_is_started_by_bit_4_and_gives_the_position() {
    let home = AxisCommand::of(Task::Home { position: 0.25 });
    let mut rig = Rig::new(settings());
    rig.run(5, |_| REST);
    // Twice: the second time the drive still shows the earlier result. Its answers are two cycles old, and the first one of
    // the second time is left from the first time.
    let mut on_the_way = rig.answer;
    for _ in 0..2 {
        rig.write(rig.tick, home);
        let (mut bits, mut homing, mut busy) = (Vec::new(), Vec::new(), 0);
        for _ in 0..HOMING + 20 {
            core::mem::swap(&mut rig.answer, &mut on_the_way);
            let commands = rig.cycle();
            assert_eq!(rig.feedback().power, Power::On, "while the mode changes, too");
            let seen = (commands.mode, commands.controlword.bits());
            if bits.last() != Some(&seen) {
                bits.push(seen);
            }
            let seen = rig.feedback().homing;
            if homing.last() != Some(&seen) {
                homing.push(seen);
            }
            busy += u32::from(seen == Homing::Busy);
        }
        assert_eq!(bits, [(6, 0x000F), (6, 0x001F)]);
        assert_eq!(homing, [Homing::Busy, Homing::Attained]);
        assert!(busy >= HOMING, "{busy}");
        assert_eq!(rig.commands.home_offset, 250_000);
        assert!((rig.feedback().position - 0.25).abs() < 1e-12);
        // The motion continues from there, without a jump.
        rig.tick = rig.tick.next_multiple_of(MOTION);
        let at = follow(Sample { x: 0.25, ..Sample::default() });
        rig.run(5, |_| at);
        assert_eq!((rig.drive.counts, rig.feedback().homing), (250_000, Homing::Idle));
    }
}

#[test]
fn homing_that_fails_says_so() {
    let home = |position| AxisCommand::of(Task::Home { position });
    let homing = || {
        let mut rig = Rig::new(settings());
        rig.run(5, |_| REST);
        rig.run(1, |_| home(0.25));
        assert_eq!(rig.feedback().homing, Homing::Busy);
        rig
    };
    // By the drive: bit 13.
    let mut rig = homing();
    rig.answer = rig
        .answer
        .map(|actuals| Actuals { statusword: actuals.statusword.with(StatusBit::ModeSpecific13, true), ..actuals });
    rig.cycle();
    assert_eq!(rig.feedback().homing, Homing::Failed);
    // By a fault.
    let mut rig = homing();
    rig.drive.fault = true;
    rig.run(1, |_| home(0.25));
    assert_eq!((rig.feedback().homing, rig.feedback().power), (Homing::Failed, Power::Off));
    // By a position that 607Ch cannot hold.
    let mut rig = Rig::new(settings());
    rig.run(5, |_| home(2_147.5));
    assert_eq!(rig.feedback().fault, Some(Fault::Link(LinkFault::Command)));
}

#[test]
fn a_reading_that_loses_counts_stops_the_axis() {
    let units = Units { counter: Counter::signed(16).unwrap(), ..settings().units };
    for reading in [40_000, -32_768] {
        let mut rig = Rig::new(Settings { units, ..settings() });
        rig.run(5, |_| REST);
        rig.answer = rig.answer.map(|actuals| Actuals { position: reading, ..actuals });
        rig.cycle();
        assert_eq!(rig.feedback().fault, Some(Fault::Link(LinkFault::PositionLost)), "{reading}");
        // From where the counter shows, after a reset.
        rig.run(2, |_| REST);
        rig.run(3, |_| AxisCommand { reset: true, ..REST });
        assert_eq!((rig.feedback().fault, rig.feedback().power), (None, Power::On));
        assert_eq!(rig.drive.counts, 0);
    }
}

#[test]
fn homing_anchors_a_counter_that_cannot_show_the_position() {
    let units = Units { counter: Counter::signed(16).unwrap(), ..settings().units };
    let mut rig = Rig::new(Settings { units, ..settings() });
    rig.run(5, |_| REST);
    // 250 000 counts are 3.8 turns of the counter.
    rig.run(5, |_| AxisCommand::of(Task::Home { position: 0.25 }));
    assert_eq!(rig.feedback().homing, Homing::Attained);
    assert!((rig.feedback().position - 0.25).abs() < 1e-12);
}
