//! Load that the program puts on motor and inverter: current, voltage, torque, power.
use crate::absence::Absence;
use crate::extremes::most_of;
use crate::metric::MetricSet;
use crate::name::Name;
use crate::power;
use crate::span::{Checked, channel, largest_magnitude, root_mean, unit};
use servobench_signals::Signal;
use std::ops::Range;

/// Peak value of a phase current; |i_dq| in the amplitude-invariant frame.
const PEAK_CURRENT: &str = "Apk";
/// Effective value of a phase current.
const RMS_CURRENT: &str = "Arms";
const EFFORT: Signal = Signal::EffortMotor;
const EFFORT_REFERENCE: Signal = Signal::EffortReference;

/// Notes current, voltage and torque over `rows`.
pub(crate) fn note(set: &mut MetricSet, recording: &Checked<'_>, rows: &Range<usize>) {
    let (peak, rms) = current(recording, rows);
    set.note(Name::CurrentPeak, PEAK_CURRENT, peak);
    set.note(Name::CurrentRms, RMS_CURRENT, rms);
    let voltage = vector(recording, Signal::VoltageD, Signal::VoltageQ, rows);
    set.note(Name::VoltagePeak, "V", voltage.and_then(longest));
    for (name, share) in [
        (Name::CurrentSaturationTime, Signal::SaturationCurrent),
        (Name::VoltageSaturationTime, Signal::SaturationVoltage),
        (Name::EffortSaturationTime, Signal::SaturationEffort),
    ] {
        set.note(name, "s", saturation_time(recording, share, rows));
    }
    let effort = channel(recording, EFFORT).map(|all| &all[rows.clone()]);
    let peak = |all: &[f64]| largest_magnitude(all, PART);
    let rms = |all: &[f64]| root_mean(all.iter().map(|effort| effort * effort), PART);
    set.note(Name::TorquePeak, unit(recording, EFFORT), effort.clone().and_then(peak));
    let asked = channel(recording, EFFORT_REFERENCE).map(|all| &all[rows.clone()]);
    set.note(Name::TorqueReferencePeak, unit(recording, EFFORT_REFERENCE), asked.and_then(peak));
    set.note(Name::TorqueRms, unit(recording, EFFORT), effort.and_then(rms));
    power::note(set, recording, rows);
}

const PART: &str = "of motor and inverter";

/// Peak and effective value of the current: with its ripple where the inverter switches, or else of the rows.
fn current(recording: &Checked<'_>, rows: &Range<usize>) -> (Result<f64, Absence>, Result<f64, Absence>) {
    let peaks = channel(recording, Signal::CurrentPeak);
    if !matches!(peaks, Err(Absence::NoChannel { .. })) {
        // No tick ends at the first row of a run.
        let ticks = if rows.len() > 1 { rows.start.max(1)..rows.end } else { rows.clone() };
        let square = |all: &[f64]| root_mean(all[ticks.clone()].iter().map(|rms| rms * rms), PART);
        let peak = peaks.and_then(|all| largest_magnitude(&all[ticks.clone()], PART));
        return (peak, channel(recording, Signal::CurrentRms).and_then(square));
    }
    let vector = vector(recording, Signal::CurrentD, Signal::CurrentQ, rows);
    // A phase of amplitude |i_dq| has the effective value |i_dq|/√2.
    let effective = |[d, q]: [&[f64]; 2]| {
        let squares = d.iter().zip(q).map(|(d, q)| d * d + q * q);
        root_mean(squares.map(|square| square / 2.0), PART)
    };
    (vector.clone().and_then(longest), vector.and_then(effective))
}

/// The two components of a vector.
fn vector<'a>(
    recording: &'a Checked<'_>,
    d: Signal,
    q: Signal,
    rows: &Range<usize>,
) -> Result<[&'a [f64]; 2], Absence> {
    Ok([&channel(recording, d)?[rows.clone()], &channel(recording, q)?[rows.clone()]])
}

/// The largest length of a vector.
fn longest([d, q]: [&[f64]; 2]) -> Result<f64, Absence> {
    let square = most_of([d, q], |[d, q]| d * d + q * q);
    if d.is_empty() { Err(Absence::NothingRecorded { part: PART }) } else { Ok(square.sqrt()) }
}

/// Σ share·period: the channel holds the share of the control ticks since the last row that were saturated.
fn saturation_time(recording: &Checked<'_>, share: Signal, rows: &Range<usize>) -> Result<f64, Absence> {
    let shares = &channel(recording, share)?[rows.clone()];
    if shares.is_empty() {
        return Err(Absence::NothingRecorded { part: PART });
    }
    Ok(shares.iter().sum::<f64>() * recording.rate.period())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::Build;
    use core::f64::consts::PI;

    fn measured() -> MetricSet {
        let recording = Build::new(10_000, 10_000)
            .channel(Signal::CurrentD, "A", |t| -3.0 * (2.0 * PI * 10.0 * t).cos())
            .channel(Signal::CurrentQ, "A", |t| 3.0 * (2.0 * PI * 10.0 * t).sin())
            .channel(Signal::VoltageD, "V", |_| 3.0)
            .channel(Signal::VoltageQ, "V", |t| if t < 0.5 { 4.0 } else { 0.0 })
            .channel(Signal::SaturationVoltage, "", |t| if t < 0.1 { 0.25 } else { 0.0 })
            .channel(Signal::EffortReference, "N m", |t| if t < 0.3 { -1.75 } else { 1.5 })
            .channel(Signal::EffortMotor, "N m", |t| -2.0 * (2.0 * PI * 3.0 * t).sin())
            .finish();
        let mut set = MetricSet::default();
        note(&mut set, &Checked::of(&recording), &(0..10_000));
        set
    }

    /// A current vector of constant length 3 A is 3 A peak and 3/√2 A effective; a torque sine likewise.
    #[test]
    fn peak_and_effective_values_are_told_apart() {
        let set = measured();
        for (name, value, unit) in [
            (Name::CurrentPeak, 3.0, "Apk"),
            (Name::CurrentRms, 3.0 / 2_f64.sqrt(), "Arms"),
            (Name::VoltagePeak, 5.0, "V"),
            (Name::TorqueRms, 2_f64.sqrt(), "N m"),
            (Name::TorqueReferencePeak, 1.75, "N m"),
        ] {
            let metric = set.get(name).unwrap();
            assert!((metric.value - value).abs() < 1e-12 && metric.unit == unit, "{name}: {metric:?}");
        }
        // 3333 samples per period: the crest is met to (π/3333)²/2.
        assert!((set.value(Name::TorquePeak).unwrap() - 2.0).abs() < 1e-6);
    }

    /// Oracle: by hand. A row holds the tick that ends there; no tick ends at the first.
    #[test]
    fn the_ripple_of_an_inverter_that_switches_is_in_peak_and_effective_value() {
        let recording = Build::new(10_000, 10_000)
            .channel(Signal::CurrentD, "A", |_| 0.0)
            .channel(Signal::CurrentQ, "A", |_| 3.0)
            .channel(Signal::CurrentPeak, "A", |t| if t > 0.0 { 3.5 + t } else { 0.0 })
            .channel(Signal::CurrentRms, "A", |t| if t > 0.0 { 2.25 } else { 0.0 })
            .finish();
        let mut set = MetricSet::default();
        note(&mut set, &Checked::of(&recording), &(0..10_000));
        assert_eq!(set.value(Name::CurrentRms), Some(2.25));
        assert!((set.value(Name::CurrentPeak).unwrap() - 4.4999).abs() < 1e-12);
        note(&mut set, &Checked::of(&recording), &(1_000..2_001));
        assert!((set.value(Name::CurrentPeak).unwrap() - 3.7).abs() < 1e-12);
    }

    /// A quarter of the control ticks of 0.1 s is 25 ms.
    #[test]
    fn saturation_counts_control_ticks() {
        let set = measured();
        assert!((set.value(Name::VoltageSaturationTime).unwrap() - 0.025).abs() < 1e-12);
        let why = set.absence(Name::CurrentSaturationTime).unwrap().to_string();
        assert_eq!(why, "`saturation.current` is not recorded; only a PMSM has a current");
    }
}
