//! The buffer and its two words.
use crate::axis::{Axis, cubic, idle, linear, run};
use servobench_cia402::interpolated::{BufferError, CAPACITY, Point, SegmentCommand, SubMode};
use servobench_drive::modes::interpolated::{Buffer, Refusal};

#[test]
fn the_words_are_those_of_the_manual() {
    let mut buffer = Buffer::default();
    assert_eq!((CAPACITY, buffer.free(), buffer.status()), (32, 32, 0x8020_0000));
    buffer.add(cubic(1, 2, 3)).unwrap();
    assert_eq!((buffer.free(), buffer.status()), (31, 0x001F_0001));
    buffer.remove(1);
    assert_eq!(buffer.status(), 0x8020_0001);
    buffer.apply(SegmentCommand::ResetSegment).unwrap();
    assert_eq!(buffer.status(), 0x8020_0000);
}

#[test]
fn a_point_without_room_is_refused_and_latched_and_so_are_those_behind_it() {
    let mut axis = Axis::at(0, SubMode::LinearTimed);
    for k in 0..32 {
        axis.add(&[linear(100 * k, 10)]);
    }
    assert_eq!(axis.buffer.free(), 0);
    assert_eq!(axis.buffer.add(linear(3200, 10)), Err(Refusal::Full));
    assert!(axis.buffer.has(BufferError::Overflow) && axis.buffer.status() == 0x0200_0020);
    // The move would not start either; and a point behind the lost one would leave a gap.
    axis.buffer.remove(1);
    assert_eq!(axis.buffer.add(linear(3200, 10)), Err(Refusal::Latched { errors: 2 }));
    axis.step(run());
    assert!(axis.state.refused().is_some() && !axis.answer.bit_12);
    axis.buffer.clear_errors(2);
    assert_eq!(axis.buffer.add(linear(3100, 0)), Ok(()));
    axis.step(idle());
    axis.until_rest(run());
    assert_eq!((axis.errors(), axis.last.x), (0, 3100.0 * 1e-6));
}

#[test]
fn a_running_move_that_lost_a_point_ends_in_underflow_not_in_a_gap() {
    let mut axis = Axis::at(0, SubMode::LinearTimed);
    for k in 0..32 {
        axis.add(&[linear(100 * k, 10)]);
    }
    axis.step(run());
    axis.add(&[linear(3200, 10), linear(3300, 10)]);
    assert_eq!(axis.buffer.add(linear(3400, 10)), Err(Refusal::Full));
    for _ in 0..33 * 40 {
        // Whatever the master sends afterwards.
        assert_eq!(axis.buffer.add(linear(0, 10)), Err(Refusal::Latched { errors: 2 }));
        assert!(axis.answer.bit_12);
        axis.step(run());
    }
    assert_eq!((axis.errors(), axis.answer.bit_12), (2 + 4, false));
}

#[test]
fn points_are_counted_and_one_that_is_missing_is_noticed() {
    let mut buffer = Buffer::default();
    let point = |counter: u8| SegmentCommand::Point { counter, point: cubic(0, 0, 1) };
    let mut send = |counter: u8| buffer.apply(point(counter));
    for k in 0..10 {
        assert_eq!(send(k & 7), Ok(()));
    }
    assert_eq!(send(4), Err(Refusal::OutOfSequence { expected: 2, got: 4 }));
    assert_eq!(send(2), Err(Refusal::Latched { errors: 1 }));
    assert_eq!(buffer.status(), 0x0116_000A, "it tells which one is expected: 10");
    buffer.apply(SegmentCommand::ClearErrors(1)).unwrap();
    assert_eq!(buffer.apply(point(2)), Ok(()));
    buffer.apply(SegmentCommand::ResetSegment).unwrap();
    assert_eq!(buffer.apply(point(0)), Ok(()));
}

#[test]
fn removing_takes_the_newest_and_at_most_all_and_lets_the_move_go_on() {
    let mut axis = Axis::at(0, SubMode::Cubic);
    axis.add(&[cubic(0, 0, 10), cubic(100, 0, 10), cubic(900, 0, 10), cubic(1000, 0, 0)]);
    axis.buffer.remove(2);
    axis.add(&[Point { is_relative: true, ..cubic(-100, 0, 0) }]);
    axis.until_rest(run());
    assert_eq!((axis.last.x, axis.errors()), (0.0, 0), "relative to the point that is left");

    axis.step(idle());
    axis.add(&[cubic(0, 0, 10), cubic(100, 0, 10), cubic(900, 0, 10)]);
    axis.step(run());
    axis.buffer.remove(200);
    axis.step(run());
    assert!(axis.answer.bit_12 && axis.buffer.free() == 32);
    axis.until_rest(run());
    assert_eq!(axis.errors(), 4);
}
