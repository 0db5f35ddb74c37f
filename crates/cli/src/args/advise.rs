//! Arguments of `advise`.
use super::shapers::{self, Shapers};
use super::{FmuTrustArgs, MemoryArgs, OverrideArgs, engine, file, time};
use clap::Args;
use servobench_plant::EngineName;
use servobench_scenario::KeyRange;
use std::path::PathBuf;
use std::time::Duration;

#[derive(Debug, Args)]
pub(crate) struct AdviseArgs {
    /// The scenario. Its limits are kept; its velocity and acceleration are the largest of the set-point.
    pub(crate) scenario: PathBuf,
    #[command(flatten)]
    pub(crate) with: OverrideArgs,
    /// What a machine may be, as in "axis.load.frequency=16 Hz..19 Hz" or "axis.load.mass=12 kg±10 %"; may be given several times
    /// [default: the frequency of the load on its spring ±10 %, its damping from half to twice].
    #[arg(long, value_name = "KEY=RANGE")]
    pub(crate) within: Vec<KeyRange>,
    /// Orders of the profile to choose from [default: 2,3,4].
    #[arg(long, value_name = "N", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(2..=4))]
    pub(crate) order: Vec<u32>,
    /// Input shapers to choose from, behind orders 2 and 3 [default: none and every kind].
    #[arg(long, value_name = "KIND", value_delimiter = ',', value_parser = shapers::parser())]
    pub(crate) shaper: Vec<Shapers>,
    /// Another key to choose, and its values, as in "drive.position.bandwidth=20 Hz,30 Hz"; may be given several times.
    #[arg(long, value_name = "KEY=VALUES")]
    pub(crate) choose: Vec<String>,
    /// Jerk and snap of the scenario are the largest of the set-point, too.
    #[arg(long)]
    pub(crate) keep_jerk_and_snap: bool,
    /// Share of the machines that is promised to keep all limits.
    #[arg(long, value_name = "SHARE", value_parser = share, default_value = "99 %")]
    pub(crate) share: f64,
    /// Machines that are drawn to verify it.
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) draws: u32,
    /// Seed of the draws.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    /// Engine to use instead of the scenario's first.
    #[arg(long, value_name = "NAME", value_parser = engine())]
    pub(crate) engine: Option<EngineName>,
    /// Write the advice for programs (JSON) to this file, too.
    #[arg(long, short, value_name = "FILE", value_parser = file())]
    pub(crate) output: Option<PathBuf>,
    /// Runs to make at once [default: one for each core].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) jobs: Option<u16>,
    /// End the process of an isolated engine that makes no progress for this long.
    #[arg(long, value_name = "TIME", value_parser = time, default_value = "5 min")]
    pub(crate) worker_timeout: Duration,
    #[command(flatten)]
    pub(crate) memory: MemoryArgs,
    #[command(flatten)]
    pub(crate) fmus: FmuTrustArgs,
}

/// A share of all, as "99 %" or "0.99".
fn share(text: &str) -> Result<f64, String> {
    let share = servobench_scenario::ratio(text.trim()).map_err(|error| error.message)?;
    if (0.0..1.0).contains(&share) { Ok(share) } else { Err("it must be at least 0 and below 100 %".into()) }
}
