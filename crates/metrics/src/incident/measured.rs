//! Incidents as metrics, so that a limit can bound them.
use super::{Incident, contact, states};
use crate::absence::Absence;
use crate::metric::MetricSet;
use crate::name::Name;
use crate::span::{Checked, channel, largest, unit};
use servobench_signals::Signal;

/// Notes the metrics of the incidents of the run.
pub(crate) fn note(set: &mut MetricSet, recording: &Checked<'_>) {
    let stops = channel(recording, Signal::EffortEndStop).and_then(|efforts| {
        channel(recording, Signal::LoadPosition)?;
        Ok(contact::largest(recording, efforts))
    });
    let speed_unit = format!("{}/s", recording.about.axis_unit);
    set.note(Name::EndStopForcePeak, unit(recording, Signal::EffortEndStop), stops.clone().map(|(effort, _)| effort));
    set.note(Name::EndStopSpeed, &speed_unit, stops.map(|(_, speed)| speed));
    let winding = channel(recording, Signal::TemperatureWinding)
        .and_then(|winding| largest(winding.iter().copied(), "of the temperature of the winding"));
    set.note(Name::WindingTemperaturePeak, unit(recording, Signal::TemperatureWinding), winding);
    let errors = states::buffer_errors(recording).ok_or(Absence::NoPoints);
    set.note(Name::BufferErrors, "", errors.map(|errors| errors as f64));
    let (source, name) = states::INTERNAL_LIMIT;
    let limited = recording
        .signal(source, name)
        .map(|_| states::recorded(recording, states::limited(recording)).map(|[start, end]| end - start).sum());
    set.note(Name::InternalLimitTime, "s", limited.ok_or(Absence::NoBus));
    let faults = recording.events.iter().filter(|event| Incident::of(event) == Some(Incident::BusFault));
    let counts = faults.filter_map(|event| event.incident.as_ref()?.count);
    let sum = counts.reduce(u64::saturating_add).ok_or(Absence::NoBusFault);
    set.note(Name::BusFaultCycles, "", sum.map(|sum| sum as f64));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::Build;
    use servobench_trace::Event;

    #[test]
    fn each_is_measured_where_the_axis_has_it() {
        let mut recording = Build::new(1000, 1001)
            .channel(Signal::LoadPosition, "m", |t| t)
            .channel(Signal::EffortEndStop, "N", |t| if t > 0.9 { -7.0 } else { 0.0 })
            .channel(Signal::TemperatureWinding, "°C", |t| 20.0 + t)
            .signal("drive", "mode", &[(0.0, "ip")])
            .signal("drive", "buffer", &[(0.0, "none"), (0.1, "Overflow")])
            .signal("drive", "internal_limit", &[(0.0, "FALSE"), (0.25, "TRUE"), (0.5, "FALSE"), (0.75, "TRUE")])
            .finish();
        let mut fault = Event::new(0.2, 0.3, "bus", "lost").incident(Incident::BusFault.name());
        fault.incident.as_mut().unwrap().count = Some(3);
        recording.events.push(fault);
        let mut set = MetricSet::default();
        note(&mut set, &Checked::of(&recording));
        for (name, value, unit) in [
            (Name::EndStopForcePeak, 7.0, "N"),
            (Name::EndStopSpeed, 1.0, "m/s"),
            (Name::WindingTemperaturePeak, 21.0, "°C"),
            (Name::BufferErrors, 1.0, ""),
            (Name::InternalLimitTime, 0.5, "s"),
            (Name::BusFaultCycles, 3.0, ""),
        ] {
            let metric = set.get(name).unwrap();
            // Of differences of positions up to 1 m over a millisecond: a few 1e-13.
            assert!((metric.value - value).abs() < 1e-12 && metric.unit == unit, "{name}: {metric:?}");
        }
    }

    /// An axis without such equipment gets no report that its metrics are absent.
    #[test]
    fn what_an_axis_cannot_have_is_rare() {
        let mut set = MetricSet::default();
        note(&mut set, &Checked::of(&Build::new(1000, 11).finish()));
        let absences: Vec<_> = set.absences().collect();
        assert_eq!(absences.len(), 6);
        assert!(absences.iter().all(|(_, why)| why.is_of_rare_equipment()), "{absences:?}");
    }
}
