//! What becomes of memory that a run has freed.

/// Bytes that stay with the program for its next run: the recordings of a suite's runs have some ten megabytes.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
const KEPT: libc::c_int = 64 << 20;
/// Bytes of one piece up to which it is kept, as many as the allocator allows.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
const PIECE: libc::c_int = 32 << 20;

/// Keeps what is freed for the next run. Otherwise it goes back to the system after each one, and comes again page by page, which takes a
/// tenth of the time of a suite.
pub(crate) fn keep_freed() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    #[expect(unsafe_code, reason = "the allocator of the C library has no other door")]
    // SAFETY: it sets two numbers of the allocator, and nothing else runs yet. One that it does not take leaves things as they were.
    unsafe {
        libc::mallopt(libc::M_MMAP_THRESHOLD, PIECE);
        libc::mallopt(libc::M_TRIM_THRESHOLD, KEPT);
    }
}
