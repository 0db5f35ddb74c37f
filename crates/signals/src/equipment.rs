//! What an axis has, and with it which signals, from whom and how often.
use servobench_base::{Coordinate, Rate};

/// What an axis has.
#[derive(Debug, Clone, Copy)]
pub struct Equipment {
    /// Coordinate of the load.
    pub axis: Coordinate,
    /// Coordinate of the motor.
    pub motor_coordinate: Coordinate,
    /// Whether there is a body between motor and load.
    pub table: bool,
    /// Whether something disturbs the motor, and the load.
    pub disturbed: [bool; 2],
    /// Whether the load meets stops at the ends of its travel.
    pub end_stops: bool,
    /// Effects of the inverter beside the voltage that it gives.
    pub inverter: InverterEffects,
    /// Whether there is a fieldbus between the motion task and the drive.
    pub bus: bool,
    /// What the motor has beside its equations.
    pub effects: MotorEffects,
    /// Which sensors err, so that what they say is not what is there.
    pub erring: Erring,
    /// What the firmware commands; `None` without firmware.
    pub amplifier: Option<Amplifier>,
    /// What the motor has: by the firmware, or by an FMU in its place.
    pub motor: Motor,
}

/// Effects of an inverter that an ideal one lacks, as far as they have signals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct InverterEffects {
    /// Its devices have losses.
    pub losses: bool,
    /// It switches.
    pub switching: bool,
    /// The voltage of its DC link changes.
    pub link: bool,
}

/// What a motor has beside its equations, as far as that has signals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct MotorEffects {
    /// Whether there is a loss in its iron.
    pub iron_loss: bool,
    /// Whether winding and housing warm up.
    pub thermal_model: bool,
}

/// Which sensors err.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Erring {
    /// The encoder on the motor, and that on the load where it closes the position loop.
    pub encoders: [bool; 2],
    /// The current sensors, or the angle by which their currents are known.
    pub current: bool,
    /// The velocity, which the drive measures by a method of its own.
    pub velocity: bool,
}

/// What there is of a motor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motor {
    /// Nothing: it is off, or follows the set-point exactly.
    Motion,
    /// An effort.
    Effort,
    /// Currents and voltages too.
    Currents,
}

/// What the firmware commands.
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
        /// When an axis has a signal.
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
    MotorDisturbed "where something disturbs the motor",
    LoadDisturbed "where something disturbs the load",
    WithEndStops "with stops at the ends of the travel",
    WithIronLoss "with a motor that has a loss in its iron",
    WithThermalModel "with a motor that warms up",
    MotorEncoderErrs "where the encoder on the motor errs",
    LoadEncoderErrs "where the encoder on the load errs",
    CurrentErrs "where the measured current errs",
    MeasuresVelocity "where the drive measures the velocity by a method of its own",
    WithInverter "with an inverter that is not ideal",
    WithSwitching "with an inverter that switches",
    WithLink "with a DC link whose voltage changes",
}

impl Presence {
    /// Whether an axis with `equipment` has it.
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
    /// The task: what moves, tables and function blocks want of the axis.
    Task,
    /// The motion task behind a fieldbus.
    MotionTask,
    /// The fieldbus.
    Fieldbus,
    /// The master on it, which fills the time between two samples of the motion task.
    Master,
    /// The generator of set-points, or what interpolates them.
    SetPoint,
    /// The mechanics.
    Mechanics,
    /// The position loop.
    PositionLoop,
    /// The velocity loop.
    VelocityLoop,
    /// The current loop.
    CurrentLoop,
    /// The current loop, or the controller that stands in its place.
    Commander,
    /// What is measured from outside.
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

/// How often the writers renew what they write.
#[derive(Debug, Clone, Copy)]
pub struct Rates {
    /// Base rate of the run.
    pub base: Rate,
    /// Of the motion task behind a fieldbus.
    pub task: Rate,
    /// Of the fieldbus.
    pub bus: Rate,
    /// Of the position loop.
    pub position: Rate,
    /// Of the velocity loop.
    pub velocity: Rate,
    /// Of the current loop.
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

    /// How often it writes.
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
