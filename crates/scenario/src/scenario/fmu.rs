//! Parts that somebody else simulates.
pub use crate::name_table::StartValue;
use servobench_signals::Signal;
use std::path::PathBuf;

/// A Functional Mock-up Unit and what it is connected to. `To` is what its outputs can be.
#[derive(Debug, Clone, PartialEq)]
pub struct Fmu<To> {
    /// Name of the instance.
    pub name: String,
    /// The archive.
    pub path: PathBuf,
    /// From exchange to exchange (base ticks).
    pub every: u32,
    /// Where it runs.
    pub isolation: Isolation,
    /// Whether its event mode is used, if it has one.
    pub event_mode: bool,
    /// How long one of its calls may take (s, real time).
    pub patience: f64,
    /// Memory that its process may take (MB).
    pub memory: u32,
    /// Start values by variable, in the order of the file.
    pub start: Vec<(String, StartValue)>,
    /// Inputs by variable with the signal that each is given.
    pub inputs: Vec<(String, InputSource)>,
    /// Outputs by variable with what each is.
    pub outputs: Vec<(String, To)>,
}

/// Where an FMU runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Isolation {
    /// In a process of its own.
    #[default]
    Process,
    /// In the bench's own process.
    None,
}

/// What an input of an FMU is given (SI).
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum InputSource {
    /// The time (s).
    Time,
    /// `shaft.position`: the motor's position in its own coordinate.
    ShaftPosition,
    /// `shaft.velocity`.
    ShaftVelocity,
    /// A signal of the axis.
    Signal(Signal),
    /// An output of another FMU, in that one's unit converted to SI.
    Fmu {
        /// Position among the scenario's FMUs.
        fmu: usize,
        /// Name of the output.
        variable: String,
    },
}

/// What an output of an FMU can be that simulates the mechanics.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BodySignal {
    /// `shaft.position`: the motor's position in its own coordinate.
    ShaftPosition,
    /// `shaft.velocity`.
    ShaftVelocity,
    /// `load.position`: the load's position in the axis coordinate.
    LoadPosition,
    /// `load.velocity`.
    LoadVelocity,
}

impl BodySignal {
    /// The name that files write.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::ShaftPosition => "shaft.position",
            Self::ShaftVelocity => "shaft.velocity",
            Self::LoadPosition => "load.position",
            Self::LoadVelocity => "load.velocity",
        }
    }
}

/// What an output of an FMU can be beside the axis (SI).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LoopSignal {
    /// `disturbance.motor`: an effort on the motor, in its own coordinate.
    MotorEffort,
    /// `disturbance.load`: an effort on the load, in the axis coordinate.
    LoadEffort,
    /// `setpoint.position`, instead of a program.
    SetpointPosition,
    /// `setpoint.velocity`.
    SetpointVelocity,
    /// `setpoint.acceleration`.
    SetpointAcceleration,
    /// `effort.motor`: the motor's effort, instead of drive and motor.
    Effort,
    /// `voltage.d`, instead of the drive's.
    VoltageD,
    /// `voltage.q`, instead of the drive's.
    VoltageQ,
}

impl LoopSignal {
    /// All of them.
    pub const ALL: &'static [Self] = &[
        Self::MotorEffort,
        Self::LoadEffort,
        Self::SetpointPosition,
        Self::SetpointVelocity,
        Self::SetpointAcceleration,
        Self::Effort,
        Self::VoltageD,
        Self::VoltageQ,
    ];

    /// The signal of the axis that the FMU gives.
    #[must_use]
    pub const fn signal(self) -> Signal {
        match self {
            Self::MotorEffort => Signal::DisturbanceMotor,
            Self::LoadEffort => Signal::DisturbanceLoad,
            Self::SetpointPosition => Signal::SetpointPosition,
            Self::SetpointVelocity => Signal::SetpointVelocity,
            Self::SetpointAcceleration => Signal::SetpointAcceleration,
            Self::Effort => Signal::EffortMotor,
            Self::VoltageD => Signal::VoltageD,
            Self::VoltageQ => Signal::VoltageQ,
        }
    }
}

/// How FMUs and the axis exchange what they give.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoSimulation {
    /// From exchange to exchange (base ticks).
    pub every: u32,
    /// Who steps when.
    pub method: CouplingMethod,
    /// Order with which inputs go on within a step, 0 to 2.
    pub extrapolation: u32,
    /// How well inputs and outputs agree after an iteration, relative to their size.
    pub tolerance: f64,
    /// How often a step may be repeated.
    pub iterations: u32,
}

/// Who steps when.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CouplingMethod {
    /// All at once.
    Jacobi,
    /// One after the other in the order of the file, the axis last.
    #[default]
    GaussSeidel,
    /// Repeated until inputs and outputs agree.
    Iterated,
}
