//! Errors of planning a move.
use servobench_base::{ParamError, Stateful};
use thiserror::Error;

/// A refused request, with the remedy.
#[derive(Debug, Clone, Copy, PartialEq, Error, Stateful)]
pub enum PlanError {
    /// A distance, limit or time that is not a number of the right sign.
    #[error(transparent)]
    Parameter(#[from] ParamError),
    /// A value so large or small that the numbers of the plan would leave the range that `f64` represents well.
    #[error("`{name}` must be between {lowest:e} and {highest:e} (SI), got {value:e}: {remedy}")]
    OutOfRange {
        /// Field name.
        name: &'static str,
        /// Rejected value (SI).
        value: f64,
        /// Smallest accepted magnitude (SI).
        lowest: f64,
        /// Largest accepted magnitude (SI).
        highest: f64,
        /// The remedy, in words.
        remedy: &'static str,
    },
    /// A sampled move with more samples than an `f64` counts exactly.
    #[error(
        "the move takes about {samples:.1e} samples at `sample_time` = {sample_time:e} s, more than 2^53 cannot be \
         counted: take a longer sample time, a shorter distance or higher limits"
    )]
    TooManySamples {
        /// Number of samples of the continuous move.
        samples: f64,
        /// Requested sample time (s).
        sample_time: f64,
    },
    /// A requested duration below the shortest one within the limits.
    #[error("`duration` must be at least {shortest} s, got {duration} s: stretch to a longer time or raise the limits")]
    TooShort {
        /// Requested duration (s).
        duration: f64,
        /// Duration of the move at its limits (s).
        shortest: f64,
    },
    /// A point of a table that cannot be followed; the first one is point 0.
    #[error("point {point}: `{name}` must be {bound}, got {value}: {remedy}")]
    Point {
        /// Number of the point.
        point: usize,
        /// Field name.
        name: &'static str,
        /// Rejected value, in the unit of the field.
        value: f64,
        /// Bound on the value, in words.
        bound: &'static str,
        /// The remedy, in words.
        remedy: &'static str,
    },
    /// A table with fewer than two points.
    #[error("a table needs at least 2 points, got {points}: add the point where the move ends")]
    TooFewPoints {
        /// Number of points.
        points: usize,
    },
    /// A table that no share of plateaus follows within the limits.
    #[error(
        "no share of plateaus keeps `{quantity}` within {limit} (SI), the best one takes {peak:.6}: give the table more time, or \
         raise the limit"
    )]
    TableTooFast {
        /// Quantity beyond its limit.
        quantity: &'static str,
        /// Peak with the best share (SI).
        peak: f64,
        /// The limit (SI).
        limit: f64,
    },
    /// A caller's slice without room for a value per point.
    #[error("`{name}` must hold a value for each of {points} points, got room for {length}: pass a longer slice")]
    ShortSlice {
        /// Argument name.
        name: &'static str,
        /// Length of the slice.
        length: usize,
        /// Number of points.
        points: usize,
    },
    /// A sample of the slow task with a value that cannot be used.
    #[error(
        "sample {index}: `{name}` must be finite and at most {highest:e} in magnitude (SI), got {value:e}: correct it or \
         its unit"
    )]
    Sample {
        /// Number of the sample, from 0.
        index: u64,
        /// Field name.
        name: &'static str,
        /// Rejected value (SI).
        value: f64,
        /// Largest accepted magnitude (SI).
        highest: f64,
    },
    /// An interval requested before all its samples are there.
    #[error("the interpolation needs {needed} samples, got {received}: push the missing ones first")]
    Waiting {
        /// Number of samples so far.
        received: usize,
        /// Number of samples that the mode needs.
        needed: usize,
    },
    /// A filter with more impulses than its capacity.
    #[error(
        "the filter has {impulses} impulses, at most {capacity} are kept: take fewer shapers or shorter ones, or filter one \
         after the other"
    )]
    TooManyImpulses {
        /// Number of impulses.
        impulses: usize,
        /// Maximum number of impulses.
        capacity: usize,
    },
    /// A streaming filter that lasts longer than its memory.
    #[error(
        "the filter spans {samples:.9e} samples, its memory holds {capacity}: take a larger memory, a longer sample time \
         or a higher frequency"
    )]
    FilterTooLong {
        /// Number of samples that the filter spans, both ends included.
        samples: f64,
        /// Number of samples in memory.
        capacity: usize,
    },
    /// A damping ratio for which the equations of an extra-insensitive shaper have no usable solution.
    #[error(
        "no extra-insensitive shaper found for `damping_ratio` = {damping_ratio} and `tolerable` = {tolerable}: lower \
         either, or take a ZVD shaper"
    )]
    NoShaper {
        /// Damping ratio of the mode.
        damping_ratio: f64,
        /// Tolerable residual vibration at the modelled frequency.
        tolerable: f64,
    },
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Limits, Order, Profile};

    const LIMITS: Limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };

    fn message(plan: &Result<Profile, PlanError>) -> String {
        plan.as_ref().unwrap_err().to_string()
    }

    #[test]
    fn every_refusal_names_field_value_bound_and_way_out() {
        let slow = Limits { velocity: -1.0, ..LIMITS };
        assert_eq!(message(&Profile::plan(Order::Fourth, 1.0, &slow)), "`velocity` must be positive, got -1");
        let sharp = Limits { snap: 1e99, ..LIMITS };
        assert_eq!(
            message(&Profile::plan(Order::Fourth, 1.0, &sharp)),
            "`snap` must be between 1e-30 and 1e30 (SI), got 1e99: correct its unit or plan a lower order"
        );
        assert_eq!(
            message(&Profile::plan_sampled(Order::Third, 1.0, &LIMITS, 1e-20)),
            "the move takes about 1.3e20 samples at `sample_time` = 1e-20 s, more than 2^53 cannot be counted: \
             take a longer sample time, a shorter distance or higher limits"
        );
        let plan = Profile::plan(Order::Second, 1.0, &LIMITS).unwrap();
        assert_eq!(
            message(&plan.stretched_to(1.0)),
            "`duration` must be at least 1.2 s, got 1 s: stretch to a longer time or raise the limits"
        );
    }
}
