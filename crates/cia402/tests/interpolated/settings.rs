//! Sub-mode (60C0h) and time period (60C2h).
use servobench_cia402::interpolated::{SubMode, TimePeriod};

#[test]
fn every_other_code_is_refused() {
    for code in i16::MIN..=i16::MAX {
        assert_eq!(SubMode::from_code(code).map(SubMode::code).ok(), (-3..=0).contains(&code).then_some(code));
    }
    assert_eq!(
        SubMode::from_code(1).unwrap_err().to_string(),
        "interpolation sub-mode (60C0h) must be 0, -1, -2 or -3, got 1"
    );
}

#[test]
fn a_period_is_so_many_powers_of_ten() {
    for index in i8::MIN..=i8::MAX {
        let expected = (-6..=-3).contains(&index).then(|| 15 * 10_u32.pow(u32::from((index + 6).unsigned_abs())));
        assert_eq!(TimePeriod::new(15, index).map(TimePeriod::microseconds).ok(), expected);
    }
    assert_eq!(
        TimePeriod::new(0, -3).unwrap_err().to_string(),
        "interpolation time period (60C2h) must be 1 to 255 units of 10^-3 to 10^-6 s, got 0 units of 10^-3 s"
    );
}
