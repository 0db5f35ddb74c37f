//! What stands between the planner and the drive.
use super::mistake::PlanMistake;
use super::quantity::{frequency, ratio, time};
use crate::args::choice;
use clap::Args;
use servobench_motion::shape::{Shaper, ShaperKind};
use servobench_planner::{Averages, Filter, Shaping};

/// Heading of what changes a move that is planned.
pub(super) const FILTER: &str = "Behind the planner";

/// Shaper and averages; whoever has them has `sample_time`.
#[derive(Debug, Args)]
#[command(next_help_heading = FILTER)]
pub(crate) struct FilterArgs {
    /// Input shaper for one vibration.
    #[arg(long, value_parser = choice::<ShaperKind>(), requires = "shaper_frequency")]
    shaper: Option<ShaperKind>,
    /// Natural frequency of the vibration, as "12 Hz".
    #[arg(long, value_name = "FREQUENCY", value_parser = frequency, requires = "shaper")]
    shaper_frequency: Option<f64>,
    /// Damping ratio of the vibration [default: 0].
    #[arg(long, value_name = "RATIO", value_parser = ratio, requires = "shaper")]
    shaper_damping: Option<f64>,
    /// Part of the vibration that an EI shaper may leave [default: 5 %].
    #[arg(long, value_name = "RATIO", value_parser = ratio, requires = "shaper")]
    shaper_tolerable: Option<f64>,
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
        Ok(Filter { shaper: self.shaping()?, averages })
    }

    fn shaping(&self) -> Result<Option<Shaping>, PlanMistake> {
        let Some((kind, frequency)) = self.shaper.zip(self.shaper_frequency) else { return Ok(None) };
        if self.shaper_tolerable.is_some() && !kind.has_tolerable() {
            return Err(PlanMistake::TolerableOfOthers);
        }
        let shaper = Shaper::new(kind, self.shaper_tolerable.unwrap_or(Shaper::TOLERABLE));
        let shaping = Shaping { shaper, frequency, damping: self.shaper_damping.unwrap_or(0.0) };
        shaping.impulses().map_err(PlanMistake::Shaper)?;
        Ok(Some(shaping))
    }
}
