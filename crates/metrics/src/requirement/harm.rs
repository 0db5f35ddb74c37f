//! `no_harm`: only expected incidents do harm.
use super::{Expectation, Occasion, Rules};
use crate::incident::Incident;
use crate::quantity::Quantity;
use servobench_signals::Signal;
use servobench_trace::{Event, Recording};

/// Channels that show harm at the time of its occurrence.
const SHOWN_BY: [Signal; 2] = [Signal::EffortEndStop, Signal::TemperatureWinding];

/// Unexpected incidents that do harm, in words; `None` where nothing could come to harm.
pub(super) fn broken(recording: &Recording, rules: &Rules<'_>) -> Option<Vec<String>> {
    let does_harm = |event: &&Event| Incident::of(event).is_some_and(Incident::is_harm);
    let mut events = recording.events.iter().filter(does_harm).peekable();
    let is_shown = SHOWN_BY.iter().any(|one| recording.find(one).is_some());
    if events.peek().is_none() && !is_shown && recording.signal("drive", "buffer").is_none() {
        return None;
    }
    let is_excused = |event: &&Event| event.incident.as_ref().is_some_and(|mark| mark.excuse.is_some());
    let is_expected = |event: &&Event| rules.expected.iter().any(|expectation| is_it(expectation, event));
    let harm = events.filter(|event| !is_excused(event) && !is_expected(event));
    Some(harm.map(|event| format!("{}, at {}", event.message, Quantity::new(event.start, "s"))).collect())
}

/// Time of the expected incident (s).
pub(super) fn met(expectation: &Expectation, recording: &Recording) -> Option<f64> {
    recording.events.iter().find(|event| is_it(expectation, event)).map(|event| event.start)
}

fn is_it(expectation: &Expectation, event: &Event) -> bool {
    matches!(expectation.on, Occasion::Event(incident) if Incident::of(event) == Some(incident))
        && expectation.is_open_at(event.start)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirement::tests::rules;
    use crate::synthetic::Build;

    /// A contact at 0.3 s, one in homing at 0.1 s, and a limit of the drive.
    fn recording() -> Recording {
        let mut recording = Build::new(1000, 1001).finish();
        let event = |start, incident: Incident, message: &str| {
            Event::new(start, start, "mechanics", message).incident(incident.name())
        };
        let mut in_homing = event(0.1, Incident::EndStop, "the load meets the stop");
        in_homing.incident.as_mut().unwrap().excuse = Some("in homing".into());
        recording.events = vec![
            in_homing,
            event(0.2, Incident::InternalLimit, "internal limit binds"),
            event(0.3, Incident::EndStop, "the load meets the stop"),
        ];
        recording
    }

    #[test]
    fn harm_that_is_neither_expected_nor_excused_is_a_reason() {
        assert_eq!(broken(&recording(), &rules()).unwrap(), ["the load meets the stop, at 300 ms"]);
        for (incident, from, to, left) in [
            (Incident::EndStop, 0.2, 0.4, 0),
            (Incident::EndStop, 0.0, f64::INFINITY, 0),
            (Incident::EndStop, 0.31, 0.4, 1),
            (Incident::WindingTemperature, 0.0, f64::INFINITY, 1),
        ] {
            let expected = [Expectation { on: Occasion::Event(incident), from, to }];
            let found = broken(&recording(), &Rules { expected: &expected, ..rules() }).unwrap();
            assert_eq!(found.len(), left, "{expected:?}: {found:?}");
        }
    }

    #[test]
    fn an_expected_incident_is_met_when_it_comes() {
        let expecting = |incident, from, to| Expectation { on: Occasion::Event(incident), from, to };
        for (incident, from, to, time) in [
            (Incident::EndStop, 0.2, 1.0, Some(0.3)),
            (Incident::EndStop, 0.0, 1.0, Some(0.1)),
            (Incident::InternalLimit, 0.0, 1.0, Some(0.2)),
            (Incident::EndStop, 0.4, 1.0, None),
            (Incident::BufferOverflow, 0.0, 1.0, None),
        ] {
            assert_eq!(met(&expecting(incident, from, to), &recording()), time, "{incident} {from} {to}");
        }
    }

    #[test]
    fn an_axis_that_nothing_can_harm_is_not_asked() {
        let with = |build: Build| broken(&build.finish(), &rules());
        assert_eq!(with(Build::new(1000, 11)), None);
        assert_eq!(with(Build::new(1000, 11).channel(Signal::EffortEndStop, "N", |_| 0.0)), Some(vec![]));
        assert_eq!(with(Build::new(1000, 11).channel(Signal::TemperatureWinding, "°C", |_| 20.0)), Some(vec![]));
        assert_eq!(with(Build::new(1000, 11).signal("drive", "buffer", &[(0.0, "none")])), Some(vec![]));
    }
}
