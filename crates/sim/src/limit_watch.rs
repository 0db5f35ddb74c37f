//! Records the limits of the loops as events while they bind, and reversals from one limit to the opposite one.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use servobench_base::Stateful;
use servobench_signals::PerLimit;
use servobench_trace::{Event, LimitReversals, Recorder};

/// Most events recorded for one limit; the last one notes that there were more.
const MOST_EVENTS: usize = 100;

/// State of one limit: start of binding, number of bound ticks since the last row, and reversals.
#[derive(Debug, Clone, Default, Stateful)]
pub(crate) struct Watch {
    since: Option<f64>,
    bound_ticks: u32,
    events: usize,
    /// True if the positive limit bound last.
    bound_above: Option<bool>,
    /// Times at which it bound on the opposite side to before (s).
    reversals: Vec<f64>,
}

/// All limits.
#[derive(Debug, Clone, Default, Stateful)]
pub(crate) struct LimitWatch {
    watches: PerLimit<Watch>,
    /// True if one of them bound at the last tick.
    bound: bool,
    ticks: u32,
}

/// The part that applies a limit, and the limit's name.
type Limit = (&'static str, &'static str);
const VOLTAGE: Limit = ("inverter", PerLimit::NAMES.voltage);
const CURRENT: Limit = ("velocity loop", PerLimit::NAMES.current);
const EFFORT: Limit = ("velocity loop", PerLimit::NAMES.effort);
const SPEED: Limit = ("velocity loop", PerLimit::NAMES.speed);
const MASTER: Limit = ("master", PerLimit::NAMES.master);

impl LimitWatch {
    /// Records the limits that bind at tick `t` (s), and the values they cut, whose sign counts.
    #[inline(always)]
    #[expect(
        clippy::trivially_copy_pass_by_ref,
        reason = "a copy waits until all of it that was just written is in the cache"
    )]
    pub(crate) fn tick(&mut self, t: f64, binds: &PerLimit<bool>, cut: PerLimit<f64>, recorder: &mut Recorder) {
        self.ticks += 1;
        let bound = binds.voltage | binds.current | binds.effort | binds.speed | binds.master;
        if bound || self.bound {
            self.bound = bound;
            self.note(t, *binds, cut, recorder);
        }
    }

    /// Shares of the ticks since the last call in which each limit bound, 0 to 1; those of velocities have no channel and stay 0.
    #[inline(always)]
    pub(crate) fn shares(&mut self) -> PerLimit<f64> {
        let ticks = core::mem::take(&mut self.ticks);
        let PerLimit { voltage, current, effort, .. } = &mut self.watches;
        let [voltage, current, effort] =
            [voltage, current, effort].map(|watch| core::mem::take(&mut watch.bound_ticks));
        if voltage | current | effort == 0 {
            return PerLimit::default();
        }
        let share = |bound: u32| f64::from(bound) / f64::from(ticks.max(1));
        let [voltage, current, effort] = [voltage, current, effort].map(share);
        PerLimit { voltage, current, effort, ..PerLimit::default() }
    }

    /// Ends the limits that still bind at `t` (s), and records the reversals.
    pub(crate) fn finish(&mut self, t: f64, recorder: &mut Recorder) {
        self.note(t, PerLimit::default(), PerLimit::default(), recorder);
        let PerLimit { voltage, current, effort, speed, master } = &mut self.watches;
        for (watch, (_, limit)) in
            [(voltage, VOLTAGE), (current, CURRENT), (effort, EFFORT), (speed, SPEED), (master, MASTER)]
        {
            let times = std::mem::take(&mut watch.reversals);
            if !times.is_empty() {
                recorder.note_limit_reversals(LimitReversals { limit: limit.into(), times });
            }
        }
    }

    #[cold]
    fn note(&mut self, t: f64, binds: PerLimit<bool>, cut: PerLimit<f64>, recorder: &mut Recorder) {
        let PerLimit { voltage, current, effort, speed, master } = &mut self.watches;
        let event =
            |(source, limit): Limit| move |start, end, is_last| Event::bound(start, end, source, limit, is_last);
        voltage.tick(t, binds.voltage.then_some(cut.voltage), recorder, event(VOLTAGE));
        current.tick(t, binds.current.then_some(cut.current), recorder, event(CURRENT));
        effort.tick(t, binds.effort.then_some(cut.effort), recorder, event(EFFORT));
        speed.tick(t, binds.speed.then_some(cut.speed), recorder, event(SPEED));
        master.tick(t, binds.master.then_some(cut.master), recorder, event(MASTER));
    }
}

impl Watch {
    /// Updates the watch with the value cut at `t` (s), if the limit binds. `event` makes the event from start to end (s); its last
    /// argument is true for the last event recorded.
    pub(crate) fn tick(
        &mut self,
        t: f64,
        cut: Option<f64>,
        recorder: &mut Recorder,
        event: impl FnOnce(f64, f64, bool) -> Event,
    ) {
        let binds = cut.is_some();
        self.bound_ticks += u32::from(binds);
        if let Some(cut) = cut {
            let is_above = cut > 0.0;
            if self.bound_above.replace(is_above).is_some_and(|before| before != is_above)
                && self.reversals.len() < LimitReversals::MOST
                && recorder.keeps()
            {
                self.reversals.push(t);
            }
        }
        match (self.since, binds) {
            (None, true) => self.since = Some(t),
            (Some(start), false) => {
                self.since = None;
                self.events += 1;
                if self.events <= MOST_EVENTS {
                    recorder.note_event(event(start, t, self.events == MOST_EVENTS));
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

    fn recorder() -> Recorder {
        Recorder::new(About::default(), Rate::new(1).unwrap(), Vec::new(), 0)
    }

    /// The events of a run in which `binds` gives the limits that bind at each tick; a tick is a second.
    fn events(binds: impl IntoIterator<Item = PerLimit<bool>>) -> Vec<Event> {
        let (mut recorder, mut watch, mut t) = (recorder(), LimitWatch::default(), 0.0);
        for binds in binds {
            watch.tick(t, &binds, POSITIVE, &mut recorder);
            t += 1.0;
        }
        watch.finish(t - 1.0, &mut recorder);
        recorder.finish().0.events
    }

    const POSITIVE: PerLimit<f64> = PerLimit { voltage: 1.0, current: 1.0, effort: 1.0, speed: 1.0, master: 1.0 };

    /// A cut in between is not a reversal, and neither is a limit that binds on the same side again.
    #[test]
    fn a_reversal_is_a_cut_at_the_limit_opposite_to_the_last_one() {
        let (mut recorder, mut watch) = (recorder(), LimitWatch::default());
        for (t, effort) in [(0.0, 1.0), (1.0, 2.0), (2.0, 0.0), (3.0, -1.0), (4.0, 0.0), (5.0, -3.0), (6.0, 0.5)] {
            let cut = PerLimit { effort, ..PerLimit::default() };
            watch.tick(t, &binding(false, false, effort != 0.0), cut, &mut recorder);
        }
        watch.finish(7.0, &mut recorder);
        let found = recorder.finish().0.limit_reversals;
        assert_eq!(found, [LimitReversals { limit: "effort limit".into(), times: vec![3.0, 6.0] }]);
    }

    /// A speed is cut as an effort is, and each limit has its own alternations.
    #[test]
    fn velocities_of_drive_and_master_are_watched_too() {
        let (mut recorder, mut watch) = (recorder(), LimitWatch::default());
        for (t, speed, master) in [(0.0, 1.0, 0.0), (1.0, -2.0, -1.0), (2.0, 0.0, 1.0), (3.0, 1.0, 0.0)] {
            let binds = PerLimit { speed: speed != 0.0, master: master != 0.0, ..PerLimit::default() };
            watch.tick(t, &binds, PerLimit { speed, master, ..PerLimit::default() }, &mut recorder);
        }
        watch.finish(4.0, &mut recorder);
        let recording = recorder.finish().0;
        let reversals = |limit: &str, times: &[f64]| LimitReversals { limit: limit.into(), times: times.to_vec() };
        let expected = [reversals("speed limit", &[1.0, 3.0]), reversals("velocity limit of the master", &[2.0])];
        assert_eq!(recording.limit_reversals, expected);
        let messages = recording.events.iter().map(|event| event.message.as_str());
        let speed = "speed limit binds";
        let master = "velocity limit of the master binds";
        assert_eq!(messages.collect::<Vec<_>>(), [speed, master, speed]);
    }

    fn binding(voltage: bool, current: bool, effort: bool) -> PerLimit<bool> {
        PerLimit { voltage, current, effort, ..PerLimit::default() }
    }

    #[test]
    fn an_event_lasts_from_the_first_tick_that_binds_to_the_first_that_does_not() {
        let voltage = [false, true, true, false, false, true, false];
        let current = [true, true, false, false, false, false, false];
        let effort = [false, false, true, true, true, true, true];
        let found = events((0..7).map(|k| binding(voltage[k], current[k], effort[k])));
        let found: Vec<_> = found.iter().map(|event| (event.start, event.end, event.message.as_str())).collect();
        let [voltage, current, effort] = ["voltage limit binds", "current limit binds", "effort limit binds"];
        assert_eq!(found, [(0.0, 2.0, current), (1.0, 3.0, voltage), (2.0, 6.0, effort), (5.0, 6.0, voltage)]);
    }

    #[test]
    fn shares_are_of_the_ticks_since_the_last_row() {
        let (mut recorder, mut watch) = (recorder(), LimitWatch::default());
        assert_eq!(watch.shares(), PerLimit::default());
        for (voltage, current, effort) in
            [(true, false, false), (true, true, false), (false, true, false), (true, false, true)]
        {
            watch.tick(0.0, &binding(voltage, current, effort), POSITIVE, &mut recorder);
        }
        let shares = PerLimit { voltage: 0.75, current: 0.5, effort: 0.25, ..PerLimit::default() };
        assert_eq!(watch.shares(), shares);
        watch.tick(0.0, &binding(true, false, false), POSITIVE, &mut recorder);
        assert_eq!(watch.shares(), PerLimit { voltage: 1.0, ..PerLimit::default() });
    }

    #[test]
    fn the_last_event_that_is_listed_says_that_there_were_others() {
        let chatter = |times: usize| events((0..2 * times).map(|k| binding(k % 2 == 0, false, false)));
        assert!(chatter(99).iter().all(|event| event.message == "voltage limit binds"));
        let many = chatter(150);
        assert_eq!(many.len(), 100);
        assert_eq!(many[99].message, "voltage limit binds; later ones are not listed");
    }
}
