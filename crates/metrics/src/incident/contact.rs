//! Contacts with the ends of the travel, and those of them that do no harm.
//!
//! A contact is harmless while the axis is in Homing, of which `MC_StepBlock` is a step, and while the drive gives the motor no
//! power. Such a contact stays harmless when that ends, unless the load is pushed in harder then.
use super::Incident;
use super::spell::spells;
use super::states::spells_of;
use crate::quantity::Quantity;
use crate::requirement::{Driven, Rules};
use servobench_signals::Signal;
use servobench_trace::{Event, Recording};
use std::ops::Range;

/// Time (s) for which a load may be off a stop within one contact: the flights of a bounce. A fall from rest covers 1 mm in half
/// of it, and a stop takes most of the velocity with which a load comes.
const FLIGHT: f64 = 0.05;
/// Factor by which harmless causes may push a load that lies on a stop in harder: the effect of a force that is applied at once,
/// without damping, rises to twice its value.
const HARDER: f64 = 2.0;
/// States of a drive that gives the motor power.
const POWERED: [&str; 3] = ["Operation enabled", "Quick stop active", "Fault reaction active"];
/// Source of the events of contacts.
const MECHANICS: &str = "mechanics";

/// A contact of the load with an end stop.
#[derive(Debug, Clone, PartialEq)]
struct Contact {
    rows: Range<usize>,
    /// Largest velocity of the load over the tick before it touched the stop (axis unit per second, a magnitude); `None` where nothing was
    /// recorded before.
    speed: Option<f64>,
    /// Effort of the stop with the largest magnitude (axis coordinate).
    peak: f64,
}

/// A time in which contacts do no harm (s), and why.
struct Harmless {
    start: f64,
    end: f64,
    why: &'static str,
}

/// Times in which contacts do no harm, in order.
fn harmless(recording: &Recording, rules: &Rules<'_>) -> Vec<Harmless> {
    if rules.driven == Driven::Not {
        return vec![Harmless { start: 0.0, end: f64::INFINITY, why: "without power" }];
    }
    let of = |(source, name), why, holds: &dyn Fn(&str) -> bool| {
        let spells = spells_of(recording, (source, name), holds);
        spells.into_iter().map(move |[start, end]| Harmless { start, end, why }).collect::<Vec<_>>()
    };
    let mut all = of(("axis", "state"), "in homing", &|state| state == "Homing");
    all.extend(of(("drive", "state"), "without power", &|state| !POWERED.contains(&state)));
    all.sort_by(|one, two| one.start.total_cmp(&two.start));
    all
}

/// Reason why a contact at `time` (s) does no harm, and the end of its validity.
fn excuse(times: &[Harmless], time: f64) -> Option<(&'static str, f64)> {
    let first = times.iter().find(|one| one.start <= time && time < one.end)?;
    // One such time may continue into the next.
    let mut end = first.end;
    while let Some(next) = times.iter().find(|one| one.start <= end && end < one.end) {
        end = next.end;
    }
    Some((first.why, end))
}

/// Contacts of the load with `[axis.end_stops]`, each as an event, and those in which it is pushed in harder afterwards.
pub(super) fn incidents(recording: &Recording, rules: &Rules<'_>) -> Vec<Event> {
    let Some(efforts) = recording.channel(Signal::EffortEndStop) else { return Vec::new() };
    let contacts = contacts(recording, efforts);
    if contacts.is_empty() {
        return Vec::new();
    }
    let (times, flight) = (harmless(recording, rules), recording.index_at(FLIGHT).max(1));
    let mut events = Vec::new();
    for contact in contacts {
        let Some((why, end)) = excuse(&times, recording.time_of(contact.rows.start)) else {
            events.push(words(recording, &contact, "the load meets"));
            continue;
        };
        let from = if end.is_finite() { recording.index_at(end) } else { efforts.len() };
        let Range { start, end: until } = contact.rows.clone();
        let before = Contact { rows: start..until.min(from), peak: peak(&efforts[start..until.min(from)]), ..contact };
        let mut event = words(recording, &before, "the load meets");
        if let Some(mark) = &mut event.incident {
            mark.excuse = Some(why.into());
        }
        events.push(event);
        if from < until {
            let lies = peak(&efforts[from.saturating_sub(flight).max(start)..from]);
            let pushed = peak(&efforts[from..until]);
            if pushed.abs() > HARDER * lies.abs() {
                let after = Contact { rows: from..until, speed: None, peak: pushed };
                events.push(words(recording, &after, "the load is pushed into"));
            }
        }
    }
    events
}

/// Completes the events of joints of a user's own model that come to the end of their range: the velocity of the load, and the
/// reason why that does no harm, where it does none.
pub(super) fn complete_joints(recording: &mut Recording, rules: &Rules<'_>) {
    let is_joint = |event: &Event| Incident::of(event) == Some(Incident::EndStop);
    if !recording.events.iter().any(is_joint) {
        return;
    }
    let times = harmless(recording, rules);
    let speeds: Vec<Option<f64>> = recording.events.iter().map(|event| speed_at(recording, event.start)).collect();
    let unit = format!("{}/s", recording.about.axis_unit);
    for (event, speed) in recording.events.iter_mut().zip(speeds).filter(|(event, _)| is_joint(event)) {
        if let Some(speed) = speed {
            event.message += "; the load came there at ";
            event.message += &Quantity::new(speed, &unit).to_string();
        }
        if let (Some((why, _)), Some(mark)) = (excuse(&times, event.start), &mut event.incident) {
            mark.excuse = Some(why.into());
        }
    }
}

/// Velocity of the load over the tick before `time` (s), a magnitude.
fn speed_at(recording: &Recording, time: f64) -> Option<f64> {
    let (positions, row) = (recording.channel(Signal::LoadPosition)?, recording.index_at(time));
    let [before, at] = [row.checked_sub(1)?, row].map(|row| positions.get(row).copied());
    Some((at? - before?).abs() * f64::from(recording.rate.hertz()))
}

/// Largest effort of the stops on the load (a magnitude), and largest velocity with which it met one (axis unit per second).
pub(super) fn largest(recording: &Recording, efforts: &[f64]) -> (f64, f64) {
    let contacts = contacts(recording, efforts);
    let largest = |of: &dyn Fn(&Contact) -> f64| contacts.iter().map(of).fold(0.0, f64::max);
    (largest(&|contact| contact.peak.abs()), largest(&|contact| contact.speed.unwrap_or_default()))
}

fn contacts(recording: &Recording, efforts: &[f64]) -> Vec<Contact> {
    let flight = recording.index_at(FLIGHT);
    let of = |sign: f64| spells(efforts, flight, move |effort| sign * effort > 0.0);
    let mut rows = [of(1.0), of(-1.0)].concat();
    rows.sort_by_key(|rows| rows.start);
    rows.into_iter()
        .map(|rows| Contact { speed: speed(recording, efforts, &rows), peak: peak(&efforts[rows.clone()]), rows })
        .collect()
}

/// Largest velocity over the tick before each touch of a contact.
fn speed(recording: &Recording, efforts: &[f64], rows: &Range<usize>) -> Option<f64> {
    let positions = recording.channel(Signal::LoadPosition)?;
    let touches = rows.clone().filter(|row| *row > 0 && efforts[*row] != 0.0 && efforts[*row - 1] == 0.0);
    let hertz = f64::from(recording.rate.hertz());
    touches.map(|row| (positions[row] - positions[row - 1]).abs() * hertz).reduce(f64::max)
}

/// Effort with the largest magnitude.
fn peak(efforts: &[f64]) -> f64 {
    efforts.iter().copied().fold(0.0, |most, effort| if effort.abs() > most.abs() { effort } else { most })
}

/// `the load meets the positive end stop at 312 mm/s, which pushes back with 4.70 kN at most`
fn words(recording: &Recording, Contact { rows, speed, peak }: &Contact, does: &str) -> Event {
    let unit = &recording.about.axis_unit;
    let effort_unit = recording.find(Signal::EffortEndStop).map_or("", |channel| channel.spec.unit.as_str());
    // A stop pushes the load back.
    let end = if *peak < 0.0 { "positive" } else { "negative" };
    let speed = speed.map_or_else(String::new, |speed| format!(" at {}", Quantity::new(speed, &format!("{unit}/s"))));
    let effort = Quantity::new(peak.abs(), effort_unit);
    let message = format!("{does} the {end} end stop{speed}, which pushes back with {effort} at most");
    let (start, end) = (recording.time_of(rows.start), recording.time_of(rows.end.saturating_sub(1).max(rows.start)));
    Event::new(start, end, MECHANICS, message).incident(Incident::EndStop.name())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirement::tests::rules;
    use crate::synthetic::Build;

    /// A load that comes with 0.2 m/s, is in the positive stop from 0.5 s to 0.52 s, and leaves.
    fn bump() -> Build {
        Build::new(1000, 1001).channel(Signal::LoadPosition, "m", |t| 0.2 * t.min(0.5)).channel(
            Signal::EffortEndStop,
            "N",
            |t| if (0.5..0.52).contains(&(t + 1e-9)) { -400.0 } else { 0.0 },
        )
    }

    fn found(recording: &Recording) -> Vec<(String, Option<String>)> {
        incidents(recording, &rules())
            .into_iter()
            .map(|event| (event.message, event.incident.unwrap().excuse))
            .collect()
    }

    #[test]
    fn a_contact_has_its_time_its_velocity_and_its_force() {
        let recording = bump().finish();
        let [event] = &incidents(&recording, &rules())[..] else { panic!() };
        assert_eq!((event.start, event.end), (0.5, 0.519));
        assert_eq!(
            event.message,
            "the load meets the positive end stop at 200 mm/s, which pushes back with 400 N at most"
        );
        assert_eq!(event.incident.as_ref().unwrap().excuse, None);
    }

    #[test]
    fn touches_of_a_bounce_are_one_contact_and_those_of_two_ends_are_two() {
        let build = |force: fn(f64) -> f64| {
            Build::new(1000, 1001)
                .channel(Signal::LoadPosition, "rad", |_| 0.0)
                .channel(Signal::EffortEndStop, "N m", force)
                .finish()
        };
        let bounce = build(|t| if (0.2..0.31).contains(&t) && (t * 100.0).rem_euclid(2.0) < 1.0 { 3.0 } else { 0.0 });
        assert_eq!(found(&bounce).len(), 1);
        let apart = build(|t| if (t * 10.0).rem_euclid(2.0) < 1.0 { 3.0 } else { 0.0 });
        assert_eq!(found(&apart).len(), 6);
        let both = build(|t| {
            if t < 0.2 {
                3.0
            } else if t < 0.3 {
                -4.0
            } else {
                0.0
            }
        });
        let ends: Vec<_> = found(&both).into_iter().map(|(message, _)| message.contains("positive")).collect();
        assert_eq!(ends, [false, true]);
    }

    #[test]
    fn a_contact_in_homing_or_without_power_does_no_harm() {
        let homing: &[(f64, &str)] = &[(0.0, "Homing"), (0.7, "Standstill")];
        let late: &[(f64, &str)] = &[(0.0, "Standstill"), (0.51, "Homing")];
        for (source, name, changes, excuse) in [
            ("axis", "state", homing, Some("in homing")),
            ("axis", "state", late, None),
            ("drive", "state", &[(0.0, "Switched on")], Some("without power")),
            ("drive", "state", &[(0.0, "Operation enabled"), (0.4, "Fault")], Some("without power")),
            ("drive", "state", &[(0.0, "Operation enabled"), (0.4, "Fault reaction active")], None),
        ] {
            let recording = bump().signal(source, name, changes).finish();
            let [(_, found)] = &found(&recording)[..] else { panic!() };
            assert_eq!(found.as_deref(), excuse, "{changes:?}");
        }
        let off = Rules { driven: Driven::Not, ..rules() };
        let [event] = &incidents(&bump().finish(), &off)[..] else { panic!() };
        assert_eq!(event.incident.as_ref().unwrap().excuse.as_deref(), Some("without power"));
    }

    /// The load lies on the stop with 100 N without power. Then the drive has power: it lets go, or pushes.
    #[test]
    fn what_lies_on_a_stop_may_not_be_pushed_in_harder() {
        for (after, harm) in [(-50.0, 0), (-190.0, 0), (-210.0, 1), (-4e3, 1)] {
            let recording = Build::new(1000, 1001)
                .channel(Signal::LoadPosition, "m", |_| 0.1)
                .channel(Signal::EffortEndStop, "N", move |t| if t < 0.5 - 1e-9 { -100.0 } else { after })
                .signal("drive", "state", &[(0.0, "Switched on"), (0.5, "Operation enabled")])
                .finish();
            let found = found(&recording);
            assert_eq!(found.iter().filter(|(_, excuse)| excuse.is_none()).count(), harm, "{found:?}");
        }
    }

    /// A joint that the mechanics noted at 0.4 s, where the load has 0.2 m/s; the axis is in Homing until 0.3 s or 0.5 s.
    #[test]
    fn a_joint_at_its_end_is_excused_as_a_stop_is() {
        for (until, excuse) in [(0.3, None), (0.5, Some("in homing"))] {
            let mut recording = bump().signal("axis", "state", &[(0.0, "Homing"), (until, "Standstill")]).finish();
            recording.events.push(Event::new(0.4, 0.5, MECHANICS, "joint `x`").incident(Incident::EndStop.name()));
            complete_joints(&mut recording, &rules());
            let event = &recording.events[0];
            assert_eq!(event.message, "joint `x`; the load came there at 200 mm/s");
            assert_eq!(event.incident.as_ref().unwrap().excuse.as_deref(), excuse);
        }
    }

    #[test]
    fn the_largest_of_all_contacts_is_measured() {
        let recording = bump().finish();
        let (force, speed) = largest(&recording, recording.channel(Signal::EffortEndStop).unwrap());
        assert!((force - 400.0).abs() < 1e-12 && (speed - 0.2).abs() < 1e-9, "{force} N at {speed} m/s");
    }
}
