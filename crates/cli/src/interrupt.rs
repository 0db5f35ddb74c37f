//! Interrupted programs leave no process, no half-written file, no recording that no results name, and no unpacked FMU.
//!
//! The first SIGINT stops a suite: active runs finish, no other begins, and the results are written. The second one, and SIGTERM, end it
//! at once, as the first ends every other command: started processes are killed, then the files removed, the results written, and the
//! program ends by the signal's default action, so that a shell sees 130 or 143.
use crate::console::say;
use crate::error::CliError;
use servobench_isolation::{Interrupt, Interrupts, end_all};
use servobench_trace::unfinished_by;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Time for other threads to notice that their process or file is gone.
const BREATH: Duration = Duration::from_millis(20);

/// `true` when nothing is to begin any more.
static STOPPING: AtomicBool = AtomicBool::new(false);
/// `true` while the program is being ended.
static ENDING: AtomicBool = AtomicBool::new(false);

/// `true` when nothing is to begin any more.
pub(crate) fn is_stopping() -> bool {
    STOPPING.load(Ordering::SeqCst)
}

/// `true` while the program is being ended: a process killed for that is not a failure.
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

/// Registers a written file, which is removed if the run is interrupted.
pub(crate) fn written(file: &Path) {
    untold().push(file.to_owned());
}

/// Keeps the registered files, because results now name them.
pub(crate) fn told() {
    untold().clear();
}

fn untold() -> MutexGuard<'static, Vec<PathBuf>> {
    // A panic never leaves the list half changed.
    UNTOLD.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Makes an interrupted program remove its unfinished files in `folder`.
pub(crate) fn watch(folder: &Path) -> Result<(), CliError> {
    listen(folder, |_| true, || {})
}

/// Makes the first SIGINT stop a suite that writes into `folder`; an interrupt that ends it at once calls `close` after its processes have
/// ended.
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

/// Ends the program on the first interrupt for which `is_last` returns true.
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

/// Makes a write beyond the process's limit (`RLIMIT_FSIZE`) an error, like a full disk, instead of the end of the process.
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
        // A file that cannot be removed does no harm.
        std::fs::remove_file(file).ok();
    }
    close();
    interrupt.end()
}

/// Removes FMUs that killed programs had unpacked.
fn remove_abandoned() {
    #[cfg(feature = "fmu")]
    servobench_fmi::remove_abandoned();
}

/// Removes FMUs unpacked by this process and by its killed workers.
#[cfg(feature = "fmu")]
fn remove_unpacked(ended: &[u32]) {
    servobench_fmi::remove_unpacked(ended);
}

#[cfg(not(feature = "fmu"))]
fn remove_unpacked(_: &[u32]) {}

/// Removes unfinished files of this process, whose names contain its id.
fn remove_unfinished(folder: &Path) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        if unfinished_by(&entry.file_name().to_string_lossy()) == Some(std::process::id()) {
            std::fs::remove_file(entry.path()).ok();
        }
    }
}
