//! Names that occur in an archive more than once.
//!
//! Other readers take the first or the last of them, so the entry that was checked and the one in use could differ. With the same bytes
//! it makes no difference: packing tools write such archives.
//!
//! Source: PKWARE, *.ZIP File Format Specification*, 6.3.10, §4.3.7 (local header), §4.3.12 (directory).
use crate::error::ArchiveProblem;
use std::collections::HashMap;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};

const RECORD: [u8; 4] = *b"PK\x01\x02";
const LOCAL: [u8; 4] = *b"PK\x03\x04";
/// Bytes of a directory record and of a local header, without their parts of variable length.
const RECORD_BYTES: usize = 46;
const LOCAL_BYTES: usize = 30;
/// Bytes compared at once.
const CHUNK: usize = 1 << 16;

/// Fields of a directory record that affect the unpacked file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Entry {
    /// General purpose bits, such as encryption.
    flags: [u8; 2],
    /// Compression method.
    method: [u8; 2],
    crc: [u8; 4],
    /// Bytes of its data in the archive.
    packed: u32,
    size: [u8; 4],
    /// File type and permissions.
    attributes: [u8; 4],
    /// Position of its local header, before the offset of the archive in its file.
    at: u32,
}

/// Names that occur in the directory more than once with the same bytes, each with its count. The directory begins at `start` in a `file`
/// of `bytes`; local headers lie `offset` behind their stated positions.
///
/// # Errors
/// [`ArchiveProblem`] for a name with different bytes.
pub(super) fn same_twice(
    file: &mut File,
    (start, offset): (u64, u64),
    bytes: u64,
) -> Result<Vec<(String, usize)>, ArchiveProblem> {
    let unreadable = |error: io::Error| ArchiveProblem::Zip(error.to_string());
    let mut known: HashMap<Vec<u8>, (Entry, usize)> = HashMap::new();
    // No archive holds more than itself: comparing entries that share their data could take for ever.
    let mut left = bytes;
    for (name, entry) in entries(file, start).map_err(unreadable)? {
        let Some((first, count)) = known.get_mut(&name) else {
            known.insert(name, (entry, 1));
            continue;
        };
        let is_same = Entry { at: first.at, ..entry } == *first
            && (first.at == entry.at || {
                left = left.checked_sub(entry.packed.into()).ok_or_else(|| different(&name))?;
                let [one, other] = [first.at, entry.at].map(|at| offset + u64::from(at));
                are_equal(file, one, other, entry.packed.into()).map_err(unreadable)?
            });
        if !is_same {
            return Err(different(&name));
        }
        *count += 1;
    }
    let mut twice: Vec<_> = known.into_iter().filter(|(_, (_, count))| *count > 1).map(named).collect();
    twice.sort();
    Ok(twice)
}

fn named((name, (_, count)): (Vec<u8>, (Entry, usize))) -> (String, usize) {
    (escaped(&name), count)
}

fn escaped(name: &[u8]) -> String {
    String::from_utf8_lossy(name).escape_debug().to_string()
}

fn different(name: &[u8]) -> ArchiveProblem {
    ArchiveProblem::Name { entry: escaped(name), why: "is there twice, and not with the same bytes" }
}

/// All records of the directory.
fn entries(file: &mut File, start: u64) -> io::Result<Vec<(Vec<u8>, Entry)>> {
    file.seek(SeekFrom::Start(start))?;
    let mut reader = io::BufReader::new(file);
    let mut all = Vec::new();
    loop {
        let mut record = [0; RECORD_BYTES];
        // The directory is followed by another record, of at least 22 bytes.
        reader.read_exact(&mut record[..4])?;
        if record[..4] != RECORD {
            return Ok(all);
        }
        reader.read_exact(&mut record[4..])?;
        let short = |at: usize| u64::from(u16::from_le_bytes([record[at], record[at + 1]]));
        let long = |at: usize| [record[at], record[at + 1], record[at + 2], record[at + 3]];
        let mut name = Vec::new();
        reader.by_ref().take(short(28)).read_to_end(&mut name)?;
        io::copy(&mut reader.by_ref().take(short(30) + short(32)), &mut io::sink())?;
        let entry = Entry {
            flags: [record[8], record[9]],
            method: [record[10], record[11]],
            crc: long(16),
            packed: u32::from_le_bytes(long(20)),
            size: long(24),
            attributes: long(38),
            at: u32::from_le_bytes(long(42)),
        };
        all.push((name, entry));
    }
}

/// True if the data of two entries, given by their local headers, are equal.
fn are_equal(file: &mut File, one: u64, other: u64, length: u64) -> io::Result<bool> {
    let starts = [data(file, one)?, data(file, other)?];
    let (mut chunks, mut done) = ([vec![0; CHUNK], vec![0; CHUNK]], 0);
    while done < length {
        let count = usize::try_from(length - done).unwrap_or(CHUNK).min(CHUNK);
        for (chunk, start) in chunks.iter_mut().zip(starts) {
            file.seek(SeekFrom::Start(start + done))?;
            file.read_exact(&mut chunk[..count])?;
        }
        if chunks[0][..count] != chunks[1][..count] {
            return Ok(false);
        }
        done += count as u64;
    }
    Ok(true)
}

/// Start of the data behind a local header.
fn data(file: &mut File, header: u64) -> io::Result<u64> {
    let mut local = [0; LOCAL_BYTES];
    file.seek(SeekFrom::Start(header))?;
    file.read_exact(&mut local)?;
    if local[..4] != LOCAL {
        return Err(io::Error::new(io::ErrorKind::InvalidData, "an entry of the directory leads nowhere"));
    }
    let short = |at: usize| u64::from(u16::from_le_bytes([local[at], local[at + 1]]));
    Ok(header + LOCAL_BYTES as u64 + short(26) + short(28))
}
