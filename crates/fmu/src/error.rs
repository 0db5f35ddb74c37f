//! Errors while writing an FMU, and reasons for refusing a call of the standard.
use servobench_sim::BuildError;
use std::path::PathBuf;
use thiserror::Error;

/// Reasons why a scenario cannot become an FMU.
#[derive(Debug, Error)]
pub enum FmuError {
    /// The loop cannot be built with the mechanics of the engine `exact`, which the FMU contains.
    #[error("`{scenario}` cannot be built on the engine `exact`, which is the one in an FMU: {error}")]
    Build {
        /// Name of the scenario.
        scenario: String,
        /// Error of the construction.
        error: BuildError,
    },
    /// The scenario has no drive to export.
    #[error("`{scenario}` has no drive: `--part axis` or `--part mechanics` can be exported")]
    NoDrive {
        /// Name of the scenario.
        scenario: String,
    },
    /// The drive's coordinate is opposite to that of its mechanics.
    #[error(
        "the motor of `{scenario}` is mounted the other way round (`bus.units`), so that its torque alone has the wrong sign for the \
         mechanics: export `--part axis`"
    )]
    Reversed {
        /// Name of the scenario.
        scenario: String,
    },
    /// Other FMUs belong to the loop.
    #[error(
        "`{scenario}` has `[[fmu]]` beside the axis, which cannot be inside an FMU: leave them out, and connect them outside"
    )]
    Beside {
        /// Name of the scenario.
        scenario: String,
    },
    /// The path of a table has no place in an archive.
    #[error("`{path}` cannot be packed: name the table by a path relative to the scenario's folder")]
    Path {
        /// The path as in the scenario.
        path: String,
    },
    /// The library to put into an FMU is missing.
    #[error(
        "there is no library to put into an FMU, neither at {looked}: build it with `cargo build --release -p servobench-fmu`"
    )]
    NoLibrary {
        /// Places that were searched.
        looked: String,
    },
    /// The library cannot be read.
    #[error("cannot read `{}`: {error}", path.display())]
    Read {
        /// Path of the library.
        path: PathBuf,
        /// Error of the system.
        error: std::io::Error,
    },
    /// The library is not for the platform of the FMU.
    #[error("the library is none for Linux on x86-64 (ELF): build it with `cargo build --release -p servobench-fmu`")]
    Library,
    /// The archive cannot be written.
    #[error("the archive cannot be written: {0}")]
    Archive(String),
}

/// Reasons for refusing a call.
#[derive(Debug, Clone, PartialEq, Error)]
pub(crate) enum Refusal {
    #[error("it is not allowed in {phase}: {allowed}")]
    Phase { phase: &'static str, allowed: &'static str },
    #[error("it is not supported: {why}")]
    Unsupported { why: &'static str },
    #[error("there is no variable with the value reference {reference}; there are {count}, from 0")]
    Reference { reference: u32, count: usize },
    #[error("`{name}` (value reference {reference}) is of the type {is}, not {asked}")]
    Type { name: String, reference: u32, is: &'static str, asked: &'static str },
    #[error("`{name}` cannot be set: it is {what}")]
    NotSettable { name: String, what: &'static str },
    #[error("`{name}` cannot be read before initialization mode: its value is calculated")]
    NotYet { name: String },
    #[error("`{name}` takes {}, got {value}", values(*min, *max))]
    Range { name: String, min: f64, max: f64, value: f64 },
    #[error("{given} values for {wanted} value references of scalars")]
    Length { given: usize, wanted: usize },
    #[error("`{argument}` is NULL")]
    Null { argument: &'static str },
    #[error("`{argument}` must be finite{and}, got {value}")]
    Number { argument: &'static str, and: &'static str, value: f64 },
    #[error("the communication point {given} s is not the time of the FMU, {now} s")]
    Point { given: f64, now: f64 },
    #[error(
        "the step of {length} s from {from} s is no whole number of base ticks of 1/{rate} s, and never fits: step by multiples of \
         {tick} s"
    )]
    Step { from: f64, length: f64, rate: u32, tick: f64 },
    #[error("the step to {to} s goes beyond the stop time {stop} s")]
    Stop { to: f64, stop: f64 },
    #[error("the scenario cannot be built with these parameters: {0}")]
    Build(String),
    #[error("{0}")]
    Failed(String),
    #[error("the target cannot be moved to: {0}")]
    Move(String),
    #[error("the bytes are no state of this FMU: {why}")]
    State { why: &'static str },
    #[error("the state takes {wanted} bytes, the buffer has {given}")]
    Size { given: usize, wanted: usize },
}

/// Values that a variable takes.
fn values(min: f64, max: f64) -> String {
    match (min > f64::MIN, max < f64::MAX) {
        (true, true) => format!("values from {min} to {max}"),
        (true, false) if min > 0.0 => "finite values above zero".into(),
        (true, false) => "finite values from zero on".into(),
        (false, _) => "finite values".into(),
    }
}
