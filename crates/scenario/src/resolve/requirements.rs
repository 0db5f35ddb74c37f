//! `[requirements]` and `[[expect]]`.
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file;
use crate::file::File;
use crate::scenario::{Plc, Requirements};
use crate::source::At;
use crate::source::Span;
use file::ExpectedOn;
use servobench_files::suggestion;
use servobench_metrics::{Expectation, Incident, Occasion, Tolerances};

/// Values from the rest of the file that expectations depend on.
pub(super) struct Known<'a> {
    /// Length of the run (s), if the file gives it.
    pub(super) duration: Option<f64>,
    pub(super) has_bus: bool,
    pub(super) plc: Option<&'a Plc>,
    /// True if the travel has ends: `[axis.end_stops]`, or limits of joints in a user's own model.
    pub(super) has_ends: bool,
    /// True if the motor has a thermal model.
    pub(super) warms_up: bool,
}

/// Requirements on the run.
pub(super) fn resolve(file: &File, known: &Known<'_>, report: &mut Report) -> Option<Requirements> {
    let named = file.requirements.optional().ok()?.map_or(&[][..], |table| &table.0);
    let lifted = named.iter().filter(|named| !named.value.1).map(|named| named.value.0).collect();
    let expected = match file.expect.optional().ok()? {
        Some(all) => all.0.iter().map(|one| expectation(one, known, report)).collect::<Option<_>>()?,
        None => Vec::new(),
    };
    let tolerances = tolerances(file.tolerance.optional().ok()?);
    Some(Requirements { lifted, expected, tolerances })
}

fn tolerances(given: Option<&file::Tolerance>) -> Tolerances {
    let default = Tolerances::default();
    let Some(given) = given else { return default };
    Tolerances {
        follows: given.follows.given().copied().unwrap_or(default.follows),
        arrives: given.arrives.given().copied().unwrap_or(default.arrives),
        velocity: given.velocity.given().copied().unwrap_or(default.velocity),
        effort: given.effort.given().copied().unwrap_or(default.effort),
    }
}

fn expectation(
    At { value: given, span }: &At<file::Expect>,
    known: &Known<'_>,
    report: &mut Report,
) -> Option<Expectation> {
    let on = match given.on.optional().ok()?.copied().unwrap_or_default() {
        ExpectedOn::Fault => {
            foreign(&[("event", given.event.span())], "with `on = \"event\"`", report);
            fault(given, *span, known, report)?
        }
        ExpectedOn::Event => {
            foreign(&[("fault", given.fault.span()), ("who", given.who.span())], "with `on = \"fault\"`", report);
            Occasion::Event(needed(&given.event, "event", *span, report)?.value)
        }
    };
    if let Occasion::Event(incident) = on
        && let Some(help) = known.rules_out(incident)
    {
        report.error(*span, format!("`{incident}` cannot occur"), help);
    }
    let (from, to) = (given.from.given().copied().unwrap_or(0.0), given.to.given().copied().unwrap_or(f64::INFINITY));
    if let (true, Some(span)) = (to <= from, given.to.span()) {
        report.error(span, format!("`to` is {to} s and `from` {from} s: the interval is empty"), "");
    }
    if let (Some(duration), Some(span)) = (known.duration.filter(|duration| from >= *duration), given.from.span()) {
        report.error(span, format!("the run is over by then: it lasts {duration} s"), "");
    }
    Some(Expectation { on, from, to })
}

/// Reports keys that do not apply here.
fn foreign(keys: &[(&str, Option<Span>)], where_they_belong: &str, report: &mut Report) {
    for (key, span) in keys {
        if let Some(span) = span {
            report.error(*span, format!("`{key}` goes {where_they_belong}"), "leave it out, or change `on`");
        }
    }
}

/// A key required by this kind of expectation.
fn needed<'a, T>(slot: &'a Slot<T>, key: &str, span: Span, report: &mut Report) -> Option<&'a At<T>> {
    if matches!(slot, Slot::Absent) {
        report.error(span, format!("missing `{key}` in `expect`"), "");
    }
    slot.at()
}

fn fault(given: &file::Expect, span: Span, known: &Known<'_>, report: &mut Report) -> Option<Occasion> {
    let (fault, who) = (needed(&given.fault, "fault", span, report), needed(&given.who, "who", span, report));
    let (fault, who) = (fault?, who?);
    if !known.has_bus {
        let help = "give a `[bus]`, or leave `[[expect]]` out";
        report.error(span, "without a fieldbus axis, drive and link have no faults", help);
    }
    let calls = || known.plc.into_iter().flat_map(|plc| &plc.calls).map(|call| call.name.as_str());
    let parts = ["axis", "drive", "link"];
    if !parts.contains(&who.value.as_str()) && !calls().any(|name| name == who.value) {
        let names = parts.into_iter().chain(calls());
        let message = format!("unknown source of faults: `{}`", who.value);
        report.error(who.span, message, suggestion(&who.value, names));
    }
    let is_code = Expectation::code_of(&fault.value).is_some();
    let objection = match who.value.as_str() {
        "axis" if fault.value != "ErrorStop" => Some("the axis has one state of error: write \"ErrorStop\""),
        "axis" if known.plc.is_none() => {
            Some("only function blocks have an axis with states: name the drive or the link")
        }
        // The names of the link's faults are only known where the loop is built.
        "axis" | "link" => None,
        "drive" if !is_code => Some("write the error code of the drive (603Fh): four digits and an h, \"8611h\""),
        _ if !is_code => Some("write the `ErrorID` of the block: four digits and an h, \"2002h\""),
        _ => None,
    };
    if let Some(help) = objection {
        report.error(fault.span, format!("\"{}\" is not a fault of `{}`", fault.value, who.value), help);
    }
    Some(Occasion::Fault { fault: fault.value.clone(), who: who.value.clone() })
}

impl Known<'_> {
    /// Remedy if the axis lacks what an incident requires.
    const fn rules_out(&self, incident: Incident) -> Option<&'static str> {
        match incident {
            Incident::EndStop if !self.has_ends => Some("give `[axis.end_stops]`, or leave `[[expect]]` out"),
            Incident::WindingTemperature if !self.warms_up => Some("give `[motor.thermal]`, or leave `[[expect]]` out"),
            Incident::MissingPoint
            | Incident::BufferOverflow
            | Incident::BufferUnderflow
            | Incident::InternalLimit
            | Incident::BusFault
                if !self.has_bus =>
            {
                Some("give a `[bus]`, or leave `[[expect]]` out")
            }
            _ => None,
        }
    }
}
