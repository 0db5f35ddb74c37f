//! Memory of a process.
use rustix::fs::{Mode, OFlags, open};
use rustix::process::Pid;
use std::ffi::{CStr, CString};

/// Bytes of memory that a process may write and does not share (`data` in proc_pid_statm(5)), which `RLIMIT_DATA` bounds.
///
/// Allocates nothing and takes no lock, so that a process may call it while it crashes.
pub(crate) fn held(statm: &CStr) -> Option<u64> {
    let file = open(statm, OFlags::RDONLY | OFlags::CLOEXEC, Mode::empty()).ok()?;
    let mut line = [0; 256];
    let count = rustix::io::read(&file, &mut line).ok()?;
    let line = line.get(..count)?;
    let pages = line.split(|byte| *byte == b' ').nth(5)?;
    let pages: u64 = str::from_utf8(pages).ok()?.parse().ok()?;
    Some(pages * rustix::param::page_size() as u64)
}

/// The same for another process.
pub(crate) fn held_by(process: Pid) -> Option<u64> {
    held(&CString::new(format!("/proc/{}/statm", process.as_raw_pid())).ok()?)
}

/// Bytes of memory that this process may write and does not share; `None` where the system does not report it.
#[must_use]
pub fn own_memory() -> Option<u64> {
    held(c"/proc/self/statm")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Requested memory counts even where it was never written; other tests allocate at the same time, a little.
    #[test]
    fn memory_counts_when_it_is_asked_for() {
        let before = own_memory().unwrap();
        let much = std::hint::black_box(vec![0_u8; 1 << 30]);
        let after = own_memory().unwrap();
        assert!(after - before > 1_000_000_000, "{before} {after}");
        drop(much);
        assert_eq!(held(c"/proc/self/no such file"), None);
    }
}
