#![expect(unsafe_code, reason = "the keeper and the contained process are one program that forks")]
//! Containment in a started program: it becomes two processes.
use super::crash;
use super::keeper::{Kept, keep};
use super::namespace;
use super::note::{Note, note};
use super::settings::{Settings, VARIABLE};
use crate::error::ContainError;
use crate::program::Limits;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::{Errno, FdFlags, fcntl_setfd};
use rustix::process::{
    Pid, Resource, Rlimit, Signal, WaitOptions, getpid, getppid, getrlimit, set_child_subreaper,
    set_parent_process_death_signal, setpgid, setrlimit, wait,
};
use std::io;
use std::os::fd::{FromRawFd, OwnedFd};
use std::sync::atomic::Ordering::Relaxed;

/// Contains this process as requested by [`Contained::start`](crate::Contained::start); returns in the contained process only.
///
/// To be called before anything else, while there is one thread.
///
/// # Errors
/// [`ContainError`]: this program was not started to be contained, or the system refuses a necessary operation.
pub fn contain() -> Result<(), ContainError> {
    let settings = std::env::var(VARIABLE).ok().and_then(|text| Settings::of_text(&text));
    let settings = settings.ok_or(ContainError::NotStarted)?;
    // SAFETY: the caller that set the variable opened it for this process alone. If it was set by anything else, this fails at once.
    let control = unsafe { OwnedFd::from_raw_fd(settings.control) };
    fcntl_setfd(&control, FdFlags::CLOEXEC).map_err(|_| ContainError::NotStarted)?;
    let cannot = |action| move |errno: Errno| ContainError::System { action, source: errno.into() };
    let none = Rlimit { current: Some(0), maximum: Some(0) };
    setrlimit(Resource::Core, none).map_err(cannot("switch core dumps off"))?;
    let note = note().map_err(|source| ContainError::System { action: "share memory with the keeper", source })?;
    set_child_subreaper(Some(getpid())).map_err(cannot("become the keeper"))?;
    if settings.limits.is_foreign && namespace::enter() {
        in_namespace(control, settings.limits, note)
    } else {
        in_group(control, settings.limits, note)
    }
}

/// The contained process is a child of the keeper.
fn in_group(control: OwnedFd, limits: Limits, note: &'static Note) -> Result<(), ContainError> {
    let keeper = getpid();
    if let Some(child) = fork()? {
        be_deaf();
        keep(&control, &Kept::Child(child), limits, note);
    }
    drop(control);
    end_with(Some(keeper))?;
    limit(limits, note)
}

/// The keeper's child is the first process of a namespace, and the contained process is a child of that one.
fn in_namespace(control: OwnedFd, limits: Limits, note: &'static Note) -> Result<(), ContainError> {
    let cannot = |action| move |source| ContainError::System { action, source };
    let (status, for_status) = io::pipe().map_err(cannot("make a pipe"))?;
    if let Some(first) = fork()? {
        be_deaf();
        drop(for_status);
        keep(&control, &Kept::Namespace { first, status: status.into() }, limits, note);
    }
    drop((control, status));
    // The keeper has no process id in this namespace.
    end_with(None)?;
    let for_status = OwnedFd::from(for_status);
    if is_closed(&for_status) {
        // The parent has ended before this call.
        leave();
    }
    let first = getpid();
    if let Some(child) = fork()? {
        wait_as_first(child, &for_status);
    }
    drop(for_status);
    end_with(Some(first))?;
    limit(limits, note)
}

/// Waits for the end of `child`, reports it, and waits for everything else that ends in the namespace.
fn wait_as_first(child: Pid, for_status: &OwnedFd) -> ! {
    loop {
        match wait(WaitOptions::empty()) {
            Ok(Some((ended, status))) if ended == child => {
                rustix::io::write(for_status, &status.as_raw().to_ne_bytes()).ok();
            }
            Ok(_) | Err(Errno::INTR) => {}
            // All processes have ended. The keeper ends this process when it has read the status.
            Err(_) => loop {
                poll(&mut [PollFd::new(for_status, PollFlags::empty())], None).ok();
            },
        }
    }
}

/// `true` when the other end of a pipe is closed.
fn is_closed(pipe: &OwnedFd) -> bool {
    let mut pipes = [PollFd::new(pipe, PollFlags::empty())];
    let now = Timespec { tv_sec: 0, tv_nsec: 0 };
    poll(&mut pipes, Some(&now)).is_ok() && pipes[0].revents().intersects(PollFlags::ERR | PollFlags::HUP)
}

/// Makes this process end with its parent.
fn end_with(parent: Option<Pid>) -> Result<(), ContainError> {
    set_parent_process_death_signal(Some(Signal::KILL))
        .map_err(|errno| ContainError::System { action: "end with the keeper", source: errno.into() })?;
    // The parent may have ended before.
    if parent.is_some() && getppid() != parent {
        leave();
    }
    Ok(())
}

/// The share of its memory that may be data. Stack and libraries take some of the rest: a process that requests too much is refused, and is
/// not killed first for memory beside its data.
const DATA: (u64, u64) = (31, 32);

/// Limits the memory of this process.
fn limit(limits: Limits, note: &'static Note) -> Result<(), ContainError> {
    let cannot = |action| move |errno: Errno| ContainError::System { action, source: errno.into() };
    // A signal to its own group is for its child processes, and not for the keeper.
    setpgid(None, None).map_err(cannot("make a process group"))?;
    let data = limits.memory / DATA.1 * DATA.0;
    let most = getrlimit(Resource::Data).maximum.map_or(data, |most| most.min(data));
    setrlimit(Resource::Data, Rlimit { current: Some(most), maximum: Some(most) }).map_err(cannot("bound memory"))?;
    // In a separate namespace, only `/proc` knows the id that all others see.
    let own = std::fs::read_link("/proc/self").ok().and_then(|link| link.to_str()?.parse().ok());
    note.process.store(own.unwrap_or(0), Relaxed);
    crash::note_in(note);
    Ok(())
}

/// The child's id; `None` in the child.
fn fork() -> Result<Option<Pid>, ContainError> {
    // SAFETY: this is the only thread, or, in a test, the only active one.
    match unsafe { libc::fork() } {
        -1 => Err(ContainError::System { action: "start a process", source: io::Error::last_os_error() }),
        child => Ok(Pid::from_raw(child)),
    }
}

/// Ignores requests to end, which are not for the keeper: a request to all processes of a name or a service reaches the simulation too, and
/// with that the keeper ends.
fn be_deaf() {
    for signal in [libc::SIGHUP, libc::SIGINT, libc::SIGQUIT, libc::SIGTERM] {
        // SAFETY: to ignore a signal runs nothing.
        unsafe { libc::signal(signal, libc::SIG_IGN) };
    }
}

/// Ends this process without its exit handlers, which belong to the contained process.
pub(crate) fn leave() -> ! {
    // SAFETY: it ends.
    unsafe { libc::_exit(0) }
}
