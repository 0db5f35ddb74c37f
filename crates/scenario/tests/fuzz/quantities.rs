//! Quantities on the command line.
use crate::WORDS;
use servobench_base::Coordinate;
use servobench_fuzz::{Splice, check, fuzz};
use servobench_scenario::{Derivative, axis_quantity, time};

const QUANTITIES: [&str; 12] = [
    "250 mm",
    "30 m/min",
    "-1.5e-3 rad/s^2",
    "3000 rpm",
    "50 m·s⁻³",
    "1000 m/(s2 s2)",
    "90°",
    "2 us",
    ".5 s",
    "1e3 krpm / ms",
    "5 %",
    "12 N m s/rad",
];

const DERIVATIVES: [Derivative; 5] =
    [Derivative::Position, Derivative::Velocity, Derivative::Acceleration, Derivative::Jerk, Derivative::Snap];

/// A value with its proper unit reads back to the same bits; a refusal quotes the text.
#[test]
fn quantities() {
    fuzz(check!(), 3_000, Splice::text(&QUANTITIES, WORDS), |text| {
        for (order, derivative) in DERIVATIVES.into_iter().enumerate() {
            for asked in [None, Some(Coordinate::Linear), Some(Coordinate::Rotary)] {
                let (value, motion) = match axis_quantity(derivative, asked, text) {
                    Ok(read) => read,
                    Err(error) => {
                        assert!(error.text == *text && !error.message.is_empty(), "{error:?}");
                        continue;
                    }
                };
                assert!(value.is_finite() && asked.is_none_or(|asked| asked == motion), "{value} {motion:?}");
                let unit = if motion == Coordinate::Linear { "m" } else { "rad" };
                let written = format!("{value:e} {unit}/s{order}").replace("/s0", "");
                assert_eq!(axis_quantity(derivative, None, &written), Ok((value, motion)), "{written}");
            }
        }
        if let Ok(value) = time(text) {
            assert_eq!(time(&format!("{value:e} s")), Ok(value));
        }
    });
}
