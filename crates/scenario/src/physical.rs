//! What keys measure: the dimensions that each accepts, and how messages call them.
use crate::dimension::Dimension as D;
use crate::scenario::Motion;
use std::f64::consts::{SQRT_2, TAU};

/// A physical quantity as keys accept it.
#[derive(Debug, PartialEq)]
pub(crate) struct Physical {
    /// With its article: "a stiffness".
    pub(crate) name: &'static str,
    /// Unit that a proposal uses.
    pub(crate) unit: &'static str,
    /// Accepted dimensions, and what one SI unit of each is in the unit that the key means.
    pub(crate) accepts: &'static [(D, f64)],
}

/// What a key measures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Kind {
    /// One thing, whatever the axis.
    Plain(&'static Physical),
    /// In the axis coordinate: linear or rotary as the axis is.
    Axis(&'static Counterparts),
    /// In the motor coordinate.
    Motor(&'static Counterparts),
}

/// A pair of corresponding quantities: force and torque, mass and inertia.
#[derive(Debug, PartialEq)]
pub(crate) struct Counterparts {
    pub(crate) linear: Physical,
    pub(crate) rotary: Physical,
}

impl Kind {
    /// What the key measures on this axis; both when that is not known.
    pub(crate) fn candidates(self, axis: Option<Motion>, motor: Option<Motion>) -> Vec<&'static Physical> {
        let (pair, motion) = match self {
            Self::Plain(physical) => return vec![physical],
            Self::Axis(pair) => (pair, axis),
            Self::Motor(pair) => (pair, motor),
        };
        match motion {
            Some(Motion::Linear) => vec![&pair.linear],
            Some(Motion::Rotary) => vec![&pair.rotary],
            None => vec![&pair.linear, &pair.rotary],
        }
    }
}

const fn physical(name: &'static str, unit: &'static str, accepts: &'static [(D, f64)]) -> Physical {
    Physical { name, unit, accepts }
}

const SECOND: D = D::SECOND;
const VELOCITY_L: D = D::METRE.times(SECOND, -1);
const VELOCITY_R: D = D::RADIAN.times(SECOND, -1);
const KG_M2: D = D::KILOGRAM.times(D::METRE, 2);
const PER_SECOND: D = D::ONE.times(SECOND, -1);
const VOLT_PEAK: D = D::VOLT.times(D::AMPLITUDE, 1);
const AMPERE_PEAK: D = D::AMPERE.times(D::AMPLITUDE, 1);
/// Where engineers leave out "/rad" it is understood.
const STIFFNESS_R: &[(D, f64)] = &[(D::NEWTON_METRE.times(D::RADIAN, -1), 1.0), (D::NEWTON_METRE, 1.0)];
const VISCOUS_R: &[(D, f64)] =
    &[(D::NEWTON_METRE.times(SECOND, 1).times(D::RADIAN, -1), 1.0), (D::NEWTON_METRE.times(SECOND, 1), 1.0)];

pub(crate) static RATIO: Physical = physical("a number", "", &[(D::ONE, 1.0)]);
pub(crate) static TIME: Physical = physical("a time", "s", &[(SECOND, 1.0)]);
pub(crate) static FREQUENCY: Physical = physical("a frequency", "Hz", &[(D::HERTZ, 1.0)]);
/// In rad/s.
pub(crate) static BANDWIDTH: Physical =
    physical("a bandwidth (Hz or rad/s)", "Hz", &[(D::HERTZ, TAU), (VELOCITY_R, 1.0)]);
pub(crate) static POSITION_GAIN: Physical = physical("a position gain (1/s)", "1/s", &[(PER_SECOND, 1.0)]);
pub(crate) static MASS: Physical = physical("a mass", "kg", &[(D::KILOGRAM, 1.0)]);
pub(crate) static INERTIA: Physical = physical("a moment of inertia", "kg m2", &[(KG_M2, 1.0)]);
pub(crate) static FORCE: Physical = physical("a force", "N", &[(D::NEWTON, 1.0)]);
pub(crate) static TORQUE: Physical = physical("a torque", "Nm", &[(D::NEWTON_METRE, 1.0)]);
pub(crate) static ENERGY: Physical = physical("an energy", "J", &[(D::NEWTON_METRE, 1.0)]);
pub(crate) static POWER: Physical = physical("a power", "W", &[(D::NEWTON_METRE.times(SECOND, -1), 1.0)]);
/// In metres per revolution.
pub(crate) static LEAD: Physical =
    physical("a lead (length per revolution)", "mm", &[(D::METRE, 1.0), (D::METRE.times(D::RADIAN, -1), TAU)]);
pub(crate) static VOLTAGE: Physical = physical("a voltage", "V", &[(D::VOLT, 1.0)]);
/// Of a phase: its amplitude.
pub(crate) static VOLTAGE_AMPLITUDE: Physical = physical("a voltage", "V", &[(D::VOLT, 1.0), (VOLT_PEAK, 1.0)]);
/// Its amplitude.
pub(crate) static CURRENT: Physical = physical("a current (Arms or Apk)", "Arms", &[(AMPERE_PEAK, 1.0)]);
/// Its effective value.
pub(crate) static CURRENT_RMS: Physical = physical("a current (Arms or Apk)", "Arms", &[(AMPERE_PEAK, 1.0 / SQRT_2)]);
pub(crate) static RESISTANCE: Physical = physical("a resistance", "Ohm", &[(D::VOLT.times(D::AMPERE, -1), 1.0)]);
pub(crate) static INDUCTANCE: Physical =
    physical("an inductance", "mH", &[(D::VOLT.times(SECOND, 1).times(D::AMPERE, -1), 1.0)]);
pub(crate) static FLUX_LINKAGE: Physical = physical(
    "a flux linkage",
    "V s",
    &[(D::VOLT.times(SECOND, 1), 1.0), (D::VOLT.times(SECOND, 1).times(D::RADIAN, -1), 1.0)],
);
/// In N·m per ampere of amplitude.
pub(crate) static TORQUE_CONSTANT: Physical =
    physical("a torque constant (Nm/Arms or Nm/Apk)", "Nm/Arms", &[(D::NEWTON_METRE.times(AMPERE_PEAK, -1), 1.0)]);
/// In N per ampere of amplitude.
pub(crate) static FORCE_CONSTANT: Physical =
    physical("a force constant (N/Arms or N/Apk)", "N/Arms", &[(D::NEWTON.times(AMPERE_PEAK, -1), 1.0)]);
/// In volts of amplitude per m/s or rad/s.
pub(crate) static BACK_EMF: Counterparts = Counterparts {
    linear: physical(
        "a back-EMF constant (Vrms s/m or Vpk s/m, line to line)",
        "Vrms s/m",
        &[(VOLT_PEAK.times(VELOCITY_L, -1), 1.0)],
    ),
    rotary: physical(
        "a back-EMF constant (Vrms/krpm or Vpk/krpm, line to line)",
        "Vrms/krpm",
        &[(VOLT_PEAK.times(VELOCITY_R, -1), 1.0)],
    ),
};
pub(crate) static CURRENT_GAIN: Physical =
    physical("a current loop gain (V/A)", "V/A", &[(D::VOLT.times(D::AMPERE, -1), 1.0)]);

pub(crate) static POSITION: Counterparts = Counterparts {
    linear: physical("a length", "mm", &[(D::METRE, 1.0)]),
    rotary: physical("an angle", "deg", &[(D::RADIAN, 1.0)]),
};
pub(crate) static VELOCITY: Counterparts = Counterparts {
    linear: physical("a velocity", "m/s", &[(VELOCITY_L, 1.0)]),
    rotary: physical("an angular velocity", "rpm", &[(VELOCITY_R, 1.0)]),
};
pub(crate) static ACCELERATION: Counterparts = Counterparts {
    linear: physical("an acceleration", "m/s2", &[(VELOCITY_L.times(SECOND, -1), 1.0)]),
    rotary: physical("an angular acceleration", "rad/s2", &[(VELOCITY_R.times(SECOND, -1), 1.0)]),
};
pub(crate) static JERK: Counterparts = Counterparts {
    linear: physical("a jerk", "m/s3", &[(VELOCITY_L.times(SECOND, -2), 1.0)]),
    rotary: physical("an angular jerk", "rad/s3", &[(VELOCITY_R.times(SECOND, -2), 1.0)]),
};
pub(crate) static SNAP: Counterparts = Counterparts {
    linear: physical("a snap", "m/s4", &[(VELOCITY_L.times(SECOND, -3), 1.0)]),
    rotary: physical("an angular snap", "rad/s4", &[(VELOCITY_R.times(SECOND, -3), 1.0)]),
};
pub(crate) static INERTIAL: Counterparts = Counterparts {
    linear: physical("a mass", "kg", &[(D::KILOGRAM, 1.0)]),
    rotary: physical("a moment of inertia", "kg m2", &[(KG_M2, 1.0)]),
};
pub(crate) static EFFORT: Counterparts = Counterparts {
    linear: physical("a force", "N", &[(D::NEWTON, 1.0)]),
    rotary: physical("a torque", "Nm", &[(D::NEWTON_METRE, 1.0)]),
};
pub(crate) static EFFORT_RATE: Counterparts = Counterparts {
    linear: physical("a change of force per time", "N/s", &[(D::NEWTON.times(SECOND, -1), 1.0)]),
    rotary: physical("a change of torque per time", "Nm/s", &[(D::NEWTON_METRE.times(SECOND, -1), 1.0)]),
};
pub(crate) static STIFFNESS: Counterparts = Counterparts {
    linear: physical("a stiffness", "N/m", &[(D::NEWTON.times(D::METRE, -1), 1.0)]),
    rotary: physical("a torsional stiffness", "Nm/rad", STIFFNESS_R),
};
pub(crate) static VISCOUS: Counterparts = Counterparts {
    linear: physical("a damping", "N s/m", &[(D::NEWTON.times(SECOND, 1).times(D::METRE, -1), 1.0)]),
    rotary: physical("a torsional damping", "Nm s/rad", VISCOUS_R),
};
/// Output voltage per velocity of the motor.
pub(crate) static VOLT_GAIN: Counterparts = Counterparts {
    linear: physical("a velocity gain", "V s/m", &[(D::VOLT.times(VELOCITY_L, -1), 1.0)]),
    rotary: physical("a velocity gain", "V s/rad", &[(D::VOLT.times(VELOCITY_R, -1), 1.0)]),
};
/// Effort per volt.
pub(crate) static SOURCE_GAIN: Counterparts = Counterparts {
    linear: physical("a force per voltage", "N/V", &[(D::NEWTON.times(D::VOLT, -1), 1.0)]),
    rotary: physical("a torque per voltage", "Nm/V", &[(D::NEWTON_METRE.times(D::VOLT, -1), 1.0)]),
};

/// Everything that has a name here, to name what a user wrote.
static NAMED: [&Physical; 36] = [
    &POSITION.linear,
    &POSITION.rotary,
    &TIME,
    &VELOCITY.linear,
    &VELOCITY.rotary,
    &ACCELERATION.linear,
    &ACCELERATION.rotary,
    &JERK.linear,
    &JERK.rotary,
    &SNAP.linear,
    &SNAP.rotary,
    &FREQUENCY,
    &MASS,
    &INERTIA,
    &FORCE,
    &TORQUE,
    &STIFFNESS.linear,
    &STIFFNESS.rotary,
    &VISCOUS.linear,
    &VISCOUS.rotary,
    &VOLTAGE,
    &CURRENT,
    &RESISTANCE,
    &INDUCTANCE,
    &FLUX_LINKAGE,
    &TORQUE_CONSTANT,
    &FORCE_CONSTANT,
    &BACK_EMF.linear,
    &BACK_EMF.rotary,
    &POSITION_GAIN,
    &VOLT_GAIN.linear,
    &VOLT_GAIN.rotary,
    &SOURCE_GAIN.linear,
    &SOURCE_GAIN.rotary,
    &EFFORT_RATE.linear,
    &EFFORT_RATE.rotary,
];

/// What a quantity of dimension `dimension` is: "a force (kg·m/s²)".
pub(crate) fn describe(dimension: D) -> String {
    if dimension == D::ONE {
        return "a pure number".to_owned();
    }
    // The first dimension in each list is the proper one.
    let named = NAMED.iter().find(|physical| physical.accepts.first().is_some_and(|(own, _)| *own == dimension));
    match named {
        Some(physical) if physical.name.contains('(') => physical.name.to_owned(),
        Some(physical) => format!("{} ({})", physical.name, physical.unit),
        None if dimension == D::AMPERE => "a current (A)".to_owned(),
        None => format!("in {dimension}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity;

    #[test]
    fn the_unit_of_every_proposal_is_accepted_as_it_is() {
        let plain = [&RATIO, &BANDWIDTH, &LEAD, &VOLTAGE_AMPLITUDE, &CURRENT_RMS, &CURRENT_GAIN];
        let pairs = [&INERTIAL, &EFFORT, &STIFFNESS, &VISCOUS, &VOLT_GAIN, &SOURCE_GAIN];
        let pairs = pairs.iter().flat_map(|pair| [&pair.linear, &pair.rotary]);
        for physical in plain.into_iter().chain(pairs).chain(NAMED) {
            let read = quantity::parse(&format!("1 {}", physical.unit)).unwrap();
            assert!(physical.accepts.iter().any(|(own, _)| *own == read.dimension), "{physical:?}");
        }
    }

    #[test]
    fn dimensions_have_names() {
        assert_eq!(describe(D::NEWTON), "a force (N)");
        assert_eq!(describe(D::METRE), "a length (mm)");
        assert_eq!(describe(D::AMPERE), "a current (A)");
        assert_eq!(describe(D::KILOGRAM.times(D::AMPERE, 3)), "in kg·A³");
        assert_eq!(describe(D::ONE), "a pure number");
    }
}
