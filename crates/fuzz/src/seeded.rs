//! A bolero engine that feeds a target the same inputs each time.
//!
//! Bolero's engine for `cargo test` takes its seeds from the operating system: a failure in one run would be gone in the next.
use bolero::generator::ValueGenerator;
use bolero::generator::bolero_generator::driver::ByteSliceDriver;
use bolero::{Engine, Test};
use bolero_engine::driver::Options;
use bolero_engine::input::Bytes;
use bolero_engine::{Failure, panic};
use std::fmt::Debug;

/// Runs a target on a number of inputs; a larger number begins with the same inputs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seeded {
    pub(crate) inputs: u64,
}

impl<T: Test> Engine<T> for Seeded
where
    T::Value: Debug,
{
    type Output = ();

    fn run(self, mut test: T, options: Options) {
        panic::set_hook();
        let forward = panic::forward_panic(false);
        for number in 0..self.inputs {
            let bytes = bytes(number);
            let Err(error) = test.test(&mut Bytes::new(&bytes, &options)) else { continue };
            let failure = test.shrink(bytes.clone(), None, &options).unwrap_or_else(|| {
                let input = test.generate_value(&mut Bytes::new(&bytes, &options));
                Failure { error, input, seed: None }
            });
            panic::forward_panic(true);
            panic!("input {number} of {}, made small:\n{failure:#}", self.inputs);
        }
        panic::forward_panic(forward);
    }
}

/// Input number `number` of `generator`, for use outside tests: by a program.
///
/// `None` if the bytes of that number do not suffice for an input.
pub fn seeded<G: ValueGenerator>(generator: &G, number: u64) -> Option<G::Output> {
    let bytes = bytes(number);
    generator.generate(&mut ByteSliceDriver::new(&bytes, &Options::default()))
}

/// Bytes from which a generator makes its input number `number`: 16 to 512.
fn bytes(number: u64) -> Vec<u8> {
    let words = 2 << (number % 6);
    let mut state = number;
    (0..words).flat_map(|_| next(&mut state).to_le_bytes()).collect()
}

/// SplitMix64: Steele, Lea, Flood, *Fast splittable pseudorandom number generators*, OOPSLA 2014.
fn next(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (*state ^ (*state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first numbers of the generator from seed 0, according to its published C code.
    #[test]
    fn the_generator_is_splitmix64() {
        let mut state = 0;
        let first: [u64; 3] = std::array::from_fn(|_| next(&mut state));
        assert_eq!(first, [0xe220_a839_7b1d_cdaf, 0x6e78_9e6a_a1b9_65f4, 0x06c4_5d18_8009_454f]);
    }

    #[test]
    fn inputs_differ_in_content_and_length() {
        let all: Vec<_> = (0..1_000).map(bytes).collect();
        let lengths: std::collections::BTreeSet<_> = all.iter().map(Vec::len).collect();
        assert_eq!(lengths.into_iter().collect::<Vec<_>>(), [16, 32, 64, 128, 256, 512]);
        let starts: std::collections::BTreeSet<_> = all.iter().map(|bytes| &bytes[..8]).collect();
        assert_eq!(starts.len(), all.len());
    }
}
