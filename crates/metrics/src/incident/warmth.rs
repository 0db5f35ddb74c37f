//! A winding that is hotter than its insulation bears.
use super::Incident;
use super::spell::spells;
use crate::requirement::Rules;
use servobench_signals::Signal;
use servobench_trace::{Event, Recording};

/// Time (s) for which a winding may be below its limit within one spell: a temperature that the ripple of the current moves across
/// the limit is one incident. Thermal time constants of windings are tens of seconds.
const COOLER: f64 = 1.0;

pub(super) fn incidents(recording: &Recording, rules: &Rules<'_>) -> Vec<Event> {
    let Some((limit, winding)) = rules.winding_limit.zip(recording.channel(Signal::TemperatureWinding)) else {
        return Vec::new();
    };
    let spells = spells(winding, recording.index_at(COOLER), |temperature| temperature > limit);
    let event = |rows: std::ops::Range<usize>| {
        let most = winding[rows.clone()].iter().copied().fold(limit, f64::max);
        let message = format!("the winding is hotter than {limit} °C: {most:.0} °C at most");
        let (start, end) = (recording.time_of(rows.start), recording.time_of(rows.end - 1));
        Event::new(start, end, "motor", message).incident(Incident::WindingTemperature.name())
    };
    spells.into_iter().map(event).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirement::tests::rules;
    use crate::synthetic::Build;

    /// Oracle: by hand. 100 °C and 20 K/s are 155 °C after 2.75 s, and 300 °C at the end.
    #[test]
    fn a_winding_above_its_limit_is_an_incident_from_there_on() {
        let recording =
            Build::new(1000, 10_001).channel(Signal::TemperatureWinding, "°C", |t| 100.0 + 20.0 * t).finish();
        let found = incidents(&recording, &Rules { winding_limit: Some(155.0), ..rules() });
        let [event] = &found[..] else { panic!("{found:?}") };
        assert!((event.start - 2.751).abs() < 1e-9 && (event.end - 10.0).abs() < 1e-9, "{event:?}");
        assert_eq!(event.message, "the winding is hotter than 155 °C: 300 °C at most");
        for winding_limit in [None, Some(300.0)] {
            assert_eq!(incidents(&recording, &Rules { winding_limit, ..rules() }), []);
        }
    }

    #[test]
    fn a_ripple_across_the_limit_is_one_incident() {
        let recording = Build::new(1000, 5001)
            .channel(Signal::TemperatureWinding, "°C", |t| if (t * 10.0).rem_euclid(2.0) < 1.0 { 154.9 } else { 155.1 })
            .finish();
        assert_eq!(incidents(&recording, &Rules { winding_limit: Some(155.0), ..rules() }).len(), 1);
    }
}
