//! A system that cannot contain a process: a request returns an error that names the supported system.
use crate::ending::Ending;
use crate::error::ContainError;
use crate::program::{Limits, Program};
use crate::stream::Output;
use std::convert::Infallible;
use std::ffi::CStr;
use std::fs::File;
use std::io::{self, ErrorKind, Read, Write};
use std::process::Stdio;
use std::ptr::NonNull;
use std::sync::MutexGuard;
use std::sync::atomic::AtomicU32;
use std::thread;
use std::time::Duration;

/// The longest time between two checks of a number.
const GLANCE: Duration = Duration::from_millis(1);

fn unsupported() -> io::Error {
    let why = "a contained process needs Linux (5.4 or later): run this there, in WSL, a container or a virtual machine as well; what \
               runs inside the program itself needs none";
    io::Error::new(ErrorKind::Unsupported, why)
}

/// A contained process; it does not exist here.
#[derive(Debug)]
pub struct Contained(Infallible);

impl Contained {
    /// Starts nothing.
    ///
    /// # Errors
    /// Always.
    pub fn start(
        _: &Program,
        _: Stdio,
        _: Option<Stdio>,
        _: Limits,
        _: impl Fn() + Send + Sync + 'static,
    ) -> io::Result<Self> {
        Err(unsupported())
    }

    /// Ending of the process.
    #[must_use]
    pub fn ending(&self) -> Option<&Ending> {
        match self.0 {}
    }

    /// Waits for the end of the process.
    pub fn wait_for_end(&self, _: Duration) {
        match self.0 {}
    }

    /// Output text of the process up to now.
    pub fn output(&self) -> MutexGuard<'_, Output> {
        match self.0 {}
    }

    /// Kills the process.
    pub fn end(&mut self) -> Option<&Ending> {
        match self.0 {}
    }
}

/// Contains nothing.
///
/// # Errors
/// Always.
pub fn contain() -> Result<(), ContainError> {
    Err(ContainError::System { action: "contain this process", source: unsupported() })
}

/// Contained processes: none.
#[must_use]
pub fn end_all() -> Vec<u32> {
    Vec::new()
}

/// One end of a channel between two processes; it does not exist here.
#[derive(Debug)]
pub struct Channel(Infallible);

impl Channel {
    /// Makes nothing.
    ///
    /// # Errors
    /// Always.
    pub fn pair() -> io::Result<(Self, Self)> {
        Err(unsupported())
    }

    /// Bounds reading and writing.
    ///
    /// # Errors
    /// None.
    pub fn set_timeout(&self, _: Duration) -> io::Result<()> {
        match self.0 {}
    }

    /// The same end again.
    ///
    /// # Errors
    /// None.
    pub fn try_clone(&self) -> io::Result<Self> {
        match self.0 {}
    }

    /// Ends the channel.
    ///
    /// # Errors
    /// None.
    pub fn close(&self) -> io::Result<()> {
        match self.0 {}
    }
}

impl Read for Channel {
    fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
        match self.0 {}
    }
}

impl Write for Channel {
    fn write(&mut self, _: &[u8]) -> io::Result<usize> {
        match self.0 {}
    }

    fn flush(&mut self) -> io::Result<()> {
        match self.0 {}
    }
}

impl From<Channel> for Stdio {
    fn from(channel: Channel) -> Self {
        match channel.0 {}
    }
}

/// Takes nothing.
///
/// # Errors
/// Always.
pub fn claim_standard_streams() -> io::Result<(Channel, File)> {
    Err(unsupported())
}

/// The file by which a process hands memory to another one; it does not exist here.
#[derive(Debug)]
pub struct MemoryFile(Infallible);

/// Memory shared with another process; it does not exist here.
#[derive(Debug)]
pub struct SharedMemory(Infallible);

impl MemoryFile {
    /// Makes nothing.
    ///
    /// # Errors
    /// Always.
    pub fn new(_: &CStr, _: usize) -> io::Result<(Self, SharedMemory)> {
        Err(unsupported())
    }

    /// Takes nothing.
    ///
    /// # Errors
    /// Always.
    pub fn of_standard_input() -> io::Result<Self> {
        Err(unsupported())
    }

    /// The memory that another process has handed over.
    ///
    /// # Errors
    /// None.
    pub fn adopt(&self, _: usize) -> io::Result<Option<SharedMemory>> {
        match self.0 {}
    }
}

impl From<MemoryFile> for Stdio {
    fn from(file: MemoryFile) -> Self {
        match file.0 {}
    }
}

impl SharedMemory {
    /// Its first byte.
    #[must_use]
    pub const fn start(&self) -> NonNull<u8> {
        match self.0 {}
    }

    /// Its length (bytes).
    #[must_use]
    pub const fn length(&self) -> usize {
        match self.0 {}
    }
}

/// No waiter needs a wake-up.
pub(crate) fn wake(_: &AtomicU32) {}

/// Sleeps a little; the caller checks the number.
pub(crate) fn sleep_while(_: &AtomicU32, _: u32, limit: Duration) {
    thread::sleep(limit.min(GLANCE));
}

/// Ends this process with exit code 0.
pub fn leave_at_once() -> ! {
    std::process::exit(0)
}

/// The allocator of the system stays unchanged.
pub fn keep_freed_memory(_: i32, _: i32) {}

/// Memory that this process and its children may take together (B); `None` where unknown.
#[must_use]
pub fn memory_of_machine() -> Option<u64> {
    None
}

/// Bytes of memory that this process may write and does not share; `None` where the system does not report it.
#[must_use]
pub fn own_memory() -> Option<u64> {
    None
}
