//! Every refusal names object, value, bound and remedy.
use servobench_cia402::counter::{Counter, Unwrapped};
use servobench_cia402::units::{AxisUnit, FactorGroup, Ratio, Scaling, UnitError};

const UNIT: AxisUnit = AxisUnit::Metre(Ratio::ONE);

fn message<T: std::fmt::Debug>(result: Result<T, UnitError>) -> String {
    result.unwrap_err().to_string()
}

fn scaling(factors: FactorGroup) -> Result<Scaling, UnitError> {
    factors.scaling(UNIT)
}

#[test]
fn zero_in_any_factor_is_refused_by_its_object() {
    let one = FactorGroup::default();
    let remedy = "must be at least 1, got 0: write the ratio of the axis, or 1 if there is none";
    for (object, factors) in [
        ("`encoder increments` (608Fh:01h)", FactorGroup { position_encoder_resolution: [0, 1], ..one }),
        ("`motor revolutions` (608Fh:02h)", FactorGroup { position_encoder_resolution: [1, 0], ..one }),
        ("`motor shaft revolutions` (6091h:01h)", FactorGroup { gear_ratio: [0, 1], ..one }),
        ("`driving shaft revolutions` (6091h:02h)", FactorGroup { gear_ratio: [1, 0], ..one }),
        ("`feed` (6092h:01h)", FactorGroup { feed_constant: [0, 1], ..one }),
        ("`driving shaft revolutions` (6092h:02h)", FactorGroup { feed_constant: [1, 0], ..one }),
        ("`velocity factor numerator` (6096h:01h)", FactorGroup { velocity_factor: [0, 1], ..one }),
        ("`velocity factor denominator` (6096h:02h)", FactorGroup { velocity_factor: [1, 0], ..one }),
    ] {
        assert_eq!(message(scaling(factors)), format!("{object} {remedy}"));
    }
}

#[test]
fn factors_that_do_not_fit_are_refused() {
    assert_eq!(
        message(scaling(FactorGroup { polarity: 0xc1, ..FactorGroup::default() })),
        "polarity (607Eh:00h) must have no bits but 7, 6 and 5, got 0xc1: clear bits 0x01"
    );
    assert_eq!(
        message(Ratio::new(1, -2)),
        "`denominator` must be at least 1, got -2: give the sign by the polarity (607Eh)"
    );
    // (2^32 − 1)²·3 has 66 bits and nothing in common with 2^31.
    let wide = FactorGroup {
        position_encoder_resolution: [u32::MAX, 1 << 31],
        gear_ratio: [u32::MAX, 1],
        feed_constant: [1, 3],
        ..FactorGroup::default()
    };
    assert_eq!(
        message(scaling(wide)),
        "`feed constant/(position encoder resolution·gear ratio)` needs a numerator or denominator of \
         55340232195358851075 when reduced, at most 9223372036854775807 is kept: choose factors that have more in \
         common, or a coarser unit"
    );
}

#[test]
fn counts_that_overflow_are_refused() {
    assert_eq!(
        message(Ratio::new(4, 1).unwrap().of(i128::MAX)),
        "170141183460469231731687303715884105727 counts cannot be multiplied by 4 within 127 bits: wrap the position \
         into its counter first"
    );
    let metres = scaling(FactorGroup::default()).unwrap();
    assert_eq!(
        message(metres.increments_at(1e300)),
        "`position` must be finite and at most 9.223372036854776e18 in magnitude (SI), got 1e300: correct it or its \
         unit"
    );
    assert!(message(metres.increments_at(f64::NAN)).contains("got NaN"));
    assert!(message(metres.increments_at(9.3e18)).contains("got 9.3e18"));
}

#[test]
fn readings_that_cannot_be_are_refused() {
    for bits in [0, 7, 65, u32::MAX] {
        assert_eq!(
            message(Counter::signed(bits)),
            format!("a position counter must have 8 to 64 bits, got {bits}: take the width of the drive's counter")
        );
    }
    let counter = Counter::unsigned(16).unwrap();
    assert_eq!(
        message(Unwrapped::new(counter, -1)),
        "a 16-bit counter shows 0 to 65535, got -1: check its width and whether it is signed"
    );
    let mut axis = Unwrapped::new(counter, 7).unwrap();
    assert_eq!(
        message(axis.follow(32_775)),
        "the counter went from 7 to 32775, -32768 counts by the shorter distance, at most 32767 determine the direction: read it \
         more often, take a wider counter or start again from a known position"
    );
}
