//! Seeded random counts.
pub(crate) use servobench_testkit::Random;

/// A positive number of 1 to `bits` bits, with equal probability of each width.
pub(crate) fn magnitude(random: &mut Random, bits: u32) -> i64 {
    let width = 1 + random.next() % u64::from(bits);
    i64::try_from(random.next() >> (64 - width)).unwrap().max(1)
}

/// 1 or −1.
pub(crate) fn sign(random: &mut Random) -> i128 {
    if random.unit() < 0.5 { 1 } else { -1 }
}
