//! Starts a contained process, reads its output and ensures its end.
use super::keeper::Report;
use super::settings::{Settings, VARIABLE};
use crate::ending::Ending;
use crate::program::{Limits, Program};
use crate::stream::{Output, Stream};
use rustix::event::{EventfdFlags, PollFd, PollFlags, Timespec, eventfd, poll};
use rustix::io::{FdFlags, fcntl_setfd, ioctl_fionbio};
use rustix::process::{Pid, PidfdFlags, Signal, kill_process_group, pidfd_open};
use std::io::{self, PipeReader, Read};
use std::net::Shutdown;
use std::os::fd::{AsFd, AsRawFd, OwnedFd};
use std::os::unix::net::UnixStream;
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, OnceLock, PoisonError, Weak};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// Longest time for a keeper to kill its processes, before it is killed itself: it may have been stopped, or be slow on a busy machine.
const PATIENCE: Duration = Duration::from_secs(5);

/// One start at a time: a child must not inherit descriptors of another.
static STARTING: Mutex<()> = Mutex::new(());
/// Running ones; `None` when no more may start.
static THERE: Mutex<Option<Vec<Weak<Shared>>>> = Mutex::new(Some(Vec::new()));

impl Output {
    fn drain(&mut self) {
        self.stdout.iter_mut().for_each(Stream::drain);
        self.stderr.drain();
    }

    /// State of standard output and standard error: `true` while open.
    fn open(&self) -> [bool; 2] {
        let stdout = self.stdout.as_ref().is_some_and(|stream| stream.source().is_some());
        [stdout, self.stderr.source().is_some()]
    }
}

/// `source` as a non-blocking stream.
fn listened_to(source: PipeReader) -> io::Result<Stream<PipeReader>> {
    ioctl_fionbio(&source, true)?;
    Ok(Stream::new(source))
}

/// State that the caller and the listening thread share.
struct Shared {
    output: Mutex<Output>,
    ending: OnceLock<Ending>,
    /// Empty; it belongs to the condition variable [`Shared::ended`].
    told: Mutex<()>,
    ended: Condvar,
    limits: Limits,
    /// Written to request the end of the process.
    stop: OwnedFd,
    on_end: Box<dyn Fn() + Send + Sync>,
}

/// A contained process, which runs until this is dropped, or ends before.
pub struct Contained {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl std::fmt::Debug for Contained {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Contained").field("ending", &self.shared.ending).finish_non_exhaustive()
    }
}

impl Contained {
    /// Starts `program`, which calls [`contain`](crate::contain). `stdout` is its standard output; without one it is read, like standard
    /// error. `on_end` is called when [`ending`](Self::ending) has become known.
    ///
    /// # Errors
    /// Those of the system, which may have no process, thread or descriptor left.
    pub fn start(
        program: &Program,
        stdin: Stdio,
        stdout: Option<Stdio>,
        limits: Limits,
        on_end: impl Fn() + Send + Sync + 'static,
    ) -> io::Result<Self> {
        let (stderr, for_stderr) = io::pipe()?;
        let (stdout, for_stdout) = if let Some(file) = stdout {
            (None, file)
        } else {
            let (reader, writer) = io::pipe()?;
            (Some(reader), Stdio::from(writer))
        };
        let mut watched: Vec<OwnedFd> = Vec::with_capacity(2);
        for stream in stdout.iter().chain([&stderr]) {
            watched.push(stream.as_fd().try_clone_to_owned()?);
        }
        let output = Output { stdout: stdout.map(listened_to).transpose()?, stderr: listened_to(stderr)? };
        let stop = eventfd(0, EventfdFlags::CLOEXEC)?;
        let shared = Arc::new(Shared {
            output: Mutex::new(output),
            ending: OnceLock::new(),
            told: Mutex::new(()),
            ended: Condvar::new(),
            limits,
            stop,
            on_end: Box::new(on_end),
        });
        let mut process = Command::new(&program.program);
        // A separate group: Ctrl-C and other signals to the group of this process do not reach it.
        process.args(&program.args).envs(program.env.iter().map(|(name, value)| (name, value))).process_group(0);
        process.stdin(stdin).stdout(for_stdout).stderr(for_stderr);
        // The thread comes first: when it cannot be created, nothing has been started yet.
        let (hand_over, handed_over) = channel();
        let for_thread = Arc::clone(&shared);
        let thread = thread::Builder::new()
            .name("supervisor".into())
            .spawn(move || listen(&handed_over, &watched, &for_thread))?;
        register(&shared)?;
        let started = start(process, limits)?;
        // The thread waits for that.
        hand_over.send(started).ok();
        Ok(Self { shared, thread: Some(thread) })
    }

    /// Ending of the process, if it has ended.
    #[must_use]
    pub fn ending(&self) -> Option<&Ending> {
        self.shared.ending.get()
    }

    /// Waits for the end of the process, `time` at most.
    pub fn wait_for_end(&self, time: Duration) {
        let told = self.shared.told.lock().unwrap_or_else(PoisonError::into_inner);
        let has_not_ended = |(): &mut ()| self.ending().is_none();
        drop(self.shared.ended.wait_timeout_while(told, time, has_not_ended).unwrap_or_else(PoisonError::into_inner));
    }

    /// Output text of the process up to now.
    pub fn output(&self) -> MutexGuard<'_, Output> {
        self.shared.drained()
    }

    /// Kills the process, if it has not ended, and returns its ending.
    pub fn end(&mut self) -> Option<&Ending> {
        if let Some(thread) = self.thread.take() {
            self.shared.stop();
            // A panic in the thread has been reported where it happened; the process ends with the control socket.
            thread.join().ok();
        }
        self.ending()
    }
}

impl Drop for Contained {
    fn drop(&mut self) {
        self.end();
    }
}

impl Shared {
    fn drained(&self) -> MutexGuard<'_, Output> {
        // A panic leaves valid text.
        let mut output = self.output.lock().unwrap_or_else(PoisonError::into_inner);
        output.drain();
        output
    }

    fn stop(&self) {
        // It fails only where it is full, which serves as well.
        rustix::io::write(&self.stop, &1_u64.to_ne_bytes()).ok();
    }
}

/// Kills all contained processes of this one, and waits for that, a few seconds at most; none can be started after that. For a program that
/// ends. Returns their process ids, as far as they are known.
pub fn end_all() -> Vec<u32> {
    let all = THERE.lock().unwrap_or_else(PoisonError::into_inner).take().unwrap_or_default();
    let all: Vec<Arc<Shared>> = all.iter().filter_map(Weak::upgrade).collect();
    for shared in &all {
        shared.stop();
    }
    let start = Instant::now();
    while all.iter().any(|shared| shared.ending.get().is_none()) && start.elapsed() < PATIENCE {
        thread::sleep(Duration::from_millis(1));
    }
    all.iter().filter_map(|shared| shared.ending.get()?.process).collect()
}

/// Registers it, unless no more may start.
fn register(shared: &Arc<Shared>) -> io::Result<()> {
    let mut there = THERE.lock().unwrap_or_else(PoisonError::into_inner);
    let there = there.as_mut().ok_or(io::ErrorKind::Interrupted)?;
    there.retain(|known| known.strong_count() > 0);
    there.push(Arc::downgrade(shared));
    Ok(())
}

/// The keeper, and the control socket by which it detects the end of this process.
struct Started {
    keeper: Child,
    pidfd: OwnedFd,
    control: UnixStream,
}

fn start(mut process: Command, limits: Limits) -> io::Result<Started> {
    let (control, theirs) = UnixStream::pair()?;
    let settings = Settings { control: theirs.as_raw_fd(), limits };
    process.env(VARIABLE, settings.to_text());
    let mut keeper = {
        let _starting = STARTING.lock().unwrap_or_else(PoisonError::into_inner);
        fcntl_setfd(&theirs, FdFlags::empty())?;
        let spawned = process.spawn();
        drop(theirs);
        spawned?
    };
    match pidfd_open(Pid::from_child(&keeper), PidfdFlags::empty()) {
        Ok(pidfd) => Ok(Started { keeper, pidfd, control }),
        Err(error) => {
            drop(control);
            keeper.kill()?;
            keeper.wait()?;
            Err(error.into())
        }
    }
}

/// Reads output until the process ends, by itself or on request.
fn listen(handed_over: &Receiver<Started>, watched: &[OwnedFd], shared: &Shared) {
    // The start failed.
    let Ok(mut started) = handed_over.recv() else { return };
    let mut stopped = None;
    loop {
        let (ended, stop) = wait(&started.pidfd, watched, shared, stopped.is_some());
        if ended {
            break;
        }
        if stop && stopped.is_none() {
            stopped = Some(Instant::now());
            // It ended in the meantime, which serves as well.
            started.control.shutdown(Shutdown::Write).ok();
        }
        if stopped.is_some_and(|since| since.elapsed() > PATIENCE) {
            started.keeper.kill().ok();
        }
    }
    // It is not yet reaped, so that its group id is still valid.
    kill_process_group(Pid::from_child(&started.keeper), Signal::KILL).ok();
    let status = started.keeper.wait().ok();
    let ending = ending(status, report(&mut started.control), shared);
    // This is the only writer.
    shared.ending.set(ending).ok();
    drop(shared.told.lock().unwrap_or_else(PoisonError::into_inner));
    shared.ended.notify_all();
    (shared.on_end)();
}

/// Waits for an event; returns true if the keeper has ended, and true if a stop is requested.
fn wait(keeper: &OwnedFd, watched: &[OwnedFd], shared: &Shared, is_stopped: bool) -> (bool, bool) {
    const GLANCE: Timespec = Timespec { tv_sec: 0, tv_nsec: 50_000_000 };
    let open = {
        let output = shared.drained();
        let [stdout, stderr] = output.open();
        if output.stdout.is_some() { vec![stdout, stderr] } else { vec![stderr] }
    };
    let mut all = vec![PollFd::new(keeper, PollFlags::IN)];
    if !is_stopped {
        all.push(PollFd::new(&shared.stop, PollFlags::IN));
    }
    all.extend(watched.iter().zip(open).filter(|(_, open)| *open).map(|(pipe, _)| PollFd::new(pipe, PollFlags::IN)));
    // Interrupted: the caller comes back.
    poll(&mut all, is_stopped.then_some(&GLANCE)).ok();
    let stop = !is_stopped && !all[1].revents().is_empty();
    let ended = !all[0].revents().is_empty();
    drop(all);
    drop(shared.drained());
    (ended, stop)
}

/// Report that the keeper wrote before it ended.
fn report(control: &mut UnixStream) -> Option<Report> {
    // A process that has inherited its end must not cause a wait.
    control.set_nonblocking(true).ok()?;
    let mut bytes = Vec::new();
    // Bytes before an error count.
    control.read_to_end(&mut bytes).ok();
    serde_json::from_slice(&bytes).ok()
}

fn ending(of_keeper: Option<ExitStatus>, report: Option<Report>, shared: &Shared) -> Ending {
    let last_words = shared.drained().stderr.last_words();
    let Limits { memory: bound, .. } = shared.limits;
    match report {
        Some(Report { process, status, held, exceeded, left, names }) => {
            let status = status.map(ExitStatus::from_raw).filter(|_| !exceeded);
            let process = u32::try_from(process).ok().filter(|process| *process > 0);
            Ending { status, held, bound, exceeded, last_words, left, names, process }
        }
        None => Ending {
            status: of_keeper,
            held: 0,
            bound,
            exceeded: false,
            last_words,
            left: 0,
            names: Vec::new(),
            process: None,
        },
    }
}
