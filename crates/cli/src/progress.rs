//! Progress of the runs: a bar on a terminal, plain lines otherwise; number of runs done, their names, elapsed and remaining time.
use crate::console::say;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use servobench_isolation::Stopwatch;
use servobench_results::printable;
use std::io::IsTerminal;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Steps of the bar for one run.
const STEPS: f64 = 1000.0;

/// Display of progress on standard error, so that results can be piped.
pub(crate) struct Progress {
    bar: ProgressBar,
    /// Runs between two lines; 0 for no lines.
    lines: u64,
    quiet: bool,
    done: AtomicU64,
    runs: usize,
    start: Instant,
}

impl Progress {
    /// For `runs` runs; `quiet` shows nothing.
    pub(crate) fn new(runs: usize, quiet: bool) -> Self {
        let terminal = std::io::stderr().is_terminal();
        let bar = if quiet || !terminal {
            ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden())
        } else {
            ProgressBar::new(runs as u64 * 1000)
        };
        let template = "{prefix} {bar:16} {percent:>3} %  {elapsed}, {eta} left  {wide_msg}";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.set_prefix(format!("0/{runs}"));
        Self { bar, lines: u64::from(!quiet && !terminal), quiet, done: AtomicU64::new(0), runs, start: Instant::now() }
    }

    /// The same with a line for each percent of the runs instead of each run.
    pub(crate) fn by_percent(self) -> Self {
        Self { lines: self.lines * (self.runs as u64).div_ceil(100), ..self }
    }

    /// A listener for the run `id`, which receives the share that is done, from 0 to 1. A run that takes longer than `slow` is named, and
    /// again each time that has doubled.
    pub(crate) fn of_run(&self, id: &str, slow: Duration) -> impl FnMut(f64) {
        // The bar goes to the terminal by itself.
        self.bar.set_message(printable(id));
        let (mut shown, watch, mut slow) = (0.0, Stopwatch::start(), slow);
        let id = id.to_owned();
        move |share: f64| {
            let step = (share * STEPS).floor();
            if step > shown {
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 1000")]
                self.bar.inc((step - shown) as u64);
                shown = step;
            }
            // The last message of a run is that of its end.
            if watch.elapsed() >= slow && share < 1.0 {
                self.say(&format!("slow: {id}: {:.0} % done after {}\n", share * 100.0, seconds(slow)));
                slow *= 2;
            }
        }
    }

    fn say(&self, words: &str) {
        if !self.quiet {
            self.bar.suspend(|| say(words));
        }
    }

    /// The run `id` ended.
    pub(crate) fn ended(&self, id: &str, words: &str) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        self.bar.set_prefix(format!("{done}/{}", self.runs));
        let is_told = self.lines > 0 && (done.is_multiple_of(self.lines) || done == self.runs as u64);
        if is_told {
            let elapsed = self.start.elapsed();
            let left = left(elapsed, done, self.runs as u64);
            say(&format!("[{done}/{}] {id}: {words} ({}{left})\n", self.runs, seconds(elapsed)));
        }
    }

    /// Everything ended: the bar goes away.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// Estimate of the remaining time from that of the runs before: `, about 12 s left`; empty at the end.
fn left(elapsed: Duration, done: u64, runs: u64) -> String {
    match runs.saturating_sub(done) {
        0 => String::new(),
        rest => format!(", about {} left", seconds(elapsed.mul_f64(rest as f64 / done.max(1) as f64))),
    }
}

/// `0.4 s`, `75 s`, `12 min`
fn seconds(time: Duration) -> String {
    match time.as_secs_f64() {
        short if short < 10.0 => format!("{short:.1} s"),
        short if short < 120.0 => format!("{short:.0} s"),
        long => format!("{:.0} min", long / 60.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_left_is_that_of_as_many_runs_as_are_left() {
        let elapsed = Duration::from_secs(6);
        assert_eq!(left(elapsed, 3, 31), ", about 56 s left");
        assert_eq!(left(elapsed, 31, 31), "");
        assert_eq!(left(elapsed, 3, 400), ", about 13 min left");
        assert_eq!(seconds(Duration::from_millis(420)), "0.4 s");
    }
}
