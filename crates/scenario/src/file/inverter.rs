//! `[drive.inverter]` and `[drive.link]`: the power stage of the plant.
use crate::simple::OneOf;
use crate::table::table;
use servobench_base::Rate;
use servobench_plant::inverter::{LinkParameter, Modulation, Parameter, Params};

table! {
    /// Effects of the inverter on the requested voltage: docs/inverter.md. Each key is a separate effect.
    pub(crate) struct Inverter sets Params {
        /// Model of the modulation; default: "averaged".
        modulation: Modulation = OneOf => modulation,
        /// Frequency of the carrier, and of the switching; `dead_time` and "switching" need it. With "switching" it divides the base rate
        /// or is a multiple of it.
        carrier: Rate = "16 kHz",
        /// default: none.
        dead_time: f64 = Parameter::DEAD_TIME => dead_time,
        /// default: none.
        device_drop: f64 = Parameter::DEVICE_DROP => device_drop,
        /// default: none.
        on_resistance: f64 = Parameter::ON_RESISTANCE => on_resistance,
    }
}

table! {
    /// The DC link: mains behind a resistance and diodes, a capacitor, a brake resistor: docs/inverter.md. `drive.dc_link` is its
    /// voltage without load.
    pub(crate) struct Link requires ["capacitance", "source_resistance"] {
        capacitance: f64 = LinkParameter::CAPACITANCE,
        source_resistance: f64 = LinkParameter::SOURCE_RESISTANCE,
        /// default: none, the voltage behind the resistance is constant.
        mains_frequency: f64 = LinkParameter::MAINS_FREQUENCY,
        /// Time in which the mains have less voltage; default: none.
        sag: Sag = (),
        /// Brake resistor for returned energy; default: none.
        brake: Brake = (),
    }
}

table! {
    /// Time in which the mains have less voltage.
    pub(crate) struct Sag requires ["start", "duration", "depth"] {
        start: f64 = LinkParameter::SAG_START,
        duration: f64 = LinkParameter::SAG_DURATION,
        depth: f64 = LinkParameter::SAG_DEPTH,
    }
}

table! {
    /// Brake resistor for the energy that a braking motor returns: on above one voltage of the link, off below another.
    pub(crate) struct Brake requires ["resistance", "on", "off"] {
        resistance: f64 = LinkParameter::BRAKE_RESISTANCE,
        on: f64 = LinkParameter::BRAKE_ON,
        off: f64 = LinkParameter::BRAKE_OFF,
    }
}
