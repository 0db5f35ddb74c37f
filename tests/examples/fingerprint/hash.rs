//! A hash that stays the same from build to build: FNV-1a, 64 bits (Fowler, Noll, Vo: RFC 9923).

/// The hash of `bytes`.
pub(crate) fn of_bytes(bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes.into_iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

/// The hash of the bits of `numbers`.
pub(crate) fn of_numbers<'a>(numbers: impl IntoIterator<Item = &'a f64>) -> u64 {
    of_bytes(numbers.into_iter().flat_map(|number| number.to_bits().to_le_bytes()))
}
