//! Records the alarms of the hardware as events, whether or not a drive reads them.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use crate::limit_watch::Watch;
use servobench_base::Stateful;
use servobench_signals::Alarms;
use servobench_trace::{Event, Recorder};

/// Source and message of each alarm.
const WORDS: [(&str, &str); 3] = [
    ("DC link", "the DC link has less than half of its voltage"),
    ("motor encoder", "the motor encoder has an error: its signals cannot be trusted"),
    ("load encoder", "the load encoder has an error: its signals cannot be trusted"),
];

/// The watches of all alarms.
#[derive(Debug, Clone, Default, Stateful)]
pub(crate) struct AlarmWatch {
    watches: [Watch; 3],
    last: Alarms,
}

impl AlarmWatch {
    /// Records the alarms of the tick at `t` (s).
    #[inline(always)]
    pub(crate) fn tick(&mut self, t: f64, alarms: Alarms, recorder: &mut Recorder) {
        if alarms != self.last {
            self.note(t, alarms, recorder);
        }
    }

    /// Ends the alarms that are still active at `t` (s).
    pub(crate) fn finish(&mut self, t: f64, recorder: &mut Recorder) {
        self.note(t, Alarms::default(), recorder);
    }

    #[cold]
    fn note(&mut self, t: f64, alarms: Alarms, recorder: &mut Recorder) {
        self.last = alarms;
        let Alarms { collapsed_link, motor_encoder, load_encoder } = alarms;
        for ((watch, alarm), (source, words)) in
            self.watches.iter_mut().zip([collapsed_link, motor_encoder, load_encoder]).zip(WORDS)
        {
            watch.tick(t, alarm.then_some(0.0), recorder, |start, end, is_last| {
                Event::new(start, end, source, format!("{words}{}", Event::noted(is_last)))
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_base::Rate;
    use servobench_trace::About;

    #[test]
    fn an_alarm_is_an_event_from_its_beginning_to_its_end() {
        let mut recorder = Recorder::new(About::default(), Rate::new(1).unwrap(), Vec::new(), 0);
        let mut watch = AlarmWatch::default();
        for (t, collapsed_link, motor_encoder) in
            [(0.0, false, false), (1.0, true, false), (2.0, true, true), (3.0, false, true)]
        {
            watch.tick(t, Alarms { collapsed_link, motor_encoder, load_encoder: false }, &mut recorder);
        }
        watch.finish(7.0, &mut recorder);
        let events = recorder.finish().0.events;
        let found: Vec<_> = events.iter().map(|event| (event.start, event.end, event.source.as_str())).collect();
        assert_eq!(found, [(1.0, 3.0, "DC link"), (2.0, 7.0, "motor encoder")]);
    }
}
