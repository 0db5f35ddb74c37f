//! Columns of numbers as pages of a Parquet file.
//!
//! A page holds the bytes of its numbers by significance, all first bytes in front, compressed as an LZ4 block: the bytes that a smooth
//! signal shares from one instant to the next are adjacent, and the rest, which does not compress, is passed over. The library's own
//! writer makes the same bytes, as a test of [`write`](crate::write) shows, and takes longer.
//!
//! Source: Apache Parquet, *File Format*, `PageHeader` in `parquet.thrift`, "Byte Stream Split (`BYTE_STREAM_SPLIT` = 9)";
//! Apache Thrift, *Thrift Compact protocol encoding*.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]

use parquet::basic::{Compression, Encoding, EncodingMask, PageType};
use parquet::errors::{ParquetError, Result as ParquetResult};
use parquet::file::metadata::{ColumnChunkMetaData, PageEncodingStats};
use parquet::file::statistics::{Statistics, ValueStatistics};
use parquet::schema::types::ColumnDescPtr;
use servobench_base::wide_registers;
use std::io::{self, Write};
use std::mem::size_of;

/// Values of a page: the library ends one at the first multiple of 1024 that is more than 20 000.
const PAGE: usize = 20_480;
const WIDTH: usize = size_of::<f64>();
/// Bytes that are collected before they go to the file: while they are hashed they are still in the cache.
const COLLECTED: usize = 1 << 18;
/// Maximum size of a page header (bytes).
const LONGEST_HEADER: usize = 48;
/// Type of a page with values, first version; the encodings of the values, and of the levels, which are absent.
const DATA_PAGE: usize = 0;
const BYTE_STREAM_SPLIT: usize = 9;
const LEVELS: usize = 3;

/// Takes the pages of a file in their order.
pub(crate) struct Pages<W> {
    sink: W,
    /// Bytes not yet written are at the front, `collected` of them; there is room for one page more.
    buffer: Vec<u8>,
    collected: usize,
    written: u64,
    /// The current page, split.
    split: Vec<u8>,
}

impl<W: Write> Pages<W> {
    /// Pages of a file, from the first byte on, which goes to `sink`.
    pub(crate) fn new(sink: W) -> Self {
        let longest = LONGEST_HEADER + lz4_flex::block::get_maximum_output_size(PAGE * WIDTH);
        Self { sink, buffer: vec![0; COLLECTED + longest], collected: 0, written: 0, split: vec![0; PAGE * WIDTH] }
    }

    /// Bytes of the file up to here.
    pub(crate) const fn position(&self) -> u64 {
        self.written + self.collected as u64
    }

    /// Adds `bytes` as they are.
    ///
    /// # Errors
    /// Those of the sink.
    pub(crate) fn add(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.hand_on(0)?;
        self.sink.write_all(bytes)?;
        self.written += bytes.len() as u64;
        Ok(())
    }

    /// Adds the pages of `values`, and returns their metadata for the file's footer; with `range`, their least and largest, positive or
    /// zero.
    ///
    /// # Errors
    /// Those of the sink.
    pub(crate) fn add_column(
        &mut self,
        values: &[f64],
        column: ColumnDescPtr,
        range: Option<[f64; 2]>,
    ) -> ParquetResult<ColumnChunkMetaData> {
        let start = self.position();
        let mut unpacked = 0;
        for page in values.chunks(PAGE) {
            unpacked += self.add_page(page)?;
        }
        let encoding = Encoding::BYTE_STREAM_SPLIT;
        let pages = i32::try_from(values.len().div_ceil(PAGE))?;
        let mut builder = ColumnChunkMetaData::builder(column)
            .set_compression(Compression::LZ4_RAW)
            .set_encodings_mask(EncodingMask::new_from_encodings([encoding, Encoding::RLE].iter()))
            .set_page_encoding_stats(vec![PageEncodingStats { page_type: PageType::DATA_PAGE, encoding, count: pages }])
            .set_total_compressed_size(i64::try_from(self.position() - start)?)
            .set_total_uncompressed_size(i64::try_from(unpacked)?)
            .set_num_values(i64::try_from(values.len())?)
            .set_data_page_offset(i64::try_from(start)?);
        if let Some([least, most]) = range {
            // A reader may take either zero for the other: the format requires the lower one as the least.
            let least = if least == 0.0 { -0.0 } else { least };
            let range = ValueStatistics::new(Some(least), Some(most), None, Some(0), false);
            builder = builder.set_statistics(Statistics::from(range.with_backwards_compatible_min_max(true)));
        }
        builder.build()
    }

    /// Adds a page, and returns its uncompressed size in bytes.
    fn add_page(&mut self, values: &[f64]) -> ParquetResult<usize> {
        let split = &mut self.split[..values.len() * WIDTH];
        split_by_significance(values, split);
        // Behind a header of the most probable length.
        let start = self.collected + header(split.len(), split.len() / 2, values.len()).len();
        let packed = lz4_flex::block::compress_into(split, &mut self.buffer[start..])
            .map_err(|error| ParquetError::General(error.to_string()))?;
        let header = header(split.len(), packed, values.len());
        let (unpacked, begin) = (header.len() + split.len(), self.collected + header.len());
        if begin != start {
            self.buffer.copy_within(start..start + packed, begin);
        }
        self.buffer[self.collected..begin].copy_from_slice(&header);
        self.collected = begin + packed;
        self.hand_on(COLLECTED)?;
        Ok(unpacked)
    }

    /// Writes the collected bytes to the sink, if there are `enough`.
    fn hand_on(&mut self, enough: usize) -> io::Result<()> {
        if self.collected >= enough {
            self.sink.write_all(&self.buffer[..self.collected])?;
            self.written += self.collected as u64;
            self.collected = 0;
        }
        Ok(())
    }

    /// The sink, to which everything was written.
    ///
    /// # Errors
    /// Those of the sink.
    pub(crate) fn finish(mut self) -> io::Result<W> {
        self.hand_on(0)?;
        self.sink.flush()?;
        Ok(self.sink)
    }
}

/// The header of a page of `values` numbers that has `packed` bytes and unpacks to `unpacked`.
pub(crate) fn header(unpacked: usize, packed: usize, values: usize) -> Vec<u8> {
    // The type of a field and its distance to the one before: fields 1, 2, 3 and 5 of the page, 1 to 4 of its data page header.
    const INTEGER: u8 = 0x15;
    const OF_VALUES: u8 = 0x2c;
    const END: u8 = 0;
    let mut bytes = Vec::with_capacity(LONGEST_HEADER);
    let integer = |bytes: &mut Vec<u8>, value: usize| {
        bytes.push(INTEGER);
        let mut zigzag = value << 1;
        while zigzag > 0x7f {
            bytes.push(zigzag.to_le_bytes()[0] | 0x80);
            zigzag >>= 7;
        }
        bytes.push(zigzag.to_le_bytes()[0]);
    };
    for value in [DATA_PAGE, unpacked, packed] {
        integer(&mut bytes, value);
    }
    bytes.push(OF_VALUES);
    for value in [values, BYTE_STREAM_SPLIT, LEVELS, LEVELS] {
        integer(&mut bytes, value);
    }
    bytes.extend([END, END]);
    bytes
}

/// Puts the first bytes of all `values` at the front of `split`, then all second ones, and so on.
fn split_by_significance(values: &[f64], split: &mut [u8]) {
    wide_registers!(split_in_any(values, split), split_in_wide_registers, values, split);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn split_in_wide_registers(values: &[f64], split: &mut [u8]) {
    split_in_any(values, split);
}

#[inline(always)]
fn split_in_any(values: &[f64], split: &mut [u8]) {
    let (blocks, rest) = values.as_chunks::<BLOCK>();
    for (block, at) in blocks.iter().zip((0..).step_by(BLOCK)) {
        for (row, split) in transposed(block).iter().zip(split.chunks_exact_mut(values.len())) {
            for (eight, split) in row.iter().zip(split[at..].as_chunks_mut::<WIDTH>().0) {
                *split = eight.to_le_bytes();
            }
        }
    }
    for (value, at) in rest.iter().zip(blocks.len() * BLOCK..) {
        for (byte, split) in value.to_le_bytes().into_iter().zip(split.chunks_exact_mut(values.len())) {
            split[at] = byte;
        }
    }
}

/// Squares of eight by eight bytes that are transposed side by side.
const SQUARES: usize = 4;
const BLOCK: usize = SQUARES * WIDTH;

/// In row k byte k of all values, eight in each number. A square is transposed by swapping its corners, then those of each quarter, then
/// single bytes.
#[inline(always)]
fn transposed(values: &[f64; BLOCK]) -> [[u64; SQUARES]; WIDTH] {
    let mut rows: [[u64; SQUARES]; WIDTH] =
        std::array::from_fn(|row| std::array::from_fn(|square| values[square * WIDTH + row].to_bits()));
    for (distance, low) in [(4, 0x0000_0000_ffff_ffff), (2, 0x0000_ffff_0000_ffff), (1, 0x00ff_00ff_00ff_00ff_u64)] {
        let shift = 8 * distance;
        for row in (0..WIDTH).filter(|row| row & distance == 0) {
            let (above, below) = rows.split_at_mut(row + distance);
            for (above, below) in above[row].iter_mut().zip(&mut below[0]) {
                let (one, two) = (*above, *below);
                *above = one & low | (two & low) << shift;
                *below = one >> shift & low | two & !low;
            }
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: byte k of value i stands at place i of part k.
    #[test]
    fn bytes_are_sorted_by_significance() {
        let mut random = servobench_testkit::Random::seeded(19);
        for count in [0, 1, 31, 32, 33, 160, 1001] {
            let values: Vec<f64> = (0..count).map(|_| random.signed()).collect();
            let (mut split, mut in_any) = (vec![0; count * WIDTH], vec![0; count * WIDTH]);
            split_by_significance(&values, &mut split);
            split_in_any(&values, &mut in_any);
            assert_eq!(split, in_any);
            for (i, value) in values.iter().enumerate() {
                for (k, byte) in value.to_le_bytes().into_iter().enumerate() {
                    assert_eq!(split[k * count + i], byte, "byte {k} of value {i} of {count}");
                }
            }
        }
    }
}
