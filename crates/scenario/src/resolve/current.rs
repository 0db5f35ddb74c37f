//! `[drive.current]`: the current loop of a synchronous motor.
use crate::diagnostic::Report;
use crate::field::{Reported, Slot};
use crate::file;
use crate::resolve::drive::Known;
use crate::resolve::motor::Motor;
use crate::resolve::{Way, need, one_way, task_rate};
use crate::scenario::CurrentGain;
use crate::source::Span;
use servobench_base::Rate;

/// What the file says of the loop.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tuning {
    pub(super) rate: Rate,
    pub(super) gain: CurrentGain,
    pub(super) integral_time: Option<(f64, f64)>,
}

/// `None` where there is no current loop and none is needed.
pub(super) fn resolve(
    drive: &file::Drive,
    known: &Known<'_>,
    is_used: bool,
    report: &mut Report,
) -> Result<Option<Tuning>, Reported> {
    if matches!(known.motor, Some(Motor::IdealSource(_))) {
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
    let gain = gain(given, path, report);
    let times = [("integral_time_d", &given.integral_time_d), ("integral_time_q", &given.integral_time_q)];
    let integral_time = if times.iter().any(|(_, slot)| slot.span().is_some()) {
        Some(pair(times[0], times[1], path, header, report)?)
    } else {
        None
    };
    Ok(Some(Tuning { rate: rate.ok_or(Reported)?, gain: gain?, integral_time }))
}

fn gain(given: &file::Current, path: &str, report: &mut Report) -> Result<CurrentGain, Reported> {
    let by_gain = given.gain_d.span().or(given.gain_q.span());
    match one_way(&[("bandwidth", given.bandwidth.span()), ("gain_d", by_gain)], report) {
        Way::Use(0) => given.bandwidth.given().copied().map(CurrentGain::Bandwidth).ok_or(Reported),
        Way::Use(_) => {
            let (d, q) = pair(("gain_d", &given.gain_d), ("gain_q", &given.gain_q), path, given.span, report)?;
            Ok(CurrentGain::PerAxis { d, q })
        }
        Way::Contradiction => Err(Reported),
        Way::None => {
            report.missing_with_help(path, "bandwidth", given.span, "or `gain_d` and `gain_q`");
            Err(Reported)
        }
    }
}

/// Two keys that go together.
fn pair(
    (d_key, d): (&str, &Slot<f64>),
    (q_key, q): (&str, &Slot<f64>),
    path: &str,
    header: Span,
    report: &mut Report,
) -> Result<(f64, f64), Reported> {
    let d = need(d, path, d_key, header, report);
    let q = need(q, path, q_key, header, report);
    d.zip(q).ok_or(Reported)
}
