//! A run in a process of its own: the worker is this same program, told one scenario and where its recording goes.
//!
//! ```text
//! servobench worker --engine <name> --recording <file> --name <scenario> [--path <file>] [--durations <s>,<s>…]
//! stdin: text of the scenario
//! stdout: lines `progress <share>`        stderr: why it failed
//! exit code: 0 done, 2 the input is wrong, 3 ended early (the recording is there as far as it came)
//! ```
//! Any other end is the end of a native library; it costs this run only, and its last words are reported.
use crate::engines::Engines;
use crate::execute::{RunError, run_here};
use crate::job::{Job, slow_to};
use servobench_scenario::{EngineName, Scenario};
use servobench_trace::Recording;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};

/// How to start a worker.
#[derive(Debug, Clone)]
pub struct WorkerCommand {
    /// The program.
    pub program: PathBuf,
    /// Folder for the recordings on their way from the worker; each is removed when it was read.
    pub folder: PathBuf,
}

/// Bytes of a worker's standard error that are kept for its report.
const LAST_WORDS: usize = 4_000;

/// Exit code of a worker whose input was wrong.
pub const INPUT: u8 = 2;
/// Exit code of a worker whose run ended early.
pub const FAILED: u8 = 3;

/// Runs `job` in a worker process.
pub(crate) fn call(
    command: &WorkerCommand,
    job: &Job,
    progress: &mut dyn FnMut(f64),
) -> Result<(Recording, Option<String>), RunError> {
    let path = command.folder.join(format!("{}.{}.worker.parquet", job.id, std::process::id()));
    let result = started(command, job, &path).and_then(|child| finished(child, job, progress));
    let recording = Recording::read_parquet(&path);
    // Nothing depends on the file any more; if it cannot be removed it is only in the way.
    std::fs::remove_file(&path).ok();
    let unread = |error: servobench_trace::TraceError| RunError::Failed(format!("recording of the worker: {error}"));
    match result? {
        Ended::Done => Ok((recording.map_err(unread)?, None)),
        Ended::Input(words) => Err(RunError::Input(words)),
        Ended::Early(words) => match recording {
            Ok(recording) => Ok((recording, Some(words))),
            Err(_) => Err(RunError::Failed(words)),
        },
    }
}

/// How a worker ended.
enum Ended {
    Done,
    Input(String),
    Early(String),
}

fn started(command: &WorkerCommand, job: &Job, recording: &Path) -> Result<Child, RunError> {
    let mut worker = Command::new(&command.program);
    worker.arg("worker").args(["--engine", job.engine.as_str(), "--name", &job.scenario.name]);
    worker.arg("--recording").arg(recording);
    if let Some(path) = &job.scenario.path {
        worker.arg("--path").arg(path);
    }
    if !job.durations.is_empty() {
        // The shortest decimal that reads back to the same bits.
        let durations: Vec<String> = job.durations.iter().map(f64::to_string).collect();
        worker.args(["--durations", &durations.join(",")]);
    }
    worker
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|error| RunError::Failed(format!("cannot start {}: {error}", command.program.display())))
}

/// Feeds the worker, listens to it and waits for its end.
fn finished(mut child: Child, job: &Job, progress: &mut dyn FnMut(f64)) -> Result<Ended, RunError> {
    let lost = |what: &str| RunError::Failed(format!("the worker has no standard {what}"));
    let mut stdin = child.stdin.take().ok_or_else(|| lost("input"))?;
    let stdout = child.stdout.take().ok_or_else(|| lost("output"))?;
    let stderr = child.stderr.take().ok_or_else(|| lost("error"))?;
    let words = std::thread::scope(|scope| {
        let listener = scope.spawn(move || last_words(stderr));
        // A worker that ended before it read everything reports itself by its exit code.
        stdin.write_all(job.text.as_bytes()).ok();
        drop(stdin);
        for line in BufReader::new(stdout).lines().map_while(Result::ok) {
            if let Some(share) = line.strip_prefix("progress ").and_then(|share| share.parse().ok()) {
                progress(share);
            }
        }
        listener.join().unwrap_or_default()
    });
    let status = child.wait().map_err(|error| RunError::Failed(format!("cannot wait for the worker: {error}")))?;
    Ok(ended(status, words.trim()))
}

fn ended(status: ExitStatus, words: &str) -> Ended {
    match status.code().map(u8::try_from) {
        Some(Ok(0)) => Ended::Done,
        Some(Ok(INPUT)) => Ended::Input(words.to_owned()),
        Some(Ok(FAILED)) => Ended::Early(words.to_owned()),
        _ => {
            let last = if words.is_empty() { String::new() } else { format!("; its last words: {words}") };
            Ended::Early(format!("the engine's library ended its process ({status}){last}"))
        }
    }
}

/// The end of what comes out of `stream`; everything is read, so that the writer never blocks.
fn last_words(mut stream: impl Read) -> String {
    let (mut kept, mut buffer) = (Vec::new(), [0; 4096]);
    while let Ok(count @ 1..) = stream.read(&mut buffer) {
        kept.extend_from_slice(&buffer[..count]);
        if kept.len() > 2 * LAST_WORDS {
            kept.drain(..kept.len() - LAST_WORDS);
        }
    }
    String::from_utf8_lossy(&kept[kept.len().saturating_sub(LAST_WORDS)..]).into_owned()
}

/// The worker's side: runs `scenario` with its moves slowed to `durations` (s; empty: as they are), reports progress on
/// standard output and writes the recording.
///
/// # Errors
/// [`RunError`], after the recording was written as far as it came.
pub fn serve(
    mut scenario: Scenario,
    durations: &[f64],
    engine: EngineName,
    engines: &Engines,
    recording: &Path,
) -> Result<(), RunError> {
    let installed = engines.get(engine)?;
    slow_to(&mut scenario, durations);
    let mut out = std::io::stdout().lock();
    // A parent that no longer listens has ended, and this process will be no longer needed.
    let mut report = |share: f64| drop(writeln!(out, "progress {share:.4}").and_then(|()| out.flush()));
    let (recorded, failure) = run_here(&scenario, installed.engine, &mut report)?;
    recorded.write_parquet(recording).map_err(|error| RunError::Failed(error.to_string()))?;
    failure.map_or(Ok(()), |failure| Err(RunError::Failed(failure)))
}
