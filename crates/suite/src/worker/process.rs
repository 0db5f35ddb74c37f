//! A worker process, from the side of its caller.
use super::WorkerError;
use super::message::{End, Message};
use super::order::Order;
use super::recording;
use super::workers::{Broken, WorkerCommand};
use servobench_isolation::{Channel, Contained, Limits, Program, Stopwatch};
use servobench_trace::Recording;
use std::fs::File;
use std::io::{self, ErrorKind, Read, Write};
use std::path::PathBuf;
use std::time::Duration;

/// Interval at which a worker is checked while it is silent, or does not read.
const GLANCE: Duration = Duration::from_millis(50);
/// Time beyond its limit after which a worker is killed: it ends its run itself, unless it is stuck, and then has its recording to write.
const GRACE: Duration = Duration::from_secs(2);
/// Memory above which a worker is not used again (B): a library that never frees its memory grows from run to run.
const MUCH: u64 = 500_000_000;
/// Bytes that are read at a time.
const CHUNK: usize = 1 << 14;

/// A worker process, killed on drop.
#[derive(Debug)]
pub(super) struct Worker {
    process: Contained,
    channel: Channel,
    /// Received bytes that are not a complete line yet.
    heard: Vec<u8>,
    /// File of its recordings.
    recording: File,
    program: PathBuf,
    timeout: Duration,
    /// Memory that it occupies (B).
    holds: u64,
    orders: u32,
}

impl Worker {
    pub(super) fn start(command: &WorkerCommand) -> Result<Self, WorkerError> {
        let cannot = |action| {
            let program = command.program.clone();
            move |source| WorkerError::Process { action, program, source }
        };
        let (channel, theirs) = Channel::pair().map_err(cannot("start"))?;
        channel.set_timeout(GLANCE).map_err(cannot("wait for"))?;
        let recording = tempfile::tempfile_in(&command.folder).map_err(cannot("make a file for"))?;
        let for_recording = recording.try_clone().map_err(cannot("make a file for"))?;
        let program = Program { program: command.program.clone(), args: vec!["worker".into()], env: Vec::new() };
        let limits = Limits { memory: command.limits.memory, is_foreign: false };
        let process = Contained::start(&program, theirs.into(), Some(for_recording.into()), limits, || ())
            .map_err(cannot("start"))?;
        let (program, timeout) = (command.program.clone(), command.timeout);
        Ok(Self { process, channel, heard: Vec::new(), recording, program, timeout, holds: 0, orders: 0 })
    }

    /// True if it has had an order before the last one.
    pub(super) const fn is_used(&self) -> bool {
        self.orders > 1
    }

    /// True if it is as good as a new one.
    pub(super) fn may_serve_again(&self) -> bool {
        self.process.ending().is_none() && self.heard.is_empty() && self.holds < MUCH
    }

    /// Gives an order and reads messages to its end; `on_message` gets all but the last message, and `None` from time to time.
    pub(super) fn carry_out(
        &mut self,
        order: &Order,
        time_limit: Option<Duration>,
        on_message: &mut dyn FnMut(Option<Message>),
    ) -> Result<End, Broken> {
        self.orders += 1;
        let mut silence = Stopwatch::start();
        let (run, last) = (Stopwatch::start(), time_limit.map(|limit| limit + GRACE));
        self.send(order, silence)?;
        loop {
            match self.line() {
                Ok(Some(line)) => {
                    silence = Stopwatch::start();
                    match Message::of(&line) {
                        Some(Message::End(end)) => return Ok(end),
                        Some(Message::Holds(bytes)) => self.holds = bytes,
                        Some(message) => on_message(Some(message)),
                        None => {}
                    }
                }
                Ok(None) => return Err(self.ended().into()),
                Err(error) if is_of_time(&error) => {
                    // A process that it has started may hold the socket open.
                    if self.process.ending().is_some() {
                        return Err(self.ended().into());
                    }
                    if silence.elapsed() > self.timeout {
                        return Err(self.stalled().into());
                    }
                    on_message(None);
                }
                Err(source) => return Err(self.mute(source).into()),
            }
            if last.is_some_and(|last| run.elapsed() > last) {
                self.process.end();
                return Err(Broken::Late);
            }
        }
    }

    /// Closes its input after the last order.
    pub(super) fn dismiss(&self) {
        // A worker that has ended needs no notice.
        self.channel.close().ok();
    }

    /// Waits for the end of a dismissed worker: processes that it left behind, in words.
    pub(super) fn left_behind(&self) -> Option<String> {
        self.process.wait_for_end(GRACE);
        self.process.ending().and_then(servobench_isolation::Ending::left_in_words)
    }

    /// Takes the recording out of its file.
    pub(super) fn take_recording(&mut self) -> io::Result<Recording> {
        let recording = recording::read(&mut self.recording);
        self.recording.set_len(0)?;
        recording
    }

    fn send(&mut self, order: &Order, silence: Stopwatch) -> Result<(), WorkerError> {
        let line = serde_json::to_vec(order).map_err(|error| self.mute(error.into()))?;
        let line = [line, b"\n".to_vec()].concat();
        let mut rest = &line[..];
        while !rest.is_empty() {
            match self.channel.write(rest) {
                Ok(count) => rest = &rest[count..],
                // A worker that ends before it has read everything may have reported the reason.
                Err(error) if error.kind() == ErrorKind::BrokenPipe && self.orders == 1 => return Ok(()),
                Err(error) if is_of_time(&error) && silence.elapsed() > self.timeout => return Err(self.stalled()),
                Err(error) if is_of_time(&error) => {}
                Err(error) => return Err(self.mute(error)),
            }
        }
        Ok(())
    }

    /// The next line, waiting up to a [`GLANCE`]; `None` when there will be none.
    fn line(&mut self) -> io::Result<Option<Vec<u8>>> {
        loop {
            if let Some(end) = self.heard.iter().position(|byte| *byte == b'\n') {
                let rest = self.heard.split_off(end + 1);
                return Ok(Some(std::mem::replace(&mut self.heard, rest)));
            }
            let mut chunk = [0; CHUNK];
            match self.channel.read(&mut chunk) {
                Ok(0) => return Ok(None),
                Ok(count) => self.heard.extend_from_slice(&chunk[..count]),
                // It ended without having read all of its orders.
                Err(error) if error.kind() == ErrorKind::ConnectionReset => return Ok(None),
                Err(error) => return Err(error),
            }
        }
    }

    /// Error of a worker that no longer reads orders.
    fn mute(&self, source: io::Error) -> WorkerError {
        WorkerError::Process { action: "speak to", program: self.program.clone(), source }
    }

    fn stalled(&mut self) -> WorkerError {
        self.process.end();
        WorkerError::Stalled { timeout: self.timeout }
    }

    /// Error of a worker that has ended, or ends, with the manner of its end. One that merely no longer reads is killed.
    fn ended(&mut self) -> WorkerError {
        let waiting = Stopwatch::start();
        while self.process.ending().is_none() && waiting.elapsed() < self.timeout {
            self.process.wait_for_end(GLANCE);
        }
        if self.process.ending().is_none() {
            return self.stalled();
        }
        let how = self.process.ending().map_or_else(String::new, servobench_isolation::Ending::how);
        WorkerError::Ended { how }
    }
}

/// True if only time has passed.
fn is_of_time(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted)
}
