#![expect(
    unsafe_code,
    reason = "memory that the keeper and the contained process share is mapped, and seen as atomics"
)]
//! Notes of the contained process where its keeper finds them, also after a crash.
use rustix::mm::{MapFlags, ProtFlags, mmap_anonymous};
use std::io;
use std::ptr;
use std::sync::atomic::{AtomicI32, AtomicU64};

/// The note. Foreign code may write over it: then it says nonsense, which is only said.
#[derive(Debug)]
#[repr(C)]
pub(crate) struct Note {
    /// Memory of its own that the process held when it crashed (B).
    pub(crate) held: AtomicU64,
    /// Its process id as `/proc` has it; 0 until it knows.
    pub(crate) process: AtomicI32,
}

/// Memory for a note, which a process that is forked shares; it stays until both have ended.
pub(crate) fn note() -> io::Result<&'static Note> {
    let access = ProtFlags::READ | ProtFlags::WRITE;
    // SAFETY: a new mapping at an address that the kernel chooses aliases nothing. It is never unmapped, a page is larger than the note
    // and aligned for it, and zeros are a note.
    unsafe {
        let page = mmap_anonymous(ptr::null_mut(), size_of::<Note>(), access, MapFlags::SHARED)?;
        Ok(&*page.cast::<Note>())
    }
}
