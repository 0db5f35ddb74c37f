#![expect(
    unsafe_code,
    reason = "memory that the keeper and the contained process share is mapped, and seen as atomics"
)]
//! Notes of the contained process in memory that its keeper reads, also after a crash.
use rustix::mm::{MapFlags, ProtFlags, mmap_anonymous};
use std::io;
use std::ptr;
use std::sync::atomic::{AtomicI32, AtomicU64};

/// The note. Foreign code may overwrite it, which makes the report wrong, and nothing else.
#[derive(Debug)]
#[repr(C)]
pub(crate) struct Note {
    /// Private memory that the process held when it crashed (B).
    pub(crate) held: AtomicU64,
    /// Its process id in `/proc`; 0 until known.
    pub(crate) process: AtomicI32,
}

/// Memory for a note, shared with forked processes; it stays until all have ended.
pub(crate) fn note() -> io::Result<&'static Note> {
    let access = ProtFlags::READ | ProtFlags::WRITE;
    // SAFETY: a new mapping at an address that the kernel chooses aliases nothing. It is never unmapped, a page is larger than the note
    // and aligned for it, and zeros are a note.
    unsafe {
        let page = mmap_anonymous(ptr::null_mut(), size_of::<Note>(), access, MapFlags::SHARED)?;
        Ok(&*page.cast::<Note>())
    }
}
