//! Start of a move, by sub-mode.
use crate::axis::{Axis, COUNT, PERIOD, assert_near, cubic, idle, linear, run};
use servobench_cia402::interpolated::{Point, SegmentCommand, SubMode, TimePeriod};
use servobench_drive::modes::interpolated::StartRefused;

#[test]
fn a_move_begins_where_the_axis_is_or_not_at_all() {
    // No jump, not even by a count.
    for first in [498, 499, 500, 501, 502] {
        let mut axis = Axis::at(500, SubMode::Cubic);
        axis.add(&[cubic(first, 0, 10), cubic(1000, 0, 0)]);
        let setpoint = axis.step(run());
        let is_near = (499..=501).contains(&first);
        assert_eq!(axis.answer.bit_12, is_near, "{first}");
        assert_near(setpoint.x, 500.0 * COUNT, 0.0);
        if is_near {
            axis.until_rest(run());
            assert_near(axis.last.x, 1000.0 * COUNT, 0.0);
        } else {
            let refused = axis.state.refused();
            assert_eq!(refused, Some(StartRefused::FarPoint { first: first.into(), axis: 500 }), "{first}");
            assert_eq!(axis.buffer.free(), 30, "the points are still there");
        }
    }
    let refused = StartRefused::FarPoint { first: 498, axis: 500 };
    let message =
        "the first point is at 498 counts, the axis at 500: begin within a count of the axis, or relative to it";
    assert_eq!(refused.to_string(), message);
}

#[test]
fn a_relative_first_point_counts_from_the_commanded_position_or_from_a_base() {
    let relative = |position, ms| Point { is_relative: true, ..cubic(position, 0, ms) };
    let mut axis = Axis::at(20_000_000, SubMode::Cubic);
    axis.add(&[relative(0, 10), relative(300, 10), relative(-50, 0)]);
    axis.until_rest(run());
    assert_near(axis.last.x, 20_000_250.0 * COUNT, 1e-14);

    // As a master begins beyond 24 bits: the base, then relative points.
    axis.step(idle());
    axis.buffer.apply(SegmentCommand::ResetSegment).unwrap();
    let base = SegmentCommand::Base { counter: 0, position: 20_000_000 }.encode().unwrap();
    axis.buffer.apply(SegmentCommand::decode(base).unwrap()).unwrap();
    axis.add(&[relative(250, 10), relative(-250, 0)]);
    axis.until_rest(run());
    assert_eq!((axis.last.x, axis.state.refused()), (20.0, None));
}

#[test]
fn positions_beyond_the_counter_are_reached_by_relative_points() {
    let mut axis = Axis::at(i32::MAX, SubMode::Cubic);
    axis.add(&[
        Point { is_relative: true, ..linear(0, 10) },
        Point { is_relative: true, ..linear(1_000_000, 10) },
        Point { is_relative: true, ..linear(1_000_000, 0) },
    ]);
    axis.until_rest(run());
    assert_near(axis.last.x, (f64::from(i32::MAX) + 2e6) * COUNT, 1e-12);
}

#[test]
fn a_constant_time_leads_from_the_axis_to_the_first_point() {
    let mut axis = Axis::at(0, SubMode::Linear);
    axis.add(&[linear(1000, 10), linear(3000, 10), linear(3000, 0)]);
    let setpoints = axis.until_rest(run());
    // 10 ms to the first, the second and the third point.
    assert_eq!(setpoints.len(), 3 * 40 + 1);
    for (k, setpoint) in setpoints.iter().enumerate() {
        let t = k as f64 * PERIOD;
        let expected = if t <= 0.01 { 0.1 * t } else { (0.001 + 0.2 * (t - 0.01)).min(0.003) };
        assert_near(setpoint.x, expected, 1e-15);
    }
    assert_eq!(axis.errors(), 0);
}

#[test]
fn sub_mode_0_empties_the_buffer_and_waits_for_three_points() {
    let mut axis = Axis::at(0, SubMode::LinearAdapted);
    axis.add(&[linear(9_000, 10), linear(9_500, 10), linear(9_900, 10), linear(9_999, 10)]);
    axis.step(run());
    assert!(axis.buffer.free() == 32 && !axis.answer.bit_12, "what came before the start is gone");
    for k in 1..3 {
        axis.add(&[linear(100 * k, 10)]);
        axis.step(run());
        assert_eq!((axis.answer.bit_12, axis.last.x), (false, 0.0));
    }
    axis.add(&[linear(300, 10)]);
    axis.step(run());
    assert!(axis.answer.bit_12);
    for _ in 0..40 {
        axis.step(run());
    }
    assert_near(axis.last.x, 100.0 * COUNT, 1e-15);

    // Cancelled while it waits, the move does not begin.
    let mut axis = Axis::at(0, SubMode::LinearAdapted);
    axis.step(run());
    axis.step(idle());
    axis.add(&[linear(100, 10), linear(200, 10), linear(300, 10)]);
    axis.step(idle());
    assert!(!axis.answer.bit_12);
}

#[test]
fn a_start_needs_a_rising_edge_and_points() {
    let mut axis = Axis::at(0, SubMode::Cubic);
    axis.take_over(run());
    axis.step(run());
    assert_eq!((axis.errors(), axis.answer.bit_12), (0, false), "set as the mode took over");
    axis.step(idle());
    axis.step(run());
    assert_eq!((axis.errors(), axis.answer.bit_12), (4, false), "an empty buffer is an underflow");
    axis.buffer.clear_errors(4);
    axis.add(&[cubic(0, 0, 10), cubic(100, 0, 0), cubic(100, 0, 10), cubic(0, 0, 0)]);
    axis.step(run());
    assert!(!axis.answer.bit_12, "the edge is over");
    axis.step(idle());
    axis.until_rest(run());
    assert_near(axis.last.x, 100.0 * COUNT, 0.0);
    for _ in 0..100 {
        axis.step(run());
    }
    assert_eq!((axis.last.x, axis.buffer.free()), (100.0 * COUNT, 30), "points of the next move wait for its start");
    axis.step(idle());
    axis.until_rest(run());
    assert_eq!((axis.last.x, axis.errors()), (0.0, 0));
}

/// A line of 1 m/s in segments of 1.1 ms, and of 0.1 ms, of which a period of the drive holds two and a half.
#[test]
fn segments_that_are_no_whole_periods_lose_no_time() {
    for (units, counts) in [(11, 1100), (1, 100)] {
        let mut axis = Axis::at(0, SubMode::Linear);
        axis.params.period = TimePeriod::new(units, -4).unwrap();
        let (duration, mut sent) = (f64::from(units) * 1e-4, 0);
        for k in 0..2000 {
            while axis.buffer.free() > 0 && sent < 5000 {
                sent += 1;
                axis.add(&[Point { time: axis.params.period.microseconds(), ..linear(counts * sent, 0) }]);
            }
            let setpoint = axis.step(run());
            // Sums of periods and of segments: a rounding of 1e-17 s each.
            assert_near(setpoint.x, f64::from(k) * PERIOD, 1e-13);
            assert!(axis.answer.bit_12, "{duration} s, step {k}");
        }
    }
}
