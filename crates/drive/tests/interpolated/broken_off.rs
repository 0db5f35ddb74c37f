//! Aborted moves: by a master that stops sending, by clearing the buffer, by bit 4 and by halt.
use crate::axis::{Axis, PERIOD, STOP, assert_near, cubic, idle, linear, run, whole};
use servobench_base::Setpoint;
use servobench_cia402::interpolated::{BufferError, Point, SubMode};
use servobench_cia402::{ControlBit, Controlword};
use servobench_drive::modes::interpolated::StartRefused;

/// An accelerating move whose last point is missing: 10 ms per segment, 4 m/s² on average.
fn start() -> Axis {
    let mut axis = Axis::at(0, SubMode::Cubic);
    for k in 0..20 {
        let t = f64::from(k) * 0.01;
        let (x, v) = (2.0 * t * t, 4.0 * t);
        axis.add(&[cubic(whole(x * 1e6), whole(v * 1e7), 10)]);
    }
    axis
}

/// From the set-point of the loops at the abort to standstill, within the steepness of a stop.
fn assert_stops(before: Setpoint, stop: &[Setpoint]) {
    let (a_max, j_max) = (STOP.acceleration, STOP.jerk.unwrap());
    let begin = before.after(PERIOD);
    let slack = 1.0 + 1e-9;
    let mut last = begin;
    for (k, now) in stop.iter().enumerate() {
        // The first set-point of the stop is the continuation of the move.
        let period = if k == 0 { 0.0 } else { PERIOD };
        assert!(now.a.abs() <= a_max.max(begin.a.abs()) * slack, "{k}: {now:?}");
        assert!((now.a - last.a).abs() <= j_max * period * slack + 1e-12, "acceleration, {k}: {last:?} {now:?}");
        // Trapezoids of rounded accelerations and velocities: the jerk bends them by that of a period.
        let bend = j_max * period * period;
        assert_near(now.v, last.v + 0.5 * period * (last.a + now.a), bend + 1e-12);
        assert_near(now.x, last.x + 0.5 * period * (last.v + now.v), (a_max * period + bend) * period + 1e-12);
        last = *now;
    }
    assert_eq!((last.v, last.a), (0.0, 0.0));
    // No longer than the distance of least jerk: bounded by the steepness of the stop alone.
    let shortest = begin.v.abs() / a_max;
    let longest = shortest + 3.0 * a_max / j_max;
    let took = (stop.len() as f64 - 1.0) * PERIOD;
    assert!(took >= shortest && took <= longest, "{took} s for {shortest} to {longest} s");
}

fn break_off(axis: &mut Axis, word: Controlword) -> Setpoint {
    let before = axis.last;
    let stop = axis.until_rest(word);
    assert!(before.v > 0.1 && before.a > 1.0, "{before:?}");
    assert_stops(before, &stop);
    assert!(!axis.answer.bit_12);
    let rest = axis.last;
    assert_eq!(axis.step(word), Setpoint::at_rest(rest.x), "and stays");
    rest
}

#[test]
fn when_the_next_point_is_not_there_underflow_is_latched_and_the_axis_stops_within_limits() {
    let mut axis = start();
    // 20 points are 19 segments.
    for k in 0..19 * 40 {
        axis.step(run());
        assert!(axis.answer.bit_12 && axis.errors() == 0, "{k}");
    }
    break_off(&mut axis, run());
    assert!(axis.buffer.has(BufferError::Underflow) && axis.errors() == 4);
    assert_eq!(axis.buffer.status() >> 31, 1, "empty");

    // Latched: points are taken, but no move starts, until the error is cleared.
    let here = axis.last.x;
    axis.add(&[cubic(0, 0, 10), cubic(100, 0, 0)]);
    axis.step(idle());
    axis.step(run());
    assert_eq!(axis.state.refused(), Some(StartRefused::Latched { errors: 4 }));
    assert!(!axis.answer.bit_12 && axis.errors() == 4);
    axis.buffer.clear();
    assert_eq!(axis.errors(), 4, "clearing the buffer clears no error");
    axis.buffer.clear_errors(4);
    axis.step(idle());
    let relative = |point| Point { is_relative: true, ..point };
    axis.add(&[relative(cubic(0, 0, 10)), relative(cubic(100, 0, 0))]);
    axis.until_rest(run());
    assert_near(axis.last.x, here + 1e-4, 1e-6);
}

#[test]
fn a_cleared_buffer_a_bit_taken_back_and_a_halt_break_off_alike() {
    type Act = fn(&mut Axis) -> Controlword;
    let acts: [Act; 3] = [
        |axis| {
            axis.buffer.clear();
            run()
        },
        |_| idle(),
        |_| run().with(ControlBit::Halt, true),
    ];
    for act in acts {
        let mut axis = start();
        for _ in 0..417 {
            axis.step(run());
        }
        let word = act(&mut axis);
        break_off(&mut axis, word);
        assert_eq!(axis.errors(), 0);
        // Nothing starts by itself once the halt is over, nor by an edge during it.
        if word == idle() {
            continue;
        }
        let rest = axis.last;
        for word in [run(), idle(), run().with(ControlBit::Halt, true), run()] {
            axis.step(word);
            assert!(!axis.answer.bit_12 && axis.state.refused().is_none() && axis.last == rest, "{word:?}");
        }
    }
}

#[test]
fn without_a_jerk_the_velocity_falls_linearly_at_once() {
    let mut axis = start();
    axis.params.stop.jerk = None;
    for _ in 0..417 {
        axis.step(run());
    }
    let begin = axis.last.after(PERIOD);
    let stop = axis.until_rest(idle());
    // v² / 2a, and a period before standstill is detected.
    let (a, v) = (STOP.acceleration, begin.v);
    assert_near(axis.last.x, begin.x + v * v / (2.0 * a), 1e-12);
    assert_near(stop.len() as f64 * PERIOD, v / a + PERIOD, PERIOD);
    for (k, now) in stop.iter().enumerate() {
        let t = k as f64 * PERIOD;
        assert_near(now.v, (v - a * t).max(0.0), 1e-12);
    }
}

#[test]
fn a_linear_move_is_stopped_from_its_velocity() {
    let mut axis = Axis::at(0, SubMode::LinearTimed);
    axis.add(&[linear(0, 10), linear(5_000, 10), linear(10_000, 10)]);
    for _ in 0..80 {
        axis.step(run());
    }
    let before = axis.last;
    assert_near(before.v, 0.5, 1e-12);
    let stop = axis.until_rest(run());
    assert_stops(before, &stop);
    assert_eq!(axis.errors(), 4);
}

#[test]
fn a_last_point_with_a_velocity_is_passed_and_the_axis_stopped_behind_it() {
    let mut axis = Axis::at(0, SubMode::Cubic);
    axis.add(&[cubic(0, 0, 100), cubic(20_000, 4_000_000, 0)]);
    for _ in 0..400 {
        axis.step(run());
    }
    let before = axis.last;
    let stop = axis.until_rest(run());
    assert_stops(before, &stop);
    assert_eq!(axis.errors(), 0, "it is an end, not an underflow");
    assert!(axis.last.x > 0.02);
}
