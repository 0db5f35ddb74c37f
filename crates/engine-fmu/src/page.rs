#![expect(unsafe_code, reason = "memory that is shared with another process is seen as atomics")]
//! The memory that both processes share.
//!
//! ```text
//! header       the doorbells, the command and the answer, each with its writer: see `Header`
//! inputs       of each: value, first and second derivative (f64)
//! outputs      (f64)
//! message      bytes of an answer that is more than numbers
//! log          lines of JSON that have not been taken yet
//! setup        bytes of the host's request to load
//! ```
//! All of it is atomic: whatever the FMU does to it can only produce wrong numbers. Lengths are kept by the parent; those that come from
//! the other side are limited to what there is.
use servobench_isolation::{Doorbell, MemoryFile, SharedMemory};
use std::sync::atomic::{
    AtomicU8, AtomicU32, AtomicU64,
    Ordering::{AcqRel, Acquire, Relaxed},
};
use std::{io, slice};

/// Marks a page of this layout.
const MAGIC: u64 = u64::from_le_bytes(*b"servofm2");
/// Bytes of an answer that is more than numbers.
const MESSAGE: usize = 1 << 16;
/// Bytes of log between two readings.
const LOG: usize = 1 << 18;

/// The part before the values; a cache line for each side and purpose.
#[repr(C, align(64))]
#[derive(Debug)]
pub(crate) struct Header {
    /// Rings for a command, with its number.
    pub(crate) order: Doorbell,
    /// Rings for an answer, with the number of the command.
    pub(crate) answer: Doorbell,
    told: Told,
    pub(crate) asked: Asked,
    pub(crate) answered: Answered,
}

/// Constant part.
#[repr(C, align(64))]
#[derive(Debug)]
pub(crate) struct Told {
    magic: AtomicU64,
    inputs: AtomicU32,
    outputs: AtomicU32,
    setup: AtomicU32,
}

/// The parent's command.
#[repr(C, align(64))]
#[derive(Debug)]
pub(crate) struct Asked {
    /// One of [`Command`](crate::protocol::Command).
    pub(crate) command: AtomicU32,
    /// Start of a step (s, bits of an f64).
    pub(crate) time: AtomicU64,
    /// Length of a step (s, bits of an f64).
    pub(crate) length: AtomicU64,
}

/// The host's answer.
#[repr(C, align(64))]
#[derive(Debug)]
pub(crate) struct Answered {
    /// One of [`Status`](crate::protocol::Status).
    pub(crate) status: AtomicU32,
    /// Not zero if the outputs are those after the step.
    pub(crate) fresh: AtomicU32,
    /// Bytes of the message.
    message: AtomicU32,
    /// Bytes of log.
    log: AtomicU32,
    /// Lines of the log dropped for lack of room.
    pub(crate) log_dropped: AtomicU32,
    /// Time that a step reached (s, bits of an f64).
    pub(crate) reached: AtomicU64,
    /// Name of the function in progress, padded with zeros.
    call: [AtomicU64; CALL / 8],
}

/// Bytes of a function's name; the longest of the standard has 27.
const CALL: usize = 32;

impl Answered {
    /// Records the function that is called; an empty name on return.
    pub(crate) fn note_call(&self, name: &str) {
        let mut bytes = [0; CALL];
        let length = name.len().min(CALL);
        bytes[..length].copy_from_slice(&name.as_bytes()[..length]);
        // An empty name is one word.
        let words = if name.is_empty() { 1 } else { self.call.len() };
        for (word, bytes) in self.call.iter().zip(bytes.chunks_exact(8)).take(words) {
            word.store(bytes.iter().rev().fold(0, |word, byte| word << 8 | u64::from(*byte)), Relaxed);
        }
    }

    /// The function in progress; empty if there is none or the bytes are not a name.
    pub(crate) fn call(&self) -> String {
        let words = self.call.iter().map(|word| word.load(Relaxed).to_le_bytes());
        let bytes: Vec<u8> = words.flatten().take_while(|byte| *byte != 0).collect();
        String::from_utf8(bytes)
            .ok()
            .filter(|name| name.bytes().all(|byte| byte.is_ascii_alphanumeric()))
            .unwrap_or_default()
    }
}

/// Sizes of the parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Layout {
    inputs: usize,
    outputs: usize,
    setup: usize,
}

impl Layout {
    /// Number of values: three for each input, one for each output.
    fn numbers(self) -> usize {
        3 * self.inputs + self.outputs
    }

    fn bytes(self) -> usize {
        MESSAGE + LOG + self.setup
    }

    fn total(self) -> usize {
        size_of::<Header>() + 8 * self.numbers() + self.bytes()
    }
}

/// Shared memory of this layout.
#[derive(Debug)]
pub(crate) struct Page {
    /// As long as the layout.
    memory: SharedMemory,
    layout: Layout,
}

impl Page {
    /// A page of the parent, and its file for the host.
    pub(crate) fn new(inputs: usize, outputs: usize, setup: &[u8]) -> io::Result<(Self, MemoryFile)> {
        let layout = Layout { inputs, outputs, setup: setup.len() };
        let as_u32 = |count: usize| u32::try_from(count).map_err(|_| io::Error::from(io::ErrorKind::FileTooLarge));
        let (inputs, outputs, setup_bytes) = (as_u32(inputs)?, as_u32(outputs)?, as_u32(setup.len())?);
        let (file, memory) = MemoryFile::new(c"servobench-fmu", layout.total())?;
        let page = Self { memory, layout };
        let told = &page.header().told;
        told.inputs.store(inputs, Relaxed);
        told.outputs.store(outputs, Relaxed);
        told.setup.store(setup_bytes, Relaxed);
        told.magic.store(MAGIC, Relaxed);
        write(page.bytes(MESSAGE + LOG, setup.len()), setup);
        Ok((page, file))
    }

    /// The page in a file made by the parent; `None` for another kind of file.
    ///
    /// Processes forked by the FMU do not inherit it: only one answers.
    pub(crate) fn adopt(file: &MemoryFile) -> io::Result<Option<Self>> {
        let empty = Layout { inputs: 0, outputs: 0, setup: 0 };
        let Some(memory) = file.adopt(empty.total())? else { return Ok(None) };
        let mut page = Self { memory, layout: empty };
        let told = &page.header().told;
        let count = |word: &AtomicU32| word.load(Relaxed) as usize;
        let layout = Layout { inputs: count(&told.inputs), outputs: count(&told.outputs), setup: count(&told.setup) };
        if told.magic.load(Relaxed) != MAGIC || layout.total() != page.memory.length() {
            return Ok(None);
        }
        page.layout = layout;
        Ok(Some(page))
    }

    #[inline]
    fn base(&self) -> *const Header {
        self.memory.start().as_ptr().cast_const().cast()
    }

    pub(crate) fn header(&self) -> &Header {
        // SAFETY: the mapping is at least a header long, aligned to memory pages, lives as long as `self`, and every bit
        // pattern is a header of atomics.
        unsafe { &*self.base() }
    }

    fn numbers(&self) -> &[AtomicU64] {
        // SAFETY: they follow the header, whose size is a multiple of their alignment; as in `header`.
        unsafe { slice::from_raw_parts(self.base().add(1).cast(), self.layout.numbers()) }
    }

    fn bytes(&self, first: usize, count: usize) -> &[AtomicU8] {
        // SAFETY: they follow the numbers; as in `header`.
        let all: &[AtomicU8] = unsafe {
            let numbers: *const AtomicU64 = self.base().add(1).cast();
            slice::from_raw_parts(numbers.add(self.layout.numbers()).cast(), self.layout.bytes())
        };
        &all[first..first + count]
    }

    /// True if the constant part is unchanged: an FMU with wild pointers may have written anywhere.
    pub(crate) fn intact(&self) -> bool {
        self.header().told.magic.load(Relaxed) == MAGIC
    }

    /// Value, first and second derivative of each input.
    pub(crate) fn inputs(&self) -> &[AtomicU64] {
        &self.numbers()[..3 * self.layout.inputs]
    }

    pub(crate) fn outputs(&self) -> &[AtomicU64] {
        &self.numbers()[3 * self.layout.inputs..]
    }

    /// The host's request to load.
    pub(crate) fn setup(&self) -> Vec<u8> {
        read(self.bytes(MESSAGE + LOG, self.layout.setup))
    }

    /// Writes a message; one that is too long becomes empty.
    pub(crate) fn set_message(&self, message: &[u8]) {
        let kept = if message.len() > MESSAGE { &[] } else { message };
        write(self.bytes(0, kept.len()), kept);
        self.header().answered.message.store(u32::try_from(kept.len()).unwrap_or(0), Relaxed);
    }

    pub(crate) fn message(&self) -> Vec<u8> {
        read(self.bytes(0, (self.header().answered.message.load(Relaxed) as usize).min(MESSAGE)))
    }

    /// Adds to the log; `false` without room. One thread at a time; the other side may take the log meanwhile.
    pub(crate) fn add_log(&self, line: &[u8]) -> bool {
        let log = &self.header().answered.log;
        let mut used = log.load(Acquire);
        loop {
            let first = (used as usize).min(LOG);
            if line.len() > LOG - first {
                return false;
            }
            write(self.bytes(MESSAGE + first, line.len()), line);
            let after = u32::try_from(first + line.len()).unwrap_or(0);
            match log.compare_exchange(used, after, AcqRel, Acquire) {
                Ok(_) => return true,
                // It was taken.
                Err(now) => used = now,
            }
        }
    }

    /// True if there is any log.
    pub(crate) fn has_log(&self) -> bool {
        self.header().answered.log.load(Relaxed) != 0
    }

    /// Takes the log. Lines added meanwhile follow those already read, and are read too.
    pub(crate) fn take_log(&self) -> Vec<u8> {
        // Attempts: a log that grows all the time is taken at the latest when it is full.
        const MOST: usize = 16;
        let log = &self.header().answered.log;
        for _ in 0..MOST {
            let used = log.load(Acquire);
            let all = read(self.bytes(MESSAGE, (used as usize).min(LOG)));
            if log.compare_exchange(used, 0, AcqRel, Relaxed).is_ok() {
                return all;
            }
        }
        Vec::new()
    }
}

fn write(to: &[AtomicU8], from: &[u8]) {
    to.iter().zip(from).for_each(|(to, from)| to.store(*from, Relaxed));
}

fn read(from: &[AtomicU8]) -> Vec<u8> {
    from.iter().map(|byte| byte.load(Relaxed)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both sides see the same through separate mappings.
    #[test]
    fn what_one_side_writes_the_other_reads() {
        let (parent, file) = Page::new(2, 3, b"{\"some\":1}").unwrap();
        let host = Page::adopt(&file).unwrap().unwrap();
        assert_eq!(host.layout, Layout { inputs: 2, outputs: 3, setup: 10 });
        assert_eq!(host.setup(), b"{\"some\":1}".to_vec());
        assert_eq!((parent.inputs().len(), parent.outputs().len()), (6, 3));
        for (k, word) in parent.inputs().iter().chain(parent.outputs()).enumerate() {
            word.store(k as u64, Relaxed);
        }
        host.set_message(&vec![0xff; MESSAGE]);
        assert!(host.add_log(b"one") && host.add_log(b", two"));
        let numbers: Vec<u64> = host.inputs().iter().chain(host.outputs()).map(|word| word.load(Relaxed)).collect();
        assert_eq!(numbers, [0, 1, 2, 3, 4, 5, 6, 7, 8]);
        assert_eq!(parent.message(), vec![0xff; MESSAGE]);
        assert_eq!(parent.take_log(), b"one, two");
        assert!(!host.has_log() && parent.take_log().is_empty());
        assert_eq!(host.setup(), b"{\"some\":1}", "nothing has run over");
    }

    /// An FMU can overwrite every byte.
    #[test]
    fn lengths_that_are_nonsense_are_cut() {
        let (page, _file) = Page::new(1, 1, b"").unwrap();
        page.header().answered.message.store(u32::MAX, Relaxed);
        page.header().answered.log.store(u32::MAX, Relaxed);
        assert!(!page.add_log(b"x"));
        assert_eq!((page.message().len(), page.take_log().len()), (MESSAGE, LOG));
    }

    #[test]
    fn log_that_finds_no_room_leaves_what_is_there() {
        let (page, _file) = Page::new(0, 0, b"").unwrap();
        assert!(page.add_log(&vec![b'a'; LOG - 1]) && !page.add_log(b"bc") && page.add_log(b"d"));
        assert_eq!(page.take_log().last(), Some(&b'd'));
    }

    /// A thread of the FMU logs while the log is taken: every line arrives once and in order.
    #[test]
    fn log_can_be_taken_while_it_is_written() {
        const LINES: u32 = 20_000;
        let (page, file) = Page::new(0, 0, b"").unwrap();
        let host = Page::adopt(&file).unwrap().unwrap();
        let mut taken = Vec::new();
        std::thread::scope(|scope| {
            scope.spawn(|| {
                for line in 0..LINES {
                    while !host.add_log(&line.to_le_bytes()) {
                        std::thread::yield_now();
                    }
                }
            });
            while taken.len() < 4 * LINES as usize {
                taken.extend(page.take_log());
            }
        });
        let lines = taken.chunks_exact(4).map(|line| u32::from_le_bytes([line[0], line[1], line[2], line[3]]));
        assert!(lines.eq(0..LINES));
    }

    #[test]
    fn other_memory_is_not_a_page() {
        let (file, _memory) = MemoryFile::new(c"other", 1 << 20).unwrap();
        assert!(Page::adopt(&file).unwrap().is_none());
    }
}
