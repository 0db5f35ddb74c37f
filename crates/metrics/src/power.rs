//! Power and energy of the motor.
//!
//! A row holds mean powers over the tick that ends at it, so the sum over rows times their period is the energy.
use crate::absence::Absence;
use crate::metric::MetricSet;
use crate::name::Name;
use crate::span::{Checked, channel, largest_magnitude};
use servobench_signals::Signal;
use std::ops::Range;

const PART: &str = "of the motor's power";

/// Notes power and energy over `rows`.
pub(crate) fn note(set: &mut MetricSet, recording: &Checked<'_>, rows: &Range<usize>) {
    for (name, power) in
        [(Name::ElectricalPowerPeak, Signal::PowerElectrical), (Name::ShaftPowerPeak, Signal::PowerShaft)]
    {
        let peak = channel(recording, power).and_then(|all| largest_magnitude(&all[rows.clone()], PART));
        set.note(name, "W", peak);
    }
    for (name, power) in [
        (Name::ElectricalEnergy, Signal::PowerElectrical),
        (Name::CopperLoss, Signal::PowerCopper),
        (Name::InverterLoss, Signal::PowerInverter),
        (Name::BrakeEnergy, Signal::PowerBrake),
    ] {
        set.note(name, "J", energy(recording, power, rows));
    }
    for (name, of) in [(Name::DcLinkMin, f64::min as fn(f64, f64) -> f64), (Name::DcLinkMax, f64::max)] {
        let found = channel(recording, Signal::VoltageDcLink).and_then(|link| {
            let voltages = link[rows.clone()].iter().copied();
            voltages.reduce(of).ok_or(Absence::NothingRecorded { part: "of the DC link's voltage" })
        });
        set.note(name, "V", found);
    }
}

fn energy(recording: &Checked<'_>, power: Signal, rows: &Range<usize>) -> Result<f64, Absence> {
    let powers = &channel(recording, power)?[rows.clone()];
    if powers.is_empty() {
        return Err(Absence::NothingRecorded { part: PART });
    }
    Ok(powers.iter().sum::<f64>() * recording.rate.period())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::Build;

    /// Oracle: by hand. 80 W for 0.25 s, then 30 W back for 0.75 s.
    #[test]
    fn energy_is_what_is_taken_less_what_is_given_back_and_a_peak_has_no_sign() {
        let power = |t: f64| if t < 0.25 - 1e-9 { 20.0_f64 } else { -30.0 };
        let recording = Build::new(12_000, 12_000)
            .channel(Signal::PowerElectrical, "W", move |t| 4.0 * power(t).max(-7.5))
            .channel(Signal::PowerCopper, "W", |_| 3.0)
            .channel(Signal::PowerShaft, "W", power)
            .finish();
        let mut set = MetricSet::default();
        note(&mut set, &Checked::of(&recording), &(0..12_000));
        for (name, value, unit) in [
            (Name::ElectricalEnergy, 80.0 * 0.25 - 30.0 * 0.75, "J"),
            (Name::CopperLoss, 3.0, "J"),
            (Name::ElectricalPowerPeak, 80.0, "W"),
            (Name::ShaftPowerPeak, 30.0, "W"),
        ] {
            let metric = set.get(name).unwrap();
            // The sum of 12 000 numbers.
            assert!((metric.value - value).abs() < 1e-10 && metric.unit == unit, "{name}: {metric:?}");
        }
        note(&mut set, &Checked::of(&recording), &(0..3_000));
        assert!((set.value(Name::ElectricalEnergy).unwrap() - 20.0).abs() < 1e-10);
    }

    /// Oracle: by hand. An axis without them reports why it has no such metrics.
    #[test]
    fn inverter_and_link_are_measured_where_they_are_recorded() {
        let recording = Build::new(1_000, 1_000)
            .channel(Signal::PowerInverter, "W", |_| 4.0)
            .channel(Signal::PowerBrake, "W", |t| if t < 0.25 - 1e-9 { 600.0 } else { 0.0 })
            .channel(Signal::VoltageDcLink, "V", |t| 320.0 + 60.0 * (1.0 - 2.0 * t))
            .finish();
        let mut set = MetricSet::default();
        note(&mut set, &Checked::of(&recording), &(0..1_000));
        for (name, value, unit) in [
            (Name::InverterLoss, 4.0, "J"),
            (Name::BrakeEnergy, 150.0, "J"),
            (Name::DcLinkMin, 260.0 + 0.12, "V"),
            (Name::DcLinkMax, 380.0, "V"),
        ] {
            let metric = set.get(name).unwrap();
            // The sum of a thousand numbers.
            assert!((metric.value - value).abs() < 1e-9 && metric.unit == unit, "{name}: {metric:?}");
        }
        let without = Build::new(1_000, 10).channel(Signal::PowerShaft, "W", |_| 1.0).finish();
        let mut set = MetricSet::default();
        note(&mut set, &Checked::of(&without), &(0..10));
        for (name, key) in [
            (Name::InverterLoss, "not ideal"),
            (Name::BrakeEnergy, "a capacitor"),
            (Name::DcLinkMin, "a capacitor"),
            (Name::DcLinkMax, "a capacitor"),
        ] {
            let why = set.absence(name).unwrap();
            assert!(set.get(name).is_none() && why.to_string().contains(key), "{name}: {why}");
            assert!(why.is_of_rare_equipment(), "{name}");
        }
    }

    #[test]
    fn an_axis_without_currents_has_no_electrical_power() {
        let recording = Build::new(1_000, 10).channel(Signal::PowerShaft, "W", |_| 1.0).finish();
        let mut set = MetricSet::default();
        note(&mut set, &Checked::of(&recording), &(0..10));
        let why = set.absence(Name::ElectricalEnergy).unwrap();
        assert!(!why.is_of_rare_equipment());
        assert_eq!(why.to_string(), "`power.electrical` is not recorded; only a PMSM has electrical power");
    }
}
