//! Modulo axes against a walk by single steps.
use servobench_cia402::modulo::{Direction, PositionRange, RotaryAxisOption};

/// Position after a step by one.
fn walk(range: PositionRange, position: i32, step: i32) -> i32 {
    match position.checked_add(step) {
        Some(next) if (range.min()..=range.max()).contains(&next) => next,
        _ if step > 0 => range.min(),
        _ => range.max(),
    }
}

/// Steps in one direction until the target is met.
fn steps(range: PositionRange, from: i32, to: i32, step: i32) -> i64 {
    let mut position = from;
    for taken in 0.. {
        if position == to {
            return taken * i64::from(step);
        }
        position = walk(range, position, step);
    }
    unreachable!("the range is finite")
}

#[test]
fn ways_are_those_of_a_walk() {
    for (min, max) in [(0, 1), (0, 6), (-3, 3), (-7, -2), (5, 12), (i32::MAX - 5, i32::MAX), (i32::MIN, i32::MIN + 6)] {
        let range = PositionRange::new(min, max).unwrap();
        for from in min..=max {
            for to in min..=max {
                let (up, down) = (steps(range, from, to, 1), steps(range, from, to, -1));
                let way = |direction| range.way(from.into(), to.into(), direction);
                assert_eq!((way(Direction::Positive), way(Direction::Negative)), (up, down), "{from} to {to}");
                assert_eq!(way(Direction::Shortest), if up <= -down { up } else { down }, "{from} to {to}");
            }
        }
    }
}

#[test]
fn a_position_without_end_wraps_as_a_walk_does() {
    let range = PositionRange::new(-4, 7).unwrap();
    let (mut up, mut down) = (range.min(), range.min());
    for walked in 0..100 {
        assert_eq!(range.wrap(i64::from(range.min()) + walked), up);
        assert_eq!(range.wrap(i64::from(range.min()) - walked), down);
        (up, down) = (walk(range, up, 1), walk(range, down, -1));
    }
    // 2^63 = 12·768614336404564650 + 8, and its negative leaves 4.
    assert_eq!(range.wrap(i64::MAX), 7);
    assert_eq!(range.wrap(i64::MIN), 4);
}

#[test]
fn the_whole_range_wraps_as_32_bits_do() {
    let range = PositionRange::default();
    for position in [0, 1, -1, 1 << 31, (1 << 31) - 1, -(1 << 31) - 1, 5 << 40, i64::MAX, i64::MIN] {
        #[expect(clippy::cast_possible_truncation, reason = "the low 32 bits are the oracle")]
        let low_bits = position as i32;
        assert_eq!(range.wrap(position), low_bits);
    }
    let half = range.way(0, i32::MIN.into(), Direction::Shortest);
    assert_eq!(half, 1 << 31, "of two ways alike the positive one");
    assert_eq!(range.way(i32::MAX.into(), i32::MIN.into(), Direction::Shortest), 1);
}

#[test]
fn positions_outside_are_wrapped_first() {
    let turn = PositionRange::new(0, 359).unwrap();
    assert_eq!(turn.way(710, -350, Direction::Positive), 20);
    assert_eq!(turn.way(350, 730, Direction::Negative), -340);
}

#[test]
fn the_option_code_chooses_by_bits_7_and_6() {
    let turn = PositionRange::new(0, 359).unwrap();
    let way = |code| RotaryAxisOption::of_code(code).direction().map(|direction| turn.way(350, 730, direction));
    assert_eq!([way(0x00), way(0x40), way(0x80), way(0xC0)], [None, Some(-340), Some(20), Some(20)]);
    assert_eq!(RotaryAxisOption::of_code(0xFF3F), RotaryAxisOption::Linear);
    for code in [0x00, 0x40, 0x80, 0xC0] {
        assert_eq!(RotaryAxisOption::of_code(code).code(), code);
    }
}

#[test]
fn an_empty_range_is_refused_in_words() {
    let message = "max position range limit (607Bh:02h) must be above 5, the min position range limit, got 5";
    assert_eq!(PositionRange::new(5, 5).unwrap_err().to_string(), message);
    assert!(PositionRange::new(5, 4).is_err());
}
