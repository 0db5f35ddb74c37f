//! Random numbers that depend on their index alone.
//!
//! Source: Steele, Lea & Flood, *Fast splittable pseudorandom number generators*, OOPSLA 2014 (`SplitMix64`).

/// Increment of the generator's state.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

/// Number `index` of the generator with this seed.
pub(crate) const fn number(seed: u64, index: u64) -> u64 {
    let z = seed.wrapping_add(STEP.wrapping_mul(index.wrapping_add(1)));
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The seed of stream `stream` derived from `seed`.
pub(crate) const fn stream(seed: u64, stream: u64) -> u64 {
    number(number(seed, 0) ^ stream, 0)
}

/// A number between 0 and 1, exclusive.
pub(crate) fn between(number: u64) -> f64 {
    ((number >> 12) as f64 + 0.5) / (1_u64 << 52) as f64
}

/// The numbers below `count` in a random order, one for each.
pub(crate) fn order(seed: u64, count: u32) -> Vec<u32> {
    let mut order: Vec<u32> = (0..count).collect();
    for last in (1..order.len()).rev() {
        // Bias: the first few of 2⁶⁴ numbers are more frequent by one part in 2³².
        let other = (u128::from(number(seed, last as u64)) * (last as u128 + 1)) >> 64;
        order.swap(last, usize::try_from(other).unwrap_or(last));
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first numbers of the authors' program for seed 0.
    #[test]
    fn the_numbers_are_those_of_the_generator() {
        let found = [0, 1, 2].map(|index| number(0, index));
        assert_eq!(found, [0xe220_a839_7b1d_cdaf, 0x6e78_9e6a_a1b9_65f4, 0x06c4_5d18_8009_454f]);
    }

    #[test]
    fn neither_end_is_reached() {
        assert!(between(0) > 0.0 && between(u64::MAX) < 1.0);
        assert!((between(1 << 63) - 0.5).abs() < 1e-15);
    }

    /// Each position has each number about equally often: 100 000 orders of 5, with an expectation of 20 000 ± 4·127.
    #[test]
    fn every_order_is_as_likely_as_any_other() {
        let mut seen = [[0_u32; 5]; 5];
        for seed in 0..100_000 {
            let found = order(seed, 5);
            let mut sorted = found.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, [0, 1, 2, 3, 4]);
            found.iter().enumerate().for_each(|(place, number)| seen[place][*number as usize] += 1);
        }
        assert!(seen.iter().flatten().all(|count| count.abs_diff(20_000) < 510), "{seen:?}");
        assert_eq!((order(7, 0), order(7, 1)), (vec![], vec![0]));
    }
}
