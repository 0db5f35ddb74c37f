//! Moves that are slowed until a measured quantity is equal.
use super::duration::slowable;
use super::search::{LONGEST, Search, Steps};
use super::{CompareError, NotReached, slow};
use crate::error::RunError;
use crate::execute::execute;
use crate::job::Job;
use crate::pool::{AtATime, map_in_parallel};
use crate::worker::Workers;
use servobench::Engines;
use servobench::size::memory;
use servobench_metrics::{Metrics, Name, Quantity};
use thiserror::Error;

/// Quantity in which runs are made equal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EqualQuantity {
    /// Duration of the moves.
    Duration,
    /// The peak torque or force of the motor.
    Torque,
    /// The effective current.
    Current,
    /// The residual vibration of the load.
    Vibration,
}

impl EqualQuantity {
    /// Its name, in words.
    #[must_use]
    pub const fn in_words(self) -> &'static str {
        match self {
            Self::Duration => "duration",
            Self::Torque => "peak torque or force",
            Self::Current => "RMS current",
            Self::Vibration => "residual vibration",
        }
    }

    /// Example of an option that gives its value, for a metric in `unit`.
    fn example(self, unit: &str) -> &'static str {
        match (self, unit) {
            (Self::Duration, _) => "duration=1.2s",
            (Self::Torque, "N") => "torque=100N",
            (Self::Torque, _) => "torque=5Nm",
            (Self::Current, _) => "current=4Arms",
            (Self::Vibration, "rad") => "vibration=20urad",
            (Self::Vibration, _) => "vibration=20um",
        }
    }

    /// Metrics of the quantity; the first one that all runs have is used.
    const fn metrics(self) -> &'static [Name] {
        match self {
            Self::Duration => &[Name::MoveTime],
            Self::Torque => &[Name::TorquePeak],
            Self::Current => &[Name::CurrentRms],
            Self::Vibration => &[Name::ResidualVibrationAmplitude, Name::ResidualVibrationPp],
        }
    }
}

/// The metric whose limit has the unit in which a value of `quantity` is given.
#[must_use]
pub const fn equal_metric(quantity: EqualQuantity) -> Name {
    quantity.metrics()[0]
}

/// Reasons why runs cannot be made equal.
#[derive(Debug, Error)]
pub enum EqualError {
    /// They cannot be compared in this quantity.
    #[error(transparent)]
    Compare(Box<CompareError>),
    /// A run of the search was not carried out.
    #[error("{error}")]
    Run {
        /// Index of its job.
        job: usize,
        /// The reason.
        error: RunError,
    },
}

impl From<CompareError> for EqualError {
    fn from(error: CompareError) -> Self {
        Self::Compare(Box::new(error))
    }
}

/// Means of measuring runs during the search.
pub struct Measuring<'a> {
    /// The engines.
    pub engines: &'a Engines,
    /// The processes of isolated engines.
    pub workers: &'a Workers,
    /// Concurrent runs and memory; results do not depend on it.
    pub limit: AtATime,
    /// Called with the number of runs made so far.
    pub progress: &'a dyn Fn(usize),
}

/// Quantity and factors by which runs were made equal.
#[derive(Debug, Clone, PartialEq)]
pub struct Equalized {
    /// The metric.
    pub metric: Name,
    /// Its unit.
    pub unit: String,
    /// The value that all runs have at most (SI).
    pub target: f64,
    /// Index of the job whose value it is; `None` when the user gave it.
    pub gentlest: Option<usize>,
    /// Number of runs in the search for the factors.
    pub runs: usize,
    /// Slowdown of each job.
    pub slowed: Vec<Slowed>,
}

/// Slowdown of one job.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slowed {
    /// Factor of the duration of its moves; 1 when it was not slowed.
    pub factor: f64,
    /// Its value of the metric with that factor (SI); not a number for a run that broke a requirement at its own limits, which is not
    /// slowed.
    pub value: f64,
}

/// A step of torque and current, relative.
const STEP: f64 = 0.05;
/// A step of vibrations, in lobes of the spectrum of the longest moving average that a move may contain.
const OF_A_LOBE: f64 = 0.099;

/// Slows the moves of each job by a separate factor, so that its measured value is not above `target` (SI), or that of the gentlest job at
/// its own limits, and not below it by more than necessary. A slowed job loses its limits. A job that breaks a requirement at its own
/// limits is neither slowed nor the gentlest: an axis that never moves is gentle by not doing what was requested.
///
/// # Errors
/// [`CompareError::NoneSound`], [`CompareError::NotSlowable`], [`CompareError::NotMeasured`], [`CompareError::Nothing`], [`CompareError::NotReached`],
/// [`CompareError::Plan`]; [`EqualError::Run`] for a run that could not be carried out.
///
/// # Panics
/// Where one of its runs panics.
pub fn to_equal(
    jobs: &mut [Job],
    quantity: EqualQuantity,
    target: Option<f64>,
    measuring: &Measuring<'_>,
) -> Result<Equalized, EqualError> {
    let own = jobs.iter().map(slowable).collect::<Result<Vec<_>, _>>()?;
    let mut making = Making { jobs, own: &own, measuring, runs: 0, wanted: &[] };
    let with_mode = [quantity.metrics(), &[Name::ResidualVibrationFrequency]].concat();
    making.wanted = if quantity == EqualQuantity::Vibration { &with_mode } else { quantity.metrics() };
    let all = making.measured(&(0..making.jobs.len()).map(|job| (job, 1.0)).collect::<Vec<_>>())?;
    let sound: Vec<usize> = (0..all.len()).filter(|job| all[*job].is_sound).collect();
    if sound.is_empty() {
        return Err(CompareError::NoneSound { what: quantity.in_words() }.into());
    }
    let at_limits: Vec<&Metrics> = sound.iter().map(|job| &all[*job].metrics).collect();
    let metric = metric_of_all(quantity, &at_limits);
    let mut values = Vec::new();
    for (job, metrics) in sound.iter().zip(&at_limits) {
        let found = metrics.get(metric).ok_or_else(|| not_measured(&making.jobs[*job], quantity, metric, metrics))?;
        values.push((found.value.abs(), found.unit.clone()));
    }
    let unit = values.first().map(|(_, unit)| unit.clone()).unwrap_or_default();
    let least = sound.iter().zip(&values).min_by(|(_, one), (_, two)| one.0.total_cmp(&two.0));
    let (gentlest, target) = match (target, least) {
        (Some(target), _) => (None, target),
        (None, Some((job, (value, _)))) => (Some(*job), *value),
        (None, None) => (None, 0.0),
    };
    if target <= 0.0 {
        let scenario = gentlest.map_or_else(String::new, |index| making.jobs[index].label().to_owned());
        let (value, what) = (Quantity::new(target, &unit).to_string(), quantity.in_words());
        return Err(CompareError::Nothing { scenario, what, value, example: quantity.example(&unit) }.into());
    }
    let mut searches = Vec::new();
    for ((job, metrics), (value, _)) in sound.iter().zip(&at_limits).zip(&values) {
        let steps = if quantity == EqualQuantity::Vibration && *value > target {
            Steps::Difference(making.step(*job, metrics, quantity, metric)?)
        } else {
            Steps::Ratio(STEP)
        };
        searches.push(Search::new(target, *value, steps));
    }
    making.search(&mut searches, &sound, metric)?;
    let mut slowed = vec![Slowed { factor: 1.0, value: f64::NAN }; making.jobs.len()];
    for ((search, (value, _)), index) in searches.iter().zip(&values).zip(&sound) {
        let job = &making.jobs[*index];
        let text = |value| Quantity::new(value, &unit).to_string();
        let not_reached = || NotReached {
            scenario: job.label().to_owned(),
            what: quantity.in_words(),
            target: text(target),
            own: text(*value),
            factor: format!("{:.3}", search.reached().min(LONGEST)),
            least: text(search.least()),
            example: quantity.example(&unit),
        };
        let found = search.found().ok_or_else(|| CompareError::NotReached(Box::new(not_reached())))?;
        slowed[*index] = Slowed { factor: found.factor, value: found.value };
    }
    let runs = making.runs;
    for (slowed, (job, own)) in slowed.iter().zip(jobs.iter_mut().zip(&own)) {
        if slowed.factor > 1.0 {
            slow(job, times(own, slowed.factor));
        }
    }
    Ok(Equalized { metric, unit, target, gentlest, runs, slowed })
}

/// The first metric of `quantity` that all have; its last where none is.
fn metric_of_all(quantity: EqualQuantity, all: &[&Metrics]) -> Name {
    let metrics = quantity.metrics();
    let found = metrics.iter().find(|metric| all.iter().all(|metrics| metrics.get(**metric).is_some()));
    found.or(metrics.last()).copied().unwrap_or(Name::MoveTime)
}

fn not_measured(job: &Job, quantity: EqualQuantity, metric: Name, metrics: &Metrics) -> CompareError {
    let why = metrics.run.absence(metric).map_or_else(|| "the run has none".to_owned(), ToString::to_string);
    CompareError::NotMeasured {
        scenario: job.label().to_owned(),
        what: quantity.in_words(),
        metric: metric.as_str(),
        why,
        remedy: "",
    }
}

fn times(own: &[f64], factor: f64) -> Vec<f64> {
    own.iter().map(|duration| duration * factor).collect()
}

/// Metrics of a run, and whether it met its requirements.
struct Measured {
    metrics: Metrics,
    is_sound: bool,
}

/// Runs of the search.
struct Making<'a> {
    jobs: &'a [Job],
    /// Duration of each move of each job at its own limits (s).
    own: &'a [Vec<f64>],
    measuring: &'a Measuring<'a>,
    wanted: &'a [Name],
    /// Number of runs made.
    runs: usize,
}

impl Making<'_> {
    /// Measurements of these jobs with their moves slowed by these factors, in that order.
    fn measured(&mut self, wanted: &[(usize, f64)]) -> Result<Vec<Measured>, EqualError> {
        let jobs: Vec<Job> = wanted.iter().map(|(job, factor)| self.slower(*job, *factor)).collect();
        let Measuring { engines, workers, limit, progress } = self.measuring;
        let ended = map_in_parallel(
            &jobs,
            *limit,
            |job| ((), memory(&job.scenario)),
            |job, ()| {
                let run = execute(job, engines, workers, &mut |_| {}).map_err(|broken| broken.error)?;
                let requirements = &run.verdict.requirements;
                let is_sound = !requirements.iter().any(|(name, result)| result.is_not_met(name.as_str()));
                Ok(Measured { metrics: run.metrics, is_sound })
            },
        );
        self.runs += jobs.len();
        progress(self.runs);
        let ended = ended.into_iter().zip(wanted);
        ended
            .map(|(ended, (job, _))| {
                ended.map_err(RunError::from).flatten().map_err(|error| EqualError::Run { job: *job, error })
            })
            .collect()
    }

    fn slower(&self, job: usize, factor: f64) -> Job {
        let mut slower = self.jobs[job].clone();
        slower.leave_recording_out();
        slower.measure_only(self.wanted);
        if factor > 1.0 {
            slow(&mut slower, times(&self.own[job], factor));
        }
        slower
    }

    /// A step of the factor that is finer than a tenth of a lobe: a moving average that lasts as long as all moves together has zeros
    /// 1/(f·T) apart, and no part of a move is longer.
    fn step(
        &self,
        index: usize,
        metrics: &Metrics,
        quantity: EqualQuantity,
        metric: Name,
    ) -> Result<f64, CompareError> {
        let job = &self.jobs[index];
        let measured = metrics.get(Name::ResidualVibrationFrequency).map(|found| found.value);
        let highest = measured.into_iter().chain(job.scenario.measure.mode).fold(0.0, f64::max);
        if highest > 0.0 {
            return Ok(OF_A_LOBE / (highest * self.own[index].iter().sum::<f64>()));
        }
        let remedy = "; name the mode by measure.mode";
        match not_measured(job, quantity, metric, metrics) {
            CompareError::NotMeasured { scenario, what, .. } => Err(CompareError::NotMeasured {
                scenario,
                what,
                metric: Name::ResidualVibrationFrequency.as_str(),
                why: metrics
                    .run
                    .absence(Name::ResidualVibrationFrequency)
                    .map_or_else(|| "the run has none".to_owned(), ToString::to_string),
                remedy,
            }),
            other => Err(other),
        }
    }

    /// Continues all searches, each for the job at its place in `jobs`, until each has ended.
    fn search(&mut self, searches: &mut [Search], jobs: &[usize], metric: Name) -> Result<(), EqualError> {
        loop {
            let wanted: Vec<Vec<f64>> = searches.iter().map(Search::wanted).collect();
            let is_open = |search: &Search, factors: &Vec<f64>| search.found().is_none() && !factors.is_empty();
            if !searches.iter().zip(&wanted).any(|(search, factors)| is_open(search, factors)) {
                return Ok(());
            }
            let each = jobs.iter().zip(&wanted);
            let each = each.flat_map(|(job, factors)| factors.iter().map(|factor| (*job, *factor)));
            let mut measured = self.measured(&each.collect::<Vec<_>>())?.into_iter();
            for (search, factors) in searches.iter_mut().zip(&wanted) {
                let values = measured.by_ref().take(factors.len());
                let values: Vec<_> = values.map(|run| run.metrics.get(metric).map(|found| found.value)).collect();
                search.learn(factors, &values);
            }
        }
    }
}
