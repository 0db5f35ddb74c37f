//! `measure.home_at`: the place at which homing puts the zero of the task.
//!
//! The axis counts from the switch that homing found, so that a misplaced switch moves all targets with it and no error shows it. The
//! position in the engine less that counted by the task is the place of the task's zero in the machine; it is read while the axis stands
//! before its first motion after homing: the positions on a bus are late, so that they are wrong during motion.
use super::arrival::RESOLUTIONS;
use super::task::Task;
use servobench_base::RequestKind;
use servobench_signals::Signal;

/// Reason why the zero is not at the place that the scenario gives; `None` if it is, if none is given, or if the axis is never homed.
pub(super) fn misplaced(task: &Task<'_>) -> Option<String> {
    let (recording, rules) = (task.recording, task.rules);
    let home_at = rules.home_at?;
    let counted = recording.channel(Signal::BusPosition)?;
    let load = recording.channel(Signal::LoadPosition)?;
    let homed = recording.signal("axis", "homed")?.changes.iter().rfind(|(_, value)| value == "TRUE")?;
    let row = recording.index_at(homed.0).min(load.len().checked_sub(1)?);
    let mut motions =
        task.phases.iter().filter(|phase| phase.kind != RequestKind::Rest && phase.kind != RequestKind::Stand);
    let first = motions.find(|phase| phase.rows.start > row).map_or(load.len(), |phase| phase.rows.start);
    let zero = load[first - 1] - counted[first - 1];
    let bound = rules.window.unwrap_or_default().max(RESOLUTIONS * rules.resolution());
    let off = (zero - home_at).abs();
    (off.is_nan() || off > bound).then(|| {
        format!(
            "after homing the position counts from {} of the machine, not from {} as the scenario requires (window ±{}): correct the home switch, or give MC_Home the `position` at which it is",
            task.length(zero),
            task.length(home_at),
            task.length(bound)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirement::Rules;
    use crate::requirement::tests::rules;
    use crate::synthetic::Build;
    use servobench_trace::Recording;

    /// Homed at 0.2 s, where the load stands at `zero` and counts 0; from 0.4 s on it moves at 1 m/s, and the bus is 2 ms late.
    fn homed(zero: f64, end: &str) -> Recording {
        let way = |t: f64| (t - 0.4).max(0.0);
        Build::new(1000, 800)
            .channel(Signal::LoadPosition, "m", move |t| zero + way(t))
            .channel(Signal::BusPosition, "m", move |t| if t < 0.2 { 7.0 } else { way(t - 2e-3) })
            .requests(&[(0.0, "nothing"), (0.2, "stand"), (0.4, "follow")])
            .signal("axis", "homed", &[(0.0, "FALSE"), (0.2, end)])
            .finish()
    }

    fn found(recording: &Recording, rules: &Rules<'_>) -> Option<String> {
        misplaced(&Task::of(recording, rules, &[]))
    }

    #[test]
    fn a_zero_elsewhere_says_where_both_are_and_what_to_do() {
        let rules = Rules { home_at: Some(0.012), window: Some(2e-5), ..rules() };
        assert_eq!(
            found(&homed(0.013, "TRUE"), &rules).unwrap(),
            "after homing the position counts from 13.0 mm of the machine, not from 12.0 mm as the scenario requires (window ±20.0 µm): correct the home switch, or give MC_Home the `position` at which it is"
        );
        assert_eq!(found(&homed(f64::NAN, "TRUE"), &rules).map(|_| ()), Some(()));
        assert_eq!(found(&homed(0.013, "FALSE"), &rules), None, "`executed` says that homing did not end");
        assert_eq!(found(&homed(0.013, "TRUE"), &Rules { home_at: None, ..rules }), None);
    }

    #[test]
    fn the_window_is_at_least_ten_resolutions() {
        for (window, increment, bus_unit, bound) in
            [(Some(1e-4), 0.0, 0.0, 1e-4), (None, 3e-5, 0.0, 3e-4), (Some(1e-4), 0.0, 2e-5, 2e-4)]
        {
            let rules = Rules { home_at: Some(0.1), window, increment, bus_unit, ..rules() };
            for side in [1.0, -1.0] {
                let is_found = |part: f64| found(&homed(0.1 + side * part * bound, "TRUE"), &rules).is_some();
                assert!(!is_found(0.99) && is_found(1.01), "{window:?} {increment} {bus_unit}");
            }
        }
    }
}
