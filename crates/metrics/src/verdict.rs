//! Limits and the verdict on them.
use crate::absence::Absence;
use crate::name::Name;
use crate::quantity::Quantity;
use crate::requirement::{Expected, Requirement, RequirementResult, Standing};
use std::fmt;

/// Bounds of a metric (SI, inclusive).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// The metric.
    pub metric: Name,
    /// Smallest permitted value; for a metric whose sign is a direction ([`Name::is_signed`]), the smallest magnitude.
    pub min: Option<f64>,
    /// Largest permitted value, or magnitude.
    pub max: Option<f64>,
}

/// A limit that was missed.
#[derive(Debug, Clone, PartialEq)]
pub struct Miss {
    /// The limit.
    pub limit: Limit,
    /// Index of the move that missed it; `None` for the run as a whole.
    pub in_move: Option<usize>,
    /// Value (SI); `None` when the metric is absent.
    pub value: Option<f64>,
    /// Unit of the metric.
    pub unit: String,
    /// Reason why the metric is absent.
    pub absence: Option<Absence>,
}

/// Result of a run: missed limits, requirements, expected faults, warnings.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Verdict {
    /// The limits that were missed, in the order in which they were given.
    pub misses: Vec<Miss>,
    /// Status of each requirement, in the order of [`Requirement::ALL`]; empty if only limits were judged.
    pub requirements: Vec<(Requirement, RequirementResult)>,
    /// The faults that were expected, in the order of the file.
    pub expected: Vec<Expected>,
    /// Findings that break no requirement, in words.
    pub warnings: Vec<String>,
}

impl Limit {
    /// A largest allowed value.
    #[must_use]
    pub const fn at_most(metric: Name, max: f64) -> Self {
        Self { metric, min: None, max: Some(max) }
    }

    /// Combines both: the tighter bound on each side.
    #[must_use]
    pub(crate) fn and(&self, other: &Self) -> Self {
        let tighter = |one: Option<f64>, two: Option<f64>, pick: fn(f64, f64) -> f64| match (one, two) {
            (Some(one), Some(two)) => Some(pick(one, two)),
            (one, two) => one.or(two),
        };
        let (min, max) = (tighter(self.min, other.min, f64::max), tighter(self.max, other.max, f64::min));
        Self { metric: self.metric, min, max }
    }

    /// True if `value` is within the limit. A limit that is not a number is never kept.
    #[must_use]
    pub fn holds(&self, value: f64) -> bool {
        let size = if self.metric.is_signed() { value.abs() } else { value };
        self.min.is_none_or(|min| size >= min) && self.max.is_none_or(|max| size <= max)
    }
}

impl Verdict {
    /// This verdict and `other` in one.
    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        self.misses.extend(other.misses);
        self.requirements.extend(other.requirements);
        self.expected.extend(other.expected);
        self.warnings.extend(other.warnings);
        self
    }

    /// True if every limit is kept, every requirement met, and every expected fault has come.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.misses.is_empty()
            && self.expected.iter().all(|expected| expected.met.is_some())
            && !self.requirements.iter().any(|(_, result)| result.standing == Standing::Broken)
    }

    /// Reasons for a failure, in words: missed limits, broken requirements, expected faults that did not come.
    pub fn reasons(&self) -> impl Iterator<Item = String> {
        let misses = self.misses.iter().map(ToString::to_string);
        let broken = self.requirements.iter().filter(|(_, result)| result.standing == Standing::Broken);
        let broken = broken.flat_map(|(name, result)| result.reasons.iter().map(move |why| format!("{name}: {why}")));
        let missing = self.expected.iter().filter(|expected| expected.met.is_none());
        let missing = missing.map(|expected| format!("expected, but did not occur: {}", expected.expectation));
        misses.chain(broken).chain(missing)
    }
}

/// `settling_time 35.2 ms, limit 20.0 ms`, of a move `move 2: settling_time 35.2 ms, limit 20.0 ms`
impl fmt::Display for Miss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(index) = self.in_move {
            write!(f, "move {}: ", index + 1)?;
        }
        let name = self.limit.metric;
        match (self.value, &self.absence) {
            (Some(value), _) => {
                let bounds = [self.limit.min, self.limit.max].into_iter().flatten();
                let digits = bounds.map(|bound| Quantity::digits_apart(value.abs(), bound.abs())).max().unwrap_or(3);
                write!(f, "{name} {:.digits$}, limit ", Quantity::new(value, &self.unit))?;
                let bound = |bound| format!("{:.digits$}", Quantity::new(bound, &self.unit));
                match (self.limit.min, self.limit.max) {
                    (Some(min), Some(max)) => write!(f, "{} to {}", bound(min), bound(max)),
                    (Some(min), None) => write!(f, "at least {}", bound(min)),
                    (None, Some(max)) => write!(f, "{}", bound(max)),
                    (None, None) => f.write_str("none"),
                }
            }
            (None, Some(absence)) => write!(f, "{name} could not be measured: {absence}"),
            (None, None) => write!(f, "{name} is not measured here"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metric::{MetricSet, Metrics, MoveMetrics};
    use servobench_signals::Signal;

    fn measured() -> Metrics {
        let mut metrics = Metrics::default();
        metrics.run.note(Name::SettlingTime, "s", Ok(0.035));
        metrics.run.note(Name::FollowingErrorCruiseLoad, "m", Ok(-0.8e-3));
        metrics.run.note(Name::TorqueRms, "N", Err(Absence::NoChannel { channel: Signal::EffortMotor }));
        metrics
    }

    #[test]
    fn bounds_are_inclusive() {
        let limit = Limit { metric: Name::MoveTime, min: Some(1.0), max: Some(2.0) };
        for (value, within) in [(1.0, true), (2.0, true), (0.999, false), (2.001, false), (f64::NAN, false)] {
            assert_eq!(limit.holds(value), within, "{value}");
        }
    }

    #[test]
    fn a_limit_bounds_the_magnitude_of_a_signed_metric() {
        let mut metrics = measured();
        assert!(!metrics.judge(&[Limit::at_most(Name::FollowingErrorCruiseLoad, 0.5e-3)]).passed());
        assert!(metrics.judge(&[Limit::at_most(Name::FollowingErrorCruiseLoad, 0.9e-3)]).passed());
        for (min, max, within) in [(0.7e-3, 0.9e-3, true), (0.5e-3, 0.7e-3, false), (0.81e-3, 0.9e-3, false)] {
            let range = Limit { metric: Name::FollowingErrorCruiseLoad, min: Some(min), max: Some(max) };
            assert_eq!(metrics.judge(&[range]).passed(), within, "{min} m to {max} m");
        }
    }

    /// Two moves at 0.8 mm and −0.9 mm, each with a separate band.
    #[test]
    fn each_move_keeps_its_own_limits() {
        let made = |error| {
            let mut metrics = MetricSet::default();
            metrics.note(Name::FollowingErrorCruiseLoad, "m", Ok(error));
            MoveMetrics { label: "to and fro".into(), start: 0.0, end: 1.0, metrics }
        };
        let mut metrics = Metrics { run: MetricSet::default(), moves: vec![made(0.8e-3), made(-0.9e-3)] };
        let band = |min, max| Limit { metric: Name::FollowingErrorCruiseLoad, min: Some(min), max: Some(max) };
        let (first, second) = (band(0.79e-3, 0.81e-3), band(0.89e-3, 0.91e-3));
        assert!(metrics.judge_moves(&[vec![first], vec![second]]).passed());
        let verdict = metrics.judge_moves(&[vec![second], vec![second, Limit::at_most(Name::Overshoot, 1e-6)]]);
        let said: Vec<_> = verdict.misses.iter().map(Miss::to_string).collect();
        assert_eq!(
            said,
            [
                "move 1: following_error_cruise_load 800 µm, limit 890 µm to 910 µm",
                "move 2: overshoot is not measured here",
            ]
        );
        let passes = metrics.moves.iter().map(|made| made.metrics.get(Name::FollowingErrorCruiseLoad).unwrap().pass);
        assert_eq!(passes.collect::<Vec<_>>(), [Some(false), Some(true)]);
    }

    #[test]
    fn a_limit_on_an_absent_metric_is_missed_with_the_reason() {
        let limits = [
            Limit::at_most(Name::SettlingTime, 0.02),
            Limit::at_most(Name::TorqueRms, 10.0),
            Limit::at_most(Name::Overshoot, 10.0),
        ];
        let mut metrics = measured();
        let said: Vec<_> = metrics.judge(&limits).misses.iter().map(Miss::to_string).collect();
        assert_eq!(
            said,
            [
                "settling_time 35.0 ms, limit 20.0 ms",
                "torque_rms could not be measured: `effort.motor` is not recorded",
                "overshoot is not measured here",
            ]
        );
        assert_eq!(metrics.get(Name::SettlingTime).unwrap().pass, Some(false));
        assert_eq!(metrics.get(Name::SettlingTime).unwrap().limit, Some(limits[0]));
    }

    #[test]
    fn two_limits_on_a_metric_are_noted_as_the_tighter_one() {
        let mut metrics = measured();
        let limits = [0.05, 0.02].map(|max| Limit::at_most(Name::SettlingTime, max));
        assert_eq!(metrics.judge(&limits).misses.len(), 1);
        let metric = metrics.get(Name::SettlingTime).unwrap();
        assert_eq!((metric.limit, metric.pass), (Some(limits[1]), Some(false)));
    }

    #[test]
    fn a_value_that_overflows_is_absent() {
        let mut metrics = measured();
        metrics.run.note(Name::CurrentPeak, "Apk", Ok(f64::INFINITY));
        assert_eq!(metrics.get(Name::CurrentPeak), None);
        assert_eq!(metrics.run.absence(Name::CurrentPeak), Some(&Absence::Overflow));
    }

    #[test]
    fn without_limits_everything_passes_and_nothing_is_judged() {
        let mut metrics = measured();
        assert!(metrics.judge(&[]).passed());
        assert_eq!(metrics.get(Name::SettlingTime).unwrap().pass, None);
    }
}
