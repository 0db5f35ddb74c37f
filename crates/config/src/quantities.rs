//! The physical quantities of parameters.
use crate::dimension::Dimension as D;
use crate::physical::{Counterparts, Physical};
use core::f64::consts::{SQRT_2, TAU};

const fn physical(name: &'static str, unit: &'static str, accepts: &'static [(D, f64)]) -> Physical {
    Physical { name, unit, accepts }
}

const SECOND: D = D::SECOND;
const VELOCITY_L: D = D::METRE.times(SECOND, -1);
const VELOCITY_R: D = D::RADIAN.times(SECOND, -1);
const KG_M2: D = D::KILOGRAM.times(D::METRE, 2);
const WATT: D = D::NEWTON_METRE.times(SECOND, -1);
const PER_SECOND: D = D::ONE.times(SECOND, -1);
const VOLT_PEAK: D = D::VOLT.times(D::AMPLITUDE, 1);
const AMPERE_PEAK: D = D::AMPERE.times(D::AMPLITUDE, 1);
/// Accepted without "/rad" too, as engineers often omit it.
const STIFFNESS_R: &[(D, f64)] = &[(D::NEWTON_METRE.times(D::RADIAN, -1), 1.0), (D::NEWTON_METRE, 1.0)];
const VISCOUS_R: &[(D, f64)] =
    &[(D::NEWTON_METRE.times(SECOND, 1).times(D::RADIAN, -1), 1.0), (D::NEWTON_METRE.times(SECOND, 1), 1.0)];

/// A pure number.
pub static RATIO: Physical = physical("a number", "", &[(D::ONE, 1.0)]);
/// Seconds.
pub static TIME: Physical = physical("a time", "s", &[(SECOND, 1.0)]);
/// Hertz.
pub static FREQUENCY: Physical = physical("a frequency", "Hz", &[(D::HERTZ, 1.0)]);
/// In rad/s.
pub static BANDWIDTH: Physical = physical("a bandwidth (Hz or rad/s)", "Hz", &[(D::HERTZ, TAU), (VELOCITY_R, 1.0)]);
/// Velocity per position.
pub static POSITION_GAIN: Physical = physical("a position gain (1/s)", "1/s", &[(PER_SECOND, 1.0)]);
/// Kilograms.
pub static MASS: Physical = physical("a mass", "kg", &[(D::KILOGRAM, 1.0)]);
/// kg·m².
pub static INERTIA: Physical = physical("a moment of inertia", "kg m2", &[(KG_M2, 1.0)]);
/// Newtons.
pub static FORCE: Physical = physical("a force", "N", &[(D::NEWTON, 1.0)]);
/// Newton metres.
pub static TORQUE: Physical = physical("a torque", "Nm", &[(D::NEWTON_METRE, 1.0)]);
/// Joules.
pub static ENERGY: Physical = physical("an energy", "J", &[(D::NEWTON_METRE, 1.0)]);
/// Watts.
pub static POWER: Physical = physical("a power", "W", &[(D::NEWTON_METRE.times(SECOND, -1), 1.0)]);
/// In metres per revolution.
pub static LEAD: Physical =
    physical("a lead (length per revolution)", "mm", &[(D::METRE, 1.0), (D::METRE.times(D::RADIAN, -1), TAU)]);
/// Volts.
pub static VOLTAGE: Physical = physical("a voltage", "V", &[(D::VOLT, 1.0)]);
/// Amplitude of a phase voltage.
pub static VOLTAGE_AMPLITUDE: Physical = physical("a voltage", "V", &[(D::VOLT, 1.0), (VOLT_PEAK, 1.0)]);
/// Amplitude of a current.
pub static CURRENT: Physical = physical("a current (Arms or Apk)", "Arms", &[(AMPERE_PEAK, 1.0)]);
/// Effective value of a current.
pub static CURRENT_RMS: Physical = physical("a current (Arms or Apk)", "Arms", &[(AMPERE_PEAK, 1.0 / SQRT_2)]);
/// Instantaneous current of a phase.
pub static CURRENT_OF_A_PHASE: Physical = physical("a current (A)", "A", &[(D::AMPERE, 1.0), (AMPERE_PEAK, 1.0)]);
/// Effective value of a noise.
pub static CURRENT_NOISE: Physical =
    physical("a current (A, RMS)", "A", &[(D::AMPERE, 1.0), (AMPERE_PEAK, 1.0 / SQRT_2)]);
/// Ohms.
pub static RESISTANCE: Physical = physical("a resistance", "Ohm", &[(D::VOLT.times(D::AMPERE, -1), 1.0)]);
/// Henries.
pub static INDUCTANCE: Physical =
    physical("an inductance", "mH", &[(D::VOLT.times(SECOND, 1).times(D::AMPERE, -1), 1.0)]);
/// Farads.
pub static CAPACITANCE: Physical =
    physical("a capacitance", "uF", &[(D::AMPERE.times(SECOND, 1).times(D::VOLT, -1), 1.0)]);
/// Volt seconds.
pub static FLUX_LINKAGE: Physical = physical(
    "a flux linkage",
    "V s",
    &[(D::VOLT.times(SECOND, 1), 1.0), (D::VOLT.times(SECOND, 1).times(D::RADIAN, -1), 1.0)],
);
/// In N·m per ampere of amplitude.
pub static TORQUE_CONSTANT: Physical =
    physical("a torque constant (Nm/Arms or Nm/Apk)", "Nm/Arms", &[(D::NEWTON_METRE.times(AMPERE_PEAK, -1), 1.0)]);
/// In N per ampere of amplitude.
pub static FORCE_CONSTANT: Physical =
    physical("a force constant (N/Arms or N/Apk)", "N/Arms", &[(D::NEWTON.times(AMPERE_PEAK, -1), 1.0)]);
/// In volts of amplitude per m/s or rad/s.
pub static BACK_EMF: Counterparts = Counterparts {
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
/// Voltage per current.
pub static CURRENT_GAIN: Physical =
    physical("a current loop gain (V/A)", "V/A", &[(D::VOLT.times(D::AMPERE, -1), 1.0)]);

/// Position or distance.
pub static POSITION: Counterparts = Counterparts {
    linear: physical("a length", "mm", &[(D::METRE, 1.0)]),
    rotary: physical("an angle", "deg", &[(D::RADIAN, 1.0)]),
};
/// Degrees Celsius.
pub static TEMPERATURE: Physical = physical("a temperature (degC)", "degC", &[(D::CELSIUS, 1.0)]);
/// Kelvin per watt.
pub static THERMAL_RESISTANCE: Physical = physical("a thermal resistance", "K/W", &[(D::KELVIN.times(WATT, -1), 1.0)]);
/// Joules per kelvin.
pub static HEAT_CAPACITY: Physical = physical("a heat capacity", "J/K", &[(D::NEWTON_METRE.times(D::KELVIN, -1), 1.0)]);
/// A relative change per kelvin.
pub static PER_KELVIN: Physical =
    physical("a temperature coefficient (1/K)", "1/K", &[(D::ONE.times(D::KELVIN, -1), 1.0)]);
/// Angle of a periodic quantity.
pub static PHASE: Physical = physical("an angle", "deg", &[(D::RADIAN, 1.0)]);
/// Velocity.
pub static VELOCITY: Counterparts = Counterparts {
    linear: physical("a velocity", "m/s", &[(VELOCITY_L, 1.0)]),
    rotary: physical("an angular velocity", "rpm", &[(VELOCITY_R, 1.0)]),
};
/// Acceleration.
pub static ACCELERATION: Counterparts = Counterparts {
    linear: physical("an acceleration", "m/s2", &[(VELOCITY_L.times(SECOND, -1), 1.0)]),
    rotary: physical("an angular acceleration", "rad/s2", &[(VELOCITY_R.times(SECOND, -1), 1.0)]),
};
/// Jerk.
pub static JERK: Counterparts = Counterparts {
    linear: physical("a jerk", "m/s3", &[(VELOCITY_L.times(SECOND, -2), 1.0)]),
    rotary: physical("an angular jerk", "rad/s3", &[(VELOCITY_R.times(SECOND, -2), 1.0)]),
};
/// Snap.
pub static SNAP: Counterparts = Counterparts {
    linear: physical("a snap", "m/s4", &[(VELOCITY_L.times(SECOND, -3), 1.0)]),
    rotary: physical("an angular snap", "rad/s4", &[(VELOCITY_R.times(SECOND, -3), 1.0)]),
};
/// Mass or moment of inertia.
pub static INERTIAL: Counterparts = Counterparts {
    linear: physical("a mass", "kg", &[(D::KILOGRAM, 1.0)]),
    rotary: physical("a moment of inertia", "kg m2", &[(KG_M2, 1.0)]),
};
/// Force or torque.
pub static EFFORT: Counterparts = Counterparts {
    linear: physical("a force", "N", &[(D::NEWTON, 1.0)]),
    rotary: physical("a torque", "Nm", &[(D::NEWTON_METRE, 1.0)]),
};
/// Change of force or torque per time.
pub static EFFORT_RATE: Counterparts = Counterparts {
    linear: physical("a change of force per time", "N/s", &[(D::NEWTON.times(SECOND, -1), 1.0)]),
    rotary: physical("a change of torque per time", "Nm/s", &[(D::NEWTON_METRE.times(SECOND, -1), 1.0)]),
};
/// Force or torque per travel.
pub static STIFFNESS: Counterparts = Counterparts {
    linear: physical("a stiffness", "N/m", &[(D::NEWTON.times(D::METRE, -1), 1.0)]),
    rotary: physical("a torsional stiffness", "Nm/rad", STIFFNESS_R),
};
/// Force or torque per velocity.
pub static VISCOUS: Counterparts = Counterparts {
    linear: physical("a damping", "N s/m", &[(D::NEWTON.times(SECOND, 1).times(D::METRE, -1), 1.0)]),
    rotary: physical("a torsional damping", "Nm s/rad", VISCOUS_R),
};
/// Output voltage per velocity of the motor.
pub static VOLT_GAIN: Counterparts = Counterparts {
    linear: physical("a velocity gain", "V s/m", &[(D::VOLT.times(VELOCITY_L, -1), 1.0)]),
    rotary: physical("a velocity gain", "V s/rad", &[(D::VOLT.times(VELOCITY_R, -1), 1.0)]),
};
/// Effort per volt.
pub static SOURCE_GAIN: Counterparts = Counterparts {
    linear: physical("a force per voltage", "N/V", &[(D::NEWTON.times(D::VOLT, -1), 1.0)]),
    rotary: physical("a torque per voltage", "Nm/V", &[(D::NEWTON_METRE.times(D::VOLT, -1), 1.0)]),
};

/// All quantities with a name, to name that of a user's value.
pub static NAMED: [&Physical; 41] = [
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
    &CAPACITANCE,
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
    &TEMPERATURE,
    &THERMAL_RESISTANCE,
    &HEAT_CAPACITY,
    &PER_KELVIN,
];
