//! `[[drive.filter]]`: the filters between velocity loop and current loop.
use crate::diagnostic::Report;
use crate::field::{Reported, Slot};
use crate::file::{self, FilterKind, TorqueFilter};
use crate::resolve::{need, refuse};
use crate::source::Span;
use servobench_base::Rate;
use servobench_drive::filter::{Filter, MOST, Params};

/// Default damping ratio of poles.
const DAMPING: f64 = 0.7;

/// The filters of the file for a velocity loop of the rate `rate`; if that is unknown, frequencies are not checked against it.
pub(super) fn resolve(drive: &file::Drive, rate: Option<Rate>, report: &mut Report) -> Result<Params, Reported> {
    let Some(given) = drive.filter.optional()? else { return Ok(Params::default()) };
    if let Some(fifth) = given.0.get(MOST) {
        report.error(fifth.span, format!("more than {MOST} filters in the torque path"), "leave the others out");
        return Err(Reported);
    }
    let filters: Vec<_> = given.0.iter().map(|at| filter(&at.value, rate, report)).collect();
    let filters = filters.into_iter().collect::<Result<Vec<_>, _>>()?;
    Params::new(&filters, rate.ok_or(Reported)?).map_err(|_| Reported)
}

fn filter(given: &TorqueFilter, rate: Option<Rate>, report: &mut Report) -> Result<Filter, Reported> {
    let kind = *given.kind.given().ok_or(Reported)?;
    let keys: [(&str, Option<Span>); 7] = [
        ("frequency", given.frequency.span()),
        ("order", given.order.span()),
        ("damping", given.damping.span()),
        ("zero_frequency", given.zero_frequency.span()),
        ("zero_damping", given.zero_damping.span()),
        ("pole_frequency", given.pole_frequency.span()),
        ("pole_damping", given.pole_damping.span()),
    ];
    let (own, why): (&[&str], _) = match kind {
        FilterKind::LowPass => (&["frequency", "order", "damping"], "is not for a low-pass"),
        FilterKind::Notch => (&["frequency", "zero_damping", "pole_damping"], "is not for a notch"),
        FilterKind::BiQuad => {
            (&["zero_frequency", "zero_damping", "pole_frequency", "pole_damping"], "is not for a bi-quad")
        }
    };
    let others: Vec<_> = keys.into_iter().filter(|(key, _)| !own.contains(key)).collect();
    refuse(&others, why, "", report);
    let mut frequency = |key: &str, slot: &Slot<f64>| {
        let value = need(slot, "drive.filter", key, given.span, report).ok_or(Reported)?;
        below_half(key, slot, rate, report)?;
        Ok(value)
    };
    let (one, zeros, poles) = match kind {
        FilterKind::LowPass | FilterKind::Notch => (frequency("frequency", &given.frequency), Ok(0.0), Ok(0.0)),
        FilterKind::BiQuad => (
            Ok(0.0),
            frequency("zero_frequency", &given.zero_frequency),
            frequency("pole_frequency", &given.pole_frequency),
        ),
    };
    let or = |slot: &Slot<f64>, default: f64| Ok::<_, Reported>(slot.optional()?.copied().unwrap_or(default));
    let order = given.order.optional()?.copied().unwrap_or(1);
    if let (FilterKind::LowPass, 1, Some(span)) = (kind, order, given.damping.span()) {
        report.error(span, "a low-pass of first order has no `damping`", "write `order = 2`");
        return Err(Reported);
    }
    let (zero_damping, pole_damping) = (or(&given.zero_damping, 0.0)?, or(&given.pole_damping, DAMPING)?);
    Ok(match kind {
        FilterKind::LowPass if order == 1 => Filter::LowPass { frequency: one? },
        FilterKind::LowPass => Filter::SecondOrder { frequency: one?, damping: or(&given.damping, DAMPING)? },
        FilterKind::Notch => Filter::Notch { frequency: one?, zero_damping, pole_damping },
        FilterKind::BiQuad => {
            Filter::BiQuad { zero_frequency: zeros?, zero_damping, pole_frequency: poles?, pole_damping }
        }
    })
}

/// Checks that a frequency is below half the sampling rate.
fn below_half(key: &str, slot: &Slot<f64>, rate: Option<Rate>, report: &mut Report) -> Result<(), Reported> {
    let (Some(at), Some(rate)) = (slot.at(), rate) else { return Ok(()) };
    let half = f64::from(rate.hertz()) / 2.0;
    if at.value < half {
        return Ok(());
    }
    let message = format!("`{key}` must be below half the rate of the velocity loop, {half} Hz");
    report.error(at.span, message, "lower it, or raise `drive.velocity.rate`");
    Err(Reported)
}
