//! Counters: the oracle is the position before it was wrapped to the reading.
use servobench_cia402::counter::{Counter, Unwrapped};
use servobench_cia402::units::UnitError;

use crate::random::Random;

/// Reading of a counter of `bits` bits at `position`, by division instead of masks.
fn shown(bits: u32, signed: bool, position: i128) -> i128 {
    let range = 2_i128.pow(bits);
    let lowest = if signed { -range / 2 } else { 0 };
    (position - lowest).rem_euclid(range) + lowest
}

fn counter(bits: u32, signed: bool) -> Counter {
    if signed { Counter::signed(bits) } else { Counter::unsigned(bits) }.unwrap()
}

#[test]
fn ten_runs_through_the_counter_show_no_jump_and_lose_no_count() {
    // Steps that divide no power of two, so that every run meets the seam elsewhere; the last one is nearly half the
    // range.
    for (bits, step) in [(16, 1), (16, 997), (16, 32_767), (32, 1_000_003), (32, 2_147_483_647_i128)] {
        for signed in [true, false] {
            for direction in [1, -1] {
                let travel = 10 * 2_i128.pow(bits);
                let mut position = 0;
                let mut axis = Unwrapped::new(counter(bits, signed), 0).unwrap();
                while position < travel {
                    position += step;
                    let unwrapped = axis.follow(shown(bits, signed, direction * position)).unwrap();
                    assert_eq!(unwrapped, direction * position, "{bits} bits, signed: {signed}");
                }
                assert!(axis.position().abs() >= travel);
            }
        }
    }
}

#[test]
fn the_integers_of_the_objects_are_readings() {
    // 6064h in two's complement, through the seam and back.
    let mut axis = Unwrapped::new(Counter::signed(32).unwrap(), i32::MAX).unwrap();
    assert_eq!(axis.follow(i32::MIN), Ok(1 << 31));
    assert_eq!(axis.follow(i32::MAX), Ok((1 << 31) - 1));
    let mut axis = Unwrapped::new(Counter::unsigned(64).unwrap(), 0_u64).unwrap();
    assert_eq!(axis.follow(u64::MAX), Ok(-1));
}

#[test]
fn random_walks_in_counters_of_every_width() {
    let mut random = Random::seeded(402);
    for bits in 8..=64 {
        for signed in [true, false] {
            let counter = counter(bits, signed);
            let start = i128::from(random.next()) - (1 << 63);
            let mut position = start;
            let first = counter.wrap(position);
            let mut axis = Unwrapped::new(counter, first).unwrap().at(i64::try_from(position).unwrap());
            for _ in 0..1000 {
                let longest = 2_i128.pow(bits - 1) - 1;
                position += i128::from(random.next()) % (2 * longest + 1) - longest;
                let reading = shown(bits, signed, position);
                assert_eq!(counter.wrap(position), reading);
                assert_eq!(axis.follow(reading), Ok(position));
            }
        }
    }
}

#[test]
fn every_step_shorter_than_half_the_range_has_a_direction() {
    for signed in [true, false] {
        let counter = counter(8, signed);
        for from in counter.lowest()..=counter.highest() {
            for step in -128..128 {
                let mut axis = Unwrapped::new(counter, from).unwrap();
                let reached = axis.follow(shown(8, signed, from + step));
                if step == -128 {
                    assert!(matches!(reached, Err(UnitError::StepTooLong { step: -128, .. })));
                    assert_eq!(axis.position(), from, "a refused reading changes nothing");
                } else {
                    assert_eq!(reached, Ok(from + step));
                }
            }
        }
    }
}

/// Oracle: the bytes of the integer, in the order of the bus.
#[test]
fn words_are_the_halves_of_the_reading() {
    let mut random = Random::seeded(3201);
    for bits in 8..=64 {
        for signed in [true, false] {
            let counter = counter(bits, signed);
            let ends = [counter.lowest(), counter.lowest() + 1, -1, 0, 1, counter.highest()];
            let any = (0..100).map(|_| i128::from(random.next()) - (1 << 62));
            for position in ends.into_iter().chain(any) {
                let [low, high] = counter.words(position);
                assert_eq!(counter.reading_of([low, high]), counter.wrap(position), "{bits} bits, signed: {signed}");
                let bytes = counter.wrap(position).to_le_bytes();
                assert_eq!(low.to_le_bytes(), bytes[..4]);
                let upper = if bits > 32 { &bytes[4..8] } else { &[0; 4] };
                assert_eq!(high.to_le_bytes(), upper, "{bits} bits, signed: {signed}");
            }
        }
    }
}
