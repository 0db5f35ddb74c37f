//! `[drive.inverter]` and `[drive.link]`: deviations of the inverter from an ideal voltage source.
use crate::diagnostic::Report;
use crate::field::{Reported, Slot};
use crate::file;
use crate::resolve::drive::Known;
use crate::resolve::motor::Motor;
use crate::source::{At, Span};
use servobench_base::{ParamError, Rate};
use servobench_plant::inverter::{Brake, LinkParams, MOST_DEAD, Modulation, Params, Sag};

/// `None` for an ideal inverter, or without an inverter.
pub(super) fn resolve(drive: &file::Drive, known: &Known<'_>, report: &mut Report) -> Result<Option<Params>, Reported> {
    let Some(given) = drive.inverter.optional()? else { return Ok(None) };
    if let (Some(Motor::IdealSource { .. }), Some(span)) = (known.motor, drive.inverter.span()) {
        report.warning(span, "the inverter is not used: an ideal source has none", "");
        return Ok(None);
    }
    let (mut params, are_right) = given.parameters();
    let carrier = given.carrier.optional()?.copied();
    if carrier.is_none() && (params.dead_time > 0.0 || params.modulation == Modulation::Switching) {
        report.missing("drive.inverter", "carrier", given.span);
        return Err(Reported);
    }
    if let (Some(carrier), Some(at)) = (carrier, given.dead_time.at()) {
        check_dead_time(carrier, at.value, report, at.span)?;
    }
    if let (Modulation::Switching, Some(carrier), Some(base_rate)) =
        (params.modulation, given.carrier.at(), known.base_rate)
    {
        check_carrier(drive, carrier, base_rate, report)?;
    }
    are_right?;
    params.carrier = carrier.map_or(0.0, |carrier| f64::from(carrier.hertz()));
    Ok((!params.is_ideal()).then_some(params))
}

/// Checks that the carrier fits the base rate, and that the current loop samples at middles of the carrier.
fn check_carrier(
    drive: &file::Drive,
    carrier: &At<Rate>,
    base_rate: Rate,
    report: &mut Report,
) -> Result<(), Reported> {
    let (carrier, span) = (carrier.value, carrier.span);
    let (one, other) = (base_rate.hertz(), carrier.hertz());
    if !one.is_multiple_of(other) && !other.is_multiple_of(one) {
        let message = format!(
            "`carrier` of {} Hz must divide the base rate of {} Hz or be a multiple of it: edges are placed from tick to tick",
            carrier.hertz(),
            base_rate.hertz()
        );
        report.error(span, message, "change it or `run.base_rate`");
        return Err(Reported);
    }
    let Some(rate) = drive.current.given().and_then(|current| current.rate.given()) else { return Ok(()) };
    if (2 * u64::from(carrier.hertz())).is_multiple_of(u64::from(rate.hertz())) {
        return Ok(());
    }
    let message = format!(
        "the current loop of {} Hz samples between the middles of the carrier of {} Hz, where the ripple is",
        rate.hertz(),
        carrier.hertz()
    );
    report.error(span, message, "give a `carrier` that is a multiple of half the rate in `[drive.current]`");
    Err(Reported)
}

/// `None` for a constant voltage. `dc_link` is the voltage without load (V).
pub(super) fn link(
    drive: &file::Drive,
    known: &Known<'_>,
    dc_link: Option<f64>,
    report: &mut Report,
) -> Result<Option<LinkParams>, Reported> {
    let Some(given) = drive.link.optional()? else { return Ok(None) };
    if let (Some(Motor::IdealSource { .. }), Some(span)) = (known.motor, drive.link.span()) {
        report.warning(span, "the link is not used: an ideal source has none", "");
        return Ok(None);
    }
    let need = |slot: &Slot<f64>| slot.given().copied().ok_or(Reported);
    let sag = match given.sag.optional()? {
        None => None,
        Some(sag) => Some(Sag { start: need(&sag.start)?, duration: need(&sag.duration)?, depth: need(&sag.depth)? }),
    };
    let brake = match given.brake.optional()? {
        None => None,
        Some(brake) => {
            Some(Brake { resistance: need(&brake.resistance)?, on: need(&brake.on)?, off: need(&brake.off)? })
        }
    };
    let params = LinkParams {
        voltage: dc_link.ok_or(Reported)?,
        capacitance: need(&given.capacitance)?,
        source_resistance: need(&given.source_resistance)?,
        mains_frequency: given.mains_frequency.optional()?.copied(),
        sag,
        brake,
    };
    if let Err(ParamError { value, bound, .. }) = params.check() {
        // Each key has its own bound: the remaining mistake is the relation of the brake's voltages.
        let span = given.brake.given().and_then(|brake| brake.off.span()).unwrap_or(given.span);
        let message = format!("`off` of {value} V must be {bound}");
        report.error(
            span,
            message,
            "the link has `drive.dc_link` without load, and the brake must switch off above it",
        );
        return Err(Reported);
    }
    Ok(Some(params))
}

fn check_dead_time(carrier: Rate, dead_time: f64, report: &mut Report, span: Span) -> Result<(), Reported> {
    let most = MOST_DEAD * carrier.period();
    if dead_time <= most {
        return Ok(());
    }
    let message = format!(
        "`dead_time` must be at most a tenth of the carrier's period, {:.4} us, got {:.4} us",
        most * 1e6,
        dead_time * 1e6
    );
    report.error(span, message, "give less, or a lower `carrier`");
    Err(Reported)
}
