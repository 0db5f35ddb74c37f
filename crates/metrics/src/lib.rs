//! Metrics with units, computed from a [`Recording`](servobench_trace::Recording), and the verdict on them.
//!
//! ```text
//! measure(&recording, &question) → Metrics      judge(&[limit]) → Verdict
//! ```
//! Every metric has a stable name ([`Name`]) and one definition (`docs/metrics.md`). A metric that cannot be measured is absent
//! with a reason ([`Absence`]); it is never zero, and a limit on it is missed.

mod absence;
mod basis;
mod compliance;
mod coupling;
mod display_unit;
mod effort;
mod extremes;
mod incident;
mod measure;
mod metric;
mod modal;
mod name;
mod power;
mod quantity;
mod requirement;
mod residual_ratios;
mod round;
mod rounding;
mod settling;
mod span;
#[cfg(test)]
mod synthetic;
mod tracking;
mod undamped;
mod verdict;
mod vibration;

pub use absence::Absence;
pub use coupling::COUPLING_ERROR_WARNED;
pub use display_unit::{DisplayUnit, DisplayUnits, digits};
pub use incident::{Incident, note_incidents};
pub use measure::{MEASURED_FROM, Question, measure, measure_only};
pub use metric::{Metric, MetricSet, Metrics, MoveMetrics};
pub use modal::{Mode, Signal, Vibration, fit_mode, vibration};
pub use name::{Name, Scope, UnknownMetric};
pub use quantity::Quantity;
pub use requirement::{
    Deflection, Disturbance, Driven, EarlyEnd, Expectation, Expected, JUDGED_BY, LinearLoop, Occasion, Oscillation,
    Poles, REQUEST_KIND, Readings, Requirement, RequirementResult, Rules, Servo, Standing, Tolerances, arrival_window,
    judge_requirements,
};
pub use residual_ratios::ResidualRatios;
pub use round::{round_above, round_below};
pub use undamped::undamped_residual;
pub use verdict::{Limit, Miss, Verdict};
