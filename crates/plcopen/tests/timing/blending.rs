//! BufferMode: where and how fast one motion becomes the next.
use crate::bench::{Bench, CYCLE_TIME, LIMITS};
use servobench_motion::Limits;
use servobench_plcopen::{
    Axis, AxisParams, AxisState, BufferMode, ErrorId, FunctionBlock, MoveAbsolute, MoveAbsoluteInputs,
    MoveContinuousAbsolute, MoveContinuousAbsoluteInputs, MoveVelocity, MoveVelocityInputs,
};

/// Limits of orders 2, 3 and 4.
const ORDERS: [Limits; 3] =
    [Limits { jerk: f64::INFINITY, snap: f64::INFINITY, ..LIMITS }, Limits { snap: f64::INFINITY, ..LIMITS }, LIMITS];

struct Course {
    positions: Vec<f64>,
    velocities: Vec<f64>,
}

impl Course {
    /// The speed where `x` is passed, by interpolation: within `a·h`.
    fn speed_at(&self, x: f64) -> f64 {
        let k = self.positions.windows(2).position(|pair| pair[0] < x && pair[1] >= x).unwrap();
        let part = (x - self.positions[k]) / (self.positions[k + 1] - self.positions[k]);
        self.velocities[k] + part * (self.velocities[k + 1] - self.velocities[k])
    }

    fn never_turns_back(&self) -> bool {
        self.velocities.iter().all(|v| *v >= -1e-9)
    }

    fn highest(&self, until: f64) -> f64 {
        let before = self.positions.iter().zip(&self.velocities).filter(|(x, _)| **x < until);
        before.map(|(_, v)| *v).fold(0.0, f64::max)
    }
}

/// A move to `one` at a velocity and, given `later` cycles after it, one to `two` at another one.
fn moves(limits: &Limits, one: (f64, f64), two: (f64, f64), mode: BufferMode, later: usize) -> Course {
    let params = AxisParams { limits: *limits, ..Bench::params() };
    let mut bench = Bench::powered(params);
    let (mut first, mut second) = (MoveAbsolute::default(), MoveAbsolute::default());
    let to = |execute, (position, velocity), buffer_mode| MoveAbsoluteInputs {
        execute,
        position,
        velocity,
        buffer_mode,
        ..MoveAbsoluteInputs::within(limits)
    };
    let mut course = Course { positions: Vec::new(), velocities: Vec::new() };
    for cycle in 0..20_000 {
        let done = bench.cycle(|axis| {
            first.step(axis, &to(true, one, BufferMode::Aborting));
            let outputs = second.step(axis, &to(cycle >= later, two, mode));
            assert!(!outputs.error, "{:?}", second.error());
            outputs.done
        });
        course.positions.push(bench.axis.commanded().x);
        course.velocities.push(bench.axis.commanded().v);
        if done {
            assert_eq!(bench.axis.commanded().x.to_bits(), two.0.to_bits());
            assert_eq!(bench.axis.state(), AxisState::Standstill);
            return course;
        }
    }
    panic!("never done");
}

/// Interpolation between two set-points: the velocity changes by `a·h` at most.
const BETWEEN: f64 = LIMITS.acceleration * CYCLE_TIME;

#[test]
fn each_mode_passes_the_first_target_at_its_velocity() {
    for limits in &ORDERS {
        for (slow_first, later) in [(true, 0), (true, 50), (false, 0), (false, 50)] {
            let (one, two) = if slow_first { (0.4, 0.8) } else { (0.8, 0.4) };
            for (mode, wanted) in [
                (BufferMode::Buffered, 0.0),
                (BufferMode::BlendingLow, 0.4),
                (BufferMode::BlendingPrevious, one),
                (BufferMode::BlendingNext, two),
                (BufferMode::BlendingHigh, 0.8),
            ] {
                let course = moves(limits, (1.0, one), (2.0, two), mode, later);
                let speed = course.speed_at(1.0);
                assert!((speed - wanted).abs() <= BETWEEN, "{mode:?} {one} {two} {later}: {speed}");
                assert!(course.never_turns_back(), "{mode:?}");
                // Beyond the velocity of the first only in the run-up to its end, where the rise from one to the other takes
                // (v₂² − v₁²)/2a and, at orders 3 and 4, (v₁ + v₂)/2 for the times a/j and at most twice j/s more.
                let run_up = (0.64 - 0.16) / (2.0 * LIMITS.acceleration) + 0.6 * (0.1 + 2.0 * 0.05);
                assert!(
                    course.highest(1.0 - run_up) <= one * (1.0 + 1e-9),
                    "{mode:?} {}",
                    course.highest(1.0 - run_up)
                );
            }
        }
    }
}

#[test]
fn a_target_in_the_other_direction_is_stopped_at() {
    for limits in &ORDERS {
        let course = moves(limits, (0.5, 0.8), (0.2, 0.8), BufferMode::BlendingHigh, 10);
        let highest = course.positions.iter().copied().fold(0.0, f64::max);
        assert!((highest - 0.5).abs() < 1e-12, "{highest}");
    }
}

/// Oracle of order 2: v² = 2·a·s, the run-up to the first target or the way to brake behind it.
#[test]
fn the_highest_velocity_is_taken_that_can_be_reached_and_braked_from() {
    let braked = moves(&ORDERS[0], (1.0, 1.0), (1.01, 1.0), BufferMode::BlendingHigh, 10);
    assert!((braked.speed_at(1.0) - libm::sqrt(2.0 * 5.0 * 0.01)).abs() <= BETWEEN, "{}", braked.speed_at(1.0));
    let reached = moves(&ORDERS[0], (0.02, 1.0), (1.0, 1.0), BufferMode::BlendingHigh, 0);
    assert!((reached.speed_at(0.02) - libm::sqrt(2.0 * 5.0 * 0.02)).abs() <= BETWEEN, "{}", reached.speed_at(0.02));
    for limits in &ORDERS[1..] {
        for (one, two) in [(1.0, 1.01), (0.02, 1.0), (0.02, 0.03)] {
            let course = moves(limits, (one, 1.0), (two, 1.0), BufferMode::BlendingHigh, 10);
            assert!(course.never_turns_back() && course.speed_at(one) > 0.05, "{one} {two}: {}", course.speed_at(one));
        }
    }
}

#[test]
fn blending_after_the_brake_is_on_releases_it() {
    // At orders 3 and 4 braking cannot end at once: the remaining distance must be long enough for that.
    for (limits, later) in [(&ORDERS[0], 700), (&ORDERS[1], 650), (&ORDERS[2], 640)] {
        let course = moves(limits, (0.5, 0.8), (1.5, 0.8), BufferMode::BlendingPrevious, later);
        assert!(course.velocities[later] < 0.8, "the brake is on");
        assert!(course.never_turns_back());
        assert!(course.speed_at(0.5) > 0.6, "{}", course.speed_at(0.5));
    }
    let late = moves(&ORDERS[2], (0.5, 0.8), (1.5, 0.8), BufferMode::BlendingPrevious, 700);
    assert!(late.never_turns_back() && late.speed_at(0.5) < 1e-3, "{}", late.speed_at(0.5));
}

#[test]
fn more_commands_than_the_axis_holds_are_refused() {
    let mut bench = Bench::powered(AxisParams { buffered_commands: 1, ..Bench::params() });
    let mut blocks = [MoveAbsolute::default(); 3];
    let inputs = MoveAbsoluteInputs {
        execute: true,
        position: 0.3,
        buffer_mode: BufferMode::Buffered,
        ..MoveAbsoluteInputs::within(&LIMITS)
    };
    let outputs = bench.cycle(|axis: &mut Axis| blocks.each_mut().map(|block| block.step(axis, &inputs)));
    assert!(outputs[0].active && outputs[1].busy && !outputs[1].active);
    assert_eq!(outputs[2].error_id, ErrorId::BufferFull);
    assert_eq!(
        blocks[2].error().unwrap().to_string(),
        "MC_MoveAbsolute: `BufferMode`: 1 commands wait, as many as the axis holds: wait for the Done of one"
    );
}

#[test]
fn a_command_waits_for_the_velocity_of_the_one_before() {
    let mut bench = Bench::standstill();
    let (mut run, mut go) = (MoveVelocity::default(), MoveAbsolute::default());
    let running = MoveVelocityInputs { execute: true, velocity: 0.8, ..MoveVelocityInputs::within(&LIMITS) };
    let going = MoveAbsoluteInputs {
        execute: true,
        position: 2.0,
        buffer_mode: BufferMode::Buffered,
        ..MoveAbsoluteInputs::within(&LIMITS)
    };
    let mut taken_over = None;
    for cycle in 0..4000 {
        let (run, go) = bench.cycle(|axis| (run.step(axis, &running), go.step(axis, &going)));
        assert!(!(run.busy && run.command_aborted));
        if run.command_aborted && taken_over.is_none() {
            assert!(go.active);
            taken_over = Some((cycle, bench.axis.commanded().v));
        }
    }
    // 0.8 m/s is reached with snap, jerk and acceleration at their limits, after 0.8/5 + 5/50 + 50/1000 s.
    assert_eq!(taken_over.map(|(cycle, _)| cycle), Some(310));
    assert!(taken_over.is_some_and(|(_, v)| (v - 0.8).abs() < 1e-12));
    assert_eq!(bench.axis.commanded().x.to_bits(), 2.0_f64.to_bits());
}

/// Cruising all the way at 0.4 m/s and 5 m/s² takes 2/0.4 + 0.4/5 s, wherever the moves in between end.
#[test]
fn blended_moves_lose_no_time_between_the_cycles() {
    for between in [&[1.00013][..], &[1.0, 1.0001], &[1.0, 1.0001, 1.0002]] {
        let mut bench = Bench::powered(AxisParams { limits: ORDERS[0], ..Bench::params() });
        let mut blocks = [MoveAbsolute::default(); 4];
        let mut positions = between.to_vec();
        positions.push(2.0);
        let (mut cycles, mut last) = (0, 0.0);
        loop {
            let done = bench.cycle(|axis| {
                let outputs = blocks.iter_mut().zip(&positions).map(|(block, position)| {
                    let buffer_mode = BufferMode::BlendingPrevious;
                    let inputs =
                        MoveAbsoluteInputs { buffer_mode, velocity: 0.4, ..MoveAbsoluteInputs::within(&ORDERS[0]) };
                    block.step(axis, &MoveAbsoluteInputs { execute: true, position: *position, ..inputs })
                });
                outputs.last().unwrap().done
            });
            let v = bench.axis.commanded().v;
            assert!((v - last).abs() <= BETWEEN * (1.0 + 1e-9), "{between:?} cycle {cycles}: {last} {v}");
            if done {
                break;
            }
            (cycles, last) = (cycles + 1, v);
        }
        assert_eq!(cycles, 5080, "{between:?}");
    }
}

/// Oracle: v² = 2·a·s with the deceleration of the second command.
#[test]
fn a_passage_is_braked_from_with_the_deceleration_of_the_next_command() {
    let mut bench = Bench::powered(AxisParams { limits: ORDERS[0], ..Bench::params() });
    let (mut first, mut second) = (MoveAbsolute::default(), MoveAbsolute::default());
    let inputs = MoveAbsoluteInputs { execute: true, ..MoveAbsoluteInputs::within(&ORDERS[0]) };
    let next = MoveAbsoluteInputs { deceleration: 2.0, buffer_mode: BufferMode::BlendingHigh, ..inputs };
    let mut fastest = 0.0_f64;
    loop {
        let done = bench.cycle(|axis| {
            first.step(axis, &MoveAbsoluteInputs { position: 1.0, ..inputs });
            second.step(axis, &MoveAbsoluteInputs { position: 1.01, ..next }).done
        });
        let now = bench.axis.commanded();
        assert!(now.v >= 0.0 && now.x <= 1.01);
        if now.x >= 1.0 {
            fastest = fastest.max(now.v);
        }
        if done {
            break;
        }
    }
    assert!((fastest - libm::sqrt(2.0 * 2.0 * 0.01)).abs() <= BETWEEN, "{fastest}");
}

/// Oracle: v² = v₂² + 2·a·s behind the passage.
#[test]
fn a_passage_before_a_velocity_is_as_fast_as_that_can_be_braked_to() {
    let mut bench = Bench::powered(AxisParams { limits: ORDERS[0], ..Bench::params() });
    let (mut first, mut second) = (MoveAbsolute::default(), MoveContinuousAbsolute::default());
    let go = MoveAbsoluteInputs { execute: true, position: 1.0, ..MoveAbsoluteInputs::within(&ORDERS[0]) };
    let pass = MoveContinuousAbsoluteInputs {
        execute: true,
        position: 1.01,
        end_velocity: 0.4,
        buffer_mode: BufferMode::BlendingHigh,
        ..MoveContinuousAbsoluteInputs::within(&ORDERS[0])
    };
    let mut fastest = 0.0_f64;
    while bench.axis.commanded().x < 1.5 {
        bench.cycle(|axis| (first.step(axis, &go), second.step(axis, &pass)));
        let now = bench.axis.commanded();
        if now.x >= 1.0 {
            fastest = fastest.max(now.v);
        }
    }
    assert!((fastest - libm::sqrt(0.16 + 2.0 * 5.0 * 0.01)).abs() <= BETWEEN, "{fastest}");
    assert_eq!(bench.axis.commanded().v.to_bits(), 0.4_f64.to_bits());
}
