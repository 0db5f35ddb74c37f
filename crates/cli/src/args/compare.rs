//! Arguments of `compare`.
mod equal;
mod variant;

pub(crate) use equal::{Equal, EqualTerm};
pub(crate) use variant::Variant;

use super::shapers::{self, Shapers};
use super::{DenyArgs, FmuTrustArgs, MemoryArgs, OverrideArgs, engine, file, time, time_bound};
use clap::Args;
use servobench_plant::EngineName;
use servobench_scenario::TimeBound;
use std::path::PathBuf;
use std::time::Duration;

#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    /// Scenario files: axes of one kind, linear or rotary; - is standard input. One is enough with two variants, or with --against.
    #[arg(required = true)]
    pub(crate) scenarios: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) with: OverrideArgs,
    /// Run each scenario with other values of its keys, under a name of its own: 'snap: setpoint.order=4; setpoint.snap=1000m/s4'. Nothing
    /// behind the colon is the scenario as it is. May be given several times.
    #[arg(long = "variant", value_name = "NAME: KEY=VALUE; …", allow_hyphen_values = true)]
    pub(crate) variants: Vec<Variant>,
    #[command(flatten)]
    pub(crate) shaper: ShaperArgs,
    /// What must be equal in all runs; without it each keeps its own limits. limits: an error when one that several moves have differs.
    /// duration, torque (peak torque or force), current (RMS) and vibration (residual, of the load): moves are slowed, and no longer
    /// judged by their limits, until they are as gentle as the gentlest run, or as a value: vibration=20um, torque=5Nm, current=4Arms,
    /// duration=1.2s.
    #[arg(long, value_name = "WHAT[=VALUE]", value_parser = Equal::parse)]
    pub(crate) equal: Option<Equal>,
    /// Put the results of an earlier run beside those of now: results.json or comparison.json, or the folder that holds one. Its runs of
    /// scenarios of the same names are reported and not judged again. May be given several times.
    #[arg(long, value_name = "FILE")]
    pub(crate) against: Vec<PathBuf>,
    /// Seeds that each run with random numbers (noise, jitter) is made with: that of its file and the numbers after it. With fewer than 5 no
    /// difference is told from chance.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=1000), default_value_t = 5)]
    pub(crate) seeds: u32,
    /// Engine to use instead of the first scenario's.
    #[arg(long, value_name = "NAME", value_parser = engine())]
    pub(crate) engine: Option<EngineName>,
    /// Folder for the comparison and its recording.
    #[arg(long, value_name = "DIR", value_parser = file(), default_value = "servobench-out")]
    pub(crate) out: PathBuf,
    /// End the process of an isolated engine that makes no progress for this long.
    #[arg(long, value_name = "TIME", value_parser = time, default_value = "5 min")]
    pub(crate) worker_timeout: Duration,
    /// End a run that takes longer by the clock; it is an error. run.time_limit of a scenario may be less. none: no limit [default: ten
    /// minutes and a hundred times the time that check estimates].
    #[arg(long, value_name = "TIME", value_parser = time_bound)]
    pub(crate) time_limit: Option<TimeBound>,
    #[command(flatten)]
    pub(crate) memory: MemoryArgs,
    #[command(flatten)]
    pub(crate) deny: DenyArgs,
    #[command(flatten)]
    pub(crate) fmus: FmuTrustArgs,
}

/// Input shapers as variants.
#[derive(Debug, Args)]
pub(crate) struct ShaperArgs {
    /// Run each scenario with this input shaper: several with commas or several times; all for every kind, none for no shaper. It is
    /// against the mode that measure.mode of the scenario names.
    #[arg(long = "shaper", value_name = "KIND", value_delimiter = ',', value_parser = shapers::parser())]
    pub(crate) kinds: Vec<Shapers>,
    /// Natural frequency of the mode that shapers are against, in place of measure.mode; two with a comma for two modes at once.
    #[arg(long = "shaper-frequency", value_name = "FREQUENCY", value_delimiter = ',', value_parser = frequency, requires = "kinds")]
    pub(crate) frequencies: Vec<f64>,
    /// Damping ratio of that mode, or of each mode with a comma [default: 0].
    #[arg(long = "shaper-damping", value_name = "RATIO", value_delimiter = ',', value_parser = damping, requires = "kinds")]
    pub(crate) dampings: Vec<f64>,
}

/// A frequency (Hz), as "17.5 Hz".
fn frequency(text: &str) -> Result<f64, String> {
    let hertz = servobench_scenario::frequency(text.trim()).map_err(|error| error.message)?;
    if hertz > 0.0 && hertz.is_finite() { Ok(hertz) } else { Err("it must be greater than 0, as in 17.5Hz".into()) }
}

/// A damping ratio.
fn damping(text: &str) -> Result<f64, String> {
    let ratio = servobench_scenario::ratio(text.trim()).map_err(|error| error.message)?;
    if (0.0..1.0).contains(&ratio) { Ok(ratio) } else { Err("it must be at least 0 and below 1, as in 0.02".into()) }
}
