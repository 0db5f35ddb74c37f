//! Watches the limits that bind: nothing is cut in silence.
use servobench_trace::{Event, Recorder};

/// Events noted for one limit at most; one more says that there were others.
const MOST_EVENTS: usize = 100;

/// One limit: whether it binds, since when, and how often it did since the last row.
#[derive(Debug, Clone, Default)]
struct Watch {
    since: Option<f64>,
    bound_ticks: u32,
    events: usize,
}

/// The voltage limit of the current loop and the effort limit of the velocity loop.
#[derive(Debug, Clone, Default)]
pub(crate) struct LimitWatch {
    voltage: Watch,
    effort: Watch,
    ticks: u32,
}

const VOLTAGE: (&str, &str) = ("current loop", "voltage limit binds");
const EFFORT: (&str, &str) = ("velocity loop", "effort limit binds");

impl LimitWatch {
    /// Takes what tick `t` (s) says.
    pub(crate) fn tick(&mut self, t: f64, voltage: bool, effort: bool, recorder: &mut Recorder) {
        self.ticks += 1;
        self.voltage.tick(t, voltage, VOLTAGE, recorder);
        self.effort.tick(t, effort, EFFORT, recorder);
    }

    /// Shares of the ticks since the last call in which the voltage and the effort limit bound, 0 to 1.
    pub(crate) fn shares(&mut self) -> (f64, f64) {
        let ticks = f64::from(self.ticks.max(1));
        self.ticks = 0;
        let share = |watch: &mut Watch| f64::from(core::mem::take(&mut watch.bound_ticks)) / ticks;
        (share(&mut self.voltage), share(&mut self.effort))
    }

    /// Ends what still binds at `t` (s).
    pub(crate) fn finish(&mut self, t: f64, recorder: &mut Recorder) {
        self.voltage.tick(t, false, VOLTAGE, recorder);
        self.effort.tick(t, false, EFFORT, recorder);
    }
}

impl Watch {
    fn tick(&mut self, t: f64, binds: bool, (source, message): (&str, &str), recorder: &mut Recorder) {
        self.bound_ticks += u32::from(binds);
        match (self.since, binds) {
            (None, true) => self.since = Some(t),
            (Some(start), false) => {
                self.since = None;
                self.events += 1;
                let more = if self.events == MOST_EVENTS { "; later ones are not listed" } else { "" };
                if self.events <= MOST_EVENTS {
                    let (source, message) = (source.to_owned(), format!("{message}{more}"));
                    recorder.note_event(Event { start, end: t, source, message });
                }
            }
            (None, false) | (Some(_), true) => {}
        }
    }
}
