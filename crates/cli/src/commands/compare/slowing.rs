//! `--equal`: slows moves and describes the result.
use super::variants::Wanted;
use crate::args::EqualTerm;
use crate::console::say;
use crate::engines;
use crate::error::{CliError, FailedRun};
use crate::workers;
use servobench_metrics::{Name, Quantity};
use servobench_report::{elided, wrapped};
use servobench_results::printable;
use servobench_scenario::metric_value;
use servobench_suite::{
    AtATime, EqualError, EqualQuantity, Equalized, Job, Measuring, Workers, equal_metric, to_duration, to_equal,
    to_equal_duration,
};

/// The way in which moves were slowed.
pub(super) enum Slowing {
    /// Each to the longest of its counterparts.
    Duration,
    /// To a duration (s), with the factor on each run's move time.
    To(f64, Vec<f64>),
    /// Until a metric was equal.
    Metric(EqualQuantity, Equalized),
}

/// Number of runs between progress messages.
const SAID_AFTER: usize = 200;
/// Largest relative difference that is reported as equal.
const EQUAL: f64 = 2e-6;

/// The requested value (SI), read in its unit on this axis.
pub(super) fn target(term: &EqualTerm, jobs: &[&Job]) -> Result<Option<f64>, CliError> {
    let (Some(text), Some(job)) = (&term.value, jobs.first()) else { return Ok(None) };
    let name = match term.quantity {
        EqualQuantity::Duration => "duration",
        EqualQuantity::Torque => "torque",
        EqualQuantity::Current => "current",
        EqualQuantity::Vibration => "vibration",
    };
    let wrong = |error: String| CliError::EqualValue { quantity: name, error };
    let axis = &job.scenario.axis;
    let value = metric_value(equal_metric(term.quantity), axis.motion, axis.motor_motion, text);
    let value = value.map_err(|error| wrong(format!("{}: {}", error.text, error.message)))?;
    if value > 0.0 && value.is_finite() {
        Ok(Some(value))
    } else {
        Err(wrong(format!("{text}: it must be greater than 0; slower moves come near to nothing and not to it")))
    }
}

/// Slows moves by duration, where no run is needed to find the factor.
pub(super) fn without_runs(
    term: &EqualTerm,
    target: Option<f64>,
    jobs: &mut [Job],
) -> Result<Option<Slowing>, CliError> {
    match (term.quantity, target) {
        (EqualQuantity::Duration, None) => {
            to_equal_duration(jobs)?;
            Ok(Some(Slowing::Duration))
        }
        (EqualQuantity::Duration, Some(duration)) => Ok(Some(Slowing::To(duration, to_duration(jobs, duration)?))),
        _ => Ok(None),
    }
}

/// Slows the moves until a measured quantity is equal.
pub(super) fn by_runs(
    term: &EqualTerm,
    target: Option<f64>,
    jobs: &mut [Job],
    (workers, limit): (&Workers, AtATime),
) -> Result<Slowing, CliError> {
    let engines = engines::installed();
    let said = std::cell::Cell::new(0);
    let progress = |runs: usize| {
        if runs >= said.get() + SAID_AFTER {
            said.set(runs);
            say(&format!("{runs} runs until now to make the {} equal\n", term.quantity.in_words()));
        }
    };
    let measuring = Measuring { engines: &engines, workers, limit, progress: &progress };
    let equalized = to_equal(jobs, term.quantity, target, &measuring);
    workers::dismiss(workers);
    match equalized {
        Ok(equalized) => Ok(Slowing::Metric(term.quantity, equalized)),
        Err(EqualError::Compare(error)) => Err(CliError::Compare(error)),
        Err(EqualError::Run { job, error }) => {
            Err(CliError::Runs(jobs.get(job).map(|job| FailedRun::new(job, error)).into_iter().collect()))
        }
    }
}

impl Slowing {
    /// The measured metric in which runs are equal; `None` for a duration.
    pub(super) const fn metric(&self) -> Option<Name> {
        match self {
            Self::Metric(_, equalized) => Some(equalized.metric),
            Self::Duration | Self::To(..) => None,
        }
    }

    /// Terms of the comparison, in a few words.
    pub(super) fn terms(&self) -> String {
        match self {
            Self::Duration => "slowed to equal duration".into(),
            Self::To(duration, _) => format!("slowed to a duration of {}", Quantity::new(*duration, "s")),
            Self::Metric(quantity, _) => format!("slowed to equal {}", quantity.in_words()),
        }
    }

    /// Outcome for each run, in lines that fit `width`.
    pub(super) fn words(&self, wanted: &[Wanted], width: usize) -> String {
        match self {
            Self::Duration => String::new(),
            Self::To(_, factors) => {
                let factors = wanted.iter().zip(factors).map(|(one, factor)| (one.label.as_str(), lasting(*factor)));
                lines(factors)
            }
            Self::Metric(_, equalized) => {
                let Equalized { metric, unit, target, gentlest, runs, slowed } = equalized;
                let of = gentlest.and_then(|index| wanted.get(index));
                let of = of.map_or_else(|| "as asked for".to_owned(), |one| format!("that of {}", one.label));
                let value = format!("{:.5}", Quantity::new(*target, unit));
                let words = format!("{metric} {value}, {of}; found by {runs} runs:");
                let each = wanted.iter().zip(slowed).map(|(one, slowed)| {
                    let words = if slowed.value.is_nan() {
                        "left as it is: it breaks a requirement".to_owned()
                    } else {
                        format!("{}, {}", lasting(slowed.factor), reached(slowed.value, *target, unit))
                    };
                    (one.label.as_str(), words)
                });
                format!("\n{}{}", wrapped(&words, width).join("\n"), lines(each))
            }
        }
    }
}

/// Factor on move times, in words.
fn lasting(factor: f64) -> String {
    if factor > 1.0 { format!("moves last {factor:.6} × as long") } else { "at its own limits".into() }
}

/// Deviation of a value from the target, in words.
fn reached(value: f64, target: f64, unit: &str) -> String {
    let share = value / target - 1.0;
    if share.abs() <= EQUAL {
        "equal".to_owned()
    } else if share < 0.0 {
        format!("{} less: {:.5}", percent(share), Quantity::new(value, unit))
    } else {
        format!("{} more: {:.5}", percent(share), Quantity::new(value, unit))
    }
}

fn percent(share: f64) -> String {
    format!("{:.2} %", Quantity::new(100.0 * share.abs(), ""))
}

/// A line for each run.
fn lines<'a>(each: impl Iterator<Item = (&'a str, String)>) -> String {
    let all: Vec<(String, String)> = each.map(|(label, words)| (elided(&printable(label), 24), words)).collect();
    let width = all.iter().map(|(label, _)| label.chars().count()).max().unwrap_or(0);
    let lines: Vec<String> = all.iter().map(|(label, words)| format!("\n  {label:width$}  {words}")).collect();
    lines.concat()
}
