//! Arguments.
use clap::{Args, Parser, Subcommand, ValueEnum};
use servobench_scenario::EngineName;
use std::path::PathBuf;

/// Closed-loop test bench for servo axes.
#[derive(Debug, Parser)]
#[command(name = "servobench", version, about, max_term_width = 80, after_help = AFTER_HELP)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

const AFTER_HELP: &str = "Exit codes: 0 all passed, 2 the input is wrong, 3 a run could not be carried out, \
                          4 a limit was missed.";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run scenarios and judge them; without a file, run the demo.
    Run(RunArgs),
    /// Validate scenario files without running them: every mistake in one go.
    Check(CheckArgs),
    /// Print the JSON Schema of a scenario file.
    Schema,
    /// Plan a rest-to-rest move: segment times, peaks, duration.
    Plan(PlanArgs),
    /// Run the same axis under different set-points and say which wins by how much.
    Compare(CompareArgs),
    /// Open a recording in the Rerun viewer.
    View(ViewArgs),
    /// Run one scenario in a process of its own (started by `run` and `compare`).
    #[command(hide = true)]
    Worker(WorkerArgs),
}

#[derive(Debug, Args)]
pub(crate) struct RunArgs {
    /// Scenario files, or folders of them.
    pub(crate) scenarios: Vec<PathBuf>,
    /// Folder for `results.json` and the recordings.
    #[arg(long, value_name = "DIR", default_value = "servobench-out")]
    pub(crate) out: PathBuf,
    /// Engine to use instead of the scenarios' own; may be given several times.
    #[arg(long, value_name = "NAME")]
    pub(crate) engine: Vec<Engine>,
    /// Write each recording for the Rerun viewer too.
    #[arg(long)]
    pub(crate) rrd: bool,
    /// Write a JUnit report.
    #[arg(long, value_name = "FILE")]
    pub(crate) junit: Option<PathBuf>,
    /// Scenarios at a time [default: one for each core].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) jobs: Option<u16>,
    /// Say only what failed.
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    /// Scenario files, or folders of them.
    #[arg(required = true)]
    pub(crate) scenarios: Vec<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct PlanArgs {
    /// Order of the profile: 2 trapezoid, 3 jerk-limited, 4 snap-limited.
    #[arg(long, value_parser = clap::value_parser!(u8).range(2..=4))]
    pub(crate) order: u8,
    /// Distance, as "1 m" or "90 deg"; its sign is the direction.
    #[arg(long, allow_hyphen_values = true)]
    pub(crate) distance: String,
    /// Velocity limit, as "1 m/s".
    #[arg(long)]
    pub(crate) velocity: String,
    /// Acceleration limit, as "5 m/s2".
    #[arg(long)]
    pub(crate) acceleration: String,
    /// Jerk limit, as "50 m/s3" (orders 3 and 4).
    #[arg(long)]
    pub(crate) jerk: Option<String>,
    /// Snap limit, as "1000 m/s4" (order 4).
    #[arg(long)]
    pub(crate) snap: Option<String>,
    /// Make every time a whole number of samples of this length, as "1 ms".
    #[arg(long, value_name = "TIME")]
    pub(crate) sample_time: Option<String>,
    /// Print JSON.
    #[arg(long)]
    pub(crate) json: bool,
    /// Write samples: time, position, velocity, acceleration, jerk, snap (SI).
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,
    /// Draw position and its derivatives with their limits.
    #[arg(long, value_name = "FILE")]
    pub(crate) svg: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    /// Scenario files: the same axis under different set-points.
    #[arg(required = true, num_args = 2..)]
    pub(crate) scenarios: Vec<PathBuf>,
    /// What is equal in all runs.
    #[arg(long, value_enum, default_value_t = Equal::Limits)]
    pub(crate) equal: Equal,
    /// Engine to use instead of the first scenario's.
    #[arg(long, value_name = "NAME")]
    pub(crate) engine: Option<Engine>,
    /// Folder for the comparison and its recording.
    #[arg(long, value_name = "DIR", default_value = "servobench-out")]
    pub(crate) out: PathBuf,
}

/// What is equal in all runs of a comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Equal {
    /// Each scenario's own limits.
    Limits,
    /// The duration: faster moves are slowed to the slowest.
    Duration,
}

#[derive(Debug, Args)]
pub(crate) struct ViewArgs {
    /// A recording (`.rrd` or `.parquet`), or a folder that `run` or `compare` wrote.
    pub(crate) recording: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct WorkerArgs {
    #[arg(long)]
    pub(crate) engine: Engine,
    #[arg(long)]
    pub(crate) recording: PathBuf,
    #[arg(long)]
    pub(crate) name: String,
    #[arg(long)]
    pub(crate) path: Option<PathBuf>,
    #[arg(long, value_delimiter = ',')]
    pub(crate) durations: Vec<f64>,
}

/// An engine by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Engine {
    /// Exact zero-order hold of the linear chain.
    Exact,
    /// Rapier, embedded.
    Rapier,
    /// `MuJoCo`, in a worker process.
    Mujoco,
}

impl From<Engine> for EngineName {
    fn from(engine: Engine) -> Self {
        match engine {
            Engine::Exact => Self::Exact,
            Engine::Rapier => Self::Rapier,
            Engine::Mujoco => Self::Mujoco,
        }
    }
}
