//! Factor groups of axes that can be computed by hand.
use servobench_cia402::units::{AxisUnit, FactorGroup, POLARITY_POSITION, Ratio, Scaling};

use crate::random::Random;

/// 2^20 increments per motor revolution, gear 7:2, screw of 5 mm, micrometres.
fn screw(polarity: u8) -> Scaling {
    let factors = FactorGroup {
        position_encoder_resolution: [1 << 20, 1],
        gear_ratio: [7, 2],
        feed_constant: [5000, 1],
        polarity,
        ..FactorGroup::default()
    };
    factors.scaling(AxisUnit::Metre(Ratio::new(1, 1_000_000).unwrap())).unwrap()
}

#[test]
fn two_turns_of_the_screw_are_seven_of_the_motor() {
    for (polarity, sign) in [(0, 1), (POLARITY_POSITION, -1)] {
        let axis = screw(polarity);
        assert_eq!(axis.increments(sign * 10_000), Ok(7 << 20));
        assert_eq!(axis.position(7 << 20), Ok(sign * 10_000));
        assert_eq!(axis.metres_or_radians(7 << 20), Ok(sign as f64 * 0.01));
        assert_eq!(axis.increments_at(sign as f64 * 0.01), Ok(7 << 20));
        // The polarity of positions leaves velocities alone.
        assert_eq!(axis.velocity(7 << 20), Ok(10_000));
    }
}

#[test]
fn a_revolution_is_two_pi() {
    let factors =
        FactorGroup { position_encoder_resolution: [4096, 1], feed_constant: [360, 1], ..FactorGroup::default() };
    let axis = factors.scaling(AxisUnit::Revolution(Ratio::new(1, 360).unwrap())).unwrap();
    assert_eq!(axis.metres_or_radians(-1024), Ok(-core::f64::consts::FRAC_PI_2));
    assert_eq!(axis.increments_at(core::f64::consts::PI), Ok(2048));
}

#[test]
fn finer_units_bring_positions_there_and_back() {
    let mut random = Random::seeded(5);
    let axis = screw(POLARITY_POSITION);
    for _ in 0..20_000 {
        // An increment is shorter than a unit, and an `f64` in metres tells increments apart up to 2^52.
        let position = i128::from(random.next() >> 20) - (1 << 43);
        assert_eq!(axis.position(axis.increments(position).unwrap()), Ok(position));
        let increments = i128::from(random.next() >> 12) - (1 << 51);
        assert_eq!(axis.increments_at(axis.metres_or_radians(increments).unwrap()), Ok(increments));
    }
}
