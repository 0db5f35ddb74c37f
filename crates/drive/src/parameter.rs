//! The parameters of the firmware, by which its errors name them.
use core::fmt::{self, Display, Formatter};
use servobench_base::ParamError;

/// A parameter of the firmware that is out of its bound.
pub type ParameterError = ParamError<Parameter>;

macro_rules! parameters {
    ($( $(#[doc = $doc:literal])+ $parameter:ident = $name:literal, )+) => {
        /// A parameter of the firmware.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum Parameter {
            $( $(#[doc = $doc])+ $parameter, )+
        }

        impl Parameter {
            /// Every parameter.
            pub const ALL: &'static [Self] = &[$(Self::$parameter),+];

            /// Its name in words.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $( Self::$parameter => $name, )+
                }
            }
        }
    };
}

parameters! {
    /// [`Params::transmission`](crate::Params::transmission).
    Transmission = "transmission",
    /// [`Params::position_gain`](crate::Params::position_gain).
    PositionGain = "gain of the position loop",
    /// [`Params::position_rate`](crate::Params::position_rate).
    PositionRate = "rate of the position loop",
    /// [`velocity::Params::k_p`](crate::velocity::Params::k_p).
    VelocityGain = "gain of the velocity loop",
    /// [`velocity::Params::integral_time`](crate::velocity::Params::integral_time).
    VelocityIntegralTime = "integral time of the velocity loop",
    /// [`Params::velocity_filter_time`](crate::Params::velocity_filter_time).
    VelocityFilterTime = "time constant of the velocity filter",
    /// [`Params::velocity_rate`](crate::Params::velocity_rate).
    VelocityRate = "rate of the velocity loop",
    /// [`velocity::Params::max_effort`](crate::velocity::Params::max_effort).
    MaxEffort = "largest effort",
    /// [`current::Gains::k_p`](crate::current::Gains::k_p), d axis.
    CurrentGainD = "gain of the current loop, d axis",
    /// [`current::Gains::k_p`](crate::current::Gains::k_p), q axis.
    CurrentGainQ = "gain of the current loop, q axis",
    /// What [`current::Gains::k_i`](crate::current::Gains::k_i) follows from, d axis.
    CurrentIntegralTimeD = "integral time of the current loop, d axis",
    /// What [`current::Gains::k_i`](crate::current::Gains::k_i) follows from, q axis.
    CurrentIntegralTimeQ = "integral time of the current loop, q axis",
    /// [`current::Params::d_reference`](crate::current::Params::d_reference).
    CurrentReferenceD = "reference of the current in d",
    /// [`current::Params::max_current`](crate::current::Params::max_current).
    MaxCurrent = "largest current",
    /// [`current::Params::max_voltage`](crate::current::Params::max_voltage), which follows from the DC link.
    DcLink = "voltage of the DC link",
    /// Gain of [`Stage::Direct`](crate::Stage::Direct).
    DirectGain = "gain of the direct output",
    /// [`MotorEstimate::electrical_ratio`](crate::current::MotorEstimate::electrical_ratio), which follows from the pole pairs.
    PolePairs = "pole pairs",
    /// [`MotorEstimate::resistance`](crate::current::MotorEstimate::resistance).
    Resistance = "estimate of the resistance",
    /// [`MotorEstimate::inductance`](crate::current::MotorEstimate::inductance), d axis.
    InductanceD = "estimate of the inductance, d axis",
    /// [`MotorEstimate::inductance`](crate::current::MotorEstimate::inductance), q axis.
    InductanceQ = "estimate of the inductance, q axis",
    /// [`MotorEstimate::flux_linkage`](crate::current::MotorEstimate::flux_linkage).
    FluxLinkage = "estimate of the flux linkage",
    /// [`feedforward::Params::velocity`](crate::feedforward::Params::velocity).
    VelocityFeedforward = "share of the velocity that is fed forward",
    /// [`Params::reference_delay`](crate::Params::reference_delay).
    ReferenceDelay = "delay of the reference",
    /// [`feedforward::Params::coulomb`](crate::feedforward::Params::coulomb).
    Coulomb = "estimate of the Coulomb friction",
    /// [`feedforward::Params::bias`](crate::feedforward::Params::bias).
    Bias = "estimate of the constant effort",
    /// Of the motor, in [`feedforward::Model`](crate::feedforward::Model).
    MotorInertia = "estimate of the motor's inertia",
    /// Of the load, in [`feedforward::Model`](crate::feedforward::Model).
    LoadInertia = "estimate of the load's inertia",
    /// In [`feedforward::Model`](crate::feedforward::Model).
    Stiffness = "estimate of the stiffness",
    /// Of the motor, in [`feedforward::Model`](crate::feedforward::Model).
    MotorViscous = "estimate of the motor's viscous friction",
    /// Of the load, in [`feedforward::Model`](crate::feedforward::Model).
    LoadViscous = "estimate of the load's viscous friction",
}

impl Display for Parameter {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}
