//! Which of the fitted modes is reported.
use super::fit::Fit;
use super::model::{Component, Oscillation, tail};
use super::order::Order;
use super::series::Series;
use super::{BAND, Mode, PERIODS, Signal};
use crate::absence::Absence;
use core::f64::consts::PI;

/// Stronger damping is settling, not vibration; stronger growth ends in an error, not in a recording.
const MAX_DAMPING: f64 = 0.5;
/// Share of the oscillation that modes must explain.
const EXPLAINED: f64 = 0.5;
/// A mode below this share of the record's height is taken for a crumb of its tail.
const CRUMB: f64 = 1e-7;
/// A mode larger than this, in heights of the record, is one of several that all but cancel: no vibration anybody sees.
const CANCELLING: f64 = 2.0;
/// An oscillation is visible while its envelope is above 5 % of its largest value, e⁻³.
const VISIBLE: f64 = 3.0;
/// What moves by less than this share of a mode's envelope for a quarter of its period stands still. At the least
/// favourable instant a mode beside a drift of its own velocity still moves by 8 %.
const STILL: f64 = 0.01;
/// Stillness is looked for while the envelope is above this share of its largest value; of a mode that has all but died
/// away an encoder may see nothing.
const LOUD: f64 = 0.2;

/// The mode with the most energy in `signal`, a record of height 1, of which `series` was thinned and `order` fitted;
/// with `near` (Hz), the one with the most energy within [`BAND`].
///
/// # Errors
/// [`Absence`]: why there is none.
pub(crate) fn dominant(
    order: &Order,
    series: &Series,
    signal: &Signal<'_>,
    near: Option<f64>,
) -> Result<Mode, Absence> {
    let span = signal.values.len() as f64 * signal.step;
    let periods = |found: Oscillation| found.damped / (2.0 * PI) * span.min(VISIBLE / found.decay.abs());
    let share = explained(&order.fit, |found| periods(found) >= PERIODS);
    let mut best: Option<(f64, Mode)> = None;
    let (mut too_short, mut unconfirmed, mut sticks) = (None::<f64>, false, false);
    for (component, coefficients) in order.fit.parts() {
        let Some(found) = vibration(component) else { continue };
        let (frequency, damping) = (found.frequency(), found.damping());
        let amplitude = amplitude(found, coefficients, series);
        let searched = near.is_none_or(|near| (frequency - near).abs() <= BAND * near);
        let envelope = |t: f64| amplitude * libm::exp(-found.decay * t);
        let largest = envelope(signal.start).max(envelope(signal.start + span));
        if !(searched && amplitude > signal.resolution.max(CRUMB) && largest < CANCELLING) {
            continue;
        }
        if periods(found) < PERIODS {
            too_short = Some(too_short.map_or(periods(found), |other| other.max(periods(found))));
        } else if !order.confirms(found) {
            unconfirmed = true;
        } else if stands_still(signal, found, envelope) {
            sticks = true;
        } else {
            // Mean of the squared envelope over the record.
            let energy = amplitude * amplitude * tail(2.0 * found.decay, span, span);
            if best.is_none_or(|(other, _)| energy > other) {
                best = Some((energy, Mode { amplitude, frequency, damping, share }));
            }
        }
    }
    match (best, too_short, near) {
        (Some((_, mode)), ..) if share >= EXPLAINED => Ok(mode),
        (Some(_), ..) => Err(Absence::NotModal { share }),
        (None, ..) if sticks => Err(Absence::Sticks),
        (None, ..) if unconfirmed => Err(Absence::Unconfirmed),
        (None, Some(periods), _) => Err(Absence::TooShort { periods, needed: PERIODS }),
        (None, None, Some(near)) => Err(Absence::NotThere { frequency: near, share: BAND }),
        (None, None, None) if order.fit.energy > CRUMB * CRUMB * series.values.len() as f64 => {
            Err(Absence::NotModal { share })
        }
        (None, None, None) => Err(Absence::NoVibration),
    }
}

/// Whether the record stands still for a quarter of a period while the mode `found` with this `envelope` is loud: then
/// something else moves it, and a sum of modes only imitates that.
fn stands_still(signal: &Signal<'_>, found: Oscillation, envelope: impl Fn(f64) -> f64) -> bool {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates: no whole quarter then")]
    let quarter = (PI / (2.0 * found.damped * signal.step)).max(1.0) as usize;
    let time = |k: usize| signal.start + k as f64 * signal.step;
    let loud = LOUD * envelope(time(0)).max(envelope(time(signal.values.len())));
    signal.values.chunks_exact(quarter).enumerate().any(|(k, values)| {
        let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(*y), h.max(*y)));
        let least = envelope(time(k * quarter)).min(envelope(time((k + 1) * quarter)));
        // Within the resolution it is not seen to move; two values stand still by chance.
        quarter > 2 && least > loud.max(2.0 * signal.resolution) && high - low < STILL * least
    })
}

/// The oscillation that a component is, when it counts as vibration.
fn vibration(component: Component) -> Option<Oscillation> {
    component.oscillation().filter(|found| found.damping().abs() <= MAX_DAMPING)
}

/// Amplitude in the record at time 0: what was fitted to the thinned series, by its gain.
fn amplitude(found: Oscillation, coefficients: &[f64], series: &Series) -> f64 {
    let gain = series.gain(found.decay, found.damped);
    libm::hypot(coefficients[0], coefficients[1] / found.damped) / libm::hypot(gain.0, gain.1)
}

/// Share of the energy of the oscillation, settling taken off, that the vibrations which `which` picks explain.
fn explained(fit: &Fit, which: impl Fn(Oscillation) -> bool) -> f64 {
    let fitted = fit.sum_of(|component| vibration(component).is_some_and(&which));
    let whole: f64 = fitted.iter().zip(&fit.residual).map(|(y, r)| (y + r) * (y + r)).sum();
    if whole > 0.0 { (1.0 - fit.energy / whole).clamp(0.0, 1.0) } else { 0.0 }
}
