//! The values of a channel, which move from memory to disk if there are many: a run of ten minutes has two gigabytes.
//!
//! What is more than [`IN_MEMORY`] goes to a file, block by block, and when all is there the file is mapped: what nobody looks at takes no
//! memory, and the system takes back what was looked at and [`released`](Values::release). The file has no name. It is gone when the
//! process is, whatever ends it.
use servobench_files::{MappedFile, UnnamedFile, is_too_many_open};
use std::fmt::{self, Debug};
use std::io;
use std::ops::Deref;
use std::path::PathBuf;
use std::sync::Arc;

/// Maximum number of values of a channel in memory: 4 MiB, half a minute at 16 kHz.
pub const IN_MEMORY: usize = 1 << 19;
/// Values that are collected before they go to the file.
const BLOCK: usize = 1 << 15;
const WIDTH: u64 = size_of::<f64>() as u64;

/// The values of a channel, one per recorded instant: a slice, in memory or in a file.
#[derive(Clone)]
pub struct Values(Place);

#[derive(Clone)]
enum Place {
    Memory(Vec<f64>),
    File(Arc<MappedFile>),
}

impl Values {
    /// True if they are in a file.
    #[must_use]
    pub const fn are_in_a_file(&self) -> bool {
        matches!(self.0, Place::File(_))
    }

    /// The values for changes, all of them in memory.
    pub fn to_mut(&mut self) -> &mut Vec<f64> {
        if let Place::File(_) = &self.0 {
            self.0 = Place::Memory(self.to_vec());
        }
        match &mut self.0 {
            Place::Memory(values) => values,
            Place::File(_) => unreachable!("they were moved to memory"),
        }
    }

    /// Frees the memory of values of a file that were read. They can be read again; nothing is lost.
    pub fn release(&self) {
        if let Place::File(map) = &self.0 {
            map.release();
        }
    }
}

impl Deref for Values {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        match &self.0 {
            Place::Memory(values) => values,
            Place::File(map) => bytemuck::cast_slice(map),
        }
    }
}

impl Default for Values {
    fn default() -> Self {
        Vec::new().into()
    }
}

impl From<Vec<f64>> for Values {
    fn from(values: Vec<f64>) -> Self {
        Self(Place::Memory(values))
    }
}

impl FromIterator<f64> for Values {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        Vec::from_iter(values).into()
    }
}

impl<'a> IntoIterator for &'a Values {
    type Item = &'a f64;
    type IntoIter = std::slice::Iter<'a, f64>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl PartialEq for Values {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl Debug for Values {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        (**self).fmt(f)
    }
}

/// [`Values`] that are still growing.
#[derive(Debug)]
pub struct GrowingValues {
    /// The last values.
    tail: Vec<f64>,
    /// Maximum number of them before they go to the file.
    most: usize,
    /// Those before the tail, `written` of them.
    file: Option<UnnamedFile>,
    written: usize,
}

impl GrowingValues {
    /// Empty, with room for `count`; more is possible.
    #[must_use]
    pub fn with_room(count: usize) -> Self {
        let most = if count > IN_MEMORY { BLOCK } else { IN_MEMORY };
        Self { tail: Vec::with_capacity(count.min(most)), most, file: None, written: 0 }
    }

    /// Number of values.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.written + self.tail.len()
    }

    /// True without values.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Appends `values`.
    ///
    /// # Errors
    /// Those of the file: the disk is full. Then values that had not reached the file are lost.
    #[inline]
    pub fn extend(&mut self, values: &[f64]) -> io::Result<()> {
        self.tail.extend_from_slice(values);
        if self.tail.len() > self.most { self.write_tail() } else { Ok(()) }
    }

    /// Appends `values`, which may be many.
    ///
    /// # Errors
    /// As [`extend`](Self::extend).
    pub fn extend_from(&mut self, mut values: impl Iterator<Item = f64>) -> io::Result<()> {
        loop {
            let (before, room) = (self.tail.len(), self.most.saturating_sub(self.tail.len()) + 1);
            self.tail.extend(values.by_ref().take(room));
            if self.tail.len() == before {
                return Ok(());
            }
            self.extend(&[])?;
        }
    }

    /// Drops the values from `count` on.
    pub fn truncate(&mut self, count: usize) {
        self.tail.truncate(count.saturating_sub(self.written));
        self.written = self.written.min(count);
    }

    /// Writes all of them to the file, if there is one.
    ///
    /// # Errors
    /// As [`extend`](Self::extend).
    pub(crate) fn settle(&mut self) -> io::Result<()> {
        if self.written > 0 && !self.tail.is_empty() { self.write_tail() } else { Ok(()) }
    }

    /// Moves the tail to the file. What cannot be written is lost.
    fn write_tail(&mut self) -> io::Result<()> {
        let done = self.append();
        self.written += if done.is_ok() { self.tail.len() } else { 0 };
        if self.most > BLOCK {
            (self.tail, self.most) = (Vec::with_capacity(BLOCK), BLOCK);
        }
        self.tail.clear();
        done
    }

    fn append(&mut self) -> io::Result<()> {
        let folder = folder();
        let written = match &mut self.file {
            Some(file) => Ok(file),
            none => UnnamedFile::new_in(&folder).map(|file| none.insert(file)),
        }
        .and_then(|file| file.write_at(self.written as u64 * WIDTH, bytemuck::cast_slice(&self.tail)));
        let named = |error: io::Error| {
            let what_to_do = if is_too_many_open(&error) {
                "allow more open files (`ulimit -n`), or make fewer runs at once"
            } else {
                "name a folder with more room by TMPDIR"
            };
            io::Error::new(error.kind(), format!("{error}, in `{}`; {what_to_do}", folder.display()))
        };
        written.map_err(named)
    }

    /// All values.
    ///
    /// # Errors
    /// Those of the file.
    pub fn finish(mut self) -> io::Result<Values> {
        if self.written == 0 {
            return Ok(self.tail.into());
        }
        self.settle()?;
        let Some(file) = self.file else { return Ok(Values::default()) };
        let map = file.map(self.written as u64 * WIDTH)?;
        Ok(Values(Place::File(Arc::new(map))))
    }
}

/// Where files go that may be large: `TMPDIR`; without it `/var/tmp`, which unlike `/tmp` is on a disk everywhere.
fn folder() -> PathBuf {
    let spacious = PathBuf::from("/var/tmp");
    if std::env::var_os("TMPDIR").is_none() && spacious.is_dir() { spacious } else { std::env::temp_dir() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Not a multiple of a block.
    const PORTION: usize = 1009;

    fn grown(room: usize, count: usize) -> GrowingValues {
        let mut growing = GrowingValues::with_room(room);
        let values: Vec<f64> = (0..count).map(|k| k as f64 + 0.25).collect();
        for portion in values.chunks(PORTION) {
            growing.extend(portion).unwrap();
        }
        assert_eq!((growing.len(), growing.is_empty()), (count, count == 0));
        growing
    }

    fn is_right(values: &Values, count: usize) -> bool {
        values.len() == count
            && values.iter().enumerate().all(|(k, value)| value.to_bits() == (k as f64 + 0.25).to_bits())
    }

    /// With the required room, with too little, and with too much.
    #[test]
    fn few_stay_in_memory_and_many_go_to_a_file() {
        for (room, count, in_a_file) in [
            (0, 0, false),
            (10, 10, false),
            (10, IN_MEMORY, false),
            (10, IN_MEMORY + 1, true),
            (10, 3 * IN_MEMORY + 7, true),
            (IN_MEMORY, IN_MEMORY, false),
            (IN_MEMORY + 1, IN_MEMORY + 1, true),
            (3 * IN_MEMORY, BLOCK, false),
            (3 * IN_MEMORY, BLOCK + 1, true),
        ] {
            let values = grown(room, count).finish().unwrap();
            assert_eq!(values.are_in_a_file(), in_a_file, "{count} in room for {room}");
            assert!(is_right(&values, count), "{count} in room for {room}");
            values.release();
            assert!(is_right(&values.clone(), count), "{count} in room for {room}, released");
        }
    }

    #[test]
    fn what_was_dropped_is_replaced() {
        for kept in [0, 5, BLOCK - 1, BLOCK, BLOCK + 1, 2 * IN_MEMORY + 3] {
            for room in [0, 3 * IN_MEMORY] {
                let mut growing = grown(room, 2 * IN_MEMORY + 99);
                growing.truncate(kept);
                assert_eq!(growing.len(), kept);
                growing.extend_from((kept..kept + 3 * BLOCK).map(|k| k as f64 + 0.25)).unwrap();
                assert!(is_right(&growing.finish().unwrap(), kept + 3 * BLOCK), "{kept} kept");
                let mut growing = grown(room, 2 * IN_MEMORY + 99);
                growing.truncate(kept);
                assert!(is_right(&growing.finish().unwrap(), kept), "{kept} kept, and no more");
            }
        }
    }

    #[test]
    fn values_are_equal_wherever_they_are() {
        let in_a_file = grown(IN_MEMORY + 1, IN_MEMORY + 1).finish().unwrap();
        let in_memory: Values = in_a_file.iter().copied().collect();
        assert!(in_a_file.are_in_a_file() && !in_memory.are_in_a_file() && in_a_file == in_memory);
        assert_eq!(format!("{:?}", Values::from(vec![0.5, f64::NAN])), "[0.5, NaN]");
        assert_ne!(Values::from(vec![f64::NAN]), Values::from(vec![f64::NAN]));
    }
}
