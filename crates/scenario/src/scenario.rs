//! A scenario with every name resolved, every quantity in SI and every rule checked: what the closed loop is built from.
//!
//! A rotary motor's own coordinate is rad, a linear one's m. The axis coordinate is the load's: rad or m, as
//! [`Axis::motion`] says. "Effort" is a torque or a force, whichever fits the coordinate.

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

/// Longest run (s), 11.6 days. At the highest base rate its ticks are fewer than 2⁵³: the time of every tick is exact.
pub const LONGEST_RUN: f64 = 1e6;

/// Most ticks of a run: 25 minutes of the engine `exact`, a week at 16 kHz.
pub const MOST_TICKS: u64 = 10_000_000_000;

/// Bound of the time of a run by the clock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TimeBound {
    /// As long as it needs.
    Unlimited,
    /// So long (s).
    AtMost(f64),
}

impl TimeBound {
    /// The bound (s), where there is one.
    #[must_use]
    pub const fn seconds(self) -> Option<f64> {
        match self {
            Self::Unlimited => None,
            Self::AtMost(seconds) => Some(seconds),
        }
    }
}

/// One experiment: an axis, a program of moves, what to measure and the limits that make it pass or fail.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// Name in tables and results; default: the file's stem.
    pub name: String,
    /// What it shows, in a sentence.
    pub description: String,
    /// File it came from; `None` for text.
    pub path: Option<PathBuf>,
    /// Engines to run it on, at least one, in the order given.
    pub engines: Vec<EngineName>,
    /// Base rate: one tick of mechanics.
    pub base_rate: Rate,
    /// Length of the run (s); `None`: the program and half a second.
    pub duration: Option<f64>,
    /// Bound of the time by the clock; `None`: not given.
    pub time_limit: Option<TimeBound>,
    /// Doubts about its files, each behind its place.
    pub warnings: Vec<String>,
    /// The mechanics.
    pub axis: Axis,
    /// What moves it, and what commands that.
    pub actuator: Actuator,
    /// Moves and pauses, one after the other, from time 0; none where there is a PLC program.
    pub program: Vec<Step>,
    /// Between the set-point and the drive; `None`: the drive has a new set-point at every tick.
    pub interpolation: Option<Interpolation>,
    /// The fieldbus; `None`: the drive has a new set-point at every tick.
    pub bus: Option<Bus>,
    /// The PLC program, which needs a fieldbus; `None` without one.
    pub plc: Option<Plc>,
    /// Parts that FMUs simulate beside the axis.
    pub fmus: Vec<Fmu>,
    /// How they and the axis exchange what they give.
    pub coupling: servobench_coupling::Settings,
    /// External efforts.
    pub disturbances: Vec<Disturbance>,
    /// Deviation from rest at zero at time 0.
    pub initial: Initial,
    /// What to record.
    pub record: Record,
    /// What the measures need to know.
    pub measure: Question,
    /// What it is held to beside its limits.
    pub requirements: Requirements,
    /// What makes it pass or fail, in the order of the file.
    pub limits: Vec<Limit>,
    /// What the file says, models and overrides merged in, key by key.
    pub parameters: Vec<Parameter>,
    /// Units in which the file gives positions and their derivatives.
    pub units: DisplayUnits,
    /// Keys that have another value than the file gives them.
    pub overrides: Vec<Override>,
    /// The folder that all files it names are below, links resolved; `None` for a scenario without a folder.
    pub root: Option<PathBuf>,
    /// The files that it is made of, itself first, in the order in which they are read.
    pub made_of: Vec<MadeOf>,
}

impl Scenario {
    /// −1 for a motor that is mounted the other way round, so that it and its encoders count against the axis; otherwise 1.
    #[must_use]
    pub fn direction(&self) -> f64 {
        self.bus.as_ref().map_or(1.0, |bus| bus.units.direction())
    }
}

/// What to record.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Rate of the recording; divides the base rate.
    pub rate: Rate,
    /// Signals to keep; empty for all.
    pub channels: Vec<Signal>,
}
