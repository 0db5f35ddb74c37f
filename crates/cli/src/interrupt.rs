//! What an interrupted program leaves: no process, no half-written file, no recording that no results name, and no FMU that was
//! unpacked.
//!
//! A suite is told to stop by the first SIGINT: what is under way comes to its end, nothing else begins, and the results are
//! written. On the second one, and on SIGTERM, it ends now, as every other command does on the first: the processes that were
//! started are ended, then the files removed, the results written, and the program ends as it would have without all this, so that
//! a shell sees 130 or 143 and knows why.
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Whether nothing is to begin any more.
static STOPPING: AtomicBool = AtomicBool::new(false);
/// Whether the program is being ended.
static ENDING: AtomicBool = AtomicBool::new(false);

/// Whether nothing is to begin any more.
pub(crate) fn is_stopping() -> bool {
    STOPPING.load(Ordering::SeqCst)
}

/// Whether the program is being ended: what a process that is ended for it leaves undone is nobody's failure.
pub(crate) fn is_ending() -> bool {
    ENDING.load(Ordering::SeqCst)
}

/// Waits for the end if the program is being ended.
pub(crate) fn end_if_ending() {
    while is_ending() {
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
pub(crate) use elsewhere::{refuse_large_files, watch, watch_suite};
#[cfg(unix)]
pub(crate) use unix::{refuse_large_files, watch, watch_suite};

#[cfg(unix)]
mod unix {
    use super::{ENDING, STOPPING, untold};
    use crate::console::say;
    use crate::error::CliError;
    use servobench_isolation::end_all;
    use servobench_trace::unfinished_by;
    use signal_hook::consts::{SIGINT, SIGTERM, SIGXFSZ};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;
    use std::path::Path;
    use std::sync::Arc;
    use std::sync::atomic::Ordering;
    use std::time::Duration;

    /// Until what is under way in other threads has seen that its process or its file is gone.
    const BREATH: Duration = Duration::from_millis(20);

    /// From now on an interrupted program removes what it did not finish in `folder`.
    pub(crate) fn watch(folder: &Path) -> Result<(), CliError> {
        listen(folder, |_| true, || {})
    }

    /// From now on the first SIGINT stops a suite that writes into `folder`; what ends it at once calls `close` when nothing of it
    /// runs any more.
    pub(crate) fn watch_suite(folder: &Path, close: impl FnOnce() + Send + 'static) -> Result<(), CliError> {
        let is_last = |signal| {
            let is_last = STOPPING.swap(true, Ordering::SeqCst) || signal != SIGINT;
            if !is_last {
                say("servobench: stopping when the runs under way have ended; interrupt again to end them now\n");
            }
            is_last
        };
        listen(folder, is_last, close)
    }

    /// Ends the program on a signal of which `is_last` says so.
    fn listen(
        folder: &Path,
        is_last: impl Fn(i32) -> bool + Send + 'static,
        close: impl FnOnce() + Send + 'static,
    ) -> Result<(), CliError> {
        remove_abandoned();
        let mut signals = Signals::new([SIGINT, SIGTERM]).map_err(CliError::Signals)?;
        let folder = folder.to_owned();
        let thread = std::thread::Builder::new().name("signals".into()).spawn(move || {
            if let Some(signal) = signals.forever().find(|signal| is_last(*signal)) {
                end(signal, &folder, close);
            }
        });
        thread.map_err(CliError::Signals)?;
        Ok(())
    }

    /// From now on a file that grows beyond what the process may write (`RLIMIT_FSIZE`) is an error of the write, as a full disk
    /// is, and not the end of the process.
    pub(crate) fn refuse_large_files() -> Result<(), CliError> {
        signal_hook::flag::register(SIGXFSZ, Arc::default()).map_err(CliError::Signals)?;
        Ok(())
    }

    fn end(signal: i32, folder: &Path, close: impl FnOnce()) {
        ENDING.store(true, Ordering::SeqCst);
        say("servobench: interrupted; what was not finished is removed\n");
        // No thread can note another file until the end.
        let files = untold();
        let ended = end_all();
        for _ in 0..2 {
            std::thread::sleep(BREATH);
            remove_unfinished(folder);
        }
        remove_unpacked(&ended);
        for file in files.iter() {
            // What cannot be removed is only in the way.
            std::fs::remove_file(file).ok();
        }
        close();
        // It returns only where the signal means nothing, and it does not.
        emulate_default_handler(signal).ok();
        std::process::exit(128 + signal);
    }

    /// FMUs that were unpacked by programs that were killed.
    fn remove_abandoned() {
        #[cfg(feature = "fmu")]
        servobench_fmi::remove_abandoned();
    }

    /// FMUs that were unpacked, here and by workers, which had no time for it.
    #[cfg(feature = "fmu")]
    fn remove_unpacked(ended: &[u32]) {
        servobench_fmi::remove_unpacked(ended);
    }

    #[cfg(not(feature = "fmu"))]
    fn remove_unpacked(_: &[u32]) {}

    /// Removes files under way of this process: their names have its id.
    fn remove_unfinished(folder: &Path) {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            if unfinished_by(&entry.file_name().to_string_lossy()) == Some(std::process::id()) {
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

    pub(crate) fn watch_suite(_: &Path, _: impl FnOnce() + Send + 'static) -> Result<(), CliError> {
        Ok(())
    }

    pub(crate) fn refuse_large_files() -> Result<(), CliError> {
        Ok(())
    }
}
