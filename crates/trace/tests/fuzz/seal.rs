//! Seals a file as the crate does, for files edited on purpose.
use std::hash::Hasher;
use twox_hash::XxHash64;

const MARK: &[u8] = b"servobench.seal\x18\x10";

/// Writes the digest over the last blank, if there is one.
pub(crate) fn apply(bytes: &mut [u8]) {
    let Some(at) = bytes.windows(MARK.len() + 16).rposition(|window| window.starts_with(MARK)) else { return };
    let digits = at + MARK.len()..at + MARK.len() + 16;
    bytes[digits.clone()].fill(b'0');
    let mut hash = XxHash64::with_seed(0);
    hash.write(bytes);
    bytes[digits].copy_from_slice(format!("{:016x}", hash.finish()).as_bytes());
}
