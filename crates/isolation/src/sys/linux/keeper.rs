//! The keeper: watches the contained process, kills all remaining processes, and reports the end.
use super::contain::leave;
use super::descendants::descendants;
use super::memory::held_by;
use super::note::Note;
use super::sample::Sampler;
use crate::program::Limits;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::{read, write};
use rustix::process::{Pid, PidfdFlags, Signal, WaitOptions, getpid, kill_process, pidfd_open, wait, waitpid};
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::os::fd::OwnedFd;
use std::sync::atomic::Ordering::Relaxed;
use std::thread;
use std::time::{Duration, Instant};

/// Time between two checks of the memory.
const LOOK: Timespec = Timespec { tv_sec: 0, tv_nsec: 20_000_000 };
/// Longest time to kill the processes left behind: one that starts others faster than they are killed is left to the system.
const MOST: Duration = Duration::from_secs(2);
/// Names in the report; the others are counted.
const NAMES: usize = 8;

/// The process that is kept.
#[derive(Debug)]
pub(crate) enum Kept {
    /// The contained process.
    Child(Pid),
    /// The first process of the namespace of the contained process; the status of the latter comes through a pipe.
    Namespace {
        /// The first process.
        first: Pid,
        /// The pipe.
        status: OwnedFd,
    },
}

/// Ending of the contained process.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Report {
    /// Its process id; 0 if that is not known.
    pub(crate) process: i32,
    /// Its wait status (wait(2)).
    pub(crate) status: Option<i32>,
    /// Memory that it held when it crashed or was killed (B); 0 if that is not known.
    pub(crate) held: u64,
    /// `true` when it was killed for its memory.
    pub(crate) exceeded: bool,
    /// Number of processes it has left behind.
    pub(crate) left: usize,
    /// Names of the first few of them.
    pub(crate) names: Vec<String>,
}

/// Event that ends the watch.
enum Event {
    /// The contained process has ended.
    Ended,
    /// The program requests its end.
    Stop,
    /// Memory above the limit: this much (B).
    Exceeded(u64),
}

/// Watches to the end.
pub(crate) fn keep(control: &OwnedFd, kept: &Kept, limits: Limits, note: &'static Note) -> ! {
    // Input and output of the contained process use these: their other ends must detect its end.
    if let Ok(nothing) = File::options().read(true).write(true).open("/dev/null") {
        rustix::stdio::dup2_stdin(&nothing).ok();
        rustix::stdio::dup2_stdout(&nothing).ok();
    }
    let event = watch(control, kept, limits, note);
    let process = note.process.load(Relaxed);
    let mut report = Report { process, status: None, held: 0, exceeded: false, left: 0, names: Vec::new() };
    let by_itself = matches!(event, Event::Ended);
    match event {
        Event::Exceeded(held) => (report.held, report.exceeded) = (held, true),
        Event::Stop => report.held = Pid::from_raw(process).and_then(held_by).unwrap_or(0),
        Event::Ended => {}
    }
    let left = match kept {
        Kept::Child(child) => {
            report.status = ended(*child);
            end_left()
        }
        Kept::Namespace { first, status } => {
            report.status = by_itself.then(|| status_from(status)).flatten();
            let left = if by_itself { of_namespace(*first) } else { Vec::new() };
            // All processes of the namespace end with it.
            let of_first = ended(*first);
            report.status = report.status.or(of_first);
            left
        }
    };
    if by_itself {
        report.left = left.len();
        report.names = left.into_iter().take(NAMES).collect();
    }
    report.held = report.held.max(note.held.load(Relaxed));
    if let Ok(bytes) = serde_json::to_vec(&report) {
        // The program may have ended.
        write(control, &bytes).ok();
    }
    leave()
}

/// Kills a child of the keeper, if it has not ended, and returns its wait status.
fn ended(child: Pid) -> Option<i32> {
    // A process that has ended still exists until its status is collected.
    kill_process(child, Signal::KILL).ok();
    loop {
        match waitpid(Some(child), WaitOptions::empty()) {
            Err(rustix::io::Errno::INTR) => {}
            status => return status.ok().flatten().map(|(_, status)| status.as_raw()),
        }
    }
}

/// Status of the contained process, from the first process of its namespace.
fn status_from(pipe: &OwnedFd) -> Option<i32> {
    let mut bytes = [0; 4];
    let count = read(pipe, &mut bytes).ok()?;
    (count == bytes.len()).then(|| i32::from_ne_bytes(bytes))
}

/// Names of the processes left in the namespace of `first`.
fn of_namespace(first: Pid) -> Vec<String> {
    descendants(first).into_iter().map(|process| process.name).collect()
}

/// Kills all processes that the contained process has left to the keeper, and returns their names.
fn end_left() -> Vec<String> {
    let (start, mut names) = (Instant::now(), None);
    while has_children() && start.elapsed() < MOST {
        let left = descendants(getpid());
        for process in left.iter().filter_map(|process| Pid::from_raw(process.id)) {
            // It may have ended meanwhile.
            kill_process(process, Signal::KILL).ok();
        }
        names.get_or_insert_with(|| left.into_iter().map(|process| process.name).collect());
        thread::sleep(Duration::from_millis(1));
    }
    names.unwrap_or_default()
}

/// `true` when the keeper has a child that has not ended. Ended ones are reaped.
fn has_children() -> bool {
    loop {
        match wait(WaitOptions::NOHANG) {
            Ok(Some(_)) | Err(rustix::io::Errno::INTR) => {}
            Ok(None) => return true,
            Err(_) => return false,
        }
    }
}

fn watch(control: &OwnedFd, kept: &Kept, limits: Limits, note: &'static Note) -> Event {
    let child = match kept {
        Kept::Child(child) | Kept::Namespace { first: child, .. } => *child,
    };
    let Ok(pidfd) = pidfd_open(child, PidfdFlags::empty()) else { return Event::Stop };
    let mut sampler = Sampler::new(getpid());
    loop {
        let mut all = vec![PollFd::new(&pidfd, PollFlags::IN), PollFd::new(control, PollFlags::IN)];
        if let Kept::Namespace { status, .. } = kept {
            all.push(PollFd::new(status, PollFlags::IN));
        }
        // Interrupted: it checks again.
        poll(&mut all, Some(&LOOK)).ok();
        let has_happened = |index: usize| all.get(index).is_some_and(|fd| !fd.revents().is_empty());
        if has_happened(0) || has_happened(2) {
            return Event::Ended;
        }
        if has_happened(1) {
            return Event::Stop;
        }
        let process = note.process.load(Relaxed);
        if sampler.held(process) > limits.memory {
            let held = sampler.held_once(process);
            if held > limits.memory {
                return Event::Exceeded(held);
            }
        }
    }
}
