//! A sampled move as computed by the forward-Euler cascade.
use crate::polynomials::{Between, Polynomials};
use servobench_base::{ParamError, Setpoint};
use servobench_motion::sampled::{Cascade, Run};
use servobench_motion::{Order, PlanError};

/// Largest number of samples stored for a move.
pub(crate) const MOST_SAMPLES: f64 = 1e7;

/// The error for a sample time (s) with which a move has too many samples.
pub(crate) fn too_many(sample_time: f64) -> PlanError {
    let bound = "long enough for a move of at most 10 million samples";
    ParamError { name: "sample_time", value: sample_time, bound }.into()
}

/// A move in `samples` samples, `duration` (s), from 0 to `distance`.
pub(crate) struct Sampled {
    pub(crate) order: Order,
    pub(crate) distance: f64,
    pub(crate) sample_time: f64,
    pub(crate) samples: u64,
    pub(crate) duration: f64,
}

impl Sampled {
    /// Set-points of the cascade driven by `runs`, each held until the next.
    pub(crate) fn cascade(&self, runs: impl Iterator<Item = Run>) -> Result<Polynomials, PlanError> {
        let Self { order, distance, sample_time, samples, duration } = *self;
        if samples as f64 > MOST_SAMPLES {
            return Err(too_many(sample_time));
        }
        let mut cascade = Cascade::at_rest(order, 0.0, sample_time)?;
        let parts: Vec<_> = cascade.along(runs).enumerate().map(|(k, at)| (k as f64 * sample_time, at)).collect();
        Ok(Polynomials::new(parts, Between::Held, duration, Setpoint::at_rest(distance)))
    }
}
