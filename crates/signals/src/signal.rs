//! The list of signals.
use crate::equipment::{Equipment, Presence, Rates, Writer};
use crate::instant::Instant;
use crate::unit::Unit;
use servobench_trace::{BLOCK, ChannelSpec, Column, Row};
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// Declares the signals once: identifier, name, unit, writer, presence, value; meaning.
macro_rules! signals {
    ($(
        $signal:ident $name:literal $unit:ident $(($power:literal))? $writer:ident $presence:ident |$now:ident| $value:expr;
        $meaning:literal;
    )+) => {
        /// A signal of an axis; the order is that of a recording's columns.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Signal {
            $(#[doc = $meaning] $signal,)+
        }

        impl Signal {
            /// Every signal, in the order of a recording's columns.
            pub const ALL: &'static [Self] = &[$(Self::$signal,)+];

            /// Its name in recordings, files and viewers.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$signal => $name,)+ }
            }

            /// Its unit.
            #[must_use]
            pub const fn unit(self) -> Unit {
                match self { $(Self::$signal => Unit::$unit $(($power))?,)+ }
            }

            /// Stage that writes it.
            #[must_use]
            pub const fn writer(self) -> Writer {
                match self { $(Self::$signal => Writer::$writer,)+ }
            }

            /// Condition under which an axis has it.
            #[must_use]
            pub const fn presence(self) -> Presence {
                match self { $(Self::$signal => Presence::$presence,)+ }
            }

            /// Its meaning, in words.
            #[must_use]
            pub const fn meaning(self) -> &'static str {
                match self { $(Self::$signal => $meaning,)+ }
            }
        }

        /// The values of all signals.
        #[inline]
        pub(crate) fn row(now: &Instant) -> [f64; COUNT] {
            [$({
                let $now = now;
                $value
            },)+]
        }

        /// Writes the same at place `at` of their columns.
        #[inline]
        fn put(now: &Instant, columns: &mut [Column; COUNT], at: usize) {
            // One check for all of them.
            assert!(at < BLOCK, "a block has no row {at}");
            $(columns[Signal::$signal as usize][at] = {
                let $now = now;
                $value
            };)+
        }
    };
}

/// Number of signals.
pub(crate) const COUNT: usize = Signal::ALL.len();

signals! {
    RequestPosition "request.position" Axis(0) Task Always |now| now.request.x;
        "position that the task requests of the load, delayed by the transport to the loops; that of the load where none is requested";
    RequestVelocity "request.velocity" Axis(1) Task Always |now| now.request.v;
        "velocity that the task requests";
    RequestEffort "request.effort" MotorEffort Task OnBus |now| now.requested_effort;
        "torque or force that the task requests; 0 where none is requested";
    TaskPosition "task.position" Axis(0) MotionTask OnBus |now| now.task.x;
        "set-point of the motion task, before the bus";
    TaskVelocity "task.velocity" Axis(1) MotionTask OnBus |now| now.task.v;
        "its velocity";
    BusPosition "bus.position" Axis(0) Fieldbus OnBus |now| now.bus_position;
        "actual position that the master reads";
    LinkPosition "link.position" Axis(0) Master OnBus |now| now.put_out.x;
        "position that the master outputs between samples of the motion task: held for a bus cycle, not yet rounded to units of the drive";
    LinkVelocity "link.velocity" Axis(1) Master OnBus |now| now.put_out.v;
        "its velocity";
    LinkAcceleration "link.acceleration" Axis(2) Master OnBus |now| now.put_out.a;
        "its acceleration";
    LinkEffort "link.effort" MotorEffort Master OnBus |now| now.put_out_effort;
        "torque or force that the master outputs with it";
    SetpointPosition "setpoint.position" Axis(0) SetPoint Always |now| now.setpoint.x;
        "position of the set-point";
    SetpointVelocity "setpoint.velocity" Axis(1) SetPoint Always |now| now.setpoint.v;
        "its velocity";
    SetpointAcceleration "setpoint.acceleration" Axis(2) SetPoint Always |now| now.setpoint.a;
        "its acceleration";
    SetpointJerk "setpoint.jerk" Axis(3) SetPoint Always |now| now.setpoint.j;
        "its jerk";
    SetpointSnap "setpoint.snap" Axis(4) SetPoint Always |now| now.setpoint.s;
        "its snap";
    MotorPosition "motor.position" Axis(0) Mechanics Always |now| now.motor.position;
        "position of the motor, in the axis coordinate";
    MotorVelocity "motor.velocity" Axis(1) Mechanics Always |now| now.motor.velocity;
        "its velocity";
    TablePosition "table.position" Axis(0) Mechanics WithTable |now| now.table.position;
        "position of the body between motor and load";
    TableVelocity "table.velocity" Axis(1) Mechanics WithTable |now| now.table.velocity;
        "its velocity";
    LoadPosition "load.position" Axis(0) Mechanics Always |now| now.load.position;
        "position of the load";
    LoadVelocity "load.velocity" Axis(1) Mechanics Always |now| now.load.velocity;
        "its velocity";
    ReferencePosition "reference.position" Axis(0) PositionLoop WithFirmware |now| now.reference;
        "reference of the load, delayed to match the feedforward path";
    ReferenceMotorPosition "reference.motor_position" Axis(0) PositionLoop WithFirmware |now| now.motor_reference;
        "reference of the motor";
    VelocityReference "velocity.reference" Axis(1) VelocityLoop WithFirmware |now| now.velocity_reference;
        "velocity command, in the axis coordinate";
    FollowingErrorMotor "following_error.motor" Axis(0) Measurement Always |now| now.following_error[0];
        "motor reference minus motor position";
    FollowingErrorLoad "following_error.load" Axis(0) Measurement Always |now| now.following_error[1];
        "load reference minus load position";
    EffortReference "effort.reference" MotorEffort VelocityLoop WithFirmware |now| now.effort_reference;
        "torque or force that the velocity loop requests";
    EffortMotor "effort.motor" MotorEffort PowerStage WithEffort |now| now.effort;
        "torque or force of the motor";
    CurrentD "current.d" Ampere Motor WithCurrents |now| now.current.d;
        "d-axis current, amplitude";
    CurrentQ "current.q" Ampere Motor WithCurrents |now| now.current.q;
        "q-axis current, amplitude";
    CurrentQReference "current.q_reference" Ampere CurrentLoop WithCurrentLoop |now| now.current_reference;
        "reference of the q-axis current";
    VoltageDReference "voltage.d_reference" Volt Commander WithCurrents |now| now.voltage_reference.d;
        "d-axis voltage that the current loop requests, amplitude; the inverter applies it a period later";
    VoltageQReference "voltage.q_reference" Volt Commander WithCurrents |now| now.voltage_reference.q;
        "q-axis voltage that the current loop requests, amplitude";
    VoltageD "voltage.d" Volt PowerStage WithCurrents |now| now.voltage.d;
        "d-axis voltage of the inverter in the middle of the tick that begins, amplitude";
    VoltageQ "voltage.q" Volt PowerStage WithCurrents |now| now.voltage.q;
        "q-axis voltage of the inverter in the middle of the tick that begins, amplitude";
    VoltageMagnitude "voltage.magnitude" Volt PowerStage WithCurrents |now| now.voltage.magnitude();
        "length of the inverter's voltage vector";
    PowerElectrical "power.electrical" Watt PowerStage WithCurrents |now| now.power.electrical;
        "electrical power of the motor, mean over the tick that ends";
    PowerCopper "power.copper" Watt PowerStage WithCurrents |now| now.power.copper;
        "loss in the winding, mean over the tick that ends";
    PowerIron "power.iron" Watt PowerStage WithIronLoss |now| now.power.iron;
        "loss in the iron, mean over the tick that ends; where the motor has one";
    PowerStored "power.stored" Watt PowerStage WithCurrents |now| now.power.stored;
        "power into the field of the inductances, mean over the tick that ends";
    PowerAirGap "power.air_gap" Watt PowerStage WithCurrents |now| now.power.air_gap;
        "torque or force times the velocity that the motor's equations used, mean over the tick that ends";
    PowerShaft "power.shaft" Watt PowerStage WithEffort |now| now.shaft_power;
        "torque or force times the travel of the motor per time, over the tick that ends";
    PowerResidual "power.residual" Watt PowerStage WithCurrents |now| now.power.air_gap - now.shaft_power;
        "air-gap power minus shaft power: power added by coupling motor and mechanics tick by tick";
    TemperatureWinding "temperature.winding" Celsius Motor WithThermalModel |now| now.temperatures.winding;
        "temperature of the winding; where the motor has a thermal model";
    TemperatureHousing "temperature.housing" Celsius Motor WithThermalModel |now| now.temperatures.housing;
        "temperature of the housing and the magnets";
    CommandOutput "command.output" Output PowerStage WithOutput |now| now.output;
        "output of an ideal source: a voltage where it has a `gain`";
    SaturationVoltage "saturation.voltage" One CurrentLoop WithCurrentLoop |now| now.saturation.voltage;
        "share of the time that the voltage limit binds";
    SaturationCurrent "saturation.current" One VelocityLoop WithCurrentLoop |now| now.saturation.current;
        "share of the time that the current limit binds";
    SaturationEffort "saturation.effort" One VelocityLoop WithFirmware |now| now.saturation.effort;
        "share of the time that the effort limit binds";
    DisturbanceMotor "disturbance.motor" MotorEffort Disturbance MotorDisturbed |now| now.motor_disturbance;
        "external torque or force on the motor, in the motor coordinate; where there is one";
    DisturbanceLoad "disturbance.load" LoadEffort Disturbance LoadDisturbed |now| now.load_disturbance;
        "external torque or force on the load; where there is one";
    EffortEndStop "effort.end_stop" LoadEffort Mechanics WithEndStops |now| now.end_stop;
        "torque or force of the end stops on the load; where it has some";
    MeasuredMotorPosition "measured.motor.position" Axis(0) Encoder MotorEncoderErrs |now| now.measured_position[0];
        "position of the motor that its encoder reads, in the axis coordinate; where the encoder has errors";
    MeasuredMotorVelocity "measured.motor.velocity" Axis(1) VelocityLoop MeasuresVelocity |now| now.measured_velocity;
        "velocity of the motor as the velocity loop sees it, in the axis coordinate; where the drive measures it by a separate method";
    MeasuredLoadPosition "measured.load.position" Axis(0) Encoder LoadEncoderErrs |now| now.measured_position[1];
        "position of the load that its encoder reads; where the encoder has errors";
    MeasuredCurrentD "measured.current.d" Ampere CurrentLoop CurrentErrs |now| now.measured_current.d;
        "d-axis current as the current loop measures it, amplitude; where sensors or commutation have errors";
    MeasuredCurrentQ "measured.current.q" Ampere CurrentLoop CurrentErrs |now| now.measured_current.q;
        "q-axis current as the current loop measures it, amplitude; where sensors or commutation have errors";
    PowerInverter "power.inverter" Watt PowerStage WithInverter |now| now.inverter_loss;
        "loss of the inverter's devices, mean over the tick that ends; where it is not ideal";
    CurrentPeak "current.peak" Ampere Motor WithSwitching |now| now.ripple.peak;
        "largest length of the current vector over the tick that ends, ripple included, amplitude; where the inverter switches";
    CurrentRms "current.rms" Ampere Motor WithSwitching |now| now.ripple.rms * core::f64::consts::FRAC_1_SQRT_2;
        "RMS value of a phase current over the tick that ends, ripple included; where the inverter switches";
    VoltageDcLink "voltage.dc_link" Volt PowerStage WithLink |now| now.dc_link;
        "voltage of the DC link; where it changes";
    PowerMains "power.mains" Watt PowerStage WithLink |now| now.link_power.source;
        "power from the mains into the DC link, mean over the tick that ends; where the link changes";
    PowerBrake "power.brake" Watt PowerStage WithLink |now| now.link_power.brake;
        "power into the brake resistor, mean over the tick that ends; where the link changes";
}

impl Signal {
    /// Its description for a recording.
    #[must_use]
    pub fn spec(self, equipment: &Equipment, rates: &Rates) -> ChannelSpec {
        let writer = self.writer();
        ChannelSpec {
            axis: equipment.name,
            name: self.name().into(),
            unit: self.unit().symbol(equipment),
            writer: writer.name(equipment).into(),
            rate: writer.rate(rates),
        }
    }
}

/// Writes the values of all signals at `now` to a row of [`Selection::recorder`](crate::Selection::recorder).
///
/// # Panics
/// When the row is that of another recorder.
#[inline]
pub fn write_row(now: &Instant, to: Row<'_>) {
    let (columns, at) = to.of_columns();
    put(now, columns, at);
}

/// A name that no signal has.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("unknown signal `{name}`")]
pub struct UnknownSignal {
    /// Rejected name.
    pub name: String,
}

impl FromStr for Signal {
    type Err = UnknownSignal;

    fn from_str(text: &str) -> Result<Self, UnknownSignal> {
        let found = Self::ALL.iter().copied().find(|signal| signal.name() == text);
        found.ok_or_else(|| UnknownSignal { name: text.to_owned() })
    }
}

/// Its name.
impl AsRef<str> for Signal {
    fn as_ref(&self) -> &str {
        self.name()
    }
}

impl fmt::Display for Signal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
