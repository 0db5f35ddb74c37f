#![expect(unsafe_code, reason = "memory that is shared with another process is mapped, and seen as atomics")]
//! Memory shared by two processes.
use rustix::fs::{MemfdFlags, SealFlags, fcntl_add_seals, fcntl_get_seals, fstat, ftruncate, memfd_create};
use rustix::mm::{Advice, MapFlags, ProtFlags, madvise, mmap, munmap};
use std::ffi::CStr;
use std::fs::File;
use std::os::fd::{AsFd as _, OwnedFd};
use std::process::Stdio;
use std::ptr::NonNull;
use std::{io, ptr};

/// The file by which a process hands memory to another one that it starts. It has no name, and is sealed, so that it cannot shrink while a
/// process has mapped it.
#[derive(Debug)]
pub struct MemoryFile(OwnedFd);

impl MemoryFile {
    /// `length` bytes of memory, all zero, and the file that hands them over, as standard input of the other process. Lists of mappings of
    /// a process show `name`.
    ///
    /// # Errors
    /// Those of the operating system.
    pub fn new(name: &CStr, length: usize) -> io::Result<(Self, SharedMemory)> {
        let file = memfd_create(name, MemfdFlags::CLOEXEC | MemfdFlags::ALLOW_SEALING)?;
        ftruncate(&file, length as u64)?;
        fcntl_add_seals(&file, SealFlags::SHRINK | SealFlags::GROW | SealFlags::SEAL)?;
        let memory = SharedMemory::map(&file, length)?;
        Ok((Self(file), memory))
    }

    /// Standard input of this process, which is replaced by nothing.
    ///
    /// # Errors
    /// Those of the operating system.
    pub fn of_standard_input() -> io::Result<Self> {
        let file = io::stdin().as_fd().try_clone_to_owned()?;
        rustix::stdio::dup2_stdin(File::open("/dev/null")?)?;
        Ok(Self(file))
    }

    /// The memory that another process has handed over; `None` if the file is of another kind, or shorter than `least`.
    ///
    /// Forked processes do not inherit it.
    ///
    /// # Errors
    /// Those of the operating system.
    pub fn adopt(&self, least: usize) -> io::Result<Option<SharedMemory>> {
        let sealed = fcntl_get_seals(&self.0).is_ok_and(|seals| seals.contains(SealFlags::SHRINK));
        let length = usize::try_from(fstat(&self.0)?.st_size).unwrap_or(0);
        if !sealed || length < least {
            return Ok(None);
        }
        let memory = SharedMemory::map(&self.0, length)?;
        // SAFETY: the range is the mapping; forked processes that touch it fault, which ends them only.
        unsafe { madvise(memory.start.as_ptr().cast(), length, Advice::LinuxDontFork)? };
        Ok(Some(memory))
    }
}

impl From<MemoryFile> for Stdio {
    fn from(file: MemoryFile) -> Self {
        file.0.into()
    }
}

/// Memory that another process may see and change at any time: it may be accessed as atomics only.
#[derive(Debug)]
pub struct SharedMemory {
    start: NonNull<u8>,
    length: usize,
}

// SAFETY: the mapping lives as long as this value, and is accessed as atomics only.
unsafe impl Send for SharedMemory {}
// SAFETY: as above.
unsafe impl Sync for SharedMemory {}

impl SharedMemory {
    fn map(file: &OwnedFd, length: usize) -> io::Result<Self> {
        let access = ProtFlags::READ | ProtFlags::WRITE;
        // SAFETY: a mapping at an address that the kernel chooses aliases nothing; the file is at least that long and
        // cannot shrink.
        let start = unsafe { mmap(ptr::null_mut(), length, access, MapFlags::SHARED, file, 0)? };
        let start = NonNull::new(start.cast()).ok_or(io::ErrorKind::AddrNotAvailable)?;
        Ok(Self { start, length })
    }

    /// Its first byte, aligned to pages of memory, as long as this lives.
    #[must_use]
    #[inline]
    pub const fn start(&self) -> NonNull<u8> {
        self.start
    }

    /// Its length (bytes).
    #[must_use]
    #[inline]
    pub const fn length(&self) -> usize {
        self.length
    }
}

impl Drop for SharedMemory {
    fn drop(&mut self) {
        // SAFETY: the range is the mapping, and no borrow of it is left.
        let unmapped = unsafe { munmap(self.start.as_ptr().cast(), self.length) };
        debug_assert!(unmapped.is_ok(), "the range is what was mapped");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU8, Ordering::SeqCst};

    fn first(memory: &SharedMemory) -> &AtomicU8 {
        // SAFETY: the memory has a byte, lives as long as what is borrowed, and every bit pattern is an atomic.
        unsafe { memory.start().cast().as_ref() }
    }

    /// Both sides see the same bytes through separate mappings.
    #[test]
    fn what_one_side_writes_the_other_reads() {
        let (file, ours) = MemoryFile::new(c"test", 100).unwrap();
        let theirs = file.adopt(100).unwrap().unwrap();
        assert_eq!((ours.length(), theirs.length()), (100, 100));
        first(&ours).store(7, SeqCst);
        assert_eq!(first(&theirs).load(SeqCst), 7);
        assert!(file.adopt(101).unwrap().is_none());
    }

    #[test]
    fn the_file_cannot_shrink_under_who_has_mapped_it() {
        let (file, _memory) = MemoryFile::new(c"test", 100).unwrap();
        assert_eq!(ftruncate(&file.0, 0), Err(rustix::io::Errno::PERM));
    }

    #[test]
    fn a_file_that_may_shrink_is_not_adopted() {
        let null = MemoryFile(File::open("/dev/null").unwrap().into());
        assert!(null.adopt(0).unwrap().is_none());
        let other = memfd_create(c"other", MemfdFlags::ALLOW_SEALING).unwrap();
        ftruncate(&other, 1 << 20).unwrap();
        assert!(MemoryFile(other).adopt(1).unwrap().is_none());
    }
}
