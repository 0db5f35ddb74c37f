//! What an interrupted run leaves: no process, no half-written file, no recording that no results name, and no FMU that was unpacked.
//!
//! On SIGINT and SIGTERM the processes that were started are ended, then the files removed, then the program ends as it would
//! have without all this, so that a shell sees 130 or 143 and knows why.
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Whether a signal has come.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Waits for the end if a signal has come: what a process that was ended for it has left undone is nobody's failure.
pub(crate) fn end_if_interrupted() {
    while INTERRUPTED.load(Ordering::SeqCst) {
        std::thread::park();
    }
}

/// Files of this run that no results name yet.
static UNTOLD: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A file was written, and goes away with the run if that is interrupted.
pub(crate) fn written(file: &Path) {
    untold().push(file.to_owned());
}

/// The results are written: what they name stays.
pub(crate) fn told() {
    untold().clear();
}

fn untold() -> MutexGuard<'static, Vec<PathBuf>> {
    // Nothing is ever left half done with it.
    UNTOLD.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(not(unix))]
pub(crate) use elsewhere::{end_with_parent, watch};
#[cfg(unix)]
pub(crate) use unix::{end_with_parent, watch};

#[cfg(unix)]
mod unix {
    use super::{INTERRUPTED, untold};
    use crate::console::say;
    use crate::error::CliError;
    use rustix::process::{Pid, Signal, kill_process, set_parent_process_death_signal};
    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;
    use std::path::Path;
    use std::sync::atomic::Ordering;
    use std::time::Duration;

    /// Until what is under way in other threads has seen that its process or its file is gone.
    const BREATH: Duration = Duration::from_millis(20);

    /// From now on an interrupted program removes what it did not finish in `folder`.
    pub(crate) fn watch(folder: &Path) -> Result<(), CliError> {
        let mut signals = Signals::new([SIGINT, SIGTERM]).map_err(CliError::Signals)?;
        let folder = folder.to_owned();
        std::thread::spawn(move || {
            for signal in signals.forever() {
                end(signal, &folder);
            }
        });
        Ok(())
    }

    /// This process ends with the one that started it, whatever ended that.
    pub(crate) fn end_with_parent() -> Result<(), CliError> {
        set_parent_process_death_signal(Some(Signal::KILL)).map_err(|error| CliError::EndWithParent(error.into()))
    }

    fn end(signal: i32, folder: &Path) {
        INTERRUPTED.store(true, Ordering::SeqCst);
        say("servobench: interrupted; what was not finished is removed\n");
        // No thread can note another file until the end.
        let files = untold();
        let mut ended = Vec::new();
        for _ in 0..2 {
            for child in children() {
                // One that has ended already is as good.
                kill_process(child, Signal::KILL).ok();
                ended.push(child.as_raw_pid().unsigned_abs());
            }
            std::thread::sleep(BREATH);
            remove_unfinished(folder);
        }
        remove_unpacked(&ended);
        for file in files.iter() {
            // What cannot be removed is only in the way.
            std::fs::remove_file(file).ok();
        }
        // It returns only where the signal means nothing, and it does not.
        emulate_default_handler(signal).ok();
        std::process::exit(128 + signal);
    }

    /// FMUs that were unpacked, here and by workers, which had no time for it.
    #[cfg(feature = "fmu")]
    fn remove_unpacked(ended: &[u32]) {
        servobench_fmi::remove_unpacked(ended);
    }

    #[cfg(not(feature = "fmu"))]
    fn remove_unpacked(_: &[u32]) {}

    /// The processes that this one started and that have not ended, as Linux lists them; none where it does not.
    fn children() -> Vec<Pid> {
        let threads = std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
        let lists = threads.filter_map(|thread| std::fs::read_to_string(thread.path().join("children")).ok());
        let ids: Vec<i32> = lists.flat_map(|list| numbers(&list)).collect();
        ids.into_iter().filter_map(Pid::from_raw).collect()
    }

    fn numbers(list: &str) -> Vec<i32> {
        list.split_whitespace().filter_map(|id| id.parse().ok()).collect()
    }

    /// Removes files under way of this process and of its workers: their names have its id.
    fn remove_unfinished(folder: &Path) {
        let id = std::process::id();
        let (partial, worker) = (format!(".{id}-"), format!(".{id}.worker.parquet"));
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            let is_ours = name.starts_with('.') && name.contains(&partial) && name.ends_with(".partial");
            if is_ours || name.contains(&worker) {
                std::fs::remove_file(entry.path()).ok();
            }
        }
    }
}

#[cfg(not(unix))]
mod elsewhere {
    use crate::error::CliError;
    use std::path::Path;

    pub(crate) fn watch(_: &Path) -> Result<(), CliError> {
        Ok(())
    }

    pub(crate) fn end_with_parent() -> Result<(), CliError> {
        Ok(())
    }
}
