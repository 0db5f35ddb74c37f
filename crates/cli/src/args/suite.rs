//! Arguments of what runs suites of scenarios: `run` and `sweep`.
use super::{OverrideArgs, choice, engine, file, memory, time, time_bound};
use clap::{Args, ValueEnum};
use servobench_config::Choice as _;
use servobench_plant::EngineName;
use servobench_report::Denied;
use servobench_scenario::TimeBound;
use std::path::{Path, PathBuf};
use std::time::Duration;

#[derive(Debug, Args)]
pub(crate) struct RunArgs {
    /// Scenario files, or folders of them; - is standard input.
    pub(crate) scenarios: Vec<PathBuf>,
    /// Folder for results.json and the recordings [default: servobench-out; of the demo servobench-out/demo].
    #[arg(long, value_name = "DIR", value_parser = file())]
    pub(crate) out: Option<PathBuf>,
    /// Run what is left of the suite in this folder, which was ended before its time; scenarios and options are those that it was
    /// begun with, but --root, --junit and --allow-unisolated-fmus, which are given again. A suite that is complete is reported if
    /// nothing that it was made of has changed since.
    #[arg(long, value_name = "DIR", value_parser = file(),
          conflicts_with_all = ["scenarios", "overrides", "out", "engine", "keep", "rrd", "worker_timeout", "time_limit", "memory_limit"])]
    pub(crate) resume: Option<PathBuf>,
    /// Recordings that stay, with their timing diagrams and .rrd.
    #[arg(long, value_enum, value_name = "WHICH", default_value_t = Keep::All)]
    pub(crate) keep: Keep,
    /// Show all metrics of every run, as of a single one.
    #[arg(long, short, conflicts_with = "quiet")]
    pub(crate) verbose: bool,
    #[command(flatten)]
    pub(crate) suite: SuiteArgs,
}

#[derive(Debug, Args)]
pub(crate) struct SweepArgs {
    /// The sweep file.
    #[arg(required_unless_present = "resume")]
    pub(crate) sweep: Option<PathBuf>,
    /// Folder for tables, pictures, results.json and the recordings [default: servobench-out/NAME].
    #[arg(long, value_name = "DIR", value_parser = file())]
    pub(crate) out: Option<PathBuf>,
    /// Run what is left of the sweep in this folder, which was ended before its time; file and options are those that it was begun
    /// with, but --root, --junit and --allow-unisolated-fmus, which are given again.
    #[arg(long, value_name = "DIR", value_parser = file(),
          conflicts_with_all = ["sweep", "overrides", "out", "engine", "keep", "rrd", "worker_timeout", "time_limit", "memory_limit"])]
    pub(crate) resume: Option<PathBuf>,
    /// Recordings that stay, with their timing diagrams and .rrd.
    #[arg(long, value_enum, value_name = "WHICH", default_value_t = Keep::None)]
    pub(crate) keep: Keep,
    #[command(flatten)]
    pub(crate) suite: SuiteArgs,
}

/// How the runs of a suite are made.
#[derive(Debug, Args)]
pub(crate) struct SuiteArgs {
    #[command(flatten)]
    pub(crate) with: OverrideArgs,
    /// Engine to use instead of those that the file names; may be given several times.
    #[arg(long, value_name = "NAME", value_parser = engine())]
    pub(crate) engine: Vec<EngineName>,
    /// Write each recording that stays for the Rerun viewer too.
    #[arg(long)]
    pub(crate) rrd: bool,
    /// Write a JUnit report.
    #[arg(long, value_name = "FILE", value_parser = file())]
    pub(crate) junit: Option<PathBuf>,
    /// Runs to make at once [default: one for each core].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) jobs: Option<u16>,
    /// End the process of an isolated engine that makes no progress for this long.
    #[arg(long, value_name = "TIME", value_parser = time, default_value = "5 min")]
    pub(crate) worker_timeout: Duration,
    /// End a run that takes longer by the clock; it is an error. run.time_limit of a scenario may be less. none: no limit [default: ten
    /// minutes and a hundred times the time that check estimates].
    #[arg(long, value_name = "TIME", value_parser = time_bound)]
    pub(crate) time_limit: Option<TimeBound>,
    #[command(flatten)]
    pub(crate) memory: MemoryArgs,
    /// Print failures only, a line each, and a line with the counts; of a sweep that line.
    #[arg(long, short)]
    pub(crate) quiet: bool,
    #[command(flatten)]
    pub(crate) deny: DenyArgs,
    #[command(flatten)]
    pub(crate) fmus: FmuTrustArgs,
}

impl SuiteArgs {
    /// Those of a suite that goes on: what it was begun with, but how much runs at a time and what is printed, and all by which a journal
    /// could read, write or run something: which files may be read, where the JUnit report goes, which FMUs are trusted. Relative paths
    /// of now start from `here`. What either denies is denied.
    pub(crate) fn resumed(self, now: &Self, here: &Path) -> Self {
        let anew = |path: &Option<PathBuf>| path.as_ref().map(|path| here.join(path));
        Self {
            with: OverrideArgs { root: anew(&now.with.root), ..self.with },
            junit: anew(&now.junit),
            deny: self.deny.and(&now.deny),
            fmus: now.fmus,
            jobs: now.jobs.or(self.jobs),
            quiet: now.quiet,
            ..self
        }
    }
}

/// Denied properties of runs that did not fail.
#[derive(Debug, Clone, Args)]
pub(crate) struct DenyArgs {
    /// End with exit code 4, and say where, when a run has this although it did not fail; several with commas.
    #[arg(long, value_name = "WHAT", value_delimiter = ',', value_parser = choice::<Denied>())]
    pub(crate) deny: Vec<Denied>,
    /// Deny all of these.
    #[arg(long)]
    pub(crate) strict: bool,
}

impl DenyArgs {
    /// All that is denied.
    pub(crate) fn kinds(&self) -> Vec<Denied> {
        if self.strict { Denied::ALL.iter().map(|(_, kind, _)| *kind).collect() } else { self.deny.clone() }
    }

    /// The kinds that either denies.
    fn and(self, other: &Self) -> Self {
        Self { strict: self.strict || other.strict, deny: [self.deny, other.deny.clone()].concat() }
    }
}

/// Which recordings a run leaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Keep {
    /// Those of all runs.
    All,
    /// Those of runs that failed or ended with an error; an unjudged one has nothing that failed.
    Failed,
    /// No recording, only results.
    None,
}

/// Memory of runs.
#[derive(Debug, Args)]
pub(crate) struct MemoryArgs {
    /// Memory of all recordings under way together, and of each process that is isolated, as "2 GB" [default: half of what machine and
    /// control group have].
    #[arg(long, value_name = "SIZE", value_parser = memory)]
    pub(crate) memory_limit: Option<u64>,
}

/// Which code of FMUs may run where.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct FmuTrustArgs {
    /// Let FMUs whose scenario says isolation = "none" run inside of servobench, with all that it may do and nothing that contains them.
    #[arg(long)]
    pub(crate) allow_unisolated_fmus: bool,
}
