//! Channels that a recording can have. Names and order are those of the crate `sim`; `tests/channels.rs` holds them
//! together.
use crate::simple::Choice;

/// A channel of the recording, by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Channel(pub(crate) &'static str);

/// Declares the channels once: name and meaning.
macro_rules! channels {
    ($($name:literal $meaning:literal,)+) => {
        /// Names of all channels that a recording can have; which it has depends on the axis and its drive.
        pub const CHANNELS: &[&str] = &[$($name,)+];

        impl Choice for Channel {
            const ALL: &'static [(&'static str, Self, &'static str)] = &[$(($name, Self($name), $meaning),)+];
        }
    };
}

channels! {
    "setpoint.position" "position of the set-point",
    "setpoint.velocity" "its velocity",
    "setpoint.acceleration" "its acceleration",
    "setpoint.jerk" "its jerk",
    "setpoint.snap" "its snap",
    "motor.position" "position of the motor, in the axis coordinate",
    "motor.velocity" "its velocity",
    "table.position" "position of the body between motor and load",
    "table.velocity" "its velocity",
    "load.position" "position of the load",
    "load.velocity" "its velocity",
    "reference.position" "what the load is to follow, delayed as the feedforward path is",
    "reference.motor_position" "what the motor is to follow",
    "velocity.reference" "velocity command, in the axis coordinate",
    "following_error.motor" "motor reference minus motor position",
    "following_error.load" "load reference minus load position",
    "effort.reference" "torque or force that the velocity loop asks for",
    "effort.motor" "torque or force of the motor",
    "current.d" "d-axis current, amplitude",
    "current.q" "q-axis current, amplitude",
    "current.q_reference" "q-axis current that the current loop is to reach",
    "voltage.d" "d-axis voltage, amplitude",
    "voltage.q" "q-axis voltage, amplitude",
    "voltage.magnitude" "length of the voltage vector",
    "command.output" "output of an ideal source",
    "saturation.voltage" "share of the time that the voltage limit binds",
    "saturation.current" "share of the time that the current limit binds",
    "saturation.effort" "share of the time that the effort limit binds",
    "disturbance.motor" "external torque or force on the motor, in its own coordinate; where there is one",
    "disturbance.load" "external torque or force on the load; where there is one",
}
