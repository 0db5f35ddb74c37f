//! Equipment of an axis, and thereby its signals, their writers and rates.
use servobench_base::{AxisName, Coordinate, Rate};

/// Equipment of an axis.
#[derive(Debug, Clone, Copy)]
pub struct Equipment {
    /// Name of the axis, where it has one.
    pub name: Option<AxisName>,
    /// Coordinate of the load.
    pub axis: Coordinate,
    /// Coordinate of the motor.
    pub motor_coordinate: Coordinate,
    /// True with a body between motor and load.
    pub table: bool,
    /// True for the motor, and for the load, if something disturbs it.
    pub disturbed: [bool; 2],
    /// True if the load meets stops at the ends of its travel.
    pub end_stops: bool,
    /// Effects of the inverter beside the voltage that it gives.
    pub inverter: InverterEffects,
    /// True with a fieldbus between the motion task and the drive.
    pub bus: bool,
    /// Effects of the motor beside its equations.
    pub effects: MotorEffects,
    /// Sensors with errors, whose readings differ from the true values.
    pub erring: Erring,
    /// Amplifier commanded by the firmware; `None` without firmware.
    pub amplifier: Option<Amplifier>,
    /// Quantities of the motor, from the firmware or from an FMU in its place.
    pub motor: Motor,
}

/// Effects that an ideal inverter lacks, as far as they have signals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct InverterEffects {
    /// Its devices have losses.
    pub losses: bool,
    /// Its devices switch.
    pub switching: bool,
    /// The voltage of its DC link changes.
    pub link: bool,
}

/// Effects of a motor beside its equations, as far as they have signals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct MotorEffects {
    /// True with a loss in its iron.
    pub iron_loss: bool,
    /// True if winding and housing warm up.
    pub thermal_model: bool,
}

/// Sensors with errors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Erring {
    /// The encoder on the motor, and that on the load if it closes the position loop.
    pub encoders: [bool; 2],
    /// The current sensors, or the angle for the conversion of their currents.
    pub current: bool,
    /// The velocity, which the drive measures by a separate method.
    pub velocity: bool,
}

/// Available quantities of a motor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motor {
    /// None: it is off, or follows the set-point exactly.
    Motion,
    /// An effort.
    Effort,
    /// Currents and voltages too.
    Currents,
}

/// Amplifier commanded by the firmware.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Amplifier {
    /// The currents of a synchronous motor.
    Current,
    /// An ideal source.
    Ideal {
        /// Unit of its output.
        output_unit: &'static str,
    },
}

/// Declares [`Presence`] once: variant and meaning.
macro_rules! presences {
    ($($variant:ident $meaning:literal,)+) => {
        /// Condition on which an axis has a signal.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Presence {
            $(#[doc = $meaning] $variant,)+
        }

        impl Presence {
            /// Its meaning in a few words.
            #[must_use]
            pub const fn meaning(self) -> &'static str {
                match self { $(Self::$variant => $meaning,)+ }
            }
        }
    };
}

presences! {
    Always "always",
    OnBus "with a fieldbus",
    WithTable "with a body between motor and load",
    WithFirmware "with firmware",
    WithCurrentLoop "with a current loop",
    WithEffort "with a motor that has an effort",
    WithCurrents "with a motor that has currents",
    WithOutput "with an ideal source",
    MotorDisturbed "with a disturbance of the motor",
    LoadDisturbed "with a disturbance of the load",
    WithEndStops "with stops at the ends of the travel",
    WithIronLoss "with a motor that has iron losses",
    WithThermalModel "with a motor that has a thermal model",
    MotorEncoderErrs "where the encoder on the motor has errors",
    LoadEncoderErrs "where the encoder on the load has errors",
    CurrentErrs "where the measured current has errors",
    MeasuresVelocity "where the drive measures the velocity by a separate method",
    WithInverter "with an inverter that is not ideal",
    WithSwitching "with an inverter that switches",
    WithLink "with a DC link whose voltage changes",
}

impl Presence {
    /// True if an axis with `equipment` has the signal.
    #[must_use]
    pub fn holds(self, equipment: &Equipment) -> bool {
        match self {
            Self::Always => true,
            Self::OnBus => equipment.bus,
            Self::WithTable => equipment.table,
            Self::WithFirmware => equipment.amplifier.is_some(),
            Self::WithCurrentLoop => equipment.amplifier == Some(Amplifier::Current),
            Self::WithEffort => equipment.motor != Motor::Motion,
            Self::WithCurrents => equipment.motor == Motor::Currents,
            Self::WithOutput => matches!(equipment.amplifier, Some(Amplifier::Ideal { .. })),
            Self::MotorDisturbed => equipment.disturbed[0],
            Self::LoadDisturbed => equipment.disturbed[1],
            Self::WithEndStops => equipment.end_stops,
            Self::WithIronLoss => equipment.effects.iron_loss,
            Self::WithThermalModel => equipment.effects.thermal_model,
            Self::MotorEncoderErrs => equipment.erring.encoders[0],
            Self::LoadEncoderErrs => equipment.erring.encoders[1],
            Self::CurrentErrs => equipment.erring.current,
            Self::MeasuresVelocity => equipment.erring.velocity,
            Self::WithInverter => equipment.inverter.losses,
            Self::WithSwitching => equipment.inverter.switching && equipment.motor == Motor::Currents,
            Self::WithLink => equipment.inverter.link,
        }
    }
}

/// Stage of the loop that writes a signal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Writer {
    /// The task: requests of moves, tables and function blocks to the axis.
    Task,
    /// The motion task behind a fieldbus.
    MotionTask,
    /// The fieldbus.
    Fieldbus,
    /// The master on the bus, which interpolates between two samples of the motion task.
    Master,
    /// The generator of set-points, or their interpolation.
    SetPoint,
    /// The mechanics.
    Mechanics,
    /// The position loop.
    PositionLoop,
    /// The velocity loop.
    VelocityLoop,
    /// The current loop.
    CurrentLoop,
    /// The current loop, or the controller that replaces it.
    Commander,
    /// A measurement from outside.
    Measurement,
    /// Inverter and motor, or the ideal source.
    PowerStage,
    /// The motor.
    Motor,
    /// A disturbance.
    Disturbance,
    /// The encoders.
    Encoder,
}

/// Rates of the writers.
#[derive(Debug, Clone, Copy)]
pub struct Rates {
    /// Base rate of the run.
    pub base: Rate,
    /// Rate of the motion task behind a fieldbus.
    pub task: Rate,
    /// Rate of the fieldbus.
    pub bus: Rate,
    /// Rate of the position loop.
    pub position: Rate,
    /// Rate of the velocity loop.
    pub velocity: Rate,
    /// Rate of the current loop.
    pub current: Rate,
}

impl Writer {
    /// Its name in recordings.
    #[must_use]
    pub fn name(self, equipment: &Equipment) -> &'static str {
        match self {
            Self::Task => "task",
            Self::MotionTask => "motion task",
            Self::Fieldbus => "fieldbus",
            Self::Master => "master",
            Self::SetPoint => "set-point",
            Self::Mechanics => "mechanics",
            Self::PositionLoop => "position loop",
            Self::VelocityLoop => "velocity loop",
            Self::CurrentLoop => "current loop",
            Self::Commander if equipment.amplifier == Some(Amplifier::Current) => "current loop",
            Self::Commander => "controller",
            Self::Measurement => "measurement",
            Self::PowerStage => "power stage",
            Self::Motor => "motor",
            Self::Disturbance => "disturbance",
            Self::Encoder => "encoder",
        }
    }

    /// Rate at which it writes.
    #[must_use]
    pub const fn rate(self, rates: &Rates) -> Rate {
        match self {
            Self::MotionTask => rates.task,
            Self::Fieldbus | Self::Master => rates.bus,
            Self::PositionLoop => rates.position,
            Self::VelocityLoop => rates.velocity,
            Self::CurrentLoop | Self::Commander => rates.current,
            Self::Task
            | Self::SetPoint
            | Self::Mechanics
            | Self::Measurement
            | Self::PowerStage
            | Self::Motor
            | Self::Disturbance
            | Self::Encoder => rates.base,
        }
    }
}
