//! A digest of a whole file, stored in the file: damage is found before any decoder sees it.
//!
//! The seal is the XXH64 (seed 0) of all bytes of the file, its own 16 hexadecimal digits counted as zeros. It is the
//! value of a key in the Parquet footer. There the key's text is followed by the two bytes that start the value in
//! Thrift's compact protocol: field 2 − 1, type binary (`0x18`), and the length 16 (`0x10`).
//! Source: Apache Thrift, *Thrift Compact protocol encoding*; Apache Parquet, *File Format* (footer length and `PAR1`
//! in the last eight bytes).
use std::fs::File;
use std::hash::Hasher;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;
use twox_hash::XxHash64;

/// Key of the seal.
pub(crate) const KEY: &str = "servobench.seal";
/// Number of digits.
const DIGITS: usize = 16;
/// Maximum size of a footer (bytes): besides the columns it holds signals, events and log messages, in some ten million words.
const LONGEST_FOOTER: u64 = 128 << 20;
/// Placeholder of the digits until the file is whole.
pub(crate) const BLANK: &str = "0000000000000000";
/// Beginning of a value of 16 bytes, after its key.
const VALUE_START: [u8; 2] = [0x18, 0x10];

/// Hashes the bytes on their way to a file to be sealed, so that it need not be read again.
pub(crate) struct Hashed<W> {
    sink: W,
    hash: XxHash64,
}

impl<W: Write> Hashed<W> {
    pub(crate) fn new(sink: W) -> Self {
        Self { sink, hash: XxHash64::with_seed(0) }
    }

    /// The digits that seal the file, all of which has passed, with the blank in it.
    pub(crate) fn digits(self) -> String {
        digits(&self.hash)
    }
}

impl<W: Write> Write for Hashed<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.sink.write(bytes)?;
        self.hash.write(&bytes[..count]);
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.sink.flush()
    }
}

/// Seals the file: writes the digits of all its bytes over the blank. Returns true if there was a place for them.
pub(crate) fn apply(file: &mut (impl Read + Write + Seek), digits: &str) -> io::Result<bool> {
    let Some((start, _)) = find(file)? else { return Ok(false) };
    file.seek(SeekFrom::Start(start))?;
    file.write_all(digits.as_bytes())?;
    Ok(true)
}

/// The seal in the file at `path`, as 16 hexadecimal digits: it identifies the bytes of a recording as a hash of them does. Reading the
/// recording checks that they are still those that were sealed. `None` without a seal.
///
/// # Errors
/// Those of the operating system.
pub fn seal_of(path: impl AsRef<Path>) -> io::Result<Option<String>> {
    let found = find(&mut open(path.as_ref())?)?;
    Ok(found.and_then(|(_, digits)| String::from_utf8(digits).ok()))
}

/// The same, if the bytes of the file are still those that were sealed.
///
/// # Errors
/// Those of the operating system.
pub fn verified_seal_of(path: impl AsRef<Path>) -> io::Result<Option<String>> {
    let whole = holds(&mut open(path.as_ref())?)? == Some(true);
    if whole { seal_of(path) } else { Ok(None) }
}

fn open(path: &Path) -> io::Result<File> {
    servobench_files::open(path, u64::MAX)
}

/// True if the bytes of the file are those that were sealed; `None` when it has no seal.
pub(crate) fn holds(file: &mut (impl Read + Seek)) -> io::Result<Option<bool>> {
    let Some((start, digits)) = find(file)? else { return Ok(None) };
    Ok(Some(digest(file, start)?.as_bytes() == digits))
}

/// Offset of the digits in the file, and the digits.
fn find(file: &mut (impl Read + Seek)) -> io::Result<Option<(u64, Vec<u8>)>> {
    let len = file.seek(SeekFrom::End(0))?;
    let Some(tail) = len.checked_sub(8) else { return Ok(None) };
    file.seek(SeekFrom::Start(tail))?;
    let mut footer_len = [0; 4];
    file.read_exact(&mut footer_len)?;
    let Some(start) = tail.checked_sub(u32::from_le_bytes(footer_len).into()) else {
        return Ok(None);
    };
    if tail - start > LONGEST_FOOTER {
        return Ok(None);
    }
    file.seek(SeekFrom::Start(start))?;
    let mut footer = Vec::new();
    file.take(tail - start).read_to_end(&mut footer)?;
    let mark = [KEY.as_bytes(), &VALUE_START].concat();
    let at = footer.windows(mark.len() + DIGITS).rposition(|window| window.starts_with(&mark));
    Ok(at.map(|at| at + mark.len()).map(|at| (start + at as u64, footer[at..at + DIGITS].to_vec())))
}

/// Digest of all bytes, the digits that start at `blank` counted as zeros.
fn digest(file: &mut (impl Read + Seek), blank: u64) -> io::Result<String> {
    let mut hash = XxHash64::with_seed(0);
    file.rewind()?;
    hash_all(file.take(blank), &mut hash)?;
    hash.write(BLANK.as_bytes());
    file.seek(SeekFrom::Start(blank + DIGITS as u64))?;
    hash_all(file, &mut hash)?;
    Ok(digits(&hash))
}

fn digits(hash: &XxHash64) -> String {
    format!("{:016x}", hash.finish())
}

fn hash_all(mut source: impl Read, hash: &mut XxHash64) -> io::Result<()> {
    let mut block = vec![0; 1 << 18];
    loop {
        match source.read(&mut block)? {
            0 => return Ok(()),
            count => hash.write(&block[..count]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    /// The shortest possible file: four bytes, a footer with the blank seal, the footer's length and `PAR1`.
    fn unsealed() -> Cursor<Vec<u8>> {
        let footer = [&b"xy"[..], KEY.as_bytes(), &VALUE_START, BLANK.as_bytes(), b"z"].concat();
        let len = u32::try_from(footer.len()).unwrap().to_le_bytes();
        Cursor::new([b"PAR1", &footer[..], &len, b"PAR1"].concat())
    }

    /// Oracle: XXH64 over the file as it was before the digits replaced the zeros.
    #[test]
    fn the_seal_is_the_digest_of_the_file_with_zeros_in_its_place() {
        let mut file = unsealed();
        let expected = format!("{:016x}", XxHash64::oneshot(0, file.get_ref()));
        assert_eq!(holds(&mut file).unwrap(), Some(false));
        let mut hashed = Hashed::new(Vec::new());
        for part in file.get_ref().chunks(7) {
            hashed.write_all(part).unwrap();
        }
        assert_eq!(&hashed.sink, file.get_ref());
        let digits = hashed.digits();
        assert!(apply(&mut file, &digits).unwrap());
        assert!(file.get_ref().windows(16).any(|window| window == expected.as_bytes()));
        assert_eq!(holds(&mut file).unwrap(), Some(true));
    }

    /// The value that the reference implementation (github.com/Cyan4973/xxHash) gives for no bytes.
    #[test]
    fn the_digest_is_xxh64() {
        assert_eq!(XxHash64::oneshot(0, b""), 0xef46_db37_51d8_e999);
    }

    #[test]
    fn one_bit_breaks_it() {
        let mut file = unsealed();
        let digits = format!("{:016x}", XxHash64::oneshot(0, file.get_ref()));
        apply(&mut file, &digits).unwrap();
        for index in 0..file.get_ref().len() {
            file.get_mut()[index] ^= 4;
            assert_ne!(holds(&mut file).unwrap(), Some(true), "byte {index}");
            file.get_mut()[index] ^= 4;
        }
        assert_eq!(holds(&mut file).unwrap(), Some(true));
    }

    #[test]
    fn without_a_place_there_is_no_seal() {
        for bytes in [&b""[..], b"PAR1", &[0xff; 40], &[0; 40]] {
            assert!(!apply(&mut Cursor::new(bytes.to_vec()), BLANK).unwrap());
            assert_eq!(holds(&mut Cursor::new(bytes.to_vec())).unwrap(), None);
        }
    }
}
