//! The drive's velocity measurement, and the integral and derivative parts of its outer loops.
use crate::diagnostic::Report;
use crate::field::{Reported, Slot};
use crate::file;
use crate::resolve::blocks::Known;
use crate::resolve::motor::Motor;
use servobench_drive::measurement::{Method, Params, mt, observer};
use servobench_drive::{derivative, position as position_loop};

/// Default period of a timer (s).
const TIMER: f64 = 100e-9;

pub(super) fn resolve(drive: &file::Drive, known: &Known<'_>, report: &mut Report) -> Result<Option<Params>, Reported> {
    let Some(given) = drive.velocity.optional()? else { return Ok(None) };
    let method = given.measurement.optional()?.copied();
    for (key, span, of) in
        [("timer", given.timer.span(), Method::Mt), ("observer", given.observer.span(), Method::Observer)]
    {
        if let Some(span) = span.filter(|_| method != Some(of)) {
            let name = servobench_config::Choice::name(of);
            let help = format!("write `measurement = \"{name}\"` in `[drive.velocity]`, or leave it out");
            report.warning(span, format!("`{key}` is not used"), help);
        }
    }
    Ok(match method {
        None => None,
        Some(Method::Difference) => Some(Params::Difference),
        Some(Method::Mt) => Some(Params::Mt(mt(given, known, report)?)),
        Some(Method::Observer) => Some(Params::Observer(observer(given, known, report)?)),
    })
}

fn mt(given: &file::Velocity, known: &Known<'_>, report: &mut Report) -> Result<mt::Params, Reported> {
    let encoder = match known.motor.ok_or(Reported)? {
        Motor::Pmsm { encoder, .. } | Motor::IdealSource { encoder, .. } => encoder,
        Motor::Prescribed => return Err(Reported),
    };
    let Some(step) = encoder.increment else {
        let span = given.measurement.span().unwrap_or(given.span);
        let message = "the M/T method counts increments, and the motor's encoder has none";
        report.error(span, message, "give `counts_per_rev` or `step` in `[motor.encoder]`");
        return Err(Reported);
    };
    Ok(mt::Params { timer: given.timer.optional()?.copied().unwrap_or(TIMER), step })
}

fn observer(given: &file::Velocity, known: &Known<'_>, report: &mut Report) -> Result<observer::Params, Reported> {
    let Some(written) = given.observer.optional()? else {
        report.missing("drive.velocity", "observer", given.span);
        return Err(Reported);
    };
    let (belief, rate) = (known.belief.ok_or(Reported)?, known.rate.ok_or(Reported)?);
    if !belief.knows_inertia {
        let help = "give `motor_inertia` in `[drive.estimate]`, or measure by differences";
        report.error(written.span, "the inertia of this axis is unknown to the drive", help);
        return Err(Reported);
    }
    let bandwidth = *written.bandwidth.given().ok_or(Reported)?;
    let compensation = written.disturbance_compensation.optional()?.copied().unwrap_or(0.0);
    let inertia = belief.estimate.inertia_at_the_motor();
    observer::Params::new(bandwidth, rate.period(), inertia, compensation).map_err(|_| Reported)
}

/// The derivative part of the velocity loop.
pub(super) fn acceleration(drive: &file::Drive, report: &mut Report) -> Result<Option<derivative::Params>, Reported> {
    let Some(given) = drive.velocity.optional()? else { return Ok(None) };
    derivative(&given.derivative_time, &given.derivative_filter_time, report)
}

/// Integral and derivative of the position loop; `None` if it has neither.
pub(super) fn position(drive: &file::Drive, report: &mut Report) -> Result<Option<position_loop::Params>, Reported> {
    let Some(given) = drive.position.optional()? else { return Ok(None) };
    let params = position_loop::Params {
        integral_time: given.integral_time.optional()?.copied(),
        derivative: derivative(&given.derivative_time, &given.derivative_filter_time, report)?,
    };
    Ok((params != position_loop::Params::default()).then_some(params))
}

fn derivative(
    time: &Slot<f64>,
    filter_time: &Slot<f64>,
    report: &mut Report,
) -> Result<Option<derivative::Params>, Reported> {
    let filter = filter_time.optional()?.copied();
    let Some(time) = time.optional()?.copied() else {
        if let Some(span) = filter_time.span() {
            report.error(span, "the loop has no derivative to filter", "give `derivative_time`");
            return Err(Reported);
        }
        return Ok(None);
    };
    Ok(Some(derivative::Params { time, filter_time: filter.unwrap_or(derivative::FILTER_SHARE * time) }))
}
