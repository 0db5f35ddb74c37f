//! While the drive does not follow, the output tracks the axis: nothing jumps when the drive follows again.
use crate::rig::{BUS, MOTION, Rig, follow, settings};
use servobench_fieldbus::link::{Control, PositionGains, Settings};
use servobench_fieldbus::{AxisCommand, Interpolation, Power, Task};
use servobench_motion::interpolate::{Mode, Sample};

/// Counts of a micrometre in a cycle of a millisecond: 0.5 m/s.
const COASTS: i128 = 500;
/// Acceleration of the recovery (m/s²): as many counts per square of a cycle.
const RECOVERY: i128 = 5;

fn rested(x: f64) -> Sample {
    Sample { x, ..Sample::default() }
}

/// A powered axis at standstill loses power, is pushed to 0.5 m/s and gets power again while it coasts, under a motion task that tracks the
/// axis while the power is off. Returns the positions of all cycles from then on; the last is within `off_target` (m) of the target.
fn coasting(control: Control, off_target: f64, mut look: impl FnMut(&Rig)) -> Vec<i128> {
    // The rig answers in the next cycle.
    let mut rig = Rig::new(Settings { control, round_trip: 1, velocity_limit: 1.0, ..settings() });
    rig.run(5, |_| follow(rested(0.0)));
    assert_eq!(rig.feedback().power, Power::On);
    rig.drive.coasts = COASTS;
    let unpowered = AxisCommand { power: false, ..AxisCommand::of(Task::Follow(rested(0.0))) };
    rig.run(5, |_| unpowered);
    assert_eq!((rig.feedback().power, rig.feedback().interpolation), (Power::Off, Interpolation::Off));
    look(&rig);
    let (mut at, mut x) = (Vec::new(), 0.0);
    for _ in 0..100 * MOTION / BUS {
        if rig.tick.is_multiple_of(MOTION) {
            let feedback = rig.feedback();
            if feedback.power != Power::On {
                x = feedback.demanded();
            }
            rig.write(rig.tick, follow(rested(x)));
        }
        rig.cycle();
        at.push(rig.drive.counts);
    }
    assert_eq!(rig.feedback().interpolation, Interpolation::Run1);
    let end = *at.last().unwrap();
    assert!((end as f64 * 1e-6 - x).abs() < off_target, "ends where the motion task is: {end} for {x} m");
    at
}

fn differences(values: &[i128]) -> Vec<i128> {
    values.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

/// Oracle: second differences. The velocity of the output changes by no more than the acceleration of the recovery and two roundings to
/// whole counts.
#[test]
fn an_axis_that_coasts_is_taken_over_at_its_velocity() {
    let csp = Control::Position { velocity_offset: true, torque_offset: true };
    let at = coasting(csp, 1e-6, |rig| {
        assert_eq!(rig.commands.velocity_offset, 500_000, "that of the axis");
        assert_eq!(
            i128::from(rig.commands.target_position),
            rig.drive.counts,
            "where the axis has gone to in this cycle"
        );
        let output = rig.state.output(&rig.params);
        assert!((output.setpoint.v - 0.5).abs() < 1e-12 && output.torque.abs() < 1e-12, "{output:?}");
    });
    let velocities = differences(&at);
    let steepest = differences(&velocities).into_iter().map(i128::abs).max().unwrap();
    println!("{steepest} counts per square of a cycle");
    assert!(steepest <= RECOVERY + 2, "{steepest}");
    assert_eq!((velocities[0], *velocities.last().unwrap()), (COASTS, 0));
    // It stopped and returned to the motion task's position at power on: 0.5²/(2·5) m at least, and more by the jerk limit.
    let back = at.iter().max().unwrap() - at.last().unwrap();
    assert!((25_000..60_000).contains(&back), "{back}");
}

/// Without the velocity offset the frame has none; the positions are the same.
#[test]
fn positions_alone_carry_the_velocity_too() {
    let csp = Control::Position { velocity_offset: false, torque_offset: false };
    let at = coasting(csp, 1e-6, |rig| assert_eq!(rig.commands.velocity_offset, 0));
    let steepest = differences(&differences(&at)).into_iter().map(i128::abs).max().unwrap();
    assert!(steepest <= RECOVERY + 2, "{steepest}");
}

#[test]
fn a_velocity_is_commanded_from_that_of_the_axis_on() {
    let csv = Control::Velocity {
        gains: PositionGains::proportional(20.0),
        feedforward: 1.0,
        limit: 1.0,
        torque_offset: false,
    };
    // The rig takes whole counts per cycle, a millimetre per second: 50 µm of error make less.
    let at = coasting(csv, 51e-6, |rig| assert_eq!(rig.commands.target_velocity, 500_000));
    let steepest = differences(&differences(&at)).into_iter().map(i128::abs).max().unwrap();
    println!("{steepest} counts per square of a cycle");
    assert!(steepest <= RECOVERY + 2, "{steepest}");
}

/// The acceleration of encoder noise is not extrapolated when the link begins to read samples: ±2 counts of noise at cycles of
/// 1 ms, led to zero by 50 m/s³, moved an axis at standstill by 220 mm with cubic interpolation.
#[test]
fn noise_before_power_does_not_carry_the_axis_away() {
    let hz = |hz| servobench_base::Rate::new(hz).unwrap();
    let motion_cycle = hz(16_000).divider(hz(1_000)).unwrap();
    let recovery = servobench_motion::Limits { velocity: 0.5, acceleration: 5.0, jerk: 50.0, snap: 0.0 };
    for (seed, interpolation) in (0..70_i32).zip(Mode::ALL.into_iter().cycle()) {
        let mut rig = Rig::new(Settings { motion_cycle, recovery, interpolation, round_trip: 1, ..settings() });
        let (mut x, mut farthest) = (0.0, 0);
        for cycle in 0..300_i32 {
            let noise = ((cycle + 31 * seed).wrapping_mul(0x9E37_79B1_u32.cast_signed()) >> 16).rem_euclid(5) - 2;
            rig.answer = rig.answer.map(|answer| servobench_cia402::Actuals {
                position: answer.position + noise,
                position_demand: answer.position_demand + noise,
                velocity: noise * 1000,
                ..answer
            });
            let feedback = rig.feedback();
            if matches!(feedback.interpolation, Interpolation::Off | Interpolation::Wait) {
                x = feedback.demanded();
            }
            rig.write(rig.tick, follow(rested(x)));
            rig.cycle();
            farthest = farthest.max(rig.drive.counts.abs());
        }
        assert_eq!(rig.feedback().interpolation, Interpolation::Run1);
        assert!(farthest <= 25, "{interpolation:?}, seed {seed}: {farthest} counts away");
    }
}

/// A velocity below a count per cycle of the motion task counts as standstill: it would be extrapolated for ever.
#[test]
fn an_axis_that_hardly_moves_is_taken_to_stand() {
    let mut rig = Rig::new(settings());
    rig.answer = Some(rig.drive.actuals);
    rig.cycle();
    // A count in 20 ms is 50 counts per second.
    for (velocity, offset) in [(49, 0), (-49, 0), (51, 51), (-51, -51)] {
        rig.drive.coasts = 0;
        rig.cycle();
        rig.answer = rig.answer.map(|answer| servobench_cia402::Actuals { velocity, ..answer });
        assert_eq!(rig.cycle().velocity_offset, offset, "{velocity}");
    }
}

/// Oracle: the torque itself, 3 N before and after.
#[test]
fn efforts_begin_with_the_one_that_the_drive_makes() {
    let mut rig = Rig::new(settings());
    rig.drive.holding_torque = 300;
    rig.run(10, |_| follow(rested(0.0)));
    assert_eq!(rig.feedback().power, Power::On);
    let push = AxisCommand::of(Task::Effort(3.0));
    for _ in 0..4 * MOTION / BUS {
        if rig.tick.is_multiple_of(MOTION) {
            rig.write(rig.tick, push);
        }
        rig.cycle();
        assert_eq!(rig.drive.actuals.torque, 300, "cycle {}", rig.tick / BUS);
    }
    // Back to positions: the earlier torque demand fades in a cycle of the motion task.
    let mut offsets = Vec::new();
    for _ in 0..3 * MOTION / BUS {
        if rig.tick.is_multiple_of(MOTION) {
            rig.write(rig.tick, follow(rested(0.0)));
        }
        let offset = rig.cycle().torque_offset;
        if offsets.last() != Some(&offset) {
            offsets.push(offset);
        }
    }
    assert!(offsets.contains(&300) && offsets.last() == Some(&0), "{offsets:?}");
    let steps = offsets.windows(2).map(|pair| (pair[1] - pair[0]).abs()).max();
    let cycles = f64::from(u32::try_from(MOTION / BUS).unwrap());
    assert!(f64::from(steps.unwrap()) <= 300.0 / cycles + 1.0, "{offsets:?}");
    // The torque of the drive's own loops is not sent along with positions.
    assert_eq!(rig.drive.actuals.torque, 300);
    assert_eq!(rig.commands.torque_offset, 0);
}
