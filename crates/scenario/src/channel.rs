//! Channels that a recording can have. Names and order are those of the crate `sim`; `tests/channels.rs` holds them
//! together.
use crate::simple::Choice;

/// A channel of the recording, by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Channel(pub(crate) &'static str);

/// Declares the channels once: name, unit and meaning.
macro_rules! channels {
    ($($name:literal $unit:literal $meaning:literal,)+) => {
        /// Names of all channels that a recording can have; which it has depends on the axis and its drive.
        pub const CHANNELS: &[&str] = &[$($name,)+];

        /// What a channel of a recording means, in words; `None` for a name that is none.
        #[must_use]
        pub fn channel_meaning(name: &str) -> Option<&'static str> {
            match name {
                $($name => Some($meaning),)+
                _ => None,
            }
        }

        impl Choice for Channel {
            const ALL: &'static [(&'static str, Self, &'static str)] =
                &[$(($name, Self($name), concat!("[", $unit, "] ", $meaning)),)+];
        }
    };
}

// U is the unit of the axis, m or rad; E that of the motor's effort, N or N m; F that of an effort on the load.
channels! {
    "task.position" "U" "set-point of the motion task, before it goes over the bus",
    "task.velocity" "U/s" "its velocity",
    "bus.position" "U" "actual position as the master reads it",
    "setpoint.position" "U" "position of the set-point",
    "setpoint.velocity" "U/s" "its velocity",
    "setpoint.acceleration" "U/s²" "its acceleration",
    "setpoint.jerk" "U/s³" "its jerk",
    "setpoint.snap" "U/s⁴" "its snap",
    "motor.position" "U" "position of the motor, in the axis coordinate",
    "motor.velocity" "U/s" "its velocity",
    "table.position" "U" "position of the body between motor and load",
    "table.velocity" "U/s" "its velocity",
    "load.position" "U" "position of the load",
    "load.velocity" "U/s" "its velocity",
    "reference.position" "U" "what the load is to follow, delayed as the feedforward path is",
    "reference.motor_position" "U" "what the motor is to follow",
    "velocity.reference" "U/s" "velocity command, in the axis coordinate",
    "following_error.motor" "U" "motor reference minus motor position",
    "following_error.load" "U" "load reference minus load position",
    "effort.reference" "E" "torque or force that the velocity loop asks for",
    "effort.motor" "E" "torque or force of the motor",
    "current.d" "A" "d-axis current, amplitude",
    "current.q" "A" "q-axis current, amplitude",
    "current.q_reference" "A" "q-axis current that the current loop is to reach",
    "voltage.d_reference" "V" "d-axis voltage that the current loop asks for, amplitude; the inverter gives it a period later",
    "voltage.q_reference" "V" "q-axis voltage that the current loop asks for, amplitude",
    "voltage.d" "V" "d-axis voltage of the inverter in the middle of the tick that begins, amplitude",
    "voltage.q" "V" "q-axis voltage of the inverter in the middle of the tick that begins, amplitude",
    "voltage.magnitude" "V" "length of the inverter's voltage vector",
    "power.electrical" "W" "electrical power of the motor, mean over the tick that ends",
    "power.copper" "W" "loss in the winding, mean over the tick that ends",
    "power.stored" "W" "power into the field of the inductances, mean over the tick that ends",
    "power.air_gap" "W" "torque or force times the velocity that the motor's equations used, mean over the tick that ends",
    "power.shaft" "W" "torque or force times the travel of the motor per time, over the tick that ends",
    "power.residual" "W" "air-gap power less shaft power: what coupling motor and mechanics tick by tick adds",
    "command.output" "V or E" "output of an ideal source: a voltage where it has a `gain`",
    "saturation.voltage" "1" "share of the time that the voltage limit binds",
    "saturation.current" "1" "share of the time that the current limit binds",
    "saturation.effort" "1" "share of the time that the effort limit binds",
    "disturbance.motor" "E" "external torque or force on the motor, in its own coordinate; where there is one",
    "disturbance.load" "F" "external torque or force on the load; where there is one",
}
