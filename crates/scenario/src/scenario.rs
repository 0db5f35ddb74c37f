//! A scenario with every name resolved, every quantity in SI and every rule checked: the input of the closed loop.
//!
//! The coordinate of a rotary motor is in rad, that of a linear motor in m. The axis coordinate is the load's: rad or m, see
//! [`Axis::motion`]. "Effort" is a torque or a force, whichever fits the coordinate.

mod actuator;
mod axis;
mod bus;
mod disturbance;
mod drive;
mod fmu;
mod plc;
mod program;
mod requirements;

pub use actuator::{Actuator, IdleMotor};
pub use axis::{Axis, AxisMechanics};
pub use bus::{Bus, BusMode, DriveUnits, ObjectWrite};
pub use disturbance::{Disturbance, DisturbedBody, Initial};
pub use drive::{Drive, Feedback};
pub use fmu::{Fmu, InputSource, LoopSignal};
pub use plc::Plc;
pub use program::{Interpolation, MoveStep, Step};
pub use requirements::Requirements;

use crate::overrides::Override;
use crate::parameters::Parameter;
use servobench_base::Rate;
use servobench_files::MadeOf;
use servobench_metrics::{DisplayUnits, Limit, Question};
use servobench_plant::EngineName;
use servobench_signals::Signal;
use std::path::PathBuf;

/// Longest run (s), 11.6 days. At the highest base rate it has fewer than 2⁵³ ticks: the time of every tick is exact.
pub const LONGEST_RUN: f64 = 1e6;

/// Largest number of ticks of a run: 25 minutes of the engine `exact`, a week at 16 kHz.
pub const MOST_TICKS: u64 = 10_000_000_000;

/// Bound of the wall-clock time of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TimeBound {
    /// No bound.
    Unlimited,
    /// At most this time (s).
    AtMost(f64),
}

impl TimeBound {
    /// The bound (s), if there is one.
    #[must_use]
    pub const fn seconds(self) -> Option<f64> {
        match self {
            Self::Unlimited => None,
            Self::AtMost(seconds) => Some(seconds),
        }
    }
}

/// One experiment: an axis, a program of moves, the measures and the limits that make it pass or fail.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// Name in tables and results; default: the file's stem.
    pub name: String,
    /// Purpose in one sentence.
    pub description: String,
    /// Path of the file; `None` for text.
    pub path: Option<PathBuf>,
    /// Engines of the run, at least one, in the order given.
    pub engines: Vec<EngineName>,
    /// Base rate: one tick of mechanics.
    pub base_rate: Rate,
    /// Length of the run (s); `None`: the program and half a second.
    pub duration: Option<f64>,
    /// Bound of the wall-clock time; `None`: not given.
    pub time_limit: Option<TimeBound>,
    /// Warnings about its files, each after its place.
    pub warnings: Vec<String>,
    /// The mechanics.
    pub axis: Axis,
    /// Motor, drive or prescribed motion of the axis.
    pub actuator: Actuator,
    /// Moves and pauses in sequence from time 0; empty with a PLC program.
    pub program: Vec<Step>,
    /// Interpolation between the set-point and the drive; `None`: the drive has a new set-point at every tick.
    pub interpolation: Option<Interpolation>,
    /// The fieldbus; `None`: the drive has a new set-point at every tick.
    pub bus: Option<Bus>,
    /// The PLC program, which needs a fieldbus; `None` without one.
    pub plc: Option<Plc>,
    /// Parts that FMUs simulate beside the axis.
    pub fmus: Vec<Fmu>,
    /// Exchange of values between the FMUs and the axis.
    pub coupling: servobench_coupling::Settings,
    /// External efforts.
    pub disturbances: Vec<Disturbance>,
    /// Deviation from rest at zero at time 0.
    pub initial: Initial,
    /// Recorded signals.
    pub record: Record,
    /// Parameters of the measures.
    pub measure: Question,
    /// Requirements in addition to its limits.
    pub requirements: Requirements,
    /// Limits that make it pass or fail, in the order of the file.
    pub limits: Vec<Limit>,
    /// Values of the file key by key, models and overrides merged in.
    pub parameters: Vec<Parameter>,
    /// Units in which the file gives positions and their derivatives.
    pub units: DisplayUnits,
    /// Keys with a value that replaces the file's.
    pub overrides: Vec<Override>,
    /// Folder above all files it names, links resolved; `None` for a scenario without a folder.
    pub root: Option<PathBuf>,
    /// Files that it is made of, itself first, in the order in which they are read.
    pub made_of: Vec<MadeOf>,
}

impl Scenario {
    /// −1 for a motor mounted the other way round, so that motor and encoders count against the axis; otherwise 1.
    #[must_use]
    pub fn direction(&self) -> f64 {
        self.bus.as_ref().map_or(1.0, |bus| bus.units.direction())
    }
}

/// Recorded signals and their rate.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Rate of the recording; divides the base rate.
    pub rate: Rate,
    /// Signals to keep; empty for all.
    pub channels: Vec<Signal>,
}
