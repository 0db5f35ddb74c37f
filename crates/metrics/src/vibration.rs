//! Residual vibration of the load: what is left when the set-point has come to rest.
use crate::absence::Absence;
use crate::extremes::range_of;
use crate::metric::MetricSet;
use crate::modal::{self, Mode, fit_mode};
use crate::name::Name;
use crate::span::{Checked, Phase, channel, root_mean};
use servobench_signals::Signal;
use std::ops::Range;

const LOAD: Signal = Signal::LoadPosition;
/// Values in which a mode is looked for, at most: a minute at 16 kHz. What a move leaves ringing has died away by then, and a spectrum of
/// ten minutes would take a gigabyte.
const HEARD: usize = 1 << 20;

/// Where the mode of a vibration is looked for.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Search {
    /// Nobody wants one.
    Nowhere,
    /// At any frequency.
    Everywhere,
    /// Near a frequency (Hz).
    Near(f64),
}

/// Vibration over one stretch of the recording.
#[derive(Debug, Clone)]
pub(crate) struct Residual {
    peak_to_peak: Result<f64, Absence>,
    rms: Result<f64, Absence>,
    /// `None` when none was looked for.
    mode: Option<Result<Mode, Absence>>,
}

impl Residual {
    /// No vibration to measure, and why.
    pub(crate) fn absent(why: &Absence) -> Self {
        Self { peak_to_peak: Err(why.clone()), rms: Err(why.clone()), mode: Some(Err(why.clone())) }
    }

    /// From the end of the profile to the next move. `search` says where a mode is looked for.
    pub(crate) fn after(recording: &Checked<'_>, phase: &Phase<'_>, search: Search) -> Self {
        Self::over(recording, &phase.after, phase.made.end, phase.made.to, search)
    }

    /// From `time` (s) to the next move.
    pub(crate) fn from_time(recording: &Checked<'_>, time: f64, search: Search) -> Self {
        let start = recording.index_at(time);
        let next = recording.moves.iter().map(|made| recording.index_at(made.start)).find(|row| *row > start);
        let rest = recording.channel(LOAD).and_then(|load| load.last()).copied().unwrap_or_default();
        Self::over(recording, &(start..next.unwrap_or(recording.len())), time, rest, search)
    }

    /// Over `rows`, as deviation from `rest` (axis unit), with the amplitude referred to the instant `zero` (s).
    fn over(recording: &Checked<'_>, rows: &Range<usize>, zero: f64, rest: f64, search: Search) -> Self {
        let load = match channel(recording, LOAD) {
            Ok(load) if !rows.is_empty() => &load[rows.clone()],
            Ok(_) => return Self::absent(&Absence::NothingRecorded { part: "after the profile" }),
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
        let heard: Vec<f64> = deviation.clone().take(HEARD).collect();
        let signal = modal::Signal {
            values: &heard,
            start: rows.start as f64 * period - zero,
            step: period,
            resolution: 8.0 * f64::EPSILON * largest,
        };
        Self {
            peak_to_peak: Ok(high - low),
            rms: root_mean(deviation.map(|x| (x - mean) * (x - mean)), "after the profile"),
            mode: match search {
                Search::Nowhere => None,
                Search::Everywhere => Some(fit_mode(&signal, None)),
                Search::Near(frequency) => Some(fit_mode(&signal, Some(frequency))),
            },
        }
    }

    /// The dominant mode, where there is one.
    pub(crate) fn mode(&self) -> Option<&Mode> {
        self.mode.as_ref()?.as_ref().ok()
    }

    /// Notes the metrics, without those of a mode when none was looked for.
    pub(crate) fn note(&self, set: &mut MetricSet, recording: &Checked<'_>) {
        let unit = recording.about.axis_unit.as_str();
        set.note(Name::ResidualVibrationPp, unit, self.peak_to_peak.clone());
        set.note(Name::ResidualVibrationRms, unit, self.rms.clone());
        let Some(mode) = &self.mode else { return };
        let of_mode = |value: fn(&Mode) -> f64| mode.as_ref().map(value).map_err(Clone::clone);
        set.note(Name::ResidualVibrationAmplitude, unit, of_mode(|mode| mode.amplitude));
        set.note(Name::ResidualVibrationFrequency, "Hz", of_mode(|mode| mode.frequency));
        set.note(Name::ResidualVibrationDamping, "", of_mode(|mode| mode.damping));
        set.note(Name::ResidualVibrationShare, "", of_mode(|mode| mode.share));
    }
}
