//! Progress of the runs: a bar on a terminal, plain lines otherwise.
use crate::console::say;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::sync::atomic::{AtomicU64, Ordering};

/// Steps of the bar for one run.
const STEPS: f64 = 1000.0;

/// Shows how far the runs are; on standard error, so that results can be piped.
pub(crate) struct Progress {
    bar: ProgressBar,
    lines: bool,
    done: AtomicU64,
    runs: usize,
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
        if let Ok(style) = ProgressStyle::with_template("{msg:30!} {wide_bar} {percent:>3} %") {
            bar.set_style(style);
        }
        Self { bar, lines: !quiet && !terminal, done: AtomicU64::new(0), runs }
    }

    /// A listener for one run: hears the share that is done, from 0 to 1.
    pub(crate) fn of_run(&self) -> impl FnMut(f64) {
        let mut shown = 0.0;
        move |share: f64| {
            let step = (share * STEPS).floor();
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 1000")]
            self.bar.inc((step - shown).max(0.0) as u64);
            shown = step.max(shown);
        }
    }

    /// A run ended.
    pub(crate) fn ended(&self, id: &str, words: &str) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        self.bar.set_message(format!("{done}/{} {id}", self.runs));
        if self.lines {
            say(&format!("[{done}/{}] {id}: {words}\n", self.runs));
        }
    }

    /// Everything ended: the bar goes away.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
