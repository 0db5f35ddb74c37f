//! `no_fault`: axis, drive and link have only expected faults, and their consequences.
//!
//! A fault of the drive stops the link, and either brings the axis to `ErrorStop`: while an expected fault lasts, one of a part
//! behind it is its consequence.
use super::{Expectation, Occasion, Rules, execution};
use crate::quantity::Quantity;
use servobench_trace::{Recording, Signal};

/// A part that can have a fault, in the order in which one follows from the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Part {
    Drive,
    Link,
    Axis,
}

/// A fault, and how long it lasted.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Occurrence {
    part: Part,
    /// Value of the signal: `8611h`, `positive limit switch`, `ErrorStop`.
    fault: String,
    /// Start and end of the fault (s).
    start: f64,
    end: f64,
}

impl Part {
    const ALL: [Self; 3] = [Self::Drive, Self::Link, Self::Axis];

    const fn name(self) -> &'static str {
        match self {
            Self::Drive => "drive",
            Self::Link => "link",
            Self::Axis => "axis",
        }
    }

    fn signal(self, recording: &Recording) -> Option<&Signal> {
        match self {
            Self::Drive | Self::Link => recording.signal(self.name(), "fault"),
            Self::Axis => recording.signal("axis", "state"),
        }
    }

    /// True if a value of its signal is a fault of this part itself.
    fn is_fault(self, value: &str) -> bool {
        match self {
            Self::Drive => value != "none",
            // The link repeats what the drive reports.
            Self::Link => value != "none" && !value.ends_with("of the drive"),
            Self::Axis => value == "ErrorStop",
        }
    }
}

/// Every fault of the run, in order of time.
pub(super) fn occurrences(recording: &Recording) -> Vec<Occurrence> {
    let mut all = Vec::new();
    for part in Part::ALL {
        let Some(signal) = part.signal(recording) else { continue };
        let ends = signal.changes.iter().skip(1).map(|(time, _)| *time).chain([f64::INFINITY]);
        let values = signal.changes.iter().zip(ends).filter(|((_, value), _)| part.is_fault(value));
        all.extend(values.map(|((start, value), end)| Occurrence { part, fault: value.clone(), start: *start, end }));
    }
    all.sort_by(|one, two| one.start.total_cmp(&two.start).then(one.part.cmp(&two.part)));
    all
}

/// Time at which the expectation was met (s).
pub(super) fn met(expectation: &Expectation, faults: &[Occurrence], recording: &Recording) -> Option<f64> {
    let of_parts = faults.iter().find(|fault| is_it(expectation, fault)).map(|fault| fault.start);
    of_parts.or_else(|| recording.calls.iter().find_map(|call| execution::fits(expectation, call)))
}

fn is_it(expectation: &Expectation, fault: &Occurrence) -> bool {
    let Occasion::Fault { fault: expected, who } = &expectation.on else { return false };
    who == fault.part.name() && expected.eq_ignore_ascii_case(&fault.fault) && expectation.is_open_at(fault.start)
}

/// The unexpected faults; `None` without a part that could have one.
pub(super) fn broken(recording: &Recording, rules: &Rules<'_>, faults: &[Occurrence]) -> Option<Vec<String>> {
    if Part::ALL.iter().all(|part| part.signal(recording).is_none()) {
        return None;
    }
    let is_expected = |fault: &Occurrence| rules.expected.iter().any(|expectation| is_it(expectation, fault));
    let follows = |fault: &Occurrence| {
        let causes = faults.iter().filter(|cause| cause.part < fault.part && is_expected(cause));
        causes.into_iter().any(|cause| cause.start <= fault.start && fault.start <= cause.end)
    };
    let unexpected = faults.iter().filter(|fault| !is_expected(fault) && !follows(fault));
    Some(unexpected.map(|fault| words(fault, recording)).collect())
}

fn words(fault: &Occurrence, recording: &Recording) -> String {
    let time = Quantity::new(fault.start, "s");
    match fault.part {
        Part::Drive => format!("the drive has the fault {} at {time}", fault.fault),
        Part::Link => format!("the link has the fault \"{}\" at {time}", fault.fault),
        Part::Axis => {
            let at_once = |start: f64| (start - fault.start).abs() <= recording.rate.period();
            let why = recording.events.iter().find(|event| event.source == "axis" && at_once(event.start));
            let why = why.map_or_else(String::new, |event| format!(": {}", event.message));
            format!("the axis enters ErrorStop at {time}{why}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirement::tests::{expecting, rules};
    use crate::synthetic::Build;
    use servobench_trace::Event;

    /// Source, name and changes of a signal.
    type Noted<'a> = (&'a str, &'a str, &'a [(f64, &'a str)]);

    fn recording(signals: &[Noted<'_>]) -> Recording {
        let mut recording = Build::new(1000, 1001).finish();
        recording.signals = signals
            .iter()
            .map(|(source, name, changes)| Signal {
                source: (*source).into(),
                name: (*name).into(),
                changes: changes.iter().map(|(time, value)| (*time, (*value).to_owned())).collect(),
            })
            .collect();
        recording
    }

    fn found(recording: &Recording, expected: &[Expectation]) -> Option<Vec<String>> {
        broken(recording, &Rules { expected, ..rules() }, &occurrences(recording))
    }

    /// A following error of the drive at 0.3 s, which the link and the axis see later, and which is reset at 0.6 s.
    fn following_error() -> Recording {
        let mut recording = recording(&[
            ("drive", "fault", &[(0.0, "none"), (0.3, "8611h"), (0.6, "none")]),
            ("link", "fault", &[(0.0, "none"), (0.301, "fault 8611h of the drive"), (0.601, "none")]),
            ("axis", "state", &[(0.0, "Standstill"), (0.302, "ErrorStop"), (0.603, "Standstill")]),
        ]);
        let message = "the drive has a fault".to_owned();
        recording.events.push(Event::new(0.302, 0.302, "axis", message));
        recording
    }

    #[test]
    fn every_fault_that_is_not_expected_is_named() {
        assert_eq!(
            found(&following_error(), &[]).unwrap(),
            ["the drive has the fault 8611h at 300 ms", "the axis enters ErrorStop at 302 ms: the drive has a fault",]
        );
        let healthy = recording(&[("drive", "fault", &[(0.0, "none")]), ("axis", "state", &[(0.0, "Standstill")])]);
        assert_eq!(found(&healthy, &[]).unwrap(), [""; 0]);
        assert_eq!(found(&recording(&[]), &[]), None, "nothing that could have a fault");
    }

    #[test]
    fn an_expected_fault_excuses_what_follows_from_it_and_nothing_else() {
        let expected = [expecting("drive", "8611h", 0.2, 0.6)];
        assert_eq!(found(&following_error(), &expected).unwrap(), [""; 0]);
        for (who, fault, from, to, left) in [
            ("drive", "8611h", 0.31, 0.6, 2),
            ("drive", "8611h", 0.0, 0.29, 2),
            ("drive", "8612h", 0.0, 1.0, 2),
            // That the axis stops is expected, but not why.
            ("axis", "ErrorStop", 0.0, 1.0, 1),
        ] {
            let left_over = found(&following_error(), &[expecting(who, fault, from, to)]).unwrap();
            assert_eq!(left_over.len(), left, "{who} {fault}: {left_over:?}");
        }
        // A second ErrorStop, when the expected fault is gone, is separate.
        let mut again = following_error();
        again.signals[2].changes.push((0.9, "ErrorStop".into()));
        assert_eq!(found(&again, &expected).unwrap(), ["the axis enters ErrorStop at 900 ms"]);
    }

    #[test]
    fn an_expectation_is_met_when_its_fault_comes() {
        let recording = following_error();
        let faults = occurrences(&recording);
        assert_eq!(met(&expecting("drive", "8611H", 0.2, 0.6), &faults, &recording), Some(0.3));
        assert_eq!(met(&expecting("axis", "ErrorStop", 0.0, f64::INFINITY), &faults, &recording), Some(0.302));
        assert_eq!(met(&expecting("link", "positive limit switch", 0.0, 1.0), &faults, &recording), None);
        assert_eq!(met(&expecting("drive", "8611h", 0.4, 1.0), &faults, &recording), None);
    }
}
