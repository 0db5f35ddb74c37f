//! Files that are almost right: real ones, spliced, and with a matching digest where one would reveal that.
use crate::failure::Failure;
use servobench_fuzz::{Splice, SplicedText, seeded};
use std::io::{Cursor, Write};
use twox_hash::XxHash64;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// Words that files of text are spliced with.
const WORDS: &[&str] = &[
    "0",
    "-1",
    "1e308",
    "nan",
    "inf",
    "9223372036854775808",
    "1e-300",
    "\"\"",
    "[",
    "]",
    "{",
    "}",
    "\"",
    "'",
    "<",
    ">",
    "/",
    "=",
    ",",
    "\n",
    "[[program]]\n",
    "model = \"ball-screw\"\n",
    "file",
    "../x",
    "/dev/zero",
    "true",
    "null",
    "\u{0}",
    "\u{feff}",
    "ä",
    "1 m/s",
    "kg",
    "#",
    "\\u0000",
];
/// Bytes that other files are spliced with.
const BYTES: &[&[u8]] = &[
    b"\0",
    b"\xff",
    b"\x80",
    b"\x7f",
    b"\x0f",
    b"PK\x03\x04",
    b"PK\x05\x06",
    b"PAR1",
    b"\xff\xff\xff\x7f",
    b"\x15\x80\x80\x80\x80\x10",
];

/// Digest that is renewed in a mutated file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Digest {
    /// No digest.
    None,
    /// Seal of a recording: renewed in every second file.
    Seal,
    /// Digest of each line of a journal: renewed in every second file.
    Lines,
}

/// Source of mutated files.
#[derive(Debug)]
pub(super) enum Mutator {
    Text(Box<SplicedText>, Digest),
    Bytes(Box<Splice>, Digest),
    /// Model descriptions in archives, and the archives themselves.
    Archives(Box<SplicedText>, Box<Splice>),
}

impl Mutator {
    pub(super) fn of_texts(files: &[String], digest: Digest) -> Self {
        let files: Vec<&str> = files.iter().map(String::as_str).collect();
        Self::Text(Box::new(Splice::text(&files, WORDS)), digest)
    }

    pub(super) fn of_bytes(files: &[Vec<u8>], digest: Digest) -> Self {
        let files: Vec<&[u8]> = files.iter().map(Vec::as_slice).collect();
        Self::Bytes(Box::new(Splice::bytes(&files, BYTES)), digest)
    }

    /// Mutates the model descriptions of FMUs.
    pub(super) fn of_descriptions(descriptions: &[String]) -> Result<Self, Failure> {
        let archives = descriptions.iter().map(|text| archive(text)).collect::<Result<Vec<_>, _>>()?;
        let texts: Vec<&str> = descriptions.iter().map(String::as_str).collect();
        let archives: Vec<&[u8]> = archives.iter().map(Vec::as_slice).collect();
        Ok(Self::Archives(Box::new(Splice::text(&texts, WORDS)), Box::new(Splice::bytes(&archives, BYTES))))
    }

    /// The file with this number, the same each time.
    pub(super) fn file(&self, number: u64) -> Result<Vec<u8>, Failure> {
        let is_second = number % 2 == 1;
        let (mut bytes, digest) = match self {
            Self::Text(splice, digest) => (seeded(&**splice, number).unwrap_or_default().into_bytes(), *digest),
            Self::Bytes(splice, digest) => (seeded(&**splice, number).unwrap_or_default(), *digest),
            Self::Archives(texts, _) if is_second => return archive(&seeded(&**texts, number).unwrap_or_default()),
            Self::Archives(_, archives) => (seeded(&**archives, number).unwrap_or_default(), Digest::None),
        };
        match digest {
            Digest::Seal if is_second => seal(&mut bytes),
            Digest::Lines if is_second => bytes = with_digests(&bytes),
            _ => {}
        }
        Ok(bytes)
    }
}

/// An archive with this model description and a file that is not a library in its place.
fn archive(description: &str) -> Result<Vec<u8>, Failure> {
    let failed = |why: &dyn std::fmt::Display| Failure::Output { command: "zip".into(), why: why.to_string() };
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
    for (name, content) in
        [("modelDescription.xml", description), ("binaries/x86_64-linux/none.so", "none"), ("resources/a.txt", "a")]
    {
        zip.start_file(name, options).map_err(|error| failed(&error))?;
        zip.write_all(content.as_bytes()).map_err(|error| failed(&error))?;
    }
    Ok(zip.finish().map_err(|error| failed(&error))?.into_inner())
}

/// The key of the seal of a recording, and the bytes that introduce a value of 16 bytes behind it.
const SEAL: &[u8] = b"servobench.seal\x18\x10";
const DIGITS: usize = 16;

/// Seals an edited recording, where it still has a place for the seal.
fn seal(file: &mut [u8]) {
    let Some(at) = file.windows(SEAL.len()).rposition(|window| window == SEAL).map(|at| at + SEAL.len()) else {
        return;
    };
    let Some(place) = file.get_mut(at..at + DIGITS) else { return };
    place.fill(b'0');
    let digits = format!("{:016x}", XxHash64::oneshot(0, file));
    file[at..at + DIGITS].copy_from_slice(digits.as_bytes());
}

/// An edited journal with a matching digest on each line.
fn with_digests(journal: &[u8]) -> Vec<u8> {
    let line = |line: &[u8]| {
        let json = line.get(DIGITS + 1..).unwrap_or_default();
        [format!("{:016x} ", XxHash64::oneshot(0, json)).as_bytes(), json, b"\n"].concat()
    };
    journal.split(|byte| *byte == b'\n').flat_map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_the_same_each_time_and_differ() {
        let mutator = Mutator::of_texts(&["[run]\nbase_rate = \"1 kHz\"\n".into()], Digest::None);
        let all: Vec<_> = (0..50).map(|number| mutator.file(number).unwrap()).collect();
        assert_eq!(all, (0..50).map(|number| mutator.file(number).unwrap()).collect::<Vec<_>>());
        assert!(all.iter().collect::<std::collections::BTreeSet<_>>().len() > 20);
    }

    /// Oracle: the digest of the file with zeros in its place.
    #[test]
    fn an_edited_recording_is_sealed_again() {
        let mut file = [b"PAR1....", SEAL, b"ffffffffffffffff", b"...."].concat();
        let blank = [b"PAR1....", SEAL, b"0000000000000000", b"...."].concat();
        seal(&mut file);
        let digits = format!("{:016x}", XxHash64::oneshot(0, &blank));
        assert_eq!(file, [b"PAR1....", SEAL, digits.as_bytes(), b"...."].concat());
    }
}
