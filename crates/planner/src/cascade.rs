//! A sampled move as the forward-Euler cascade makes it.
use crate::polynomials::{Between, Polynomials};
use servobench_base::{ParamError, Setpoint};
use servobench_motion::sampled::Cascade;
use servobench_motion::{PlanError, Profile, Samples};

/// Samples at most that are kept of a move.
pub(crate) const MOST_SAMPLES: f64 = 1e7;

/// The refusal of a sample time (s) with which a move takes more samples than are kept.
pub(crate) fn too_many(sample_time: f64) -> PlanError {
    let bound = "long enough for a move of at most 10 million samples";
    ParamError { name: "sample_time", value: sample_time, bound }.into()
}

/// The set-points of `profile`, each held until the next; the profile as it is where it is continuous.
pub(crate) fn cascade(profile: &Profile, samples: &Samples) -> Result<Polynomials, PlanError> {
    if samples.total() as f64 > MOST_SAMPLES {
        return Err(too_many(samples.time));
    }
    let mut cascade = Cascade::at_rest(profile.order(), 0.0, samples.time)?;
    let parts: Vec<_> =
        cascade.along(profile.runs()).enumerate().map(|(k, at)| (k as f64 * samples.time, at)).collect();
    Ok(Polynomials::new(parts, Between::Held, profile.duration(), Setpoint::at_rest(profile.distance())))
}
