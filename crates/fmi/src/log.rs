//! Log of an FMU: messages are kept, within limits, until they are taken.
use crate::slave::LogLine;
use servobench_base::Severity;
use std::ffi::c_int;
use std::mem;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

/// Most lines kept; a message repeated at every step would fill the memory.
const MOST_LINES: usize = 10_000;
/// Most bytes of all lines kept.
const MOST_BYTES: usize = 1 << 20;

/// Receiver of every line at once.
static SINK: OnceLock<fn(&LogLine) -> bool> = OnceLock::new();

/// Sends every line logged by an FMU in this process to `sink` at once, from any thread; lines for which it returns true are not kept for
/// [`Slave::take_log`](crate::Slave::take_log). For a process that its FMU may end at any time. Only the first sink counts.
pub fn send_log_lines_to(sink: fn(&LogLine) -> bool) {
    SINK.get_or_init(|| sink);
}

/// Present time of an instance (s), stamped on its log lines, whichever thread writes them.
#[derive(Debug, Clone)]
pub(crate) struct Clock(Arc<AtomicU64>);

impl Clock {
    pub(crate) fn at(time: f64) -> Self {
        Self(Arc::new(AtomicU64::new(time.to_bits())))
    }

    pub(crate) fn time(&self) -> f64 {
        f64::from_bits(self.0.load(Ordering::Relaxed))
    }

    pub(crate) fn set(&self, time: f64) {
        self.0.store(time.to_bits(), Ordering::Relaxed);
    }
}

/// The log of an instance. The FMU may write to it from its own threads.
#[derive(Debug)]
pub(crate) struct Log {
    clock: Clock,
    kept: Mutex<Kept>,
}

#[derive(Debug, Default)]
struct Kept {
    lines: Vec<LogLine>,
    bytes: usize,
    /// Lines that were not kept.
    dropped: usize,
    /// Time of the last of them (s).
    dropped_at: f64,
    /// The last message, kept or not.
    last: String,
}

impl Log {
    /// The log of an instance whose time is `clock`.
    pub(crate) fn new(clock: Clock) -> Self {
        Self { clock, kept: Mutex::default() }
    }

    fn kept(&self) -> MutexGuard<'_, Kept> {
        // A thread that panicked leaves nothing half done.
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds a message; `status` is that of the standard, with the same numbers in both versions.
    pub(crate) fn push(&self, status: c_int, category: &str, message: &str) {
        let severity = match status {
            0 | 5 => Severity::Info,
            1 => Severity::Warning,
            _ => Severity::Error,
        };
        let message = message.trim_end();
        message.clone_into(&mut self.kept().last);
        let line =
            LogLine { time: self.clock.time(), severity, category: category.to_owned(), message: message.to_owned() };
        if SINK.get().is_some_and(|sink| sink(&line)) {
            return;
        }
        let mut kept = self.kept();
        let bytes = kept.bytes + category.len() + message.len();
        if kept.lines.len() < MOST_LINES && bytes <= MOST_BYTES {
            kept.bytes = bytes;
            kept.lines.push(line);
        } else {
            kept.dropped += 1;
            kept.dropped_at = line.time;
        }
    }

    /// The last message; empty if there was none.
    pub(crate) fn last(&self) -> String {
        self.kept().last.clone()
    }

    /// Takes the lines since the last call.
    pub(crate) fn take(&self) -> Vec<LogLine> {
        let mut kept = self.kept();
        kept.bytes = 0;
        let dropped = mem::take(&mut kept.dropped);
        let mut lines = mem::take(&mut kept.lines);
        if dropped > 0 {
            let message = format!("{dropped} more lines were not kept");
            let time = kept.dropped_at;
            lines.push(LogLine { time, severity: Severity::Warning, category: String::new(), message });
        }
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flood_is_cut_and_said() {
        let log = Log::new(Clock::at(0.0));
        for number in 0..MOST_LINES + 7 {
            log.push(0, "", &format!("{number}\n"));
        }
        let lines = log.take();
        assert_eq!(lines.len(), MOST_LINES + 1);
        assert_eq!(lines[MOST_LINES].message, "7 more lines were not kept");
        assert_eq!(log.last(), (MOST_LINES + 6).to_string());
        assert!(log.take().is_empty());
        log.push(3, "c", &"x".repeat(MOST_BYTES));
        assert_eq!(log.take().len(), 1, "too long to be kept");
    }

    #[test]
    fn a_line_has_the_time_at_which_it_was_said() {
        let clock = Clock::at(-1.0);
        let log = Log::new(clock.clone());
        for time in [-1.0, 0.0, 0.25] {
            clock.set(time);
            log.push(0, "", "here");
        }
        let times: Vec<f64> = log.take().iter().map(|line| line.time).collect();
        assert_eq!(times, [-1.0, 0.0, 0.25]);
    }
}
