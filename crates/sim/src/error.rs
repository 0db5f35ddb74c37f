//! Errors while building a run.
use servobench_base::{ParamError, Rate, RateError};
use servobench_cia402::SdoError;
use servobench_cia402::units::UnitError;
use servobench_drive::device::ObjectsError;
use servobench_fieldbus::FieldbusError;
use servobench_fieldbus::trajectory::{Help, Unsendable};
use servobench_fmi::FmuMistake;
use servobench_motion::PlanError;
use servobench_plant::{EndStopError, EngineName, MechanicsError, SwitchPoint};
use servobench_scenario::{LONGEST_RUN, MOST_TICKS};
use servobench_signals::Signal;
use std::fmt::Display;
use thiserror::Error;

/// Reasons why a scenario could not be turned into a closed loop.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum BuildError {
    /// A parameter is out of its bound.
    #[error(transparent)]
    Parameter(#[from] ParamError),
    /// A parameter of the drive's firmware is out of its bound.
    #[error(transparent)]
    Drive(#[from] servobench_drive::ParameterError),
    /// A switch without a valid place.
    #[error(transparent)]
    Switches(#[from] ParamError<SwitchPoint>),
    /// The end stops are invalid, or do not suit these ticks.
    #[error(transparent)]
    EndStops(#[from] EndStopError),
    /// The value of a key of the scenario does not fit others; its name is the key.
    #[error(transparent)]
    Key(ParamError),
    /// A task rate does not divide the base rate.
    #[error(transparent)]
    Rate(#[from] RateError),
    /// A move cannot be planned.
    #[error("program step {}: {error}", index + 1)]
    Plan {
        /// Number of the step, from 0.
        index: usize,
        /// Error of the planner.
        error: PlanError,
    },
    /// A move to be aborted has already ended by then.
    #[error(
        "program step {}: `aborts_after` is {after} s, but the move before lasts {lasts} s: abort it earlier, or let this move \
         follow without `aborts_after`",
        index + 1
    )]
    NothingToAbort {
        /// Number of the step that aborts, from 0.
        index: usize,
        /// Time at which it would abort, after the start of the previous move (s).
        after: f64,
        /// Duration of the previous move (s).
        lasts: f64,
    },
    /// A value that an object of the drive rejects.
    #[error("`{key}`: {error}")]
    Object {
        /// Key of the scenario.
        key: String,
        /// Answer of the drive.
        error: Box<SdoError>,
    },
    /// Settings that do not fit the objects of the drive.
    #[error(transparent)]
    Objects(Box<ObjectsError>),
    /// A table that cannot be sent to the buffer of the drive.
    #[error("{_0}{}", key_of(_0))]
    Points(#[from] Unsendable),
    /// An expected fault that the link cannot have.
    #[error("the link has no fault \"{fault}\"; it has {}", available.join(", "))]
    NoSuchFault {
        /// Number of the expectation, from 0.
        index: usize,
        /// Expected fault.
        fault: String,
        /// Available faults.
        available: Vec<&'static str>,
    },
    /// A fieldbus without a drive at its end.
    #[error("a fieldbus leads to a drive, and this motor has none: give the motor a drive, or leave `bus` out")]
    NoDriveOnTheBus,
    /// Units of the bus that a drive cannot count in.
    #[error(transparent)]
    Units(#[from] UnitError),
    /// The link to the drive cannot be set up.
    #[error(transparent)]
    Link(#[from] FieldbusError),
    /// FMUs beside the axis that cannot be used, each with its reasons; at least one.
    #[error("{}", in_one_line(.0))]
    Fmus(Vec<UnusableFmu>),
    /// FMUs beside the axis crashed, or did not return, before the first tick.
    #[error("{}", in_one_line(.0))]
    Broken(Vec<UnusableFmu>),
    /// Axis and FMUs failed before their first exchange, with the error of one of them.
    #[error("at 0 s: {0}")]
    NotBegun(String),
    /// An input of an FMU is connected to a channel that the axis does not have.
    #[error("this axis has no channel `{signal}` for the input `{variable}` of an FMU; it has {}", names(available))]
    NoSuchSignal {
        /// Index of the scenario's FMU, from 0.
        index: usize,
        /// The input.
        variable: String,
        /// Requested signal.
        signal: Signal,
        /// Available signals.
        available: Vec<Signal>,
    },
    /// The connections of the FMUs cannot be run.
    #[error("{0}")]
    Coupling(String),
    /// An engine that simulates FMUs, without an FMU.
    #[error("the engine `{engine}` has no mechanics: give `[axis.fmu]`")]
    NoFmu {
        /// The engine.
        engine: EngineName,
    },
    /// The engine has nothing to simulate.
    #[error(
        "the engine `{engine}` needs bodies or an MJCF file, and the axis has an FMU alone: choose the engine `fmu`"
    )]
    OnlyAnFmu {
        /// The engine.
        engine: EngineName,
    },
    /// The engine refuses the mechanics.
    #[error(transparent)]
    Mechanics(#[from] MechanicsError),
    /// The program or the run exceeds the longest run.
    #[error(
        "{} would end at {end} s, a run lasts {limit} s at most; {}",
        step.map_or("the run".into(), |index| format!("program step {}", index + 1)),
        if step.is_some() { "wait less, or raise its limits" } else { "shorten its program or `run.duration`" }
    )]
    TooLong {
        /// Number of the step of the program, from 0; `None` for the run itself.
        step: Option<usize>,
        /// End (s).
        end: f64,
        /// Longest run (s).
        limit: f64,
    },
    /// The run has too many ticks.
    #[error(
        "the run has {ticks} ticks, at {rate} Hz, and may have {limit}: so many take half an hour on the fastest engine; shorten \
         `run.duration` or the program to {} s, or lower `run.base_rate`",
        limit / u64::from(*rate)
    )]
    TooManyTicks {
        /// Ticks of the run.
        ticks: u64,
        /// The base rate (Hz).
        rate: u32,
        /// Largest number of ticks.
        limit: u64,
    },
    /// A disturbance without any effect.
    #[error(
        "disturbance {} acts on no tick of the run, which ends at {end_of_run} s: it starts at {start} s and lasts \
         {duration} s",
        index + 1
    )]
    IdleDisturbance {
        /// Number of the disturbance, from 0.
        index: usize,
        /// First instant (s).
        start: f64,
        /// Duration (s).
        duration: f64,
        /// Last instant of the run (s).
        end_of_run: f64,
    },
    /// The recording would be too large.
    #[error(
        "recording {channels} channels at {rate} Hz for {duration} s takes {gigabytes:.1} GB, more than {limit} GB; \
         lower `record.rate` or name fewer `record.channels`"
    )]
    RecordingTooLarge {
        /// Number of channels.
        channels: usize,
        /// Recording rate (Hz).
        rate: u32,
        /// Length of the run (s).
        duration: f64,
        /// Size of the recording (GB).
        gigabytes: f64,
        /// Largest size (GB).
        limit: f64,
    },
    /// A channel that the recording does not have.
    #[error("`record.channels` names `{signal}`, which this axis does not have; it has {}", names(available))]
    UnknownChannel {
        /// Requested channel.
        signal: Signal,
        /// Available channels.
        available: Vec<Signal>,
    },
}

fn names(signals: &[Signal]) -> String {
    let names: Vec<&str> = signals.iter().map(|signal| signal.name()).collect();
    names.join(", ")
}

/// Checks that the run, or the step of its program, ends at `end` (s) within the longest run.
///
/// # Errors
/// [`BuildError::TooLong`] otherwise.
pub(crate) fn check_length(step: Option<usize>, end: f64) -> Result<(), BuildError> {
    if end <= LONGEST_RUN { Ok(()) } else { Err(BuildError::TooLong { step, end, limit: LONGEST_RUN }) }
}

/// Checks that a run does not exceed the largest number of ticks.
///
/// # Errors
/// [`BuildError::TooManyTicks`] otherwise.
pub(crate) fn check_ticks(ticks: u64, base_rate: Rate) -> Result<(), BuildError> {
    if ticks <= MOST_TICKS {
        return Ok(());
    }
    Err(BuildError::TooManyTicks { ticks, rate: base_rate.hertz(), limit: MOST_TICKS })
}

/// An FMU that cannot be used.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("FMU `{name}`: {}", in_one_line(mistakes))]
pub struct UnusableFmu {
    /// Index of the scenario's FMU, from 0.
    pub index: usize,
    /// Name of the FMU.
    pub name: String,
    /// Mistakes, at least one.
    pub mistakes: Vec<FmuMistake>,
}

fn in_one_line(all: &[impl Display]) -> String {
    all.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
}

impl From<ObjectsError> for BuildError {
    fn from(error: ObjectsError) -> Self {
        Self::Objects(Box::new(error))
    }
}

impl From<SdoError> for BuildError {
    fn from(error: SdoError) -> Self {
        ObjectsError::Refused(error).into()
    }
}

/// The key that would help, appended to the message.
const fn key_of(unsendable: &Unsendable) -> &'static str {
    match unsendable {
        Unsendable::Point { help: Help::CoarserUnit | Help::MorePoints, .. } => " (`bus.units`)",
        Unsendable::SubMode { .. } => " (`bus.trajectory_buffer`, `drive.objects.60C0h`)",
        Unsendable::Point { help: Help::OtherTimes, .. } => " (`bus.point_time` where they are those of a move)",
        Unsendable::Late { .. } => " (`bus.delay`, `bus.point_time`)",
        Unsendable::Point { .. } => "",
    }
}
