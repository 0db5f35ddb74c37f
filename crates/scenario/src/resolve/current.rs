//! `[drive.current]`: the current loop of a synchronous motor.
use crate::diagnostic::Report;
use crate::field::{Reported, Slot};

use crate::file;
use crate::resolve::drive::Known;
use crate::resolve::motor::Motor;
use crate::resolve::{Alternative, estimate, need, one_of, sensors, task_rate};
use crate::source::Span;
use servobench_base::{Dq, Rate};
use servobench_drive::current::Tuning;
use servobench_drive::current::operating_point::{self, Strategy, Weakening};
use servobench_plant::CurrentSensor;

/// The current loop of the file.
#[derive(Debug, Clone, Copy)]
pub(super) struct CurrentLoop {
    pub(super) rate: Rate,
    pub(super) tuning: Tuning,
    /// Integral times (s).
    pub(super) integral_times: Option<Dq>,
    /// Reference of the d axis (A, peak).
    pub(super) d_reference: f64,
    /// Choice of the currents for an effort.
    pub(super) operation: operating_point::Params,
    /// Errors of the sensors.
    pub(super) sensor: Option<CurrentSensor>,
}

/// `None` if there is no current loop and none is needed.
pub(super) fn resolve(
    drive: &file::Drive,
    known: &Known<'_>,
    is_used: bool,
    report: &mut Report,
) -> Result<Option<CurrentLoop>, Reported> {
    if matches!(known.motor, Some(Motor::IdealSource { .. })) {
        if let Some(span) = drive.current.span() {
            report.warning(span, "the current loop is not used: an ideal source has no current", "");
        }
        return Ok(None);
    }
    let Some(given) = drive.current.optional()? else {
        if is_used && known.motor.is_some() {
            report.missing("drive", "current", drive.span);
            return Err(Reported);
        }
        return Ok(None);
    };
    let (path, header) = ("drive.current", given.span);
    need(&given.rate, path, "rate", header, report);
    let rate = task_rate(&given.rate, known.base_rate, report);
    let tuning = tuning(given, path, report);
    let times = [("integral_time_d", &given.integral_time_d), ("integral_time_q", &given.integral_time_q)];
    let integral_times = if times.iter().any(|(_, slot)| slot.span().is_some()) {
        Some(pair(times[0], times[1], path, header, report)?)
    } else {
        None
    };
    let d_reference = d_reference(&given.d_reference, known, report)?;
    let operation = operation(given, report)?;
    has_torque(drive, given, (operation.strategy, d_reference), known, report)?;
    let sensor = sensors::current(&given.sensor, known.base_rate, report)?;
    Ok(Some(CurrentLoop {
        rate: rate.ok_or(Reported)?,
        tuning: tuning?,
        integral_times,
        d_reference,
        operation,
        sensor,
    }))
}

/// Maximum torque per ampere and field weakening.
fn operation(given: &file::Current, report: &mut Report) -> Result<operating_point::Params, Reported> {
    let strategy = given.strategy.optional()?.copied().unwrap_or_default();
    if let (Strategy::Mtpa, Some(span)) = (strategy, given.d_reference.span()) {
        report.error(span, "`strategy = \"mtpa\"` has no `d_reference`", "leave one of them out");
        return Err(Reported);
    }
    let is_weakened = given.field_weakening.optional()?.copied().unwrap_or(false);
    let (share, feedback) = (&given.field_weakening_share, &given.field_weakening_feedback);
    for (key, span) in [("field_weakening_share", share.span()), ("field_weakening_feedback", feedback.span())] {
        if let (false, Some(span)) = (is_weakened, span) {
            report.warning(span, format!("`{key}` is not used"), "write `field_weakening = true`");
        }
    }
    let weakening = Weakening {
        share: share.optional()?.copied().unwrap_or(0.95),
        feedback: feedback.optional()?.copied().unwrap_or(0.0),
    };
    Ok(operating_point::Params { strategy, weakening: is_weakened.then_some(weakening) })
}

/// Reference of the d axis (A, peak). It must leave some of the current limit to the q axis, and the motor some torque.
fn d_reference(slot: &Slot<f64>, known: &Known<'_>, report: &mut Report) -> Result<f64, Reported> {
    let at = match slot {
        Slot::Absent => return Ok(0.0),
        Slot::Wrong(_) => return Err(Reported),
        Slot::Given(at) => at,
    };
    let Some(Motor::Pmsm { motor, max_current, .. }) = known.motor else { return Ok(at.value) };
    if at.value.abs() >= *max_current {
        let message =
            format!("`d_reference` of {:.5} A (peak) uses up the current limit, {max_current:.5} A", at.value);
        report.error(at.span, message, "`motor.max_current` bounds the vector of both axes; give less");
        return Err(Reported);
    }
    if motor.effort_constant(at.value) <= 0.0 {
        let message =
            format!("at a d-axis current of {:.5} A (peak) the motor has no torque in its direction", at.value);
        report.error(at.span, message, "ψ + (L_d − L_q)·i_d must be above 0; give less");
        return Err(Reported);
    }
    Ok(at.value)
}

/// Checks that the motor, and the drive's estimate of it, have torque with the currents that the strategy chooses.
fn has_torque(
    drive: &file::Drive,
    given: &file::Current,
    (strategy, i_d): (Strategy, f64),
    known: &Known<'_>,
    report: &mut Report,
) -> Result<(), Reported> {
    let Some(Motor::Pmsm { motor, .. }) = known.motor else { return Ok(()) };
    let estimates = drive.estimate.given();
    let believed = estimates.and_then(|given| given.motor.span()).unwrap_or(given.span);
    for (whose, span, motor) in [
        ("the motor", given.d_reference.span().unwrap_or(given.span), estimate::of_motor(None, motor)),
        ("the motor of the drive's estimate", believed, estimate::of_motor(estimates, motor)),
    ] {
        if !strategy.has_torque(&motor, i_d) {
            let psi = motor.flux_linkage;
            let message =
                format!("with a flux linkage of {psi} V s {whose} has no torque at a d-axis current of {i_d:.5} A");
            let help = "a reluctance motor takes `strategy = \"mtpa\"`, or a `d_reference` with which (L_d − L_q)·i_d is above 0";
            report.error(span, message, help);
            return Err(Reported);
        }
    }
    Ok(())
}

fn tuning(given: &file::Current, path: &str, report: &mut Report) -> Result<Tuning, Reported> {
    let by_gain = given.gain_d.span().or(given.gain_q.span());
    match one_of(&[("bandwidth", given.bandwidth.span()), ("gain_d", by_gain)], report) {
        Alternative::Use(0) => given.bandwidth.given().copied().map(Tuning::Bandwidth).ok_or(Reported),
        Alternative::Use(_) => {
            pair(("gain_d", &given.gain_d), ("gain_q", &given.gain_q), path, given.span, report).map(Tuning::Gains)
        }
        Alternative::Contradiction => Err(Reported),
        Alternative::None => {
            report.missing_with_help(path, "bandwidth", given.span, "or `gain_d` and `gain_q`");
            Err(Reported)
        }
    }
}

/// Two keys that must be given together.
fn pair(
    (d_key, d): (&str, &Slot<f64>),
    (q_key, q): (&str, &Slot<f64>),
    path: &str,
    header: Span,
    report: &mut Report,
) -> Result<Dq, Reported> {
    let d = need(d, path, d_key, header, report);
    let q = need(q, path, q_key, header, report);
    d.zip(q).map(|(d, q)| Dq { d, q }).ok_or(Reported)
}
