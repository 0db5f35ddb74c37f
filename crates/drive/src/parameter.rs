//! The parameters of the firmware, by which its errors name them.
use servobench_base::ParamError;
use servobench_config::Kind::{Axis, Motor, Plain};
use servobench_config::quantities::{
    CURRENT, CURRENT_GAIN, EFFORT, FLUX_LINKAGE, FREQUENCY, INDUCTANCE, INERTIAL, POSITION_GAIN, RATIO, RESISTANCE,
    SOURCE_GAIN, STIFFNESS, TIME, VISCOUS, VOLTAGE,
};
use servobench_config::{any, not_negative, positive};

/// A parameter of the firmware that is out of its bound.
pub type ParameterError = ParamError<Parameter>;

servobench_config::parameters! {
    /// A parameter of the firmware.
    pub enum Parameter {
        /// Axis coordinate per motor coordinate
        Transmission "transmission" = positive(Plain(&RATIO), "0.0016");
        /// Proportional gain K_v of the position loop
        PositionGain "gain of the position loop" = not_negative(Plain(&POSITION_GAIN), "160 1/s");
        /// Rate of the position loop
        PositionRate "rate of the position loop" = positive(Plain(&FREQUENCY), "4 kHz");
        /// Proportional gain of the velocity loop
        VelocityGain "gain of the velocity loop" = not_negative(Motor(&VISCOUS), "243.45 N s/m");
        /// Integral time of a PI
        VelocityIntegralTime "integral time of the velocity loop" = positive(Plain(&TIME), "6 ms");
        /// Time constant of the low-pass on the measured velocity
        VelocityFilterTime "time constant of the velocity filter" = not_negative(Plain(&TIME), "0.1 ms");
        /// Rate of the velocity loop
        VelocityRate "rate of the velocity loop" = positive(Plain(&FREQUENCY), "8 kHz");
        /// Largest torque or force that the drive asks for
        MaxEffort "largest effort" = positive(Motor(&EFFORT), "12 Nm");
        /// Proportional gain of the d axis
        CurrentGainD "gain of the current loop, d axis" = positive(Plain(&CURRENT_GAIN), "12 V/A");
        /// Proportional gain of the q axis
        CurrentGainQ "gain of the current loop, q axis" = positive(Plain(&CURRENT_GAIN), "12 V/A");
        /// Integral time of the d axis
        CurrentIntegralTimeD "integral time of the current loop, d axis" = positive(Plain(&TIME), "5 ms");
        /// Integral time of the q axis
        CurrentIntegralTimeQ "integral time of the current loop, q axis" = positive(Plain(&TIME), "5 ms");
        /// Reference of the d-axis current
        CurrentReferenceD "reference of the current in d" = any(Plain(&CURRENT), "-20 Arms");
        /// Largest phase current
        MaxCurrent "largest current" = positive(Plain(&CURRENT), "20 Arms");
        /// Voltage of the DC link
        DcLink "voltage of the DC link" = positive(Plain(&VOLTAGE), "540 V");
        /// Force or torque per volt of an ideal source
        DirectGain "gain of the direct output" = positive(Motor(&SOURCE_GAIN), "35.1507 N/V");
        /// Pole pairs
        PolePairs "pole pairs" = positive(Plain(&RATIO), "4");
        /// Stator resistance
        Resistance "estimate of the resistance" = positive(Plain(&RESISTANCE), "0.36 Ohm");
        /// Inductance of the d axis
        InductanceD "estimate of the inductance, d axis" = positive(Plain(&INDUCTANCE), "36 mH");
        /// Inductance of the q axis
        InductanceQ "estimate of the inductance, q axis" = positive(Plain(&INDUCTANCE), "51 mH");
        /// Flux linkage, amplitude
        FluxLinkage "estimate of the flux linkage" = positive(Plain(&FLUX_LINKAGE), "0.545 V s");
        /// Share of the reference velocity that is added to the velocity command
        VelocityFeedforward "share of the velocity that is fed forward" = any(Plain(&RATIO), "1");
        /// How long the reference waits for the feedforward path
        ReferenceDelay "delay of the reference" = not_negative(Plain(&TIME), "0.2 ms");
        /// Coulomb friction of all bodies
        Coulomb "estimate of the Coulomb friction" = not_negative(Axis(&EFFORT), "20 N");
        /// Constant resisting force or torque on all bodies
        Bias "estimate of the constant effort" = any(Axis(&EFFORT), "-3 N");
        /// Mass or inertia on the motor's side of the softest spring, rotor included
        MotorInertia "estimate of the motor's inertia" = not_negative(Axis(&INERTIAL), "20 kg");
        /// Mass or inertia beyond that spring
        LoadInertia "estimate of the load's inertia" = not_negative(Axis(&INERTIAL), "10 kg");
        /// Stiffness of that spring
        Stiffness "estimate of the stiffness" = positive(Axis(&STIFFNESS), "0.6 N/um");
        /// Viscous friction on the motor's side
        MotorViscous "estimate of the motor's viscous friction" = not_negative(Axis(&VISCOUS), "10 N s/m");
        /// Viscous friction on the load
        LoadViscous "estimate of the load's viscous friction" = not_negative(Axis(&VISCOUS), "10 N s/m");
    }
}
