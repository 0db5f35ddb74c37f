//! Parameters of an inverter that is not ideal.
use crate::pmsm;
use servobench_base::ParamError;
use servobench_config::Kind::Plain;
use servobench_config::quantities::{FREQUENCY, RESISTANCE, TIME, VOLTAGE};
use servobench_config::{choices, not_negative, positive};

servobench_config::parameters! {
    /// A parameter of an inverter.
    pub enum Parameter {
        /// Frequency of the carrier, and of the switching
        CARRIER "carrier of the inverter" = positive(Plain(&FREQUENCY), "16 kHz");
        /// Time after each change of a leg for which both of its devices are off
        DEAD_TIME "dead time" = not_negative(Plain(&TIME), "2 us");
        /// Constant voltage drop of a conducting device, transistor or diode
        DEVICE_DROP "device drop" = not_negative(Plain(&VOLTAGE), "1 V");
        /// Resistance of a conducting device, in addition to that drop
        ON_RESISTANCE "on-resistance" = not_negative(Plain(&RESISTANCE), "30 mOhm");
    }
}

choices! {
    /// Model of the inverter's modulation.
    pub enum Modulation {
        /// the mean over the carrier
        Averaged = "averaged",
        /// pulses of space-vector modulation, symmetrical about the middle of the carrier
        Switching = "switching",
    }
}

/// Largest dead time in periods of the carrier: a leg then loses a tenth of the link.
pub const MOST_DEAD: f64 = 0.1;

/// Parameters of an inverter; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Generation of its voltage.
    pub modulation: Modulation,
    /// Frequency of its carrier (Hz); without dead time an averaged inverter does not need it.
    pub carrier: f64,
    /// Time for which both devices of a leg are off at each change (s).
    pub dead_time: f64,
    /// Voltage of a device that conducts, at no current (V).
    pub device_drop: f64,
    /// Resistance of a device that conducts (Ω).
    pub on_resistance: f64,
}

impl Default for Params {
    fn default() -> Self {
        Self::IDEAL
    }
}

impl Params {
    /// An inverter without effects.
    pub const IDEAL: Self =
        Self { modulation: Modulation::Averaged, carrier: 0.0, dead_time: 0.0, device_drop: 0.0, on_resistance: 0.0 };

    /// The motor with the data `p` behind the conducting devices: of the inverter, their resistance alone is linear.
    #[must_use]
    pub fn linearised(&self, p: &pmsm::Params) -> pmsm::Params {
        let Self { modulation: _, carrier: _, dead_time: _, device_drop: _, on_resistance } = *self;
        pmsm::Params { resistance: p.resistance + on_resistance, ..*p }
    }

    /// True if its output is exactly the requested voltage.
    #[must_use]
    pub fn is_ideal(&self) -> bool {
        self.modulation == Modulation::Averaged && self.dead_time + self.device_drop + self.on_resistance == 0.0
    }

    /// # Errors
    /// [`ParamError`] names the first parameter out of its bound.
    pub fn check(&self) -> Result<(), ParamError> {
        let needs_carrier = self.modulation == Modulation::Switching || self.dead_time > 0.0;
        if needs_carrier {
            Parameter::CARRIER.check_in_words(self.carrier)?;
        }
        Parameter::DEAD_TIME.check_in_words(self.dead_time)?;
        Parameter::DEVICE_DROP.check_in_words(self.device_drop)?;
        Parameter::ON_RESISTANCE.check_in_words(self.on_resistance)?;
        if self.dead_time * self.carrier > MOST_DEAD {
            let bound = "at most a tenth of the carrier's period";
            return Err(ParamError { name: Parameter::DEAD_TIME.name, value: self.dead_time, bound });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_out_of_its_bound_is_named() {
        let good = Params { carrier: 16e3, dead_time: 2e-6, device_drop: 0.9, on_resistance: 0.02, ..Params::IDEAL };
        assert_eq!(good.check(), Ok(()));
        assert!(Params::IDEAL.is_ideal() && !good.is_ideal() && Params::IDEAL.check().is_ok());
        for (wrong, name) in [
            (Params { carrier: 0.0, ..good }, Parameter::CARRIER),
            (Params { modulation: Modulation::Switching, ..Params::IDEAL }, Parameter::CARRIER),
            (Params { dead_time: -1e-6, ..good }, Parameter::DEAD_TIME),
            (Params { dead_time: 6.3e-6, ..good }, Parameter::DEAD_TIME),
            (Params { device_drop: f64::NAN, ..good }, Parameter::DEVICE_DROP),
            (Params { on_resistance: -0.1, ..good }, Parameter::ON_RESISTANCE),
        ] {
            assert_eq!(wrong.check().unwrap_err().name, name.name);
        }
    }
}
