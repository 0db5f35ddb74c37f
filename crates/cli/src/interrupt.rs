//! Interrupted programs leave no process, no half-written file, no recording that no results name, and no FMU that was
//! unpacked.
//!
//! A suite is told to stop by the first SIGINT: what is under way comes to its end, nothing else begins, and the results are
//! written. On the second one, and on SIGTERM, it ends now, as every other command does on the first: the processes that were
//! started are ended, then the files removed, the results written, and the program ends as it would have without all this, so that
//! a shell sees 130 or 143 and knows why.
use crate::console::say;
use crate::error::CliError;
use servobench_isolation::{Interrupt, Interrupts, end_all};
use servobench_trace::unfinished_by;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Until what is under way in other threads has seen that its process or its file is gone.
const BREATH: Duration = Duration::from_millis(20);

/// `true` when nothing is to begin any more.
static STOPPING: AtomicBool = AtomicBool::new(false);
/// `true` while the program is being ended.
static ENDING: AtomicBool = AtomicBool::new(false);

/// `true` when nothing is to begin any more.
pub(crate) fn is_stopping() -> bool {
    STOPPING.load(Ordering::SeqCst)
}

/// `true` while the program is being ended: what a process that is ended for it leaves undone is nobody's failure.
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

/// From now on an interrupted program removes what it did not finish in `folder`.
pub(crate) fn watch(folder: &Path) -> Result<(), CliError> {
    listen(folder, |_| true, || {})
}

/// From now on the first SIGINT stops a suite that writes into `folder`; what ends it at once calls `close` when nothing of it
/// runs any more.
pub(crate) fn watch_suite(folder: &Path, close: impl FnOnce() + Send + 'static) -> Result<(), CliError> {
    let is_last = |interrupt: Interrupt| {
        let is_last = STOPPING.swap(true, Ordering::SeqCst) || !interrupt.is_from_keyboard();
        if !is_last {
            say("servobench: stopping when the runs under way have ended; interrupt again to end them now\n");
        }
        is_last
    };
    listen(folder, is_last, close)
}

/// Ends the program on an interrupt of which `is_last` says so.
fn listen(
    folder: &Path,
    is_last: impl Fn(Interrupt) -> bool + Send + 'static,
    close: impl FnOnce() + Send + 'static,
) -> Result<(), CliError> {
    remove_abandoned();
    let Some(mut interrupts) = Interrupts::listen().map_err(CliError::Signals)? else { return Ok(()) };
    let folder = folder.to_owned();
    let thread = std::thread::Builder::new().name("signals".into()).spawn(move || {
        let last = interrupts.all().find(|interrupt| is_last(*interrupt));
        if let Some(interrupt) = last {
            end(interrupt, &folder, close);
        }
    });
    thread.map_err(CliError::Signals)?;
    Ok(())
}

/// From now on a file that grows beyond what the process may write (`RLIMIT_FSIZE`) is an error of the write, as a full disk
/// is, and not the end of the process.
pub(crate) fn refuse_large_files() -> Result<(), CliError> {
    servobench_isolation::refuse_large_files().map_err(CliError::Signals)
}

fn end(interrupt: Interrupt, folder: &Path, close: impl FnOnce()) -> ! {
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
    interrupt.end()
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
