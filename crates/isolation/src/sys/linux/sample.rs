//! Total memory of several processes.
//!
//! `RLIMIT_DATA` bounds private memory, of one process. Shared memory (mappings, memfd, files in `/dev/shm`) has no such bound, and neither
//! has the total of several processes. Both are checked from outside, periodically: the growth between two checks is bounded by the speed
//! of the memory.
use super::descendants::descendants;
use rustix::process::Pid;
use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::Path;
use std::time::{Duration, Instant};

/// Reciprocal of the share of time for searches of further processes, and of files in memory.
const SHARE: u32 = 200;
/// Least time between two such searches.
const PAUSE: Duration = Duration::from_millis(100);
/// Bytes of a block of `st_blocks` (stat(2)).
const BLOCK: u64 = 512;

/// Measures the memory of processes.
#[derive(Debug)]
pub(crate) struct Sampler {
    /// Parent of all of them.
    keeper: Pid,
    processes: Vec<i32>,
    /// Memory files that they have open (B).
    files: u64,
    /// Time of the next search.
    due: Instant,
}

impl Sampler {
    /// For the descendants of `keeper`.
    pub(crate) fn new(keeper: Pid) -> Self {
        Self { keeper, processes: Vec::new(), files: 0, due: Instant::now() + PAUSE }
    }

    /// Memory that they hold together (B), private and shared; `first` is one of them.
    pub(crate) fn held(&mut self, first: i32) -> u64 {
        let now = Instant::now();
        if now >= self.due {
            self.processes = descendants(self.keeper).into_iter().map(|process| process.id).collect();
            self.files = memory_files(&self.processes);
            self.due = now + PAUSE.max(now.elapsed() * SHARE);
        }
        let first = Some(first).filter(|first| *first > 0 && !self.processes.contains(first));
        let all: Vec<i32> = self.processes.iter().copied().chain(first).collect();
        let memory = all.iter().filter_map(|process| status(*process)).fold(Memory::default(), Memory::and);
        memory.with_files(self.files)
    }

    /// The same, with memory shared among them counted once; it takes longer.
    pub(crate) fn held_once(&self, first: i32) -> u64 {
        let first = Some(first).filter(|first| *first > 0 && !self.processes.contains(first));
        let all = self.processes.iter().copied().chain(first);
        // A system without the proportional values has reported the others.
        let memory = all.filter_map(|process| rollup(process).or_else(|| status(process)));
        memory.fold(Memory::default(), Memory::and).with_files(self.files)
    }
}

/// Memory (B).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Memory {
    private: u64,
    shared: u64,
}

impl Memory {
    fn and(self, other: Self) -> Self {
        Self { private: self.private + other.private, shared: self.shared + other.shared }
    }

    /// With `files`, mapped or not.
    fn with_files(self, files: u64) -> u64 {
        self.private + self.shared.max(files)
    }
}

/// Resident memory by kind, from proc_pid_status(5): mapped files do not count.
fn status(process: i32) -> Option<Memory> {
    let text = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    Some(Memory { private: kilobytes(&text, "RssAnon:")? * 1024, shared: kilobytes(&text, "RssShmem:")? * 1024 })
}

/// The same, each page divided by the number of processes that share it (`/proc/PID/smaps_rollup`).
fn rollup(process: i32) -> Option<Memory> {
    let text = fs::read_to_string(format!("/proc/{process}/smaps_rollup")).ok()?;
    Some(Memory { private: kilobytes(&text, "Pss_Anon:")? * 1024, shared: kilobytes(&text, "Pss_Shmem:")? * 1024 })
}

fn kilobytes(text: &str, name: &str) -> Option<u64> {
    text.lines().find_map(|line| line.strip_prefix(name))?.trim().strip_suffix("kB")?.trim().parse().ok()
}

/// Memory of the files in memory (memfd, `/dev/shm`) that `processes` have open, each once.
fn memory_files(processes: &[i32]) -> u64 {
    let mut files = BTreeMap::new();
    for process in processes {
        for entry in fs::read_dir(format!("/proc/{process}/fd")).into_iter().flatten().flatten() {
            let path = entry.path();
            if fs::read_link(&path).is_ok_and(|target| is_memory(&target))
                && let Ok(file) = fs::metadata(&path)
            {
                files.insert((file.dev(), file.ino()), file.blocks() * BLOCK);
            }
        }
    }
    files.values().sum()
}

fn is_memory(file: &Path) -> bool {
    file.to_str().is_some_and(|name| name.starts_with("/memfd:") || name.starts_with("/dev/shm/"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rustix::fs::{MemfdFlags, ftruncate, memfd_create};

    #[test]
    fn private_memory_counts_when_it_is_used() {
        let this = std::process::id().cast_signed();
        let before = status(this).unwrap();
        let much = std::hint::black_box(vec![1_u8; 1 << 28]);
        let after = status(this).unwrap();
        assert!(after.private - before.private > 200_000_000, "{before:?} {after:?}");
        drop(much);
    }

    #[test]
    fn files_of_memory_count_by_what_is_in_them() {
        let this = std::process::id().cast_signed();
        let before = memory_files(&[this]);
        let file = memfd_create(c"much", MemfdFlags::CLOEXEC).unwrap();
        ftruncate(&file, 1 << 40).unwrap();
        assert_eq!(memory_files(&[this]), before);
        rustix::io::write(&file, &vec![1; 1 << 24]).unwrap();
        let twice = file.try_clone().unwrap();
        assert_eq!(memory_files(&[this]) - before, 1 << 24);
        drop((file, twice));
        assert_eq!(memory_files(&[this]), before);
    }

    #[test]
    fn what_is_mapped_and_open_counts_once() {
        let memory = Memory { private: 5, shared: 7 };
        assert_eq!((memory.with_files(0), memory.with_files(3), memory.with_files(9)), (12, 12, 14));
    }
}
