//! Selection of the fitted mode that is reported.
use super::fit::Fit;
use super::model::{Component, Oscillation, tail};
use super::order::Order;
use super::series::Series;
use super::swings::Swings;
use super::{BAND, Mode, PERIODS, Signal, noise};
use crate::extremes::span_of;
use core::f64::consts::PI;

/// Stronger damping is settling, not vibration; stronger growth ends in an error, not in a recording.
const MAX_DAMPING: f64 = 0.5;
/// Share of the oscillation that modes must explain, unless they explain everything.
const EXPLAINED: f64 = 0.9;
/// Largest remainder of a true mode, as a share of its envelope; a larger one shows an imitation.
const IMITATED: f64 = 0.2;
/// A mode below this share of the record's height is an artefact of its tail.
const CRUMB: f64 = 1e-7;
/// A mode larger than this, in heights of the record, is one of several that nearly cancel: not a visible vibration.
const CANCELLING: f64 = 2.0;
/// An oscillation is visible while its envelope is above 5 % of its largest value, e⁻³, and above the smallest vibration that matters.
const VISIBLE: f64 = 3.0;
/// A motion by less than this share of a mode's envelope for a quarter of its period is a standstill. At the least
/// favourable instant a mode beside a drift of its own velocity still moves by 8 %.
const STILL: f64 = 0.01;
/// Stillness is searched for while the envelope is above this share of its largest value; a mode that has nearly died
/// away may be invisible to an encoder.
const LOUD: f64 = 0.2;
/// The same in steps of a sensor, to which less may be invisible.
const INCREMENTS: f64 = 4.0;

/// A mode that is seen for fewer periods may be the imitation of a motion that comes to a stop, by a few poles of much damping.
const FEW_PERIODS: f64 = 5.0;
/// A motion comes to a stop where a quarter of a period moves it by this multiple of noise and encoder resolution at rest, and the
/// next one by no more than that. If it decays as such a mode does, a quarter moves by 1/22 of the one before at least.
const STOPPED: f64 = 25.0;
/// Means in a quarter of a period, from which a stop is detected: noise is less in them.
const MEANS: usize = 4;

/// A fitted mode.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Found {
    pub(crate) mode: Mode,
    /// Periods before its envelope falls to 5 %, or below the smallest vibration that matters, within the record.
    pub(crate) periods: f64,
}

/// Reasons why a record has no fitted mode.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Unfit {
    /// Tails explain it, or it is empty.
    Settles,
    /// Its slowest part is shorter than two periods.
    TooShort {
        /// Periods in the record.
        periods: f64,
    },
    /// The record holds still where a mode would move it.
    Sticks,
    /// The record has modes, but none near the frequency that was given.
    Elsewhere,
    /// Modes explain this share of it only.
    NotModal {
        /// From 0 to 1.
        share: f64,
    },
}

/// The mode with the most energy in `signal`, a record of height 1, of which `series` was thinned and `order` fitted;
/// with `near` (Hz), the one with the most energy within [`BAND`]. Modes that are visible for two periods come before those that die
/// sooner. Nothing below `least` is a mode.
///
/// # Errors
/// [`Unfit`]: the reason why there is none.
pub(crate) fn dominant(
    order: &Order,
    series: &Series,
    signal: &Signal<'_>,
    near: Option<f64>,
    least: f64,
) -> Result<Found, Unfit> {
    let span = signal.values.len() as f64 * signal.step;
    let seen = |found: Oscillation, time: f64| found.damped / (2.0 * PI) * time;
    let unseen = least.max(signal.resolution);
    let visible = |found: Oscillation, largest: f64| {
        seen(found, span.min(VISIBLE.min((largest / unseen).ln()) / found.decay.abs()))
    };
    let share = explained(&order.fit, |found| seen(found, span) >= PERIODS);
    let mut best: Option<((bool, f64), f64, Found)> = None;
    let (mut too_short, mut elsewhere, mut cancelling) = (None::<f64>, false, Vec::new());
    for (component, coefficients) in order.fit.parts() {
        let Some(found) = vibration(component) else { continue };
        let (frequency, damping) = (found.frequency(), found.damping());
        let amplitude = amplitude(found, coefficients, series);
        let envelope = |t: f64| amplitude * libm::exp(-found.decay * t);
        let largest = envelope(signal.start).max(envelope(signal.start + span));
        if largest >= CANCELLING {
            cancelling.push(component);
            continue;
        }
        if largest <= unseen.max(CRUMB) {
            continue;
        }
        if seen(found, span) < PERIODS {
            too_short = Some(too_short.map_or(seen(found, span), |other| other.max(seen(found, span))));
        } else if near.is_some_and(|near| (frequency - near).abs() > BAND * near) {
            elsewhere = true;
        } else if stands_still(signal, found, envelope)
            || visible(found, largest) < FEW_PERIODS && comes_to_a_stop(signal, found, unseen)
        {
            return Err(Unfit::Sticks);
        } else if !order.is_whole && order.fit.peak() > IMITATED * largest {
            return Err(Unfit::NotModal { share });
        } else {
            // Mean of the squared envelope over the record.
            let energy = amplitude * amplitude * tail(2.0 * found.decay, span, span);
            let periods = visible(found, largest);
            let rank = (periods >= PERIODS, energy);
            if best.is_none_or(|(other, ..)| rank > other) {
                let mode = Mode { amplitude, frequency, damping, share };
                best = Some((rank, largest, Found { mode, periods }));
            }
        }
    }
    // A component that nearly cancels may still be the swing: then a small mode beside it is a part of the imitation.
    let among_larger = best.is_some_and(|(_, largest, _)| {
        let rest = order.fit.sum_of(|component| cancelling.contains(&component));
        !cancelling.is_empty() && Swings::of(&rest, series.step, 2.0 * largest).is_some()
    });
    match (best, too_short) {
        (Some(_), _) if among_larger => Err(Unfit::NotModal { share }),
        (Some((.., found)), _) if order.is_whole || share >= EXPLAINED => Ok(found),
        (None, Some(periods)) => Err(Unfit::TooShort { periods }),
        (None, None) if elsewhere => Err(Unfit::Elsewhere),
        (None, None) if order.is_whole => Err(Unfit::Settles),
        _ => Err(Unfit::NotModal { share }),
    }
}

/// True if the record moves by more than `unseen` in a quarter of a period of the mode `found` and holds still in the next one; for a
/// mode that grows, in the one before.
fn comes_to_a_stop(signal: &Signal<'_>, found: Oscillation, unseen: f64) -> bool {
    let rows = (quarter(signal, found) / MEANS).max(1);
    let mean = |values: &[f64]| values.iter().sum::<f64>() / rows as f64;
    let means: Vec<f64> = signal.values.chunks_exact(rows).map(mean).collect();
    let noise = 2.0 * noise::DEVIATIONS * noise::deviation(signal.values) / (rows as f64).sqrt();
    let quiet = signal.resolution.max(noise);
    means.windows(2 * (MEANS + 1)).any(|means| {
        let (before, after) = means.split_at(MEANS + 1);
        let (moves, rests) = if found.decay < 0.0 { (after, before) } else { (before, after) };
        let moves = span_of(moves);
        moves > unseen.max(STOPPED * quiet) && span_of(rests) <= quiet.max(STILL * moves)
    })
}

/// Rows of a quarter of a period; at least one.
fn quarter(signal: &Signal<'_>, found: Oscillation) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates: no whole quarter then")]
    let quarter = (PI / (2.0 * found.damped * signal.step)).max(1.0) as usize;
    quarter
}

/// True if the record stands still for a quarter of a period while the mode `found` with this `envelope` is loud: then
/// something else moves it, and a sum of modes only imitates that.
fn stands_still(signal: &Signal<'_>, found: Oscillation, envelope: impl Fn(f64) -> f64) -> bool {
    let quarter = quarter(signal, found);
    let time = |k: usize| signal.start + k as f64 * signal.step;
    let loud = LOUD * envelope(time(0)).max(envelope(time(signal.values.len())));
    signal.values.chunks_exact(quarter).enumerate().any(|(k, values)| {
        let least = envelope(time(k * quarter)).min(envelope(time((k + 1) * quarter)));
        // Motion within the resolution is invisible; two values stand still by chance.
        quarter > 2 && least > loud.max(INCREMENTS * signal.resolution) && span_of(values) < STILL * least
    })
}

/// The oscillation of a component, if it counts as vibration.
fn vibration(component: Component) -> Option<Oscillation> {
    component.oscillation().filter(|found| found.damping().abs() <= MAX_DAMPING)
}

/// Amplitude in the record at time 0: fitted to the thinned series, corrected by its gain.
fn amplitude(found: Oscillation, coefficients: &[f64], series: &Series) -> f64 {
    let gain = series.gain(found.decay, found.damped);
    libm::hypot(coefficients[0], coefficients[1] / found.damped) / libm::hypot(gain.0, gain.1)
}

/// Share of the energy of the oscillation, without settling, that the vibrations selected by `which` explain.
fn explained(fit: &Fit, which: impl Fn(Oscillation) -> bool) -> f64 {
    let fitted = fit.sum_of(|component| vibration(component).is_some_and(&which));
    let whole: f64 = fitted.iter().zip(&fit.residual).map(|(y, r)| (y + r) * (y + r)).sum();
    if whole > 0.0 { (1.0 - fit.energy / whole).clamp(0.0, 1.0) } else { 0.0 }
}
