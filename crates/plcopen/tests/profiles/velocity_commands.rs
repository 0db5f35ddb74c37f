//! Blocks on a drive in profile velocity, to which the axis sends velocities.
//!
//! The oracle is the drive of the bench, which goes to each velocity in a straight line. It is a cycle behind the axis: it reaches a
//! set-point at the end of its cycle.
use crate::bench::{Bench, CYCLE_TIME, LIMITS};
use servobench_fieldbus::{ProfileCommand, Task};
use servobench_motion::position_profile::{Clock, ClockedPlateaus, ClockedSpline, PlateauShare, Spline};
use servobench_motion::pvt::Knot;
use servobench_plcopen::{
    AxisParams, AxisState, Follow, FunctionBlock, Halt, HaltInputs, MoveAbsolute, MoveAbsoluteInputs, MoveSuperimposed,
    MoveSuperimposedInputs, Pair, PositionProfile, PositionProfileInputs, RampStart, TimePosition,
};

/// No time is a whole number of cycles.
const PAIRS: [Pair; 4] = [
    Pair { delta_time: 0.500_3, value: 0.1 },
    Pair { delta_time: 0.299_65, value: 0.2 },
    Pair { delta_time: 0.400_21, value: 0.15 },
    Pair { delta_time: 0.600_777, value: 0.3 },
];

fn params(start: RampStart) -> AxisParams {
    AxisParams { velocity_ramps: Some(start), ..Bench::params() }
}

/// Start of the profile, and its points.
fn knots() -> [Knot; 5] {
    let (mut t, mut knots) = (0.0, [Knot::new(0.0, 0.0); 5]);
    for (knot, pair) in knots[1..].iter_mut().zip(&PAIRS) {
        t += pair.delta_time;
        *knot = Knot::new(t, pair.value);
    }
    knots
}

/// Command of a cycle, and the drive's position at its end.
#[derive(Debug, Clone, Copy)]
struct Sent {
    velocity: f64,
    acceleration: f64,
    position: f64,
    before: f64,
}

/// Commands of a profile from Execute to Done, for each cycle from the one after the edge on.
fn sent(follow: Follow, start: RampStart) -> (Vec<Sent>, Bench) {
    let mut bench = Bench::powered(params(start));
    let mut block = PositionProfile::new([Knot::default(); 5], [0.0; 5]);
    let inputs = PositionProfileInputs {
        execute: true,
        time_position: TimePosition { pairs: &PAIRS, is_absolute: true },
        follow,
        ..PositionProfileInputs::along(&PAIRS)
    };
    let mut all = Vec::new();
    loop {
        let before = bench.feedback.velocity;
        let outputs = bench.cycle(|axis| block.step(axis, &inputs));
        assert!(!outputs.error, "{:?}", block.error());
        let Some(Task::Drive(ProfileCommand::Velocity { velocity, acceleration })) = bench.command.map(|c| c.task)
        else {
            panic!("{:?}", bench.command)
        };
        all.push(Sent { velocity, acceleration, position: bench.feedback.position, before });
        if outputs.done {
            // In the cycle of the edge the axis has not moved yet.
            assert_eq!((all[0].velocity, all[0].position), (0.0, 0.0));
            all.remove(0);
            return (all, bench);
        }
    }
}

/// Position of the drive at the time `t` from the start of the profile, which is the first cycle of `sent`.
fn place(sent: &[Sent], t: f64) -> f64 {
    let cycle = (0..sent.len()).rev().find(|cycle| *cycle as f64 * CYCLE_TIME <= t).unwrap_or(0);
    let (begin, from) = (cycle as f64 * CYCLE_TIME, if cycle == 0 { 0.0 } else { sent[cycle - 1].position });
    let reached = sent.get(cycle + 1).map_or(sent[cycle].velocity, |next| next.before);
    let (part, length) = (t - begin, CYCLE_TIME);
    from + part * (sent[cycle].before + 0.5 * part / length * (reached - sent[cycle].before))
}

/// Every position is met at its time, by one command for each ramp, with any share; without one, a share within the axis limits is found.
#[test]
fn plateaus_meet_every_position_with_a_command_for_each_ramp() {
    let limits = PlateauShare::SmallestPartOf { velocity: LIMITS.velocity, acceleration: LIMITS.acceleration };
    for share in [Some(0.3), Some(0.5), Some(0.217), None] {
        let (sent, bench) = sent(Follow::Plateaus(share), RampStart::SetPoint);
        for knot in knots() {
            // The last one in the last cycle that begins before its time.
            let x = place(&sent, knot.t.min(sent.len() as f64 * CYCLE_TIME));
            assert!((x - knot.x).abs() < 1e-12, "{share:?}: {x} instead of {} at {}", knot.x, knot.t);
        }
        let (mut table, clock) = (knots(), Clock::new(0.0, CYCLE_TIME).unwrap());
        let asked = share.map_or(limits, PlateauShare::Given);
        let expected = ClockedPlateaus::solve(&mut table, 0.0, 0.0, asked, clock, &mut [0.0; 5]).unwrap();
        let mut changes = sent.iter().enumerate().filter(|(k, now)| {
            k.checked_sub(1)
                .is_none_or(|k| sent[k].velocity != now.velocity || sent[k].acceleration != now.acceleration)
        });
        for command in expected.commands() {
            let (k, change) = changes.next().unwrap();
            assert!((k as f64 * CYCLE_TIME - command.t).abs() < 1e-9, "{share:?}: {k} {command:?}");
            assert_eq!(change.velocity.to_bits(), command.velocity.to_bits(), "{share:?}: {command:?}");
            assert!((change.acceleration - command.acceleration).abs() < 1e-9, "{change:?} {command:?}");
        }
        assert!(changes.next().is_none(), "{share:?}");
        assert_eq!(bench.axis.state(), AxisState::Standstill);
    }
}

/// The drive is off the spline by the announced error, with a command in every cycle or in every fifth.
#[test]
fn along_the_spline_the_error_is_the_one_announced() {
    let rate = 1.0 / CYCLE_TIME;
    for (follow, rate) in [(Follow::Spline, rate), (Follow::Steps(rate), rate), (Follow::Steps(200.0), 200.0)] {
        let (sent, _) = sent(follow, RampStart::SetPoint);
        let mut table = knots();
        let clock = Clock::new(0.0, CYCLE_TIME).unwrap();
        let mut stepped = knots();
        let stepped = ClockedSpline::solve(&mut stepped, 0.0, 0.0, rate, clock, &mut [0.0; 5]).unwrap();
        if let Follow::Steps(_) = follow {
            table = stepped.table().knots().try_into().unwrap();
        }
        let spline = Spline::solve(&mut table, 0.0, 0.0, &mut [0.0; 5]).unwrap();
        // The end of the table of steps is on an instant.
        let announced = spline.stepped(rate).unwrap().largest_error();
        let end = spline.table().knots()[4].t.min(sent.len() as f64 * CYCLE_TIME);
        let away = (0..10_000).map(|k| {
            let t = end * f64::from(k) / 10_000.0;
            (place(&sent, t) - spline.table().at(t).x).abs()
        });
        let largest = away.fold(0.0, f64::max);
        assert!((largest - announced).abs() < 0.02 * announced + 1e-9, "{follow:?}: {largest} {announced}");
        let changes = sent.windows(2).filter(|pair| pair[0].velocity != pair[1].velocity).count() + 1;
        let expected = (end * rate).ceil();
        assert!((changes as f64 - expected).abs() <= 2.0, "{follow:?}: {changes} {expected}");
    }
}

/// Any other motion is sent as a velocity per cycle: the position is off by h²/12·(a(t) − a(0)) at most, and by less at the end.
#[test]
fn a_move_is_sent_as_velocities_and_ends_on_its_target() {
    let mut bench = Bench::powered(params(RampStart::SetPoint));
    let mut block = MoveAbsolute::default();
    let inputs = MoveAbsoluteInputs { execute: true, position: 0.3, ..MoveAbsoluteInputs::within(&LIMITS) };
    let mut largest = 0.0_f64;
    loop {
        let before = bench.axis.sent();
        let outputs = bench.cycle(|axis| block.step(axis, &inputs));
        // At the end of a cycle the drive is at the set-point of the cycle.
        largest = largest.max((bench.feedback.position - bench.axis.sent().x).abs());
        assert!((bench.feedback.velocity - bench.axis.sent().v).abs() < 1e-12, "{before:?}");
        if outputs.done {
            break;
        }
    }
    let bound = CYCLE_TIME.powi(2) / 12.0 * LIMITS.acceleration + CYCLE_TIME.powi(3) * LIMITS.jerk;
    assert!(largest < bound && largest > 0.1 * bound, "{largest} {bound}");
    assert!((bench.feedback.position - 0.3).abs() < 1e-9, "{}", bench.feedback.position);
}

/// The drive has the velocity of the axis also with a motion on top of a profile, and after one that aborts it.
#[test]
fn a_superimposed_motion_and_an_abort_leave_the_drive_with_the_velocity_of_the_axis() {
    let mut bench = Bench::powered(params(RampStart::SetPoint));
    let mut block = PositionProfile::new([Knot::default(); 5], [0.0; 5]);
    let (mut superimposed, mut halt) = (MoveSuperimposed::default(), Halt::default());
    let inputs =
        PositionProfileInputs { execute: true, follow: Follow::Plateaus(None), ..PositionProfileInputs::along(&PAIRS) };
    for k in 0..1500 {
        bench.cycle(|axis| {
            block.step(axis, &inputs);
            let on_top = MoveSuperimposedInputs {
                execute: k > 300,
                distance: 0.01,
                velocity_diff: 0.05,
                ..MoveSuperimposedInputs::within(&LIMITS)
            };
            superimposed.step(axis, &on_top);
            halt.step(axis, &HaltInputs { execute: k > 900, ..HaltInputs::within(&LIMITS) });
        });
        let (drive, axis) = (bench.feedback, bench.axis.sent());
        // On a ramp of several cycles the drive gets the final velocity of the ramp.
        assert!((drive.velocity - axis.v).abs() < 1e-9, "{k}: {} {}", drive.velocity, axis.v);
        assert!((drive.position - axis.x).abs() < 1e-5, "{k}: {} {}", drive.position, axis.x);
    }
    assert_eq!(bench.axis.state(), AxisState::Standstill);
}

/// A drive that lags by 10 % of a step catches up when the ramp begins at the velocity that it reports; otherwise it keeps the
/// acceleration of the set-point.
#[test]
fn a_ramp_from_the_actual_velocity_makes_up_for_what_the_drive_lacks() {
    for start in [RampStart::SetPoint, RampStart::Actual] {
        let mut bench = Bench::powered(params(start));
        let mut block = MoveAbsolute::default();
        let inputs = MoveAbsoluteInputs { execute: true, position: 0.3, ..MoveAbsoluteInputs::within(&LIMITS) };
        for _ in 0..200 {
            bench.cycle(|axis| block.step(axis, &inputs));
        }
        let lacking = 0.1 * LIMITS.acceleration * CYCLE_TIME;
        bench.feedback.velocity -= lacking;
        let [before, now] = [bench.axis.sent().v, {
            bench.cycle(|axis| block.step(axis, &inputs));
            bench.axis.sent().v
        }];
        let expected = match start {
            RampStart::SetPoint => (now - before) / CYCLE_TIME,
            RampStart::Actual => (now - before + lacking) / CYCLE_TIME,
        };
        let Some(Task::Drive(ProfileCommand::Velocity { velocity, acceleration })) = bench.command.map(|c| c.task)
        else {
            panic!("{:?}", bench.command)
        };
        assert_eq!(velocity.to_bits(), now.to_bits());
        assert!((acceleration - expected.abs()).abs() < 1e-9, "{start:?}: {acceleration} {expected}");
    }
}

#[test]
fn steps_are_for_an_axis_that_is_told_velocities() {
    let mut bench = Bench::standstill();
    let mut block = PositionProfile::new([Knot::default(); 5], [0.0; 5]);
    let inputs =
        PositionProfileInputs { execute: true, follow: Follow::Steps(100.0), ..PositionProfileInputs::along(&PAIRS) };
    assert!(bench.cycle(|axis| block.step(axis, &inputs)).error);
    let said = "MC_PositionProfile: `Follow` must be the spline itself on an axis that receives positions, got 100: correct the \
                input";
    assert_eq!(block.error().unwrap().to_string(), said);
    for rate in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let mut bench = Bench::powered(params(RampStart::SetPoint));
        let mut block = PositionProfile::new([Knot::default(); 5], [0.0; 5]);
        let inputs = PositionProfileInputs { follow: Follow::Steps(rate), ..inputs };
        assert!(bench.cycle(|axis| block.step(axis, &inputs)).error, "{rate}");
    }
}
