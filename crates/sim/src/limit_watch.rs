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

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_base::Rate;
    use servobench_trace::About;

    /// The events of a run in which `binds` says at each tick whether voltage and effort limit bind; a tick is a second.
    fn events(binds: impl IntoIterator<Item = (bool, bool)>) -> Vec<Event> {
        let about = About {
            scenario: "limits".into(),
            engine: "none".into(),
            axis_unit: "m".into(),
            bodies: vec!["motor".into()],
        };
        let mut recorder = Recorder::new(about, Rate::new(1).unwrap(), Vec::new(), 0);
        let (mut watch, mut t) = (LimitWatch::default(), 0.0);
        for (voltage, effort) in binds {
            watch.tick(t, voltage, effort, &mut recorder);
            t += 1.0;
        }
        watch.finish(t - 1.0, &mut recorder);
        recorder.finish().events
    }

    /// Start, end and source of each.
    fn spans(events: &[Event]) -> Vec<(f64, f64, &str)> {
        events.iter().map(|event| (event.start, event.end, event.source.as_str())).collect()
    }

    #[test]
    fn an_event_lasts_from_the_first_tick_that_binds_to_the_first_that_does_not() {
        let voltage = [false, true, true, false, false, true, false];
        let effort = [false, false, true, true, true, true, true];
        let found = events(voltage.into_iter().zip(effort));
        let (current_loop, velocity_loop) = ("current loop", "velocity loop");
        assert_eq!(spans(&found), [(1.0, 3.0, current_loop), (2.0, 6.0, velocity_loop), (5.0, 6.0, current_loop)]);
        assert_eq!(found[0].message, "voltage limit binds");
        assert_eq!(found[1].message, "effort limit binds");
    }

    #[test]
    fn shares_are_of_the_ticks_since_the_last_row() {
        let mut recorder = Recorder::new(
            About { scenario: String::new(), engine: String::new(), axis_unit: String::new(), bodies: Vec::new() },
            Rate::new(1).unwrap(),
            Vec::new(),
            0,
        );
        let mut watch = LimitWatch::default();
        assert_eq!(watch.shares(), (0.0, 0.0));
        for (voltage, effort) in [(true, false), (true, false), (false, false), (true, true)] {
            watch.tick(0.0, voltage, effort, &mut recorder);
        }
        assert_eq!(watch.shares(), (0.75, 0.25));
        watch.tick(0.0, true, false, &mut recorder);
        assert_eq!(watch.shares(), (1.0, 0.0));
    }

    #[test]
    fn the_last_event_that_is_listed_says_that_there_were_others() {
        let chatter = |times: usize| events((0..2 * times).map(|k| (k % 2 == 0, false)));
        assert!(chatter(99).iter().all(|event| event.message == "voltage limit binds"));
        let many = chatter(150);
        assert_eq!(many.len(), 100);
        assert_eq!(many[99].message, "voltage limit binds; later ones are not listed");
    }
}
