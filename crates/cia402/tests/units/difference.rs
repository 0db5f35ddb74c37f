//! Velocities by differences against the motion that the positions were made from.
use servobench_cia402::counter::{Counter, Unwrapped};
use servobench_cia402::difference::{Difference, Displacement};
use servobench_cia402::units::{AxisUnit, FactorGroup, POLARITY_VELOCITY, Ratio};

#[test]
fn the_difference_spans_the_cycles_that_there_are() {
    let mut difference = Difference::<3>::new(500_000, 10).unwrap();
    let seen = [11, 14, 19, 26, 35].map(|position| difference.follow(position));
    // Squares from 10: 1, 4, 9 since the start, then 26 − 11 and 35 − 14.
    assert_eq!(seen.map(Displacement::increments), [1, 4, 9, 15, 21]);
    assert_eq!(seen.map(Displacement::nanoseconds), [500_000, 1_000_000, 1_500_000, 1_500_000, 1_500_000]);
    assert_eq!(seen[4].increments_per_second().to_bits(), 14_000.0_f64.to_bits());
}

#[test]
fn velocity_through_a_wrapping_counter_does_not_jump() {
    let mut axis = Unwrapped::new(Counter::signed(16).unwrap(), 0).unwrap();
    let mut difference = Difference::<1>::new(1_000_000, 0).unwrap();
    for cycle in 1..1000_i128 {
        let reading = (cycle * 1234 + 32_768).rem_euclid(65_536) - 32_768;
        assert_eq!(difference.follow(axis.follow(reading).unwrap()).increments(), 1234);
    }
}

#[test]
fn velocities_come_in_the_units_of_the_drive() {
    // 2^20 increments and 360 000 millidegrees per revolution, velocity in millidegrees per minute, inverted.
    let factors = FactorGroup {
        position_encoder_resolution: [1 << 20, 1],
        feed_constant: [360_000, 1],
        velocity_factor: [60, 1],
        polarity: POLARITY_VELOCITY,
        ..FactorGroup::default()
    };
    let scaling = factors.scaling(AxisUnit::Revolution(Ratio::new(1, 360_000).unwrap())).unwrap();
    let turn_a_second = Difference::<1>::new(976_562, 0).unwrap().follow(1 << 10);
    // 1024 increments in 976.562 µs: 360 000·60·(10^9/1024)/976.562 per mil = 21 600 011.06 by hand.
    assert_eq!(scaling.velocity_actual_value(turn_a_second), Ok(-21_600_011));
    assert_eq!(scaling.velocity(1 << 20), Ok(-21_600_000));
    assert_eq!(scaling.increments_per_second(-21_600_000), Ok(1 << 20));
    let too_fast = Difference::<1>::new(1_000_000, 0).unwrap().follow(1 << 30);
    assert_eq!(
        scaling.velocity_actual_value(too_fast).unwrap_err().to_string(),
        "`velocity actual value` (606Ch:00h) must be between -2147483648 and 2147483647, got -22118400000000: choose a \
         coarser unit (6092h, 6096h)"
    );
}
