//! FMUs as plain data: which file, how it is started, and which of its variables are what.
use std::fmt::{self, Display, Formatter};
use std::path::PathBuf;
use std::time::Duration;

/// A functional mock-up unit (FMI 2.0 or 3.0, co-simulation) and how it is started.
#[derive(Debug, Clone, PartialEq)]
pub struct FmuFile {
    /// The file.
    pub path: PathBuf,
    /// What is set before it starts.
    pub start: Vec<FmuStart>,
    /// Where it runs.
    pub isolation: Isolation,
    /// Whether its event mode is used, if it has one (FMI 3.0); otherwise it deals with events by itself.
    pub event_mode: bool,
}

/// An FMU that is the mechanics of an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct FmuModel {
    /// The FMU.
    pub file: FmuFile,
    /// Input that takes the torque (N·m) or force (N) of the motor, in the motor's coordinate.
    pub effort: FmuPort,
    /// The body that the motor moves, in the motor's own coordinate.
    pub motor: FmuBody,
    /// The load, in the axis coordinate; `None` if the motor's body is both.
    pub load: Option<FmuBody>,
    /// Input that takes a disturbance of the motor's body, in its coordinate. Without one it is added to the effort, which is
    /// the same for a body that both act on.
    pub motor_disturbance: Option<FmuPort>,
    /// Input that takes a disturbance of the load, in the axis coordinate. Without one a single body gets it through the
    /// transmission; a load of its own can have none.
    pub load_disturbance: Option<FmuPort>,
    /// Axis coordinate per motor coordinate.
    pub transmission: f64,
    /// Base ticks between two exchanges with it, at least one.
    pub ticks: u32,
    /// How motion goes on between two exchanges.
    pub extrapolation: Extrapolation,
}

impl FmuModel {
    /// Inputs in the order in which they are exchanged: effort, disturbance of the motor, of the load.
    pub fn inputs(&self) -> impl Iterator<Item = &FmuPort> {
        std::iter::once(&self.effort).chain(&self.motor_disturbance).chain(&self.load_disturbance)
    }

    /// Outputs in the order in which they are exchanged: of each body position and velocity, if it has one.
    pub fn outputs(&self) -> impl Iterator<Item = &FmuPort> {
        self.bodies().flat_map(|body| std::iter::once(&body.position).chain(&body.velocity))
    }

    /// The bodies: the motor's first.
    pub fn bodies(&self) -> impl Iterator<Item = &FmuBody> {
        std::iter::once(&self.motor).chain(&self.load)
    }
}

/// An FMU beside an axis: a load, a controller, a source of signals.
#[derive(Debug, Clone, PartialEq)]
pub struct FmuPartner {
    /// The FMU.
    pub file: FmuFile,
    /// Name of the instance.
    pub name: String,
    /// Inputs that are exchanged.
    pub inputs: Vec<FmuPort>,
    /// Outputs that are exchanged.
    pub outputs: Vec<FmuPort>,
    /// How long its steps are (s).
    pub step: f64,
    /// When its last step ends (s): at the end of the run or after it, since steps are whole.
    pub end: f64,
}

/// A number that is exchanged with an FMU, in SI units. The FMU has it in the unit of its model description; what has none there
/// counts in SI units.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FmuPort {
    /// Name of the variable, or `name[2]`, `name[2,1]` of an element of an array, counted from 1.
    pub variable: String,
    /// What the number is on our side; `None` if it may be anything.
    pub unit: Option<SiUnit>,
}

/// An SI unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SiUnit {
    /// As people write it.
    pub name: String,
    /// Exponents of kilogram, metre, second and ampere. The radian, which some count and some do not, is one.
    pub exponents: [i32; 4],
}

/// Outputs of an FMU that are a body's motion.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FmuBody {
    /// Its position.
    pub position: FmuPort,
    /// Its velocity. Without one it is taken from the last positions, and is late by half a step between two exchanges.
    pub velocity: Option<FmuPort>,
}

/// A parameter or an initial value.
#[derive(Debug, Clone, PartialEq)]
pub struct FmuStart {
    /// Name of the variable.
    pub variable: String,
    /// Its value, or those of its elements in row-major order.
    pub values: Vec<FmuValue>,
}

/// A value for an FMU.
#[derive(Debug, Clone, PartialEq)]
pub enum FmuValue {
    /// A number in the unit of the variable, an integer, or the value of an item of an enumeration.
    Number(f64),
    /// A number with a unit, which may also be just a text.
    Quantity {
        /// As it was written.
        text: String,
        /// In SI units.
        si: f64,
        /// Exponents of kilogram, metre, second and ampere in its unit.
        exponents: [i32; 4],
    },
    /// TRUE or FALSE.
    Boolean(bool),
    /// Text.
    Text(String),
}

/// How motion goes on between two exchanges with an FMU.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Extrapolation {
    /// It stands still.
    Hold,
    /// With the velocity.
    #[default]
    Linear,
    /// With velocity and acceleration, by the last two or three exchanges.
    Quadratic,
}

/// Where an FMU runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Isolation {
    /// In this process: it is trusted.
    None,
    /// In a process of its own.
    Process {
        /// Real time that it may take for any one call.
        patience: Duration,
        /// Memory that it may have (B).
        memory: u64,
    },
}

/// What of an FMU's data does not fit its file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FmuMistake {
    /// Which part of the data.
    pub at: FmuEntry,
    /// What is wrong.
    pub message: String,
    /// What to do; may be empty.
    pub way_out: String,
}

/// A part of what is said of an FMU.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FmuEntry {
    /// The file itself.
    File,
    /// What it does: it crashed or did not come back, which is nobody's data.
    Conduct,
    /// The length of its steps.
    Step,
    /// Whether its event mode is used.
    EventMode,
    /// The start value of this variable.
    Start(String),
    /// This input.
    Input(String),
    /// This output.
    Output(String),
}

impl FmuMistake {
    /// Something that is wrong with the file itself.
    #[must_use]
    pub fn of_file(error: &impl Display) -> Self {
        Self { at: FmuEntry::File, message: error.to_string(), way_out: String::new() }
    }
}

impl Display for FmuMistake {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        if self.way_out.is_empty() { Ok(()) } else { write!(f, "; {}", self.way_out) }
    }
}
