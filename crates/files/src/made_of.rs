//! Files that a scenario is made of.
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};
use std::fmt::Write as _;
use std::io::{self, Read};

/// Role of a file in a scenario.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FileRole {
    /// The scenario itself.
    Scenario,
    /// The model of `[axis]`: it has the values that the scenario does not give.
    AxisModel,
    /// The model of `[motor]`.
    MotorModel,
    /// The model of `[drive]`.
    DriveModel,
    /// A table of points.
    Table,
    /// An MJCF file, or one that it includes.
    Mjcf,
    /// A mesh, a texture or the like that an MJCF file names.
    MjcfAsset,
    /// An FMU.
    Fmu,
}

impl FileRole {
    /// The table of a scenario with its values, if it is a model.
    #[must_use]
    pub const fn modelled(self) -> Option<&'static str> {
        match self {
            Self::AxisModel => Some("axis"),
            Self::MotorModel => Some("motor"),
            Self::DriveModel => Some("drive"),
            _ => None,
        }
    }
}

/// A file that a scenario is made of.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct MadeOf {
    /// Its path from the root of the scenario, `<embedded>/…` for one that is built in.
    pub path: String,
    /// Its role in the scenario.
    pub role: FileRole,
    /// Its size (bytes).
    pub size: u64,
    /// SHA-256 of its bytes, in hexadecimal digits.
    pub sha256: String,
}

impl MadeOf {
    /// A file with these bytes.
    #[must_use]
    pub fn of_bytes(path: String, role: FileRole, bytes: &[u8]) -> Self {
        Self { path, role, size: bytes.len() as u64, sha256: digits(&Sha256::digest(bytes)) }
    }
}

/// SHA-256 of the whole of `source`, in hexadecimal digits, and its number of bytes.
///
/// # Errors
/// Those of the operating system.
pub fn sha256(mut source: impl Read) -> io::Result<(String, u64)> {
    let mut hash = Sha256::new();
    let size = io::copy(&mut source, &mut hash)?;
    Ok((digits(&hash.finalize()), size))
}

/// `bytes` as hexadecimal digits, two each.
#[must_use]
pub fn digits(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        // Writing to a string cannot fail.
        write!(text, "{byte:02x}").ok();
        text
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: FIPS 180-2, appendix B.1.
    #[test]
    fn the_digest_is_sha256() {
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(sha256(&b"abc"[..]).unwrap(), (expected.to_owned(), 3));
        assert_eq!(MadeOf::of_bytes("a".into(), FileRole::Table, b"abc").sha256, expected);
    }

    #[test]
    fn roles_are_words() {
        assert_eq!(serde_json_word(FileRole::AxisModel), "axis-model");
        assert_eq!((FileRole::DriveModel.modelled(), FileRole::Table.modelled()), (Some("drive"), None));
    }

    fn serde_json_word(role: FileRole) -> String {
        serde_json::to_value(role).unwrap().as_str().unwrap().to_owned()
    }
}
