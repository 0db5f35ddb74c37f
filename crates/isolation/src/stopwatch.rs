//! Time that this process has run.
//!
//! A process that waits for another must not take its own sleep for the other's silence: after a SIGSTOP (Ctrl-Z) of this process, or a
//! pause of its virtual machine, all clocks of the system have advanced. A thread adds up short steps of the monotonic clock instead. The
//! time between two of its steps counts as [`LONGEST`] at most.
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::thread;
use std::time::{Duration, Instant};

/// Time between two steps.
const STEP: Duration = Duration::from_millis(20);
/// Longest time that a step may count: more passes between two of them only where the thread did not run.
const LONGEST: Duration = Duration::from_millis(100);

/// Time that has been added up (ns).
static RUN: AtomicU64 = AtomicU64::new(0);
/// Its start, where no thread adds up.
static CLOCK: OnceLock<Option<Instant>> = OnceLock::new();

/// Measures time in which this process runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stopwatch {
    start: Duration,
}

impl Stopwatch {
    /// Starts one.
    #[must_use]
    pub fn start() -> Self {
        Self { start: now() }
    }

    /// Time since its start, to a few hundredths of a second.
    #[must_use]
    pub fn elapsed(&self) -> Duration {
        now().saturating_sub(self.start)
    }
}

fn now() -> Duration {
    let without_thread = CLOCK.get_or_init(|| {
        let thread = thread::Builder::new().name("stopwatch".into()).spawn(|| add_up(Instant::now()));
        // Without a thread it is an ordinary clock.
        thread.is_err().then(Instant::now)
    });
    without_thread.map_or_else(|| Duration::from_nanos(RUN.load(Relaxed)), |start| start.elapsed())
}

fn add_up(mut last: Instant) {
    loop {
        thread::sleep(STEP);
        let now = Instant::now();
        let step = (now - last).min(LONGEST);
        RUN.fetch_add(u64::try_from(step.as_nanos()).unwrap_or(0), Relaxed);
        last = now;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A stopwatch never runs ahead, and keeps up where nothing stops the process; its largest lag depends on the machine.
    #[test]
    fn it_goes_with_the_clock() {
        let (clock, watch) = (Instant::now(), Stopwatch::start());
        while watch.elapsed() < Duration::from_millis(200) {
            thread::sleep(Duration::from_millis(1));
        }
        assert!(clock.elapsed() + STEP + LONGEST >= Duration::from_millis(200));
    }
}
