//! Limit of the wall-clock time of a run.
//!
//! A run without a given limit ends eventually all the same: after [`LEAST`] and [`TIMES`] the duration of its ticks by the table of the
//! engines. A valid run takes that long on no machine; one that would take a week by a slip in a length or in a model does not hold up a
//! suite for a week.
use crate::error::RunError;
use crate::job::Job;
use servobench_scenario::{AxisMechanics, TimeBound};
use servobench_sim::Bench;
use std::time::Duration;

/// Allowance of every run: reading a model, machines under other load.
const LEAST: Duration = Duration::from_mins(10);
/// The table of the engines is right within a factor of three; a user's own model may be thirty times as large as those of the table.
const TIMES: f64 = 100.0;
/// Duration of a tick with FMUs, whose cost is unknown (s).
const TICK_WITH_FMUS: f64 = 10e-3;

/// Limit of the wall-clock time of a run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TimeLimit<'a> {
    pub(crate) time: Duration,
    /// True where no limit was given.
    is_default: bool,
    job: &'a Job,
}

impl<'a> TimeLimit<'a> {
    /// The smaller of the limit of the scenario of `job` and `given`; a default without either.
    pub(crate) fn of(job: &'a Job, given: Option<TimeBound>) -> Option<Self> {
        let bounds = || job.scenario.time_limit.into_iter().chain(given);
        let least = bounds().filter_map(TimeBound::seconds).reduce(f64::min);
        let limit = |seconds| Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
        match least {
            Some(least) => Some(Self { time: limit(least), is_default: false, job }),
            None if bounds().next().is_some() => None,
            None => Some(Self { time: LEAST + limit(TIMES * estimate(job)), is_default: true, job }),
        }
    }

    /// Length of the whole run (s); not a number when it cannot be planned.
    pub(crate) fn length(self) -> f64 {
        Bench::length(&self.job.scenario).unwrap_or(f64::NAN)
    }

    /// Error of a run that came to `reached` (s).
    pub(crate) fn exceeded(self, reached: f64) -> RunError {
        let which = if self.is_default { "default limit" } else { "limit" };
        RunError::TimeLimit { which, limit: self.time, reached, length: self.length() }
    }
}

/// Approximate duration of the ticks of `job` (s); 0 when it cannot be planned, and does not run.
fn estimate(job: &Job) -> f64 {
    let scenario = &job.scenario;
    let ticks = Bench::length(scenario).map_or(0.0, |length| length * f64::from(scenario.base_rate.hertz()));
    let known = job.engine.capabilities().tick_time.filter(|_| scenario.fmus.is_empty());
    let tick = known.map_or(TICK_WITH_FMUS, |[of_bodies, of_file]| {
        let own_file = matches!(scenario.axis.mechanics, AxisMechanics::Mjcf(_));
        1e-9 * if own_file { of_file } else { of_bodies }
    });
    ticks * tick
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::{Source, jobs};

    /// The demo, with this bound in the file and one from the caller.
    fn limit(own: Option<TimeBound>, given: Option<TimeBound>) -> Option<Duration> {
        let (_, text) = servobench_scenario::embedded_demo().into_iter().next().unwrap();
        let mut scenario = servobench_scenario::parse("demo", text, None).unwrap_or_else(|e| panic!("{e}")).scenario;
        scenario.time_limit = own;
        let job = jobs(vec![Source { scenario, text: text.to_owned() }], &[]).remove(0);
        TimeLimit::of(&job, given).map(|limit| limit.time)
    }

    #[test]
    fn the_smaller_limit_counts_and_none_lifts_the_default_alone() {
        use TimeBound::{AtMost, Unlimited};
        let minutes = |minutes: u64| Some(Duration::from_mins(minutes));
        assert_eq!(limit(Some(AtMost(60.0)), Some(AtMost(120.0))), minutes(1));
        assert_eq!(limit(Some(AtMost(7200.0)), Some(AtMost(120.0))), minutes(2));
        assert_eq!(limit(Some(AtMost(7200.0)), None), minutes(120), "more than the default");
        assert_eq!(limit(Some(Unlimited), Some(AtMost(120.0))), minutes(2), "a scenario cannot lift what is given");
        assert_eq!(limit(Some(AtMost(60.0)), Some(Unlimited)), minutes(1));
        for (own, given) in [(Some(Unlimited), None), (None, Some(Unlimited))] {
            assert_eq!(limit(own, given), None);
        }
        let default = limit(None, None).unwrap();
        assert!(default > LEAST && default < LEAST * 2, "{default:?}");
    }
}
