//! Arguments.
mod advise;
mod choice;
mod compare;
mod mistakes;
mod shapers;
mod start;
mod suite;

pub(crate) use advise::AdviseArgs;
pub(crate) use choice::choice;
pub(crate) use compare::{CompareArgs, Equal, EqualTerm, Variant};
pub(crate) use mistakes::parse;
pub(crate) use shapers::Shapers;
pub(crate) use start::{ExamplesArgs, ExplainArgs, InitArgs, ModelsArgs};
pub(crate) use suite::{DenyArgs, FmuTrustArgs, Keep, MemoryArgs, RunArgs, SuiteArgs, SweepArgs};

use crate::commands::{PLAN_EXAMPLES, PlanArgs};
use crate::exit;
use clap::builder::{OsStringValueParser, PossibleValuesParser, TypedValueParser};
use clap::{Args, CommandFactory as _, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use servobench_config::Choice as _;
#[cfg(feature = "fmu")]
use servobench_fmi::Version;
#[cfg(feature = "fmu")]
use servobench_fmu::Part;
use servobench_plant::EngineName;
use servobench_scenario::{Override, TimeBound};
use servobench_structured_text::{Dialect, Format};
use std::path::PathBuf;
use std::time::Duration;

/// Closed-loop test bench for servo axes.
#[derive(Debug, Parser)]
#[command(name = "servobench", version, max_term_width = 80, after_help = exit::help())]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

const AFTER_RUN: &str = "Columns: MOVE is the set-point's duration, SETTLING the time after it until the load stays in \
                         its window, PEAK ERR the peak following error of the load, VIBR P-P its residual vibration, \
                         peak-to-peak.\n\n\
                         A run with signals (of function blocks, axis, link and drive) leaves a timing diagram beside \
                         its recording, RUN.timing.svg; servobench timing draws other stretches of it.";

const AFTER_SWEEP: &str = "A sweep file names a scenario and the keys that vary: values or a range one after the other, or a distribution \
                           that is drawn from (tolerances). docs/sweep.md describes it. Each run is a row of sweep.csv \
                           and sweep.parquet; servobench run with the keys of a row as --set gives its very numbers.\n\n\
                           Call sweep files NAME.sweep.toml: a folder of scenarios may then hold them too.";

const AFTER_ADVISE: &str = "Order, velocity, acceleration, jerk, snap and input shaper are chosen. What is told was run: on the corners of \
                            the box, on machines between them whose frequencies are nearer to each other than a tenth of a \
                            lobe of the profile, and on draws. docs/advise.md says how.";

const AFTER_COMPARE: &str = "Examples:\n  \
                             servobench compare jerk.toml snap.toml --equal duration\n  \
                             servobench compare axis.toml --variant 'jerk: setpoint.order=3' --variant 'snap: setpoint.order=4'\n  \
                             servobench compare axis.toml --shaper none,zv,zvd,ei --shaper-frequency 17.5Hz\n  \
                             servobench compare axis.toml --against before/results.json";

const AFTER_COMPLETIONS: &str = "For bash: servobench completions bash > ~/.local/share/bash-completion/completions/servobench. For fish: … fish > \
                                 ~/.config/fish/completions/servobench.fish. For zsh: into _servobench in a folder of $fpath. A shell \
                                 that is started afterwards reads it.";

const AFTER_MAN: &str =
    "Read a page without installing it: servobench man | man -l -. Pages in ~/.local/share/man/man1 are found by man.";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Write a commented scenario of an axis to begin with, which runs as it is.
    #[command(after_help = start::AFTER_INIT)]
    Init(InitArgs),
    /// List the ready scenarios, or write one of them with the files that it names.
    #[command(after_help = start::AFTER_EXAMPLES)]
    Examples(ExamplesArgs),
    /// Explain a key of scenario files, a metric, a requirement, a signal, a function block or an exit code.
    #[command(after_help = start::AFTER_EXPLAIN)]
    Explain(ExplainArgs),
    /// List the built-in models of motors, drives and axes, or print one.
    #[command(after_help = start::AFTER_MODELS)]
    Models(ModelsArgs),
    /// Run scenarios and judge them; without a file, run the demo.
    #[command(after_help = AFTER_RUN)]
    Run(RunArgs),
    /// Run a scenario over many values of its keys, and say what they cost: tables, heat maps, the Pareto front.
    #[command(after_help = AFTER_SWEEP)]
    Sweep(SweepArgs),
    /// Find the fastest set-point that keeps the limits of a scenario on every machine of a box, and verify it.
    #[command(after_help = AFTER_ADVISE)]
    Advise(AdviseArgs),
    /// Validate scenario files without running them: every mistake in one go.
    Check(CheckArgs),
    /// Print the JSON Schema of a scenario or sweep file.
    Schema(SchemaArgs),
    /// Plan a move of any family: duration, segments, peaks against limits.
    #[command(after_help = PLAN_EXAMPLES)]
    Plan(Box<PlanArgs>),
    /// Run scenarios, or variants of one, side by side: what differs in them and in what they give.
    #[command(after_help = AFTER_COMPARE)]
    Compare(CompareArgs),
    /// Open a recording in the Rerun viewer.
    View(ViewArgs),
    /// Draw the timing diagram of a recording: velocity and position over the signals of blocks, axis, link and drive.
    Timing(TimingArgs),
    /// Show the object dictionary of the drive (CiA 402): as a table, an electronic data sheet or JSON.
    Objects(ObjectsArgs),
    /// Write the generator of fourth order as code for a PLC (IEC 61131-3).
    #[command(subcommand)]
    Plc(PlcCommand),
    /// Show what is in an FMU, or write an axis as one (Functional Mock-up Interface 2.0 and 3.0).
    #[cfg(feature = "fmu")]
    #[command(subcommand)]
    Fmu(FmuCommand),
    /// Print what completes command lines of servobench in a shell.
    #[command(after_help = AFTER_COMPLETIONS)]
    Completions(CompletionsArgs),
    /// Print the man page of the program, or write those of all commands.
    #[command(after_help = AFTER_MAN)]
    Man(ManArgs),
    /// Run an FMU in a process of its own (started by `run`, `check` and `compare`).
    #[cfg(feature = "fmu")]
    #[command(hide = true)]
    FmuHost,
    /// Run scenarios in a process of its own (started by `run`, `check` and `compare`).
    #[command(hide = true)]
    Worker,
}

/// What to do for a PLC.
#[derive(Debug, Subcommand)]
pub(crate) enum PlcCommand {
    /// Write the function blocks Profile4th and MC_MoveAbsolute as Structured Text or PLCopen XML.
    #[command(after_help = AFTER_PLC_EXPORT)]
    Export(PlcExportArgs),
}

const AFTER_PLC_EXPORT: &str = "Profile4th makes the set-points of a move from standstill to standstill, sample by sample: \
                                position, velocity, acceleration, jerk and snap, bounded up to the snap (or the jerk, or \
                                the acceleration: ProfileOrder). MC_MoveAbsolute starts such a move by Execute and tells \
                                Busy, Done and Error; it has no axis, whose set-point its outputs become.\n\n\
                                A call in every period of the task:\n\n  \
                                Move(Execute := Go, Position := 0.25, Velocity := 0.5,\n       \
                                Acceleration := 5.0, Jerk := 100.0, Snap := 5000.0,\n       \
                                CommandedPosition := AxisSetPosition);\n  \
                                IF Move.Active THEN AxisSetPosition := Move.SetPosition; END_IF;\n\n\
                                The head of the file says what each error number means, the memory of an instance, and on \
                                which compiler the file was tried. Logix controllers of Rockwell are not among the \
                                dialects: they import Add-On Instructions as L5X, have no functions of the user and no \
                                LINT to LREAL conversion that all of them share.\n\n\
                                Examples:\n  \
                                servobench plc export --sample-time \"1 ms\" -o profile4th.st\n  \
                                servobench plc export --dialect codesys --format xml -o profile4th.xml\n  \
                                servobench plc export --dialect scl -o profile4th.scl";

#[derive(Debug, Args)]
pub(crate) struct PlcExportArgs {
    /// What the file is.
    #[arg(long, value_parser = choice::<Format>(), default_value = Format::default().name())]
    pub(crate) format: Format,
    /// Whose language it is written in.
    #[arg(long, value_parser = choice::<Dialect>(), default_value = Dialect::default().name())]
    pub(crate) dialect: Dialect,
    /// Initial value of the input Ts: the period of the task, as "1 ms".
    #[arg(long, value_name = "TIME", value_parser = instant, default_value = "1 ms")]
    pub(crate) sample_time: f64,
    /// Initial value of the input T_set: from the end of a move until Ready, as "50 ms".
    #[arg(long, value_name = "TIME", value_parser = instant, default_value = "0 s")]
    pub(crate) settling_time: f64,
    /// What the block with Execute is called, where the project has one of the standard's name.
    #[arg(long, value_name = "NAME", default_value = servobench_structured_text::MOVE)]
    pub(crate) move_block: String,
    /// Write to this file [default: standard output].
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}

/// The program as its users see it: without the commands that it starts itself.
pub(crate) fn visible() -> clap::Command {
    let whole = Cli::command();
    clap::Command::new("servobench")
        .version(env!("CARGO_PKG_VERSION"))
        .about(whole.get_about().cloned().unwrap_or_default())
        .after_help(exit::help())
        .subcommand_required(true)
        .subcommands(whole.get_subcommands().filter(|inner| !inner.is_hide_set()).cloned())
}

/// What to do with FMUs.
#[cfg(feature = "fmu")]
#[derive(Debug, Subcommand)]
pub(crate) enum FmuCommand {
    /// Show what is in an FMU: versions, capabilities, variables with units. Nothing of it is executed.
    Info(FmuInfoArgs),
    /// Write the axis of a scenario as a co-simulation FMU for Linux x86-64.
    Export(FmuExportArgs),
}

#[cfg(feature = "fmu")]
#[derive(Debug, Args)]
pub(crate) struct FmuInfoArgs {
    /// The FMU.
    pub(crate) file: PathBuf,
}

#[cfg(feature = "fmu")]
#[derive(Debug, Args)]
pub(crate) struct FmuExportArgs {
    /// The scenario; - is standard input.
    pub(crate) scenario: PathBuf,
    #[command(flatten)]
    pub(crate) with: OverrideArgs,
    /// Version of the Functional Mock-up Interface.
    #[arg(long, value_parser = choice::<Version>(), default_value = Version::default().name())]
    pub(crate) fmi: Version,
    /// What is inside.
    #[arg(long, value_parser = choice::<Part>(), default_value = Part::default().name())]
    pub(crate) part: Part,
    /// The file, or - for standard output [default: the scenario's name with .fmu].
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}

/// The arguments of this process, for a command that is to be given again; none when one of them is no text.
pub(crate) fn command_line() -> Vec<String> {
    let words = std::env::args_os().skip(1).map(|word| word.into_string().ok());
    words.collect::<Option<_>>().unwrap_or_default()
}

/// The command that `words` give, as [`command_line`] has them.
pub(crate) fn of(words: &[String]) -> Option<Command> {
    let program = std::iter::once("servobench");
    Cli::try_parse_from(program.chain(words.iter().map(String::as_str))).ok().map(|cli| cli.command)
}

/// How scenario files are read.
#[derive(Debug, Args)]
pub(crate) struct OverrideArgs {
    /// Give a key of the scenario another value, as in setpoint.jerk=200m/s3 or 'program.0.move_to=100 mm' (lists count from 0); may
    /// be given several times.
    #[arg(long = "set", value_name = "KEY=VALUE", allow_hyphen_values = true)]
    pub(crate) overrides: Vec<Override>,
    /// Folder that the scenario and every file it names must be in [default: the nearest folder above it with a .git, or else its own].
    #[arg(long, value_name = "DIR", value_parser = file())]
    pub(crate) root: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    /// Scenario files, or folders of them; - is standard input.
    #[arg(required = true)]
    pub(crate) scenarios: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) with: OverrideArgs,
    /// Show the whole preview of every scenario, as of a single one.
    #[arg(long, short)]
    pub(crate) verbose: bool,
    #[command(flatten)]
    pub(crate) memory: MemoryArgs,
    /// Load and initialise the FMUs, which runs their code; without it only their descriptions are read.
    #[arg(long)]
    pub(crate) load_fmus: bool,
    #[command(flatten)]
    pub(crate) fmus: FmuTrustArgs,
}

#[derive(Debug, Args)]
pub(crate) struct ViewArgs {
    /// A recording (.rrd or .parquet), or a folder that run or compare wrote.
    pub(crate) recording: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct TimingArgs {
    /// A recording (.parquet).
    pub(crate) recording: PathBuf,
    /// Write the SVG there [default: -, standard output].
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Beginning, as "1.5 s" [default: that of the recording].
    #[arg(long, value_name = "TIME", value_parser = instant)]
    pub(crate) from: Option<f64>,
    /// End, as "2500 ms" [default: that of the recording].
    #[arg(long, value_name = "TIME", value_parser = instant)]
    pub(crate) to: Option<f64>,
    /// Show only the signals of this source (a block by its name, axis, link, drive); may be given several times.
    #[arg(long, value_name = "NAME")]
    pub(crate) source: Vec<String>,
    /// Width in pixels, 480 to 4000 [default: 860].
    #[arg(long, value_name = "PX")]
    pub(crate) width: Option<u32>,
    /// Show signals too in which nothing happens.
    #[arg(long)]
    pub(crate) idle: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ObjectsArgs {
    /// A scenario, for the values that its drive.objects writes; without it the values after power-on; - is standard input.
    pub(crate) scenario: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) with: OverrideArgs,
    /// How the dictionary is written.
    #[arg(long, value_enum, default_value_t = ObjectsFormat::Table)]
    pub(crate) format: ObjectsFormat,
    /// Write to this file [default: -, standard output].
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}

/// How an object dictionary is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ObjectsFormat {
    /// For a person: index, name, type, access, value, unit, range.
    Table,
    /// Electronic data sheet (CiA 306); values of a scenario as ParameterValue.
    Eds,
    /// For a program: everything that the table says, and PDO mapping and defaults.
    Json,
}

#[derive(Debug, Args)]
pub(crate) struct CompletionsArgs {
    /// The shell.
    #[arg(value_enum)]
    pub(crate) shell: Shell,
}

#[derive(Debug, Args)]
pub(crate) struct SchemaArgs {
    /// The kind of file.
    #[arg(value_enum, default_value_t = SchemaOf::Scenario)]
    pub(crate) of: SchemaOf,
}

/// A kind of file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum SchemaOf {
    /// A scenario.
    Scenario,
    /// A sweep.
    Sweep,
}

#[derive(Debug, Args)]
pub(crate) struct ManArgs {
    /// Write the pages of the program and of each command into this folder.
    #[arg(long, value_name = "DIR", value_parser = file())]
    pub(crate) out: Option<PathBuf>,
}

/// A file or a folder that is written beside what goes to standard output: `-` is none.
pub(crate) fn file() -> impl TypedValueParser<Value = PathBuf> {
    OsStringValueParser::new().try_map(|path| match path.to_str() {
        Some("-") => Err("standard output (-) is for --output alone; ./- names a file or a folder"),
        Some("") => Err("a name is needed"),
        _ => Ok(PathBuf::from(path)),
    })
}

/// An engine by the name that scenario files give it.
fn engine() -> impl TypedValueParser<Value = EngineName> {
    PossibleValuesParser::new(EngineName::ALL.iter().map(|(name, ..)| *name))
        .try_map(|name| EngineName::from_name(&name).ok_or_else(|| format!("there is no engine `{name}`")))
}

/// A length of time, as "5 min".
fn time(text: &str) -> Result<Duration, String> {
    let seconds = servobench_scenario::time(text).map_err(|error| error.message)?;
    match Duration::try_from_secs_f64(seconds) {
        Ok(time) if !time.is_zero() => Ok(time),
        _ => Err("it must be greater than 0 and at most 1.8e19 s".into()),
    }
}

/// A bound of time by the clock, as "5 min"; "none" is none.
fn time_bound(text: &str) -> Result<TimeBound, String> {
    if text == "none" { Ok(TimeBound::Unlimited) } else { Ok(TimeBound::AtMost(time(text)?.as_secs_f64())) }
}

/// An amount of memory (B), as "2 GB".
fn memory(text: &str) -> Result<u64, String> {
    const UNITS: [(&str, f64); 4] = [("GiB", 1_073_741_824.0), ("MiB", 1_048_576.0), ("GB", 1e9), ("MB", 1e6)];
    // The program alone does not work with less in a process of its own.
    const LEAST: f64 = 50e6;
    let text = text.trim();
    let parts = UNITS.iter().find_map(|(unit, factor)| Some((text.strip_suffix(unit)?.trim(), *factor)));
    let (number, factor) = parts.ok_or("it is a number with a unit: MB, GB, MiB or GiB, as in \"2 GB\"")?;
    let bytes = number.parse::<f64>().map_err(|_| format!("`{number}` is not a number"))? * factor;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the bounds")]
    if (LEAST..=1e18).contains(&bytes) {
        Ok(bytes as u64)
    } else {
        Err("it must be at least 50 MB and at most 1e9 GB".into())
    }
}

/// A time (s), as "1.5 s".
fn instant(text: &str) -> Result<f64, String> {
    servobench_scenario::time(text).map_err(|error| error.message)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_arguments_are_consistent() {
        Cli::command().debug_assert();
    }

    /// Help is plain text: a backtick in it comes from a doc comment that forgot so.
    #[test]
    fn help_is_plain_text_that_says_what_the_program_is() {
        let mut cli = Cli::command();
        let help = cli.render_long_help().to_string();
        assert!(help.starts_with("Closed-loop test bench for servo axes"), "{help}");
        are_plain(&mut cli);
    }

    fn are_plain(command: &mut clap::Command) {
        for inner in command.get_subcommands_mut().filter(|inner| !inner.is_hide_set()) {
            let help = inner.render_long_help().to_string();
            assert!(!help.contains('`'), "{help}");
            are_plain(inner);
        }
    }

    #[test]
    fn every_engine_has_its_name() {
        for (name, engine, _) in EngineName::ALL {
            let cli = Cli::try_parse_from(["servobench", "run", "--engine", name]).unwrap();
            let Command::Run(args) = cli.command else { panic!("run") };
            assert_eq!(args.suite.engine, [*engine]);
        }
    }

    #[test]
    fn times_have_units() {
        let timeout = |text| Cli::try_parse_from(["servobench", "run", "--worker-timeout", text]);
        let Command::Run(args) = timeout("90 s").unwrap().command else { panic!("run") };
        assert_eq!(args.suite.worker_timeout, Duration::from_secs(90));
        for wrong in ["90", "90 m", "0 s", "-1 s", "1e30 s"] {
            assert!(timeout(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_limit_of_time_may_be_none() {
        let limit = |text| Cli::try_parse_from(["servobench", "run", "--time-limit", text]);
        for (text, bound) in [("none", TimeBound::Unlimited), ("2 min", TimeBound::AtMost(120.0))] {
            let Command::Run(args) = limit(text).unwrap().command else { panic!("run") };
            assert_eq!(args.suite.time_limit, Some(bound));
        }
        assert!(limit("never").is_err() && limit("0 s").is_err());
    }

    /// A journal is a file: nothing that it says is read, written or run by an option.
    #[test]
    fn what_could_do_harm_is_what_the_command_line_of_now_says() {
        let suite = |words: &[&str]| {
            let Command::Run(args) = Cli::try_parse_from([&["servobench", "run"], words].concat()).unwrap().command
            else {
                panic!("run")
            };
            args.suite
        };
        let of_journal = ["--junit", "/etc/x", "--root", "/", "--allow-unisolated-fmus", "--deny", "lifted", "--rrd"];
        let here = std::path::Path::new("/here");
        let resumed = suite(&of_journal).resumed(&suite(&["--resume", "out"]), here);
        assert_eq!((resumed.junit, resumed.with.root, resumed.fmus.allow_unisolated_fmus), (None, None, false));
        assert!(resumed.rrd && resumed.deny.kinds().len() == 1, "what is denied stays so");
        let now = suite(&["--resume", "out", "--junit", "a.xml", "--root", "b", "--strict"]);
        let resumed = suite(&of_journal).resumed(&now, here);
        assert_eq!((resumed.junit, resumed.with.root), (Some("/here/a.xml".into()), Some("/here/b".into())));
        assert_eq!(resumed.deny.kinds().len(), 3);
    }

    #[test]
    fn memory_has_units() {
        let sizes = [("2 GB", 2_000_000_000), ("1.5GiB", 1_610_612_736), ("300 MB", 300_000_000), ("64 MiB", 1 << 26)];
        for (text, bytes) in sizes {
            assert_eq!(memory(text), Ok(bytes), "{text}");
        }
        for wrong in ["", "2", "GB", "2 TB", "-1 GB", "0 GB", "49.9 MB", "60000 kB", "nan GB", "inf GB", "2 GB more"] {
            assert!(memory(wrong).is_err(), "{wrong}");
        }
    }
}
