//! Ranges of keys on the command line.
use servobench_fuzz::{Splice, check, fuzz};
use servobench_scenario::KeyRange;

const RANGES: [&str; 4] =
    ["axis.load.frequency=14 Hz..22 Hz", "axis.load.mass=12 kg±10 %", "a = -1e3..2.5e-3 m", "a=5+-2"];
const WORDS: &[&str] = &["..", "±", "+-", "=", "%", "Hz", "nan", "inf", "1e999", "-", ".", " "];

/// Any text is a key with two finite ends in order, or yields a message with the correct notation.
#[test]
fn ranges() {
    fuzz(check!(), 3_000, Splice::text(&RANGES, WORDS), |text| match text.parse::<KeyRange>() {
        Ok(KeyRange { key, ends, .. }) => {
            assert!(!key.is_empty() && ends[0] <= ends[1] && ends.iter().all(|end| end.is_finite()), "{ends:?}");
        }
        Err(error) => assert!(error.to_string().contains("14 Hz..22 Hz"), "{error}"),
    });
}
