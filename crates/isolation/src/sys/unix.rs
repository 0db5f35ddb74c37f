//! Signals and descriptors of a Unix.
use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
use signal_hook::consts::{SIGINT, SIGTERM, SIGXFSZ};
use signal_hook::iterator::Signals;
use signal_hook::low_level::emulate_default_handler;
use std::io;
use std::os::unix::process::ExitStatusExt as _;
use std::process::ExitStatus;
use std::sync::Arc;

/// Requests to end this program (SIGINT, SIGTERM), which then do not end it by themselves.
#[derive(Debug)]
pub struct Interrupts(Signals);

/// A request to end this program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Interrupt(i32);

impl Interrupts {
    /// Listens to them; `None` where the system has none.
    ///
    /// # Errors
    /// Those of the operating system.
    pub fn listen() -> io::Result<Option<Self>> {
        Signals::new([SIGINT, SIGTERM]).map(|signals| Some(Self(signals)))
    }

    /// All requests, waiting for the next one.
    pub fn all(&mut self) -> impl Iterator<Item = Interrupt> {
        self.0.forever().map(Interrupt)
    }
}

impl Interrupt {
    /// `true` when it came from the keyboard (Ctrl-C), where it may come a second time.
    #[must_use]
    pub const fn is_from_keyboard(self) -> bool {
        self.0 == SIGINT
    }

    /// Ends this program as the request would have without a listener: a shell sees 130 or 143.
    pub fn end(self) -> ! {
        // It returns only for a signal without effect, which these are not.
        emulate_default_handler(self.0).ok();
        std::process::exit(128 + self.0)
    }
}

/// Makes a file that grows beyond the limit of the process (`RLIMIT_FSIZE`) an error of the write, as a full disk is, and not the end of
/// the process.
///
/// # Errors
/// Those of the operating system.
pub fn refuse_large_files() -> io::Result<()> {
    signal_hook::flag::register(SIGXFSZ, Arc::default())?;
    Ok(())
}

/// Allows `count` open files at once, or as many as the system permits; never fewer than now.
pub fn allow_open_files(count: u64) {
    let Rlimit { current, maximum } = getrlimit(Resource::Nofile);
    let wanted = maximum.map_or(count, |maximum| maximum.min(count));
    if current.is_some_and(|current| current < wanted) {
        // A refusal leaves the limit unchanged.
        setrlimit(Resource::Nofile, Rlimit { current: Some(wanted), maximum }).ok();
    }
}

/// The signal that ended a process, if one did.
pub(crate) fn signal_of(status: ExitStatus) -> Option<i32> {
    status.signal()
}
