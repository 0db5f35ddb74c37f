//! Digest of inputs, as one number.
use serde::{Deserialize, Serialize};
use servobench_files::{digits, named};
use sha2::{Digest as _, Sha256};
use std::borrow::Cow;
use std::fmt;
use thiserror::Error;

/// A SHA-256 (FIPS 180-4), written as 64 hexadecimal digits; empty if none was computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(into = "String", try_from = "Cow<'_, str>")]
pub struct Digest(Option<[u8; 32]>);

/// A text that is not a digest.
#[derive(Debug, Error)]
#[error("`{}` is no digest: it has 64 hexadecimal digits, or none", named(.0))]
pub struct NoDigest(String);

impl Digest {
    /// The digest of `bytes`.
    #[must_use]
    pub fn of(bytes: &[u8]) -> Self {
        Self(Some(Sha256::digest(bytes).into()))
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|bytes| f.write_str(&digits(bytes)))
    }
}

impl From<Digest> for String {
    fn from(digest: Digest) -> Self {
        digest.to_string()
    }
}

impl TryFrom<Cow<'_, str>> for Digest {
    type Error = NoDigest;

    fn try_from(text: Cow<'_, str>) -> Result<Self, NoDigest> {
        let no_digest = || NoDigest(text.clone().into_owned());
        let is_digits = text.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'));
        if text.is_empty() {
            return Ok(Self(None));
        }
        if text.len() != 64 || !is_digits {
            return Err(no_digest());
        }
        let mut bytes = [0; 32];
        for (k, byte) in bytes.iter_mut().enumerate() {
            *byte = u8::from_str_radix(&text[2 * k..2 * k + 2], 16).map_err(|_| no_digest())?;
        }
        Ok(Self(Some(bytes)))
    }
}

/// Builder of one digest of many parts. Each part is preceded by its length, so that no two lists of parts look alike.
#[derive(Debug, Clone, Default)]
pub struct Digester(Sha256);

impl Digester {
    /// Adds this part.
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
        Digest(Some(self.0.finalize().into()))
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
    fn its_text_reads_back() {
        for digest in [Digest::of(b"abc"), Digest::default()] {
            let text = serde_json::to_string(&digest).unwrap();
            assert_eq!(text, format!("\"{digest}\""));
            assert_eq!(serde_json::from_str::<Digest>(&text).unwrap(), digest);
        }
        let digits = Digest::of(b"abc").to_string();
        for wrong in ["ab", &digits[1..], &digits.to_uppercase(), &format!("{digits}0"), &format!("{}µ", &digits[2..])]
        {
            let refusal = serde_json::from_str::<Digest>(&format!("\"{wrong}\"")).unwrap_err().to_string();
            assert!(refusal.contains("is no digest"), "{refusal}");
        }
    }

    #[test]
    fn parts_are_told_apart() {
        let of = |parts: &[&str]| parts.iter().fold(Digester::default(), Digester::with).finish();
        assert_ne!(of(&["ab", "c"]), of(&["a", "bc"]));
        assert_ne!(of(&["ab", ""]), of(&["ab"]));
        assert_eq!(of(&["ab", "c"]), of(&["ab", "c"]));
    }
}
