//! Parts that FMUs simulate.
use servobench_fmu_file::FmuFile;
use servobench_signals::Signal;

/// A Functional Mock-up Unit beside the axis, with its connections.
#[derive(Debug, Clone, PartialEq)]
pub struct Fmu {
    /// Name of the instance.
    pub name: String,
    /// The archive, its start values and where it runs.
    pub file: FmuFile,
    /// Time between two exchanges (base ticks).
    pub every: u32,
    /// Inputs: variable and the signal connected to it.
    pub inputs: Vec<(String, InputSource)>,
    /// Outputs: variable and the signal it provides.
    pub outputs: Vec<(String, LoopSignal)>,
    /// True if its efforts excite the axis, and so explain oscillations.
    pub excites: bool,
}

/// Source of an FMU input (SI).
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
    /// An output of another FMU, converted from its unit to SI.
    Fmu {
        /// Position among the scenario's FMUs.
        fmu: usize,
        /// Name of the output.
        variable: String,
    },
}

/// Signal of the loop that an output of an FMU can provide (SI).
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

impl Fmu {
    /// Signals by which it exerts an effort on the motor or the load.
    pub fn efforts(&self) -> impl Iterator<Item = LoopSignal> + '_ {
        let acts = |signal: &LoopSignal| matches!(signal, LoopSignal::MotorEffort | LoopSignal::LoadEffort);
        self.outputs.iter().map(|(_, signal)| *signal).filter(acts)
    }
}

impl LoopSignal {
    /// All signals.
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

    /// The corresponding signal of the axis.
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
