//! Peaks of a set-point relative to its limits. Analytic: from the plan, never by differencing samples.
use crate::absence::Absence;
use crate::metric::MetricSet;
use crate::name::Name;
use crate::span::Phase;

/// Relative excess over a limit that rounding may cause: the guarantee of the generators.
const ROUNDING: f64 = 1e-9;

const DERIVATIVES: [(Name, &str); 4] = [
    (Name::SetpointVelocityRatio, "velocity"),
    (Name::SetpointAccelerationRatio, "acceleration"),
    (Name::SetpointJerkRatio, "jerk"),
    (Name::SetpointSnapRatio, "snap"),
];

/// Notes peak over limit for each derivative, the largest over `phases`.
pub(crate) fn note(set: &mut MetricSet, phases: &[Phase<'_>]) {
    for (order, (name, derivative)) in DERIVATIVES.into_iter().enumerate() {
        set.note(name, "", ratio(phases, order, derivative));
    }
}

fn ratio(phases: &[Phase<'_>], order: usize, derivative: &'static str) -> Result<f64, Absence> {
    if phases.is_empty() {
        return Err(Absence::NoMove);
    }
    let mut largest = None;
    for made in phases.iter().map(|phase| phase.made) {
        let Some(limit) = made.limits[order].filter(|limit| limit.is_finite()) else { continue };
        let ratio = made.peaks[order].abs() / limit;
        let ratio = if (ratio - 1.0).abs() <= ROUNDING { 1.0 } else { ratio };
        if !ratio.is_finite() {
            return Err(Absence::Unbounded { derivative, label: made.label.clone() });
        }
        largest = Some(largest.map_or(ratio, |other: f64| other.max(ratio)));
    }
    largest.ok_or(Absence::NoLimit { derivative })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::span::phases;
    use crate::synthetic::{Build, planned};

    #[test]
    fn what_differs_from_its_limit_by_rounding_is_at_it() {
        let limits = [Some(3.0), Some(3.0), Some(3.0), Some(3.0)];
        let peaks = [3.0_f64.next_up(), 3.0 - 2e-9, 3.0 + 1e-8, 3.0 - 1e-8];
        let recording =
            Build::new(1000, 100).moves([planned(0.0, 0.01, 0.0, 1.0).bounded(peaks, limits).made()]).finish();
        let mut set = MetricSet::default();
        note(&mut set, &phases(&recording));
        let at_limit = [Name::SetpointVelocityRatio, Name::SetpointAccelerationRatio];
        assert!(at_limit.iter().all(|name| set.value(*name) == Some(1.0)));
        assert!(set.value(Name::SetpointJerkRatio) > Some(1.0) && set.value(Name::SetpointSnapRatio) < Some(1.0));
    }

    #[test]
    fn the_largest_ratio_of_the_moves_counts() {
        let limits = [Some(1.0), Some(5.0), Some(50.0), None];
        let recording = Build::new(1000, 100)
            .moves([
                planned(0.0, 0.01, 0.0, 1.0).bounded([0.5, 5.0, 40.0, f64::INFINITY], limits).made(),
                planned(0.05, 0.06, 1.0, 0.0).bounded([0.8, 4.0, 40.0, f64::INFINITY], limits).made(),
            ])
            .finish();
        let mut set = MetricSet::default();
        note(&mut set, &phases(&recording));
        for (name, ratio) in
            [(Name::SetpointVelocityRatio, 0.8), (Name::SetpointAccelerationRatio, 1.0), (Name::SetpointJerkRatio, 0.8)]
        {
            assert_eq!(set.value(name), Some(ratio), "{name}");
        }
        assert_eq!(set.absence(Name::SetpointSnapRatio), Some(&Absence::NoLimit { derivative: "snap" }));
    }

    #[test]
    fn a_limit_on_an_unbounded_derivative_is_no_number() {
        let recording = Build::new(1000, 100)
            .moves([planned(0.0, 0.01, 0.0, 1.0)
                .bounded([1.0, 5.0, f64::INFINITY, f64::INFINITY], [None, None, Some(50.0), Some(f64::INFINITY)])
                .made()])
            .finish();
        let mut set = MetricSet::default();
        note(&mut set, &phases(&recording));
        let why = set.absence(Name::SetpointJerkRatio).unwrap().to_string();
        assert_eq!(why, "the jerk of `move to 1 m` is not bounded");
        assert_eq!(set.absence(Name::SetpointSnapRatio), Some(&Absence::NoLimit { derivative: "snap" }));
    }
}
