//! Filters between the planner and the drive.
use super::mistake::PlanMistake;
use super::quantity::{frequency, ratio, time};
use crate::args::choice;
use clap::Args;
use servobench_motion::shape::{Shaper, ShaperKind};
use servobench_planner::{Averages, Filter, Shaping};

/// Heading of options that change a planned move.
pub(super) const FILTER: &str = "Behind the planner";

/// Shapers and averages; whoever has them has `sample_time`.
#[derive(Debug, Args)]
#[command(next_help_heading = FILTER)]
pub(crate) struct FilterArgs {
    /// Input shaper for one vibration, or one for each of several, as "zvd,ei".
    #[arg(long, value_delimiter = ',', value_parser = choice::<ShaperKind>(), requires = "shaper_frequency")]
    shaper: Vec<ShaperKind>,
    /// Natural frequency of the vibration, as "12 Hz", or of each, as "12 Hz,31 Hz".
    #[arg(long, value_name = "FREQUENCY", value_delimiter = ',', value_parser = frequency, requires = "shaper")]
    shaper_frequency: Vec<f64>,
    /// Damping ratio of the vibrations, or of each [default: 0].
    #[arg(long, value_name = "RATIO", value_delimiter = ',', value_parser = ratio, requires = "shaper")]
    shaper_damping: Vec<f64>,
    /// Part of the vibration that EI shapers may leave, or each of them [default: 5 %].
    #[arg(long, value_name = "RATIO", value_delimiter = ',', value_parser = ratio, requires = "shaper")]
    shaper_tolerable: Vec<f64>,
    /// Moving averages one after the other, as "10 ms,5 ms"; they need --sample-time.
    #[arg(long, value_name = "TIMES", value_delimiter = ',', value_parser = time, requires = "sample_time")]
    averages: Option<Vec<f64>>,
}

/// The same with samples that nothing else has.
#[derive(Debug, Args)]
#[command(next_help_heading = FILTER)]
pub(crate) struct SampledFilterArgs {
    #[command(flatten)]
    filter: FilterArgs,
    /// Sample time of the averages, as "1 ms".
    #[arg(long, value_name = "TIME", value_parser = time, requires = "averages")]
    sample_time: Option<f64>,
}

impl SampledFilterArgs {
    /// The filters.
    pub(super) fn filter(&self) -> Result<Filter, PlanMistake> {
        self.filter.filter(self.sample_time)
    }
}

impl FilterArgs {
    pub(super) const fn has_averages(&self) -> bool {
        self.averages.is_some()
    }

    /// The filters, averages of samples of `sample_time` (s).
    pub(super) fn filter(&self, sample_time: Option<f64>) -> Result<Filter, PlanMistake> {
        let averages = self.averages.clone().zip(sample_time);
        let averages = averages.map(|(lengths, sample_time)| Averages { lengths, sample_time });
        let filter = Filter { shapers: self.shapers()?, averages };
        filter.impulses().map_err(PlanMistake::Shaper)?;
        Ok(filter)
    }

    fn shapers(&self) -> Result<Vec<Shaping>, PlanMistake> {
        let (count, frequencies) = (self.shaper.len(), self.shaper_frequency.len());
        if frequencies != count {
            return Err(PlanMistake::Frequencies { frequencies, shapers: count });
        }
        let with_tolerable = self.shaper.iter().filter(|kind| kind.has_tolerable()).count();
        if with_tolerable == 0 && !self.shaper_tolerable.is_empty() {
            return Err(PlanMistake::TolerableOfOthers);
        }
        let dampings = for_each("shaper-damping", &self.shaper_damping, count, "shapers")?;
        let mut tolerables =
            for_each("shaper-tolerable", &self.shaper_tolerable, with_tolerable, "EI shapers")?.into_iter().flatten();
        let modes = self.shaper_frequency.iter().zip(dampings);
        let shaping = |(kind, (frequency, damping)): (&ShaperKind, (&f64, Option<f64>))| {
            let tolerable = if kind.has_tolerable() { tolerables.next() } else { None };
            let shaper = Shaper::new(*kind, tolerable.unwrap_or(Shaper::TOLERABLE));
            Shaping { shaper, frequency: *frequency, damping: damping.unwrap_or(0.0) }
        };
        Ok(self.shaper.iter().zip(modes).map(shaping).collect())
    }
}

/// One value for each of `count` shapers, named `what` in messages: none, the same one, or separate ones.
fn for_each(
    option: &'static str,
    values: &[f64],
    count: usize,
    what: &'static str,
) -> Result<Vec<Option<f64>>, PlanMistake> {
    match values {
        [] => Ok(vec![None; count]),
        [one] => Ok(vec![Some(*one); count]),
        each if each.len() == count => Ok(each.iter().copied().map(Some).collect()),
        others => Err(PlanMistake::OtherCount { option, values: others.len(), count, what }),
    }
}
