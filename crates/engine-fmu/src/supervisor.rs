//! Starts the process of an FMU, listens to it and sees to its end.
//!
//! One thread does all of it: a process that is to be ended with its parent ends with the *thread* that started it
//! (`PR_SET_PDEATHSIG`, prctl(2)), and a simulation may go from thread to thread.
use crate::ending::Ending;
use crate::memory;
use crate::output::Stream;
use crate::page::Page;
use rustix::event::{EventfdFlags, PollFd, PollFlags, eventfd, poll};
use rustix::process::{Pid, PidfdFlags, Signal, kill_process_group, pidfd_open};
use std::ffi::{CString, OsString};
use std::io::{self, PipeReader};
use std::os::fd::OwnedFd;
use std::os::unix::process::CommandExt;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::Ordering::Relaxed;
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::thread::{self, JoinHandle};

/// The program that an FMU runs in: one that calls [`serve`](crate::serve), most simply the same one again.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HostCommand {
    /// The program.
    pub program: PathBuf,
    /// What tells it that it is a host.
    pub args: Vec<OsString>,
    /// What its environment has besides that of this process: libraries of Python FMUs need `LD_PRELOAD`, the simulation does
    /// not.
    pub env: Vec<(OsString, OsString)>,
}

/// What the simulation and the thread that keeps the process see.
#[derive(Debug)]
pub(crate) struct Shared {
    pub(crate) page: Page,
    output: Mutex<Output>,
    ending: OnceLock<Ending>,
    /// Memory that the process may have (B).
    memory: u64,
    /// Is written to when the process is to end.
    stop: OwnedFd,
}

/// What comes out of the process.
#[derive(Debug)]
pub(crate) struct Output {
    pub(crate) stdout: Stream<PipeReader>,
    pub(crate) stderr: Stream<PipeReader>,
}

impl Shared {
    /// How the process ended, if it did.
    pub(crate) fn ending(&self) -> Option<&Ending> {
        self.ending.get()
    }

    /// What has come out of the process up to now.
    pub(crate) fn output(&self) -> MutexGuard<'_, Output> {
        // What a panic leaves is text.
        let mut output = self.output.lock().unwrap_or_else(PoisonError::into_inner);
        output.stdout.drain();
        output.stderr.drain();
        output
    }
}

/// A process that is there until its supervisor is dropped, or ends before.
#[derive(Debug)]
pub(crate) struct Supervisor {
    pub(crate) shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl Supervisor {
    /// Starts the process, with the file of `page` as its standard input.
    pub(crate) fn new(command: &HostCommand, page: Page, file: OwnedFd, memory: u64) -> io::Result<Self> {
        let (stdout, for_stdout) = io::pipe()?;
        let (stderr, for_stderr) = io::pipe()?;
        let watched = [stdout.try_clone()?, stderr.try_clone()?];
        let output = Mutex::new(Output { stdout: Stream::new(stdout)?, stderr: Stream::new(stderr)? });
        let stop = eventfd(0, EventfdFlags::CLOEXEC)?;
        let shared = Arc::new(Shared { page, output, ending: OnceLock::new(), memory, stop });
        let mut process = Command::new(&command.program);
        // A group of its own: what it starts ends with it, and Ctrl-C is for the simulation.
        process.args(&command.args).envs(command.env.iter().map(|(name, value)| (name, value))).process_group(0);
        process.stdin(Stdio::from(file)).stdout(for_stdout).stderr(for_stderr);
        let (told, started) = channel();
        let for_thread = Arc::clone(&shared);
        let thread = thread::Builder::new()
            .name("supervisor of an FMU".into())
            .spawn(move || start_and_keep(process, &watched, &for_thread, &told))?;
        started.recv().unwrap_or_else(|_| Err(io::ErrorKind::Other.into()))?;
        Ok(Self { shared, thread: Some(thread) })
    }

    /// Ends the process, if it has not ended, and says how it ended.
    pub(crate) fn end(&mut self) -> Option<&Ending> {
        if let Some(thread) = self.thread.take() {
            // It fails only where it is full, which is as good.
            rustix::io::write(&self.shared.stop, &1_u64.to_ne_bytes()).ok();
            // A panic in the thread has been reported where it happened; the process ends with its thread.
            thread.join().ok();
        }
        self.shared.ending()
    }
}

impl Drop for Supervisor {
    fn drop(&mut self) {
        self.end();
    }
}

fn start_and_keep(mut process: Command, watched: &[PipeReader; 2], shared: &Shared, told: &Sender<io::Result<()>>) {
    let spawned = process.spawn();
    // The writing ends of the pipes are the process's alone.
    drop(process);
    let started = spawned.and_then(|mut child| match pidfd_open(Pid::from_child(&child), PidfdFlags::empty()) {
        Ok(pidfd) => Ok((child, pidfd)),
        Err(error) => {
            child.kill()?;
            child.wait()?;
            Err(error.into())
        }
    });
    // Whoever asked waits for the answer.
    match started {
        Ok((child, pidfd)) => {
            told.send(Ok(())).ok();
            keep(child, &pidfd, watched, shared);
        }
        Err(error) => {
            told.send(Err(error)).ok();
        }
    }
}

/// Listens until the process ends, by itself or because it is to.
fn keep(mut child: Child, pidfd: &OwnedFd, watched: &[PipeReader; 2], shared: &Shared) {
    let mut held = 0;
    loop {
        let (ended, stopped) = wait(pidfd, watched, shared);
        drop(shared.output());
        if stopped && !ended {
            held = CString::new(format!("/proc/{}/statm", child.id()))
                .ok()
                .and_then(|path| memory::held(&path))
                .unwrap_or(0);
            // It ended in the meantime, which is as good.
            child.kill().ok();
        }
        if ended || stopped {
            break;
        }
    }
    // It is not yet reaped, so that its group is still its own.
    wait_for(pidfd);
    kill_process_group(Pid::from_child(&child), Signal::KILL).ok();
    let last_words = shared.output().stderr.last_words();
    let answered = &shared.page.header().answered;
    let ending = Ending {
        status: child.wait().ok(),
        held: held.max(answered.held.load(Relaxed)),
        bound: shared.memory,
        last_words,
    };
    // Nobody else sets it.
    shared.ending.set(ending).ok();
    shared.page.header().answer.give_up();
}

/// Waits for something to happen: whether the process has ended, and whether it is to.
fn wait(pidfd: &OwnedFd, watched: &[PipeReader; 2], shared: &Shared) -> (bool, bool) {
    let open = {
        let output = shared.output();
        [output.stdout.source().is_some(), output.stderr.source().is_some()]
    };
    let mut all = vec![PollFd::new(pidfd, PollFlags::IN), PollFd::new(&shared.stop, PollFlags::IN)];
    all.extend(watched.iter().zip(open).filter(|(_, open)| *open).map(|(pipe, _)| PollFd::new(pipe, PollFlags::IN)));
    // Interrupted: the caller comes back.
    poll(&mut all, None).ok();
    (!all[0].revents().is_empty(), !all[1].revents().is_empty())
}

/// Waits for the end of a process that ends.
fn wait_for(pidfd: &OwnedFd) {
    while poll(&mut [PollFd::new(pidfd, PollFlags::IN)], None).is_err() {}
}
