//! `[drive.supervision]`.
use crate::diagnostic::Report;
use crate::field::{Reported, Slot};
use crate::file;
use crate::resolve::blocks::Known;
use crate::resolve::motor::Motor;
use crate::resolve::refuse;
use servobench_drive::supervision::{Commutation, Params, Phases, Stall};

pub(super) fn resolve(drive: &file::Drive, known: &Known<'_>, report: &mut Report) -> Result<Option<Params>, Reported> {
    let Some(given) = drive.supervision.optional()? else { return Ok(None) };
    if !known.has_bus {
        report.error(given.span, "without a `[bus]` no fault can be reported", "add `[bus]`, or leave it out");
        return Err(Reported);
    }
    if matches!(known.motor, Some(Motor::IdealSource { .. })) {
        let keys = [
            ("undervoltage", given.undervoltage.span()),
            ("overvoltage", given.overvoltage.span()),
            ("overcurrent", given.overcurrent.span()),
            ("winding_temperature", given.winding_temperature.span()),
            ("commutation", given.commutation.span()),
            ("phase_loss", given.phase_loss.span()),
        ];
        refuse(&keys, "belongs to a synchronous motor, this is an ideal source", "", report);
        if keys.iter().any(|(_, span)| span.is_some()) {
            return Err(Reported);
        }
    }
    let number = |slot: &Slot<f64>| slot.given().copied().ok_or(Reported);
    let optional = |slot: &Slot<f64>| Ok::<_, Reported>(slot.optional()?.copied());
    let (undervoltage, overvoltage) = (optional(&given.undervoltage)?, optional(&given.overvoltage)?);
    if let (Some(low), Some(high), Some(span)) = (undervoltage, overvoltage, given.overvoltage.span())
        && high <= low
    {
        report.error(span, "`overvoltage` must be above `undervoltage`", "");
        return Err(Reported);
    }
    let commutation = match given.commutation.optional()? {
        None => None,
        Some(one) => Some(Commutation { speed: number(&one.speed)?, current: number(&one.current)? }),
    };
    let stall = match given.stall.optional()? {
        None => None,
        Some(one) => Some(Stall { speed: number(&one.speed)?, time: number(&one.time)? }),
    };
    let phases = match given.phase_loss.optional()? {
        None => None,
        Some(one) => Some(Phases { current: number(&one.current)?, time: number(&one.time)? }),
    };
    let winding_temperature = optional(&given.winding_temperature)?;
    let is_cold = matches!(known.motor, Some(Motor::Pmsm { effects, .. }) if !effects.warms_up());
    if let Some(span) = given.winding_temperature.span().filter(|_| is_cold) {
        report.error(span, "a winding without `[motor.thermal]` does not warm up", "add it, or leave this out");
        return Err(Reported);
    }
    Ok(Some(Params {
        undervoltage,
        overvoltage,
        overspeed: optional(&given.overspeed)?,
        overcurrent: optional(&given.overcurrent)?,
        winding_temperature,
        commutation,
        stall,
        phases,
    }))
}
