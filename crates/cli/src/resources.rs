//! What the program takes of the machine beyond what is usual: memory that it keeps, files that it has open.

/// Bytes that stay with the program for its next run: the recordings of a suite's runs have some ten megabytes.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
const KEPT: libc::c_int = 64 << 20;
/// Bytes of one piece up to which it is kept, as many as the allocator allows.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
const PIECE: libc::c_int = 32 << 20;

/// Keeps what is freed for the next run. Otherwise it goes back to the system after each one, and comes again page by page.
pub(crate) fn keep_freed() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    #[expect(unsafe_code, reason = "the allocator of the C library has no other door")]
    // SAFETY: it sets two numbers of the allocator, and nothing else runs yet. One that it does not take leaves things as they were.
    unsafe {
        libc::mallopt(libc::M_MMAP_THRESHOLD, PIECE);
        libc::mallopt(libc::M_TRIM_THRESHOLD, KEPT);
    }
}

/// Files that may be open at once, if the machine allows as many: a long run has one for each channel, and as many runs as there are
/// processors go side by side. A thousand and twenty-four are usual.
#[cfg(unix)]
const FILES: u64 = 1 << 16;

/// Allows more open files than usual.
pub(crate) fn open_many() {
    #[cfg(unix)]
    {
        use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
        let Rlimit { current, maximum } = getrlimit(Resource::Nofile);
        let wanted = maximum.map_or(FILES, |maximum| maximum.min(FILES));
        if current.is_some_and(|current| current < wanted) {
            // What is refused leaves things as they were.
            setrlimit(Resource::Nofile, Rlimit { current: Some(wanted), maximum }).ok();
        }
    }
}
