//! Listens to a worker without waiting for it forever.
use super::message::Message;
use std::io::{BufRead, BufReader, Read};
use std::process::{Child, ChildStderr, ChildStdout, ExitStatus};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

/// Bytes of a worker's standard error that are kept for its report.
const LAST_WORDS: usize = 4_000;
/// How often a worker is looked after once it is silent.
const GLANCE: Duration = Duration::from_millis(2);

/// What a worker says, in threads of their own: they end with its pipes.
pub(super) struct Listener {
    messages: Receiver<Message>,
    last_words: Receiver<String>,
}

/// It says nothing more, for too long.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Silence;

impl Listener {
    pub(super) fn new(stdout: ChildStdout, stderr: ChildStderr) -> Self {
        let (said, messages) = channel();
        thread::spawn(move || {
            let lines = BufReader::new(stdout).lines().map_while(Result::ok);
            // Nobody listens any more to a worker that was ended.
            lines.filter_map(|line| Message::of(&line)).try_for_each(|message| said.send(message)).ok();
        });
        let (cried, last_words) = channel();
        thread::spawn(move || cried.send(end_of(stderr)).ok());
        Self { messages, last_words }
    }

    /// The next message, at most `timeout` later; `None` when there will be none.
    pub(super) fn next(&self, timeout: Duration) -> Result<Option<Message>, Silence> {
        match self.messages.recv_timeout(timeout) {
            Ok(message) => Ok(Some(message)),
            Err(RecvTimeoutError::Disconnected) => Ok(None),
            Err(RecvTimeoutError::Timeout) => Err(Silence),
        }
    }

    /// The end of what it wrote on standard error. Something that it started may hold the pipe open: nobody waits longer
    /// than `timeout` for that.
    pub(super) fn last_words(&self, timeout: Duration) -> String {
        self.last_words.recv_timeout(timeout).unwrap_or_default().trim().to_owned()
    }
}

/// Waits for the end of `child`, at most `timeout`.
pub(super) fn end(child: &mut Child, timeout: Duration) -> std::io::Result<Result<ExitStatus, Silence>> {
    let start = Instant::now();
    loop {
        match child.try_wait()? {
            Some(status) => return Ok(Ok(status)),
            None if start.elapsed() > timeout => return Ok(Err(Silence)),
            None => thread::sleep(GLANCE),
        }
    }
}

/// The end of what comes out of `stream`; everything is read, so that the writer never blocks.
fn end_of(mut stream: impl Read) -> String {
    let (mut kept, mut buffer) = (Vec::new(), [0; 4096]);
    while let Ok(count @ 1..) = stream.read(&mut buffer) {
        kept.extend_from_slice(&buffer[..count]);
        if kept.len() > 2 * LAST_WORDS {
            kept.drain(..kept.len() - LAST_WORDS);
        }
    }
    String::from_utf8_lossy(&kept[kept.len().saturating_sub(LAST_WORDS)..]).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_long_lament_the_end_is_kept() {
        let long = "x".repeat(100_000) + "the reason";
        let kept = end_of(long.as_bytes());
        assert_eq!((kept.len(), kept.ends_with("the reason")), (LAST_WORDS, true));
        assert_eq!(end_of("short".as_bytes()), "short");
    }
}
