//! What something was made of, as one number.
use serde::{Deserialize, Serialize};
use servobench_files::digits;
use sha2::{Digest as _, Sha256};
use std::fmt;

/// A SHA-256 (FIPS 180-4) as 64 hexadecimal digits; empty where nobody computed one.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Digest(String);

impl Digest {
    /// That of `bytes`.
    #[must_use]
    pub fn of(bytes: &[u8]) -> Self {
        Self(digits(&Sha256::digest(bytes)))
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Makes one digest of many parts. Each part is preceded by its length, so that no two lists of parts look alike.
#[derive(Debug, Clone, Default)]
pub struct Digester(Sha256);

impl Digester {
    /// With this part added.
    #[must_use]
    pub fn with(mut self, part: impl AsRef<[u8]>) -> Self {
        let part = part.as_ref();
        self.0.update((part.len() as u64).to_le_bytes());
        self.0.update(part);
        self
    }

    /// The digest.
    #[must_use]
    pub fn finish(self) -> Digest {
        Digest(digits(&self.0.finalize()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The example of FIPS 180-4 for `abc`.
    #[test]
    fn it_is_sha_256() {
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(Digest::of(b"abc").to_string(), expected);
    }

    #[test]
    fn parts_are_told_apart() {
        let of = |parts: &[&str]| parts.iter().fold(Digester::default(), Digester::with).finish();
        assert_ne!(of(&["ab", "c"]), of(&["a", "bc"]));
        assert_ne!(of(&["ab", ""]), of(&["ab"]));
        assert_eq!(of(&["ab", "c"]), of(&["ab", "c"]));
    }
}
