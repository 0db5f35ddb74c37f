//! Times in base ticks: sample times, averages, the period of a commanding task; and the input shapers.
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file::{self, File};
use crate::resolve::keys::{Keys, Reported};
use crate::resolve::whole;
use crate::scenario::Interpolation;
use crate::source::At;
use servobench_base::Rate;
use servobench_motion::shape::{Shaper, ShaperKind};
use servobench_planner::{Averages, Filter, Grid, Shaping};

/// The filter of a move.
pub(super) fn filter(
    keys: &Keys<'_>,
    base_rate: Option<Rate>,
    said: &mut Reported,
    report: &mut Report,
) -> Option<Filter> {
    let given = keys.shaper.optional().ok()?.map_or(&[][..], |shapers| &shapers.0);
    let all: Vec<_> = given.iter().map(|one| shaping(&one.value, said, report)).collect();
    let shapers: Vec<_> = all.into_iter().collect::<Option<Vec<_>>>()?.into_iter().flatten().collect();
    let given = keys.averages.optional().ok()?.map_or(&[][..], |averages| &averages.0);
    let lengths: Vec<_> =
        given.iter().map(|length| whole_ticks("averages", *length, base_rate, said, report)).collect();
    let averages = match lengths.into_iter().collect::<Option<Vec<_>>>()? {
        lengths if lengths.is_empty() => None,
        lengths => Some(Averages { lengths, sample_time: base_rate?.period() }),
    };
    let filter = Filter { shapers, averages };
    if let (Err(error), Some(span)) = (filter.impulses(), keys.shaper.span()) {
        said.once(span, |report| report.error(span, format!("`shaper`: {error}"), ""), report);
        return None;
    }
    Some(filter)
}

/// An input shaper, unless it is "none".
#[expect(clippy::option_option, reason = "a wrong shaper is not the same as none")]
fn shaping(given: &file::Shaper, said: &mut Reported, report: &mut Report) -> Option<Option<Shaping>> {
    let kind = *given.kind.given()?;
    let tolerable = given.tolerable.optional().ok()?.copied();
    if let (Some(_), Some(span), true) =
        (tolerable, given.tolerable.span(), !kind.is_some_and(ShaperKind::has_tolerable))
    {
        said.once(span, |report| report.error(span, "`tolerable` is for the EI shapers", ""), report);
    }
    let Some(kind) = kind else { return Some(None) };
    if matches!(given.frequency, Slot::Absent) {
        let say = |report: &mut Report| {
            report.missing_with_help("shaper", "frequency", given.span, "that of the mode");
        };
        said.once(given.span, say, report);
    }
    let damping = given.damping.optional().ok()?.copied().unwrap_or(0.0);
    let shaper = Shaper::new(kind, tolerable.unwrap_or(Shaper::TOLERABLE));
    let shaping = Shaping { shaper, frequency: *given.frequency.given()?, damping };
    if let Err(error) = shaping.impulses() {
        said.once(given.span, |report| report.error(given.span, format!("`shaper`: {error}"), ""), report);
        return None;
    }
    Some(Some(shaping))
}

/// The sampling of a move from rest to rest, if it has one.
#[expect(clippy::option_option, reason = "a wrong sample time is not the same as none")]
pub(super) fn grid(
    keys: &Keys<'_>,
    base_rate: Option<Rate>,
    said: &mut Reported,
    report: &mut Report,
) -> Option<Option<Grid>> {
    let sample_time = match keys.sample_time {
        Slot::Absent => None,
        Slot::Wrong(_) => return None,
        Slot::Given(at) => Some(whole_ticks("sample_time", *at, base_rate, said, report)?),
    };
    let Some(sample_time) = sample_time else {
        for (key, span) in [("sampling", keys.sampling.span()), ("execution", keys.execution.span())] {
            let Some(span) = span else { continue };
            let message = format!("`{key}` is for a move that has samples");
            said.once(span, |report| report.error(span, message, "give `sample_time`"), report);
        }
        return Some(None);
    };
    let sampling = keys.sampling.optional().ok()?.copied().unwrap_or_default();
    let execution = keys.execution.optional().ok()?.copied().unwrap_or_default();
    Some(Some(Grid { sample_time, sampling, execution }))
}

/// Interpolation between the set-point and the drive, if there is one.
#[expect(clippy::option_option, reason = "a wrong table is not the same as none")]
pub(super) fn interpolation(
    file: &File,
    base_rate: Option<Rate>,
    report: &mut Report,
) -> Option<Option<Interpolation>> {
    let Some(setpoint) = file.setpoint.given() else { return Some(None) };
    let Some(given) = setpoint.interpolation.optional().ok()? else { return Some(None) };
    let period = whole_ticks("period", *given.period.at()?, base_rate, &mut Reported::default(), report)?;
    Some(Some(Interpolation { mode: *given.mode.given()?, period }))
}

/// A time that must be a whole number of base ticks.
fn whole_ticks(
    key: &str,
    time: At<f64>,
    base_rate: Option<Rate>,
    said: &mut Reported,
    report: &mut Report,
) -> Option<f64> {
    let hertz = f64::from(base_rate?.hertz());
    match whole::number(key, time.value, hertz, "base ticks") {
        // Not as typed: the deviation of 83.33333333 us from a tick at 12 kHz would accumulate over the samples of a move.
        Ok(ticks) => Some(ticks / hertz),
        Err((message, help)) => {
            said.once(time.span, |report| report.error(time.span, message, help), report);
            None
        }
    }
}
