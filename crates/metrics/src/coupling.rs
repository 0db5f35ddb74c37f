//! Error of the coupling with FMUs, as its master estimates it.
use crate::absence::Absence;
use crate::metric::MetricSet;
use crate::name::Name;
use servobench_trace::{CouplingEstimate, Recording};

/// Smallest estimated error with a warning: 40 exchanges per period with inputs of order 1.
pub const COUPLING_ERROR_WARNED: f64 = 0.01;

/// Notes the estimate of the run.
pub(crate) fn note(set: &mut MetricSet, recording: &Recording) {
    let error = recording.coupling.as_ref().map(|estimate| estimate.error);
    set.note(Name::CouplingError, "", error.ok_or(Absence::NotCoupled));
}

/// The warning of a run whose coupling is too coarse.
pub(crate) fn warning(recording: &Recording) -> Option<String> {
    let CouplingEstimate { error, connection } = recording.coupling.as_ref()?;
    (*error > COUPLING_ERROR_WARNED).then(|| {
        let percent = 100.0 * error;
        format!(
            "coupling: the exchange `{connection}` is off by about {percent:.2} % of its signal; take a smaller `coupling.step`, or \
             another `method` or `extrapolation`"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::Build;

    fn recording(error: Option<f64>) -> Recording {
        let connection = "load.force -> disturbance.load".to_owned();
        let coupling = error.map(|error| CouplingEstimate { error, connection });
        Recording { coupling, ..Build::new(1000, 11).finish() }
    }

    #[test]
    fn the_estimate_is_a_metric_and_warns_beyond_one_per_cent() {
        let mut set = MetricSet::default();
        note(&mut set, &recording(Some(0.02)));
        assert_eq!(set.value(Name::CouplingError), Some(0.02));
        let said = warning(&recording(Some(0.02))).unwrap();
        assert!(said.contains("load.force -> disturbance.load") && said.contains("2.00 %"), "{said}");
        assert_eq!([Some(0.01), Some(0.0), None].map(|error| warning(&recording(error))), [None, None, None]);
    }

    #[test]
    fn nobody_misses_it_without_an_fmu() {
        let mut set = MetricSet::default();
        note(&mut set, &recording(None));
        assert!(set.absence(Name::CouplingError).unwrap().is_of_rare_equipment());
    }
}
