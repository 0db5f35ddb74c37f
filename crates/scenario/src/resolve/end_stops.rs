//! `[axis.end_stops]`: stops at the ends of the load's travel.
use super::disturbance::Fixed;
use crate::diagnostic::Report;
use crate::field::Reported;
use crate::file;
use crate::file::File;
use crate::scenario::{Axis, Initial};
use servobench_plant::EndStops;

/// The stops of `axis`, if it has any.
pub(super) fn resolve(axis: &file::Axis, report: &mut Report) -> Result<Option<EndStops>, Reported> {
    let Some(given) = axis.end_stops.optional()? else { return Ok(None) };
    if let Some(span) = axis.modulo.span() {
        report.error(span, "a modulo axis has no end stops", "leave out `modulo` or `[axis.end_stops]`");
    }
    let ends = [&given.negative, &given.positive].map(|slot| slot.optional().map(Option::<&f64>::copied));
    if let [Ok(None), Ok(None)] = ends {
        report.error(given.span, "the table has no end stop", "give `negative`, `positive` or both");
    }
    if let (Some(negative), Some(positive)) = (given.negative.at(), given.positive.at())
        && negative.value >= positive.value
    {
        report.error(positive.span, "the positive end is not above the negative one", "swap them");
    }
    let [negative, positive] = ends;
    let stiffness = *given.stiffness.given().ok_or(Reported)?;
    let damping = given.damping.optional()?.copied().unwrap_or(0.0);
    Ok(Some(EndStops { negative: negative?, positive: positive?, stiffness, damping }))
}

/// Refuses stops that have no effect on the load of `axis`, and an initial position within one.
pub(super) fn refuse(file: &File, axis: &Axis, initial: &Initial, fixed: Option<Fixed>, report: &mut Report) {
    let (Some(stops), Some(given)) = (&axis.end_stops, file.axis.given().and_then(|axis| axis.end_stops.given()))
    else {
        return;
    };
    if fixed == Some(Fixed::Everything) {
        let message = "the load is rigid with a motor that follows the set-point exactly, through any end stop";
        report.error(given.span, message, "give `stiffness` in `[axis.load]`, or a motor that is not prescribed");
    }
    let start = initial.load_position;
    let of_start = file.initial.given().and_then(|initial| initial.load_position.span());
    for (is_beyond, slot) in [
        (stops.negative.is_some_and(|end| start < end), &given.negative),
        (stops.positive.is_some_and(|end| start > end), &given.positive),
    ] {
        if is_beyond && let Some(span) = of_start.or(slot.span()) {
            let help = "it begins at 0, or at `load_position` of `[initial]`";
            report.error(span, "the load begins in the end stop", help);
        }
    }
}
