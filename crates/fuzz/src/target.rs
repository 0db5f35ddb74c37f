//! A fuzz target: the property, its inputs, and their number.
use crate::seeded::Seeded;
use bolero::generator::ValueGenerator;
use bolero::{BorrowedInput, ByteSliceGenerator, DefaultEngine, TestTarget};
use std::fmt::Debug;
use std::panic::RefUnwindSafe;

/// Result of `check!()`, which marks the place of the target.
pub type Target = TestTarget<ByteSliceGenerator, DefaultEngine, BorrowedInput>;

/// Checks `property` against `inputs` seeded inputs of `generator`, or `SERVOBENCH_SWEEP` of them if that is set; then against every file
/// in `__fuzz__/<target>/{crashes,corpus}` beside the test; then, under a fuzzer, against the fuzzer's inputs.
///
/// # Panics
/// If the property panics, after shrinking the input; if `SERVOBENCH_SWEEP` is not a whole number.
pub fn fuzz<G>(target: Target, inputs: u64, generator: G, property: impl Fn(&G::Output) + RefUnwindSafe)
where
    G: ValueGenerator,
    G::Output: Debug,
{
    let seeded = Seeded { inputs: sweep_size(inputs) };
    TestTarget::new(seeded).with_generator(&generator).for_each(&property);
    target.with_iterations(0).with_generator(generator).for_each(property);
}

fn sweep_size(inputs: u64) -> u64 {
    std::env::var("SERVOBENCH_SWEEP").map_or(inputs, |size| size.parse().expect("SERVOBENCH_SWEEP is a whole number"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Splice, check};
    use std::sync::Mutex;

    fn words() -> crate::SplicedText {
        Splice::text(&["one two three", "uno dos tres"], &["zero"])
    }

    #[test]
    fn every_run_sees_the_same_inputs() {
        let runs = [Mutex::new(vec![]), Mutex::new(vec![])];
        for seen in &runs {
            fuzz(check!(), 500, words(), |text| seen.lock().unwrap().push(text.clone()));
        }
        let [first, second] = runs.map(|seen| seen.into_inner().unwrap());
        assert_eq!(first.len() as u64, sweep_size(500));
        assert_eq!(first, second);
    }

    #[test]
    #[should_panic(expected = "made small")]
    fn a_property_that_does_not_hold_is_found() {
        fuzz(check!(), 500, words(), |text| assert!(!text.contains("zerouno"), "{text}"));
    }
}
