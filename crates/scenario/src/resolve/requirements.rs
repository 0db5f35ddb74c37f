//! `[requirements]` and `[[expect]]`.
use crate::diagnostic::Report;
use crate::file;
use crate::file::File;
use crate::nearest::suggestion;
use crate::scenario::{Plc, Requirements};
use crate::source::At;
use servobench_metrics::Expectation;

/// What the expectations need to know of the rest of the file.
pub(super) struct Known<'a> {
    /// Length of the run (s), as far as the file says it.
    pub(super) duration: Option<f64>,
    pub(super) has_bus: bool,
    pub(super) plc: Option<&'a Plc>,
}

/// What the run is held to.
pub(super) fn resolve(file: &File, known: &Known<'_>, report: &mut Report) -> Option<Requirements> {
    let named = file.requirements.optional().ok()?.map_or(&[][..], |table| &table.0);
    let lifted = named.iter().filter(|named| !named.value.1).map(|named| named.value.0).collect();
    let expected = match file.expect.optional().ok()? {
        Some(all) => all.0.iter().map(|one| expectation(one, known, report)).collect::<Option<_>>()?,
        None => Vec::new(),
    };
    Some(Requirements { lifted, expected })
}

fn expectation(given: &At<file::Expect>, known: &Known<'_>, report: &mut Report) -> Option<Expectation> {
    let At { value: given, .. } = given;
    let (fault, who) = (given.fault.at()?, given.who.at()?);
    if !known.has_bus {
        let help = "give a `[bus]`, or leave `[[expect]]` out";
        report.error(given.span, "without a fieldbus axis, drive and link have no faults", help);
    }
    let calls = || known.plc.into_iter().flat_map(|plc| &plc.calls).map(|call| call.name.as_str());
    let parts = ["axis", "drive", "link"];
    if !parts.contains(&who.value.as_str()) && !calls().any(|name| name == who.value) {
        let names = parts.into_iter().chain(calls());
        let message = format!("there is no `{}` that could have a fault", who.value);
        report.error(who.span, message, suggestion(&who.value, names));
    }
    let is_code = Expectation::code_of(&fault.value).is_some();
    let objection = match who.value.as_str() {
        "axis" if fault.value != "ErrorStop" => Some("the axis has one state of error: write \"ErrorStop\""),
        "axis" if known.plc.is_none() => {
            Some("only function blocks have an axis with states: name the drive or the link")
        }
        // The names of the link's faults are known where the loop is built.
        "axis" | "link" => None,
        "drive" if !is_code => Some("write the error code of the drive (603Fh): four digits and an h, \"8611h\""),
        _ if !is_code => Some("write the `ErrorID` of the block: four digits and an h, \"2002h\""),
        _ => None,
    };
    if let Some(help) = objection {
        report.error(fault.span, format!("\"{}\" is no fault of `{}`", fault.value, who.value), help);
    }
    let (from, to) = (given.from.given().copied().unwrap_or(0.0), given.to.given().copied().unwrap_or(f64::INFINITY));
    if let (true, Some(span)) = (to <= from, given.to.span()) {
        report.error(span, format!("`to` is {to} s and `from` {from} s: there is no time between"), "");
    }
    if let (Some(duration), Some(span)) = (known.duration.filter(|duration| from >= *duration), given.from.span()) {
        report.error(span, format!("the run is over by then: it lasts {duration} s"), "");
    }
    Some(Expectation { fault: fault.value.clone(), who: who.value.clone(), from, to })
}
