//! `[motor.encoder]`, `[drive.load_encoder]`, `[drive.current.sensor]`: sensors and their errors.
use crate::diagnostic::Report;
use crate::field::{Reported, Slot};
use crate::file;
use crate::resolve::{Alternative, one_of, refuse};
use servobench_base::{Coordinate, Rate};
use servobench_plant::{Converter, CurrentSensor, Encoder, EncoderErrors};
use std::f64::consts::TAU;

/// An encoder on a body of `motion`.
pub(super) fn encoder(
    keys: &file::Encoder,
    motion: Option<Coordinate>,
    report: &mut Report,
) -> Result<Encoder, Reported> {
    if motion == Some(Coordinate::Linear) {
        let of_turning = [
            ("counts_per_rev", keys.counts_per_rev.span()),
            ("lines_per_rev", keys.lines_per_rev.span()),
            ("turn_bits", keys.turn_bits.span()),
            ("eccentricity", keys.eccentricity.span()),
            ("disc_radius", keys.disc_radius.span()),
            ("eccentricity_angle", keys.eccentricity_angle.span()),
        ];
        for (key, span) in of_turning {
            if let Some(span) = span {
                let help = match key {
                    "counts_per_rev" => "give one `step`",
                    "lines_per_rev" => "give one `signal_period`",
                    _ => "",
                };
                report.error(span, format!("an encoder along a line has no `{key}`"), help);
                return Err(Reported);
            }
        }
    }
    let periods = [("signal_period", keys.signal_period.span()), ("lines_per_rev", keys.lines_per_rev.span())];
    let period = match one_of(&periods, report) {
        Alternative::None => None,
        Alternative::Contradiction => return Err(Reported),
        Alternative::Use(0) => keys.signal_period.optional()?.copied(),
        Alternative::Use(_) => keys.lines_per_rev.optional()?.map(|lines| TAU / f64::from(*lines)),
    };
    let resolutions = [
        ("step", keys.step.span()),
        ("counts_per_rev", keys.counts_per_rev.span()),
        ("interpolation", keys.interpolation.span()),
    ];
    let increment = match one_of(&resolutions, report) {
        Alternative::None => None,
        Alternative::Contradiction => return Err(Reported),
        Alternative::Use(0) => keys.step.optional()?.copied(),
        Alternative::Use(1) => keys.counts_per_rev.optional()?.map(|counts| TAU / f64::from(*counts)),
        Alternative::Use(_) => {
            let steps = keys.interpolation.optional()?;
            steps.map(|steps| need_period(period, keys, report).map(|period| period / f64::from(*steps))).transpose()?
        }
    };
    let (mut errors, are_right) = keys.parameters();
    if let Some(track) = keys.lost_track.optional()? {
        errors.signals.lost = Some((*track, keys.lost_at.optional()?.copied().unwrap_or(0.0)));
    }
    if errors.signals.errs() {
        errors.signals.period = need_period(period, keys, report)?;
    }
    check_eccentricity(&errors, keys, report)?;
    are_right?;
    errors.range = keys.turn_bits.optional()?.map(|bits| TAU * (1_u64 << bits) as f64);
    Ok(Encoder { increment, errors: errors.errs().then_some(errors) })
}

fn need_period(period: Option<f64>, keys: &file::Encoder, report: &mut Report) -> Result<f64, Reported> {
    period.ok_or_else(|| {
        report.error(
            keys.span,
            "the signals of this encoder have no period",
            "give `signal_period` or `lines_per_rev`",
        );
        Reported
    })
}

/// Checks that the disc of an eccentric encoder is read at a radius larger than its eccentricity.
fn check_eccentricity(errors: &EncoderErrors, keys: &file::Encoder, report: &mut Report) -> Result<(), Reported> {
    let EncoderErrors { eccentricity, radius, .. } = *errors;
    if eccentricity == 0.0 {
        return Ok(());
    }
    if keys.disc_radius.optional()?.is_none() {
        report.error(keys.span, "an `eccentricity` needs the radius at which the disc is read", "give `disc_radius`");
        return Err(Reported);
    }
    if eccentricity >= radius {
        let span = keys.eccentricity.span().unwrap_or(keys.span);
        let message = format!("`eccentricity` of {eccentricity} m is not less than `disc_radius`, {radius} m");
        report.error(span, message, "give less");
        return Err(Reported);
    }
    Ok(())
}

/// The encoder of a synchronous motor of `electrical_ratio`, which also serves commutation.
pub(super) fn with_commutation(
    encoder: Encoder,
    slot: &Slot<file::Encoder>,
    electrical_ratio: f64,
) -> Result<Encoder, Reported> {
    let Some(given) = slot.optional()? else { return Ok(encoder) };
    let Some(offset) = given.commutation.offset.optional()? else { return Ok(encoder) };
    let errors = EncoderErrors { commutation: offset / electrical_ratio, ..encoder.errors.unwrap_or_default() };
    Ok(Encoder { errors: errors.errs().then_some(errors), ..encoder })
}

/// Refuses a commutation offset: an ideal source is not commutated.
pub(super) fn refuse_commutation(slot: &Slot<file::Encoder>, report: &mut Report) {
    if let Some(given) = slot.given() {
        let why = "belongs to a synchronous motor, this is an ideal source";
        refuse(&[("commutation_offset", given.commutation.offset.span())], why, "", report);
    }
}

/// `None` for sensors without errors.
pub(super) fn current(
    slot: &Slot<file::CurrentSensor>,
    base_rate: Option<Rate>,
    report: &mut Report,
) -> Result<Option<CurrentSensor>, Reported> {
    let Some(given) = slot.optional()? else { return Ok(None) };
    let converter = match (given.bits.optional()?, given.range.optional()?) {
        (None, None) => None,
        (Some(bits), Some(range)) => Some(Converter { bits: *bits, range: *range }),
        (bits, _) => {
            let key = if bits.is_some() { "range" } else { "bits" };
            report.missing_with_help("drive.current.sensor", key, given.span, "a converter has both");
            return Err(Reported);
        }
    };
    if let (Some(at), Some(base_rate)) = (given.shift.at(), base_rate)
        && at.value >= base_rate.period()
    {
        let message = format!("`shift` of {:e} s is not less than a base tick, {:e} s", at.value, base_rate.period());
        report.error(at.span, message, "for whole cycles of the current loop there is `delay`");
        return Err(Reported);
    }
    let (sensor, are_right) = given.parameters();
    are_right?;
    let sensor = CurrentSensor { converter, ..sensor };
    Ok((sensor != CurrentSensor { seed: sensor.seed, ..CurrentSensor::default() }).then_some(sensor))
}
