//! Records the limits of the joints' ranges in a user's model as events while they bind.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use crate::limit_watch::Watch;
use servobench_base::Stateful;
use servobench_metrics::Incident;
use servobench_plant::JointLimit;
use servobench_trace::{Event, Recorder};

/// Source of the events of joint limits.
const MECHANICS: &str = "mechanics";

/// The watches of all joint limits, in the order of the mechanics.
#[derive(Debug, Clone, Default, Stateful)]
pub(crate) struct JointWatch {
    watches: Vec<Watch>,
    /// True if one of them bound at the last tick.
    bound: bool,
}

impl JointWatch {
    /// Records the limits that bind at tick `t` (s).
    #[inline(always)]
    pub(crate) fn tick(&mut self, t: f64, limits: &[JointLimit], recorder: &mut Recorder) {
        let bound = limits.iter().any(|limit| limit.binds);
        if bound || self.bound {
            self.bound = bound;
            self.note(t, limits, true, recorder);
        }
    }

    /// Ends the limits that still bind at `t` (s).
    pub(crate) fn finish(&mut self, t: f64, limits: &[JointLimit], recorder: &mut Recorder) {
        self.note(t, limits, false, recorder);
    }

    #[cold]
    fn note(&mut self, t: f64, limits: &[JointLimit], goes_on: bool, recorder: &mut Recorder) {
        self.watches.resize_with(limits.len(), Watch::default);
        for (watch, limit) in self.watches.iter_mut().zip(limits) {
            watch.tick(t, (goes_on && limit.binds).then_some(0.0), recorder, |start, end, is_last| {
                let event = Event::new(start, end, MECHANICS, format!("{}{}", limit.text, Event::noted(is_last)));
                event.incident(Incident::EndStop.name())
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
    fn an_end_that_binds_is_an_event_of_the_mechanics() {
        let mut recorder = Recorder::new(About::default(), Rate::new(1).unwrap(), Vec::new(), 0);
        let mut watch = JointWatch::default();
        let limits = |binds: [bool; 2]| {
            ["lower", "upper"].map(str::to_owned).into_iter().zip(binds).map(|(text, binds)| JointLimit { text, binds })
        };
        let binding = [[false, false], [false, true], [false, true], [false, false], [true, false]];
        for (t, binds) in [0.0, 1.0, 2.0, 3.0, 4.0].into_iter().zip(binding) {
            watch.tick(t, &limits(binds).collect::<Vec<_>>(), &mut recorder);
        }
        watch.finish(5.0, &limits([true, false]).collect::<Vec<_>>(), &mut recorder);
        let events = recorder.finish().0.events;
        let found: Vec<_> =
            events.iter().map(|event| (event.start, event.end, &event.source[..], &event.message[..])).collect();
        assert_eq!(found, [(1.0, 3.0, "mechanics", "upper"), (4.0, 5.0, "mechanics", "lower")]);
    }
}
