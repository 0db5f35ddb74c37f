//! Residual vibration of the load, after the set-point has come to rest.
use crate::absence::Absence;
use crate::basis;
use crate::extremes::range_of;
use crate::measure::Question;
use crate::metric::MetricSet;
use crate::modal::{self, Mode, Vibration, vibration};
use crate::name::Name;
use crate::span::{Checked, Phase, channel, root_mean};
use servobench_signals::Signal;
use std::ops::Range;

const LOAD: Signal = Signal::LoadPosition;
/// Maximum number of values in which a mode is searched for: a minute at 16 kHz. The ringing after a move has died away by then, and
/// a spectrum of ten minutes would take a gigabyte.
const HEARD: usize = 1 << 20;

/// Frequencies at which the mode of a vibration is searched for.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Search {
    /// No mode is needed.
    Nowhere,
    /// At any frequency.
    Everywhere,
    /// Near a frequency (Hz).
    Near(f64),
}

impl Search {
    /// Near `mode` (Hz), or everywhere without one.
    pub(crate) fn of(mode: Option<f64>) -> Self {
        mode.map_or(Self::Everywhere, Self::Near)
    }
}

/// Vibration over one stretch of the recording.
#[derive(Debug, Clone)]
pub(crate) struct Residual {
    peak_to_peak: Result<f64, Absence>,
    rms: Result<f64, Absence>,
    /// `None` without a search.
    mode: Option<Result<Vibration, Absence>>,
}

impl Residual {
    /// No vibration to measure, with the reason.
    pub(crate) fn absent(why: &Absence) -> Self {
        Self { peak_to_peak: Err(why.clone()), rms: Err(why.clone()), mode: Some(Err(why.clone())) }
    }

    /// From the end of the profile to the next move; `search` gives the frequencies of the mode.
    pub(crate) fn after(recording: &Checked<'_>, phase: &Phase<'_>, question: &Question, search: Search) -> Self {
        Self::over(recording, &phase.rest, phase.made.end, phase.made.to, question, search)
    }

    /// From `time` (s) to the next move. The amplitude is that at the end of the profile before it, if no effort has changed since.
    pub(crate) fn from_time(recording: &Checked<'_>, time: f64, question: &Question, search: Search) -> Self {
        let start = recording.index_at(time);
        let next = recording.moves.iter().map(|made| recording.index_at(made.start)).find(|row| *row > start);
        let rest = recording.channel(LOAD).and_then(|load| load.last()).copied().unwrap_or_default();
        let made = recording.moves.iter().rfind(|made| made.end <= time);
        let zero = made.map(|made| made.end).filter(|end| !is_pushed(recording, &(recording.index_at(*end)..start)));
        Self::over(recording, &(start..next.unwrap_or(recording.len())), zero.unwrap_or(time), rest, question, search)
    }

    /// Over `rows`, as deviation from `rest` (axis unit), with the amplitude referred to the instant `zero` (s).
    fn over(
        recording: &Checked<'_>,
        rows: &Range<usize>,
        zero: f64,
        rest: f64,
        question: &Question,
        search: Search,
    ) -> Self {
        let load = match channel(recording, LOAD).and_then(|load| basis::of(recording, rows, question).map(|()| load)) {
            Ok(load) => &load[rows.clone()],
            Err(why) => return Self::absent(&why),
        };
        let (lowest, highest) = range_of(load);
        let largest = lowest.abs().max(highest.abs());
        // Deviations of nanometres beside a position of a metre: subtract before anything else.
        let deviation = load.iter().map(|x| x - rest);
        let (low, high) = (lowest - rest, highest - rest);
        // From the first value on, so that a load at rest has no RMS of rounding.
        let first = deviation.clone().next().unwrap_or_default();
        let mean = first + deviation.clone().map(|x| x - first).sum::<f64>() / load.len() as f64;
        let period = recording.rate.period();
        let mode = match search {
            Search::Nowhere => None,
            Search::Everywhere | Search::Near(_) => {
                let heard: Vec<f64> = deviation.clone().take(HEARD).collect();
                let signal = modal::Signal {
                    values: &heard,
                    start: rows.start as f64 * period - zero,
                    step: period,
                    resolution: 8.0 * f64::EPSILON * largest,
                    least: question.least(),
                };
                Some(vibration(&signal, if let Search::Near(frequency) = search { Some(frequency) } else { None }))
            }
        };
        Self {
            peak_to_peak: Ok(high - low),
            rms: root_mean(deviation.map(|x| (x - mean) * (x - mean)), "after the profile"),
            mode,
        }
    }

    /// Largest peak-to-peak value and RMS over all rests of a program, and the mode with the largest amplitude. A pause that is too
    /// short to measure does not count; a too short last rest means that the run was cut short.
    pub(crate) fn largest(mut all: Vec<Self>) -> Self {
        let Some(last) = all.pop() else { return Self::absent(&Absence::NoMove) };
        if let Err(why @ (Absence::RestTooShort { .. } | Absence::NothingRecorded { .. })) = &last.peak_to_peak {
            return Self::absent(why);
        }
        all.into_iter().filter(|rest| rest.peak_to_peak.is_ok()).fold(last, |one, two| Self {
            peak_to_peak: larger(one.peak_to_peak, two.peak_to_peak, |value| *value),
            rms: larger(one.rms, two.rms, |value| *value),
            mode: match (one.mode, two.mode) {
                (Some(one), Some(two)) => Some(larger(one, two, |found| found.amplitude)),
                (one, two) => one.or(two),
            },
        })
    }

    /// The dominant mode, if one could be fitted.
    pub(crate) fn mode(&self) -> Option<Mode> {
        self.mode.as_ref()?.as_ref().ok()?.mode().ok()
    }

    /// Notes the metrics, without those of a mode if none was searched for.
    pub(crate) fn note(&self, set: &mut MetricSet, recording: &Checked<'_>) {
        let unit = recording.about.axis_unit.as_str();
        set.note(Name::ResidualVibrationPp, unit, self.peak_to_peak.clone());
        set.note(Name::ResidualVibrationRms, unit, self.rms.clone());
        let Some(mode) = &self.mode else { return };
        let mode = mode.clone();
        set.note(Name::ResidualVibrationAmplitude, unit, mode.clone().map(|found| found.amplitude));
        set.note(Name::ResidualVibrationFrequency, "Hz", mode.clone().and_then(|found| found.frequency));
        set.note(Name::ResidualVibrationDamping, "", mode.clone().and_then(|found| found.damping));
        set.note(Name::ResidualVibrationShare, "", mode.and_then(|found| found.share));
    }
}

/// The larger of two, by `size`; absent only if both are.
fn larger<T>(one: Result<T, Absence>, two: Result<T, Absence>, size: impl Fn(&T) -> f64) -> Result<T, Absence> {
    match (one, two) {
        (Ok(one), Ok(two)) => Ok(if size(&two) > size(&one) { two } else { one }),
        (Ok(one), Err(_)) | (Err(_), Ok(one)) => Ok(one),
        (Err(why), Err(_)) => Err(why),
    }
}

/// True if an external effort changes within `rows`.
fn is_pushed(recording: &Checked<'_>, rows: &Range<usize>) -> bool {
    let changes = |signal: Signal| {
        let values = channel(recording, signal).ok().and_then(|values| values.get(rows.clone()));
        values.is_some_and(|values| values.windows(2).any(|pair| pair[0].to_bits() != pair[1].to_bits()))
    };
    changes(Signal::DisturbanceMotor) || changes(Signal::DisturbanceLoad)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::span::phases;
    use crate::synthetic::{Build, planned};
    use core::f64::consts::TAU;

    /// 1 µm at 20 Hz, and 50 µm at 40 Hz after the part in which a mode is searched for.
    #[test]
    fn a_mode_is_of_the_first_minute_and_the_peaks_are_of_all() {
        let rate = 16_000;
        let late = HEARD as f64 / f64::from(rate) + 0.01;
        let position = move |t: f64| {
            let (size, frequency) = if t < late { (1e-6, 20.0) } else { (50e-6, 40.0) };
            1.0 + size * (TAU * frequency * t).sin()
        };
        let made = planned(0.0, 0.01, 0.0, 1.0).made();
        let recording = Build::new(rate, HEARD + 8_000).channel(LOAD, "m", position).moves([made]).finish();
        let residual =
            Residual::after(&Checked::of(&recording), &phases(&recording)[0], &Question::default(), Search::Everywhere);
        let mode = residual.mode().unwrap();
        assert!((mode.frequency - 20.0).abs() < 1e-3 && (mode.amplitude - 1e-6).abs() < 1e-9, "{mode:?}");
        assert!((residual.peak_to_peak.unwrap() - 100e-6).abs() < 1e-9);
    }

    /// 1 µm at 20 Hz, and from 1 s on a motion that is not a move: a search for a switch, 10 mm far.
    #[test]
    fn a_rest_ends_where_something_else_is_requested() {
        let position = |t: f64| 1.0 + 1e-6 * (TAU * 20.0 * t).sin() + if t < 1.0 { 0.0 } else { 10e-3 * (t - 1.0) };
        let requested = |t: f64| if t < 1.0 { 0.0 } else { 10e-3 };
        let recording = Build::new(1_000, 2_000)
            .channel(LOAD, "m", position)
            .channel(Signal::RequestVelocity, "m/s", requested)
            .moves([planned(0.0, 0.01, 0.0, 1.0).made()])
            .finish();
        let residual =
            Residual::after(&Checked::of(&recording), &phases(&recording)[0], &Question::default(), Search::Everywhere);
        // Crests lie half a row beside one at most: (ωh)²/8 of 2 µm, 4 nm.
        let found = residual.peak_to_peak.unwrap();
        assert!((found - 2e-6).abs() < 5e-9, "{found}");
    }

    #[test]
    fn where_nobody_wants_a_mode_none_is_noted() {
        let made = planned(0.0, 0.01, 0.0, 1.0).made();
        let position = |t: f64| 1.0 + 1e-6 * (TAU * 20.0 * t).sin();
        let recording = Build::new(1_000, 2_000).channel(LOAD, "m", position).moves([made]).finish();
        let checked = Checked::of(&recording);
        let noted = |search| {
            let mut set = MetricSet::default();
            Residual::after(&checked, &phases(&recording)[0], &Question::default(), search).note(&mut set, &checked);
            (set.get(Name::ResidualVibrationPp).is_some(), set.get(Name::ResidualVibrationFrequency).is_some())
        };
        assert_eq!([Search::Nowhere, Search::Near(20.0)].map(noted), [(true, false), (true, true)]);
    }
}
