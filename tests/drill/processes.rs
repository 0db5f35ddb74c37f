//! Processes of a drill: found by what is in their environment, since one may have changed its parent, its group and its session.
use rustix::process::{Pid, Signal, kill_process};
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

/// Processes with the folder `marker` in their environment.
pub(crate) fn of(marker: &Path) -> Vec<Pid> {
    let marker = marker.to_str().unwrap().as_bytes();
    let entries = fs::read_dir("/proc").unwrap().filter_map(|entry| entry.ok()?.file_name().to_str()?.parse().ok());
    let is_ours = |pid: &i32| {
        // Those that end meanwhile, and those of others, cannot be read.
        let environment = fs::read(format!("/proc/{pid}/environ")).unwrap_or_default();
        environment.windows(marker.len()).any(|window| window == marker)
    };
    entries.filter(is_ours).filter_map(Pid::from_raw).collect()
}

/// The same without `main`: its workers, and what these have started.
pub(crate) fn below(marker: &Path, main: Pid) -> Vec<Pid> {
    of(marker).into_iter().filter(|pid| *pid != main).collect()
}

/// Whether all of them have ended, at most `patience` later. The system ends the children of a process that was killed a little
/// after it.
pub(crate) fn have_ended(marker: &Path, patience: Duration) -> bool {
    let start = Instant::now();
    loop {
        if of(marker).is_empty() {
            return true;
        }
        if start.elapsed() > patience {
            return false;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Sends `signal`; one that has ended meanwhile gets none.
pub(crate) fn send(pid: Pid, signal: Signal) {
    kill_process(pid, signal).ok();
}
