//! The caller's side.
use super::listener::{Listener, Silence, end};
use super::message::{End, Message};
use super::{WorkerCommand, WorkerError};
use crate::check::Objection;
use crate::execute::{Interruption, Recorded};
use crate::job::Job;
use servobench_config::Choice as _;
use servobench_metrics::EarlyEnd;
use servobench_trace::Recording;
use std::io::{self, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread;

/// Runs `job` in a worker process.
pub(crate) fn call(command: &WorkerCommand, job: &Job, progress: &mut dyn FnMut(f64)) -> Result<Recorded, WorkerError> {
    let path = command.folder.join(format!("{}.{}.worker.parquet", job.id, std::process::id()));
    let ended = converse(command, job, Some(&path), &mut |message| {
        if let Message::Progress(share) = message {
            progress(share);
        }
    });
    let recording = Recording::read_parquet(&path);
    // Nothing depends on the file any more; if it cannot be removed it is only in the way.
    std::fs::remove_file(&path).ok();
    match ended {
        Ok(early) => Ok((recording?, early.map(Interruption::Early))),
        Err(error @ WorkerError::Input(_)) => Err(error),
        // As far as it came.
        Err(error) => match recording {
            Ok(recording) => Ok((recording, Some(Interruption::Broken(error.into())))),
            Err(_) => Err(error),
        },
    }
}

/// Asks a worker process what keeps `job` from being built.
pub(crate) fn ask(command: &WorkerCommand, job: &Job) -> Result<Vec<Objection>, WorkerError> {
    let mut all = Vec::new();
    converse(command, job, None, &mut |message| {
        if let Message::Objections(objections) = message {
            all.extend(objections);
        }
    })?;
    Ok(all)
}

/// Starts the worker, feeds it and listens to it to its end; `on_message` gets all but its last word, which says whether the run ended
/// early.
fn converse(
    command: &WorkerCommand,
    job: &Job,
    recording: Option<&Path>,
    on_message: &mut dyn FnMut(Message),
) -> Result<Option<EarlyEnd>, WorkerError> {
    let cannot = |action| {
        let program = command.program.clone();
        move |source| WorkerError::Process { action, program, source }
    };
    let mut child = start(command, job, recording).map_err(cannot("start"))?;
    let end = listen(&mut child, command, job, on_message);
    if let Err(WorkerError::Stalled { .. }) = end {
        // One that ended in the meantime cannot be ended, which is as good.
        child.kill().ok();
        child.wait().map_err(cannot("wait for"))?;
    }
    end
}

fn start(command: &WorkerCommand, job: &Job, recording: Option<&Path>) -> io::Result<Child> {
    let mut worker = Command::new(&command.program);
    worker.arg("worker").args(["--engine", job.engine.name(), "--name", &job.scenario.name]);
    if let Some(recording) = recording {
        worker.arg("--recording").arg(recording);
    }
    if let Some(path) = &job.scenario.path {
        worker.arg("--path").arg(path);
    }
    for one in &job.scenario.overrides {
        worker.arg(format!("--set={one}"));
    }
    if !job.durations().is_empty() {
        // The shortest decimal that reads back to the same bits.
        let durations: Vec<String> = job.durations().iter().map(f64::to_string).collect();
        worker.args(["--durations", &durations.join(",")]);
    }
    worker.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()
}

/// Feeds the worker, and passes on what it says until its last word and its end.
fn listen(
    child: &mut Child,
    command: &WorkerCommand,
    job: &Job,
    on_message: &mut dyn FnMut(Message),
) -> Result<Option<EarlyEnd>, WorkerError> {
    let cannot = |action, source| WorkerError::Process { action, program: command.program.clone(), source };
    let stalled = |Silence| WorkerError::Stalled { timeout: command.timeout };
    let (Some(mut stdin), Some(stdout), Some(stderr)) = (child.stdin.take(), child.stdout.take(), child.stderr.take())
    else {
        return Err(cannot("speak to", io::ErrorKind::BrokenPipe.into()));
    };
    let listener = Listener::new(stdout, stderr);
    let text = job.text.clone();
    // A worker that ends before it has read everything reports itself; one that reads nothing must not hold us up.
    thread::spawn(move || stdin.write_all(text.as_bytes()).ok());
    let mut last = None;
    while let Some(message) = listener.next(command.timeout).map_err(stalled)? {
        match message {
            Message::End(end) => last = Some(end),
            other => on_message(other),
        }
    }
    let status = end(child, command.timeout).map_err(|error| cannot("wait for", error))?.map_err(stalled)?;
    match last {
        Some(End::Done) => Ok(None),
        Some(End::Diverged { time, reason }) => Ok(Some(EarlyEnd::Diverged { time, reason })),
        Some(End::GaveUp(why)) => Ok(Some(EarlyEnd::GaveUp(why))),
        Some(End::Input(why)) => Err(WorkerError::Input(why)),
        Some(End::Failed(why)) => Err(WorkerError::Failed(why)),
        None => Err(WorkerError::Ended { status, last_words: listener.last_words(command.timeout) }),
    }
}
