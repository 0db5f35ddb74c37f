//! Incidents that states of the drive show: its trajectory buffer, its limits.
use super::Incident;
use servobench_trace::{Event, Recording};

/// Source and name of the state of the trajectory buffer.
pub(super) const BUFFER: (&str, &str) = ("drive", "buffer");
/// Source and name of bit 11 of the statusword.
pub(super) const INTERNAL_LIMIT: (&str, &str) = ("drive", "internal_limit");
/// Name in events of the limit that bit 11 stands for.
const LIMIT: &str = "internal limit";

/// Errors that a buffer latches: value of its state, incident, words.
const ERRORS: [(&str, Incident, &str); 3] = [
    ("point missing", Incident::MissingPoint, "a point of the trajectory is missing in the buffer of the drive"),
    ("Overflow", Incident::BufferOverflow, "the trajectory buffer of the drive overflows: points are lost"),
    (
        "Underflow",
        Incident::BufferUnderflow,
        "the trajectory buffer of the drive runs out of points while the axis moves",
    ),
];

/// Spells of a state in which `holds`, from start to end (s); the last one may last to infinity.
pub(super) fn spells_of(
    recording: &Recording,
    (source, name): (&str, &str),
    holds: impl Fn(&str) -> bool,
) -> Vec<[f64; 2]> {
    let Some(signal) = recording.signal(source, name) else { return Vec::new() };
    let mut spells = Vec::new();
    let mut since = None;
    for (time, value) in &signal.changes {
        match (since, holds(value)) {
            (None, true) => since = Some(*time),
            (Some(start), false) => {
                spells.push([start, *time]);
                since = None;
            }
            (None, false) | (Some(_), true) => {}
        }
    }
    spells.extend(since.map(|start| [start, f64::INFINITY]));
    spells
}

/// Such spells, clipped at the end of the recording.
pub(super) fn recorded(recording: &Recording, spells: Vec<[f64; 2]>) -> impl Iterator<Item = [f64; 2]> {
    let last = recording.time_of(recording.len().saturating_sub(1));
    spells.into_iter().map(move |[start, end]| [start, end.min(last).max(start)])
}

/// Each error of the buffer, from when it is latched to its reset.
pub(super) fn of_buffer(recording: &Recording) -> Vec<Event> {
    let of = |(word, incident, message): (&'static str, Incident, &'static str)| {
        let spells = spells_of(recording, BUFFER, |value| value.split(", ").any(|one| one == word));
        let event = move |[start, end]: [f64; 2]| Event::new(start, end, "drive", message).incident(incident.name());
        recorded(recording, spells).map(event)
    };
    ERRORS.into_iter().flat_map(of).collect()
}

/// Each spell of an active limit.
pub(super) fn of_internal_limit(recording: &Recording) -> Vec<Event> {
    let event = |[start, end]: [f64; 2]| {
        Event::bound(start, end, "drive", LIMIT, false).incident(Incident::InternalLimit.name())
    };
    recorded(recording, limited(recording)).map(event).collect()
}

/// Spells of an active limit.
pub(super) fn limited(recording: &Recording) -> Vec<[f64; 2]> {
    spells_of(recording, INTERNAL_LIMIT, |value| value == "TRUE")
}

/// Errors that the buffer latched in a run whose drive followed points; `None` where it never did.
pub(super) fn buffer_errors(recording: &Recording) -> Option<usize> {
    let in_ip = |signal: &servobench_trace::Signal| signal.changes.iter().any(|(_, mode)| mode == "ip");
    let follows_points = recording.signal("drive", "mode").is_some_and(in_ip);
    (follows_points && recording.signal(BUFFER.0, BUFFER.1).is_some()).then(|| of_buffer(recording).len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::Build;
    use servobench_signals::Signal;

    #[test]
    fn each_error_of_the_buffer_is_an_incident_of_its_own() {
        let changes =
            [(0.0, "none"), (0.2, "Overflow"), (0.5, "Overflow, Underflow"), (0.8, "none"), (0.9, "Overflow")];
        let recording = Build::new(1000, 1001)
            .channel(Signal::LoadPosition, "m", |t| t)
            .signal("drive", "buffer", &changes)
            .signal("drive", "mode", &[(0.0, "ip")])
            .finish();
        let found = of_buffer(&recording);
        let found: Vec<_> = found.iter().map(|event| (event.start, event.end, Incident::of(event).unwrap())).collect();
        let (over, under) = (Incident::BufferOverflow, Incident::BufferUnderflow);
        assert_eq!(found, [(0.2, 0.8, over), (0.9, 1.0, over), (0.5, 0.8, under)]);
        assert_eq!(buffer_errors(&recording), Some(3));
        let csp = Build::new(1000, 1001).signal("drive", "buffer", &[(0.0, "none")]).finish();
        assert_eq!(buffer_errors(&csp), None, "no drive that follows points");
    }

    #[test]
    fn an_active_limit_is_an_event_of_a_limit_that_bound() {
        let changes = [(0.0, "FALSE"), (0.3, "TRUE"), (0.45, "FALSE")];
        let recording = Build::new(1000, 1001)
            .channel(Signal::LoadPosition, "m", |t| t)
            .signal("drive", "internal_limit", &changes)
            .finish();
        let [event] = &of_internal_limit(&recording)[..] else { panic!() };
        assert_eq!((event.start, event.end, event.message.as_str()), (0.3, 0.45, "internal limit binds"));
    }
}
