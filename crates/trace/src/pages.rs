//! Checks of the pages of a column, from their headers: as many values as the file promises, each with its eight bytes.
//!
//! A page of a foreign file may stand for a thousand million values by a few bytes (a dictionary and one run), or claim any unpacked
//! size; the decoder trusts it. Our writer makes neither: each page has its own values, and a bounded size. That is
//! checked before anything is decoded, so that nothing is allocated that the file does not hold.
//!
//! Source: Apache Parquet, *File Format*, `PageHeader` in `parquet.thrift`; Apache Thrift, *Thrift Compact protocol encoding*.
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::ops::Range;

/// Maximum size of a page header (bytes): without statistics it has some thirty.
const LONGEST_HEADER: usize = 1024;
/// Maximum unpacked size of a page (bytes); the writer ends one at 20 480 values.
const LARGEST_PAGE: u64 = 8 << 20;
/// Type of a page with values, first version.
const DATA_PAGE: i64 = 0;
/// Encoding in which the bytes of equal significance are adjacent.
const BYTE_STREAM_SPLIT: i64 = 9;
const PLAIN: i64 = 0;

/// Reason why pages are not decoded.
pub(crate) type Refusal = String;

/// Checks the pages in `place`, those of one chunk of a column, which must have `values` values.
///
/// # Errors
/// Those of the operating system; the inner error is the mistake in the pages.
pub(crate) fn check(file: &mut File, place: Range<u64>, values: u64) -> io::Result<Result<(), Refusal>> {
    let (mut at, mut found) = (place.start, 0_u64);
    while at < place.end {
        file.seek(SeekFrom::Start(at))?;
        let mut bytes = Vec::with_capacity(LONGEST_HEADER);
        file.take((place.end - at).min(LONGEST_HEADER as u64)).read_to_end(&mut bytes)?;
        let Some((page, length)) = Page::read(&bytes) else { return Ok(Err("a page has no header".into())) };
        match page.values() {
            Ok(count) => found = found.saturating_add(count),
            Err(why) => return Ok(Err(why)),
        }
        at = at.saturating_add(length as u64).saturating_add(page.packed.unsigned_abs());
    }
    Ok(if at != place.end {
        Err("a page is longer than its column".into())
    } else if found != values {
        Err(format!("its pages have {found} values, {values} are promised"))
    } else {
        Ok(())
    })
}

/// Header of a page.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct Page {
    kind: i64,
    unpacked: i64,
    packed: i64,
    values: i64,
    encoding: i64,
}

impl Page {
    /// The header at the beginning of `bytes`, and its length.
    fn read(bytes: &[u8]) -> Option<(Self, usize)> {
        let mut reader = Reader { bytes, at: 0 };
        let mut page = Self { kind: -1, ..Self::default() };
        reader.fields(&mut |field, kind, reader| match (field, kind) {
            (1, INTEGER) => reader.integer().map(|value| page.kind = value),
            (2, INTEGER) => reader.integer().map(|value| page.unpacked = value),
            (3, INTEGER) => reader.integer().map(|value| page.packed = value),
            (5, STRUCT) => reader.fields(&mut |field, kind, reader| match (field, kind) {
                (1, INTEGER) => reader.integer().map(|value| page.values = value),
                (2, INTEGER) => reader.integer().map(|value| page.encoding = value),
                _ => reader.skip(kind, 0),
            }),
            _ => reader.skip(kind, 0),
        })?;
        Some((page, reader.at))
    }

    /// Number of its values.
    fn values(self) -> Result<u64, Refusal> {
        let Self { kind, unpacked, packed, values, encoding } = self;
        let size = u64::try_from(unpacked).ok().filter(|size| *size <= LARGEST_PAGE);
        let (Some(size), Ok(values), 0..) = (size, u64::try_from(values), packed) else {
            return Err(format!("a page of it unpacks to {unpacked} bytes, at most {LARGEST_PAGE} are written"));
        };
        if kind != DATA_PAGE || !(encoding == BYTE_STREAM_SPLIT || encoding == PLAIN) {
            return Err("a page of it is in a form that is not written here".into());
        }
        if size != values.saturating_mul(size_of::<f64>() as u64) {
            return Err(format!("a page of it has {values} values in {size} bytes"));
        }
        Ok(values)
    }
}

const TRUE: u8 = 1;
const FALSE: u8 = 2;
const BYTE: u8 = 3;
const SHORT: u8 = 4;
const INTEGER: u8 = 5;
const LONG: u8 = 6;
const DOUBLE: u8 = 7;
const BINARY: u8 = 8;
const LIST: u8 = 9;
const SET: u8 = 10;
const STRUCT: u8 = 12;

/// Structs in structs: the header of a page has three.
const DEEPEST: u32 = 8;

/// Reader of Thrift's compact protocol, as far as needed to find the end of a header.
struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Reader<'_> {
    fn byte(&mut self) -> Option<u8> {
        let byte = *self.bytes.get(self.at)?;
        self.at += 1;
        Some(byte)
    }

    fn unsigned(&mut self) -> Option<u64> {
        let mut value = 0_u64;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            value |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Some(value);
            }
        }
        None
    }

    /// A zigzag number.
    fn integer(&mut self) -> Option<i64> {
        let value = self.unsigned()?;
        Some((value >> 1).cast_signed() ^ -((value & 1).cast_signed()))
    }

    /// Passes every field of a struct, by its number and kind, to `take`, which reads it.
    fn fields(&mut self, take: &mut dyn FnMut(i64, u8, &mut Self) -> Option<()>) -> Option<()> {
        let mut field = 0_i64;
        loop {
            let byte = self.byte()?;
            if byte == 0 {
                return Some(());
            }
            let (step, kind) = (byte >> 4, byte & 0x0f);
            field = if step == 0 { self.integer()? } else { field.checked_add(i64::from(step))? };
            take(field, kind, self)?;
        }
    }

    fn skip(&mut self, kind: u8, depth: u32) -> Option<()> {
        if depth > DEEPEST {
            return None;
        }
        match kind {
            TRUE | FALSE => Some(()),
            BYTE => self.byte().map(drop),
            SHORT | INTEGER | LONG => self.unsigned().map(drop),
            DOUBLE => self.jump(8),
            BINARY => {
                let length = self.unsigned()?;
                self.jump(length)
            }
            LIST | SET => {
                let byte = self.byte()?;
                let count = if byte >> 4 == 15 { self.unsigned()? } else { u64::from(byte >> 4) };
                // Each element has a byte at least, except for those that the type contains already.
                let element = if matches!(byte & 0x0f, TRUE | FALSE) { BYTE } else { byte & 0x0f };
                (0..count).try_for_each(|_| self.skip(element, depth + 1))
            }
            STRUCT => self.fields(&mut |_, kind, reader| reader.skip(kind, depth + 1)),
            _ => None,
        }
    }

    fn jump(&mut self, bytes: u64) -> Option<()> {
        let at = self.at.checked_add(usize::try_from(bytes).ok()?)?;
        self.at = at;
        (at <= self.bytes.len()).then_some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write as _;

    /// A header in the compact protocol: type, sizes, and a data page header with levels by run lengths.
    fn header(kind: u8, [unpacked, packed, values]: [i64; 3], encoding: u8) -> Vec<u8> {
        let integer = |value: i64| {
            let mut zigzag = ((value << 1) ^ (value >> 63)).cast_unsigned();
            let mut bytes = vec![0x15];
            while zigzag > 0x7f {
                bytes.push(zigzag.to_le_bytes()[0] | 0x80);
                zigzag >>= 7;
            }
            bytes.push(zigzag.to_le_bytes()[0]);
            bytes
        };
        let of = |value: u8| integer(i64::from(value));
        let inner = [integer(values), of(encoding), of(3), of(3), vec![0]].concat();
        [of(kind), integer(unpacked), integer(packed), vec![0x2c], inner, vec![0]].concat()
    }

    fn refusal(pages: &[(Vec<u8>, usize)], values: u64) -> Option<String> {
        let mut file = tempfile::tempfile().unwrap();
        for (header, packed) in pages {
            file.write_all(header).unwrap();
            file.write_all(&vec![0x55; *packed]).unwrap();
        }
        let end = file.stream_position().unwrap();
        check(&mut file, 0..end, values).unwrap().err()
    }

    #[test]
    fn pages_that_hold_what_they_say_are_taken() {
        let page = || (header(0, [80, 20, 10], 9), 20);
        assert_eq!(refusal(&[page(), page()], 20), None);
        assert_eq!(refusal(&[page()], 20).unwrap(), "its pages have 10 values, 20 are promised");
    }

    #[test]
    fn pages_that_stand_for_more_are_refused() {
        let of = |header: Vec<u8>| refusal(&[(header, 20)], 1 << 30).unwrap();
        assert!(of(header(0, [20, 20, 1 << 30], 8)).contains("a form that is not written"), "a dictionary's indices");
        assert!(of(header(2, [8, 20, 1], 0)).contains("a form that is not written"), "a dictionary");
        assert!(of(header(0, [20, 20, 1 << 30], 9)).contains("1073741824 values in 20 bytes"));
        assert!(of(header(0, [1 << 31, 20, 1 << 28], 9)).contains("at most 8388608"));
        assert!(of(header(0, [80, 21, 10], 9)).contains("longer than its column"));
        assert!(of(header(0, [80, -21, 10], 9)).contains("unpacks to 80 bytes"));
        assert!(of(vec![0xff; 20]).contains("no header"));
    }
}
