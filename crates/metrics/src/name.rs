//! The metrics: stable names, quantities, meanings.
use servobench_config::{Kind, Measure, any, not_negative, quantities};
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// Declares [`Name`] once: variant, name in files, scope, quantity, a limit as users write it, meaning in a few
/// words.
macro_rules! names {
    ($($variant:ident $text:literal $scope:ident $kind:ident $example:literal $meaning:literal,)*) => {
        /// A metric; the order is the order of tables.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Name {
            $(#[doc = $meaning] $variant,)*
        }

        impl Name {
            /// Every metric, in the order of tables.
            pub const ALL: &'static [Self] = &[$(Self::$variant,)*];

            /// Name in scenario files and results.
            #[must_use]
            pub const fn as_str(self) -> &'static str {
                match self { $(Self::$variant => $text,)* }
            }

            /// Part of a run that it covers.
            #[must_use]
            pub const fn scope(self) -> Scope {
                match self { $(Self::$variant => Scope::$scope,)* }
            }

            /// Kind of quantity that it measures.
            #[must_use]
            pub const fn kind(self) -> Kind {
                match self { $(Self::$variant => $kind,)* }
            }

            /// A limit as users write it.
            #[must_use]
            pub const fn example(self) -> &'static str {
                match self { $(Self::$variant => $example,)* }
            }

            /// Meaning in a few words.
            #[must_use]
            pub const fn meaning(self) -> &'static str {
                match self { $(Self::$variant => $meaning,)* }
            }
        }
    };
}

const TIME: Kind = Kind::Plain(&quantities::TIME);
const RATIO: Kind = Kind::Plain(&quantities::RATIO);
const LENGTH: Kind = Kind::Axis(&quantities::POSITION);
const VELOCITY: Kind = Kind::Axis(&quantities::VELOCITY);
const FREQUENCY: Kind = Kind::Plain(&quantities::FREQUENCY);
const EFFORT: Kind = Kind::Motor(&quantities::EFFORT);
const CURRENT: Kind = Kind::Plain(&quantities::CURRENT);
const CURRENT_RMS: Kind = Kind::Plain(&quantities::CURRENT_RMS);
const VOLTAGE: Kind = Kind::Plain(&quantities::VOLTAGE_AMPLITUDE);
const POWER: Kind = Kind::Plain(&quantities::POWER);
const ENERGY: Kind = Kind::Plain(&quantities::ENERGY);
const LOAD_EFFORT: Kind = Kind::Axis(&quantities::EFFORT);
const TEMPERATURE: Kind = Kind::Plain(&quantities::TEMPERATURE);

names! {
    MoveTime "move_time" Move TIME "1.35 s" "duration of the longest set-point profile",
    SettlingTime "settling_time" Move TIME "50 ms" "last exit of the load from the window after the end of the profile",
    MoveAndSettlingTime "move_and_settling_time" Move TIME "1.4 s" "longest profile with its settling time",
    ProgramTime "program_time" Move TIME "3 s" "time from the start of the run until the last target is reached for good",
    Overshoot "overshoot" Move LENGTH "5 um" "largest excursion of the load beyond the target",
    SteadyStateError "steady_state_error" Move LENGTH "1 um" "target minus load position once at rest",
    FollowingErrorPeakMotor "following_error_peak_motor" Run LENGTH "10 um" "largest following error of the motor",
    FollowingErrorPeakLoad "following_error_peak_load" Run LENGTH "10 um" "largest following error of the load",
    FollowingErrorRmsMotor "following_error_rms_motor" Run LENGTH "5 um" "RMS following error of the motor during moves",
    FollowingErrorRmsLoad "following_error_rms_load" Run LENGTH "5 um" "RMS following error of the load during moves",
    FollowingErrorCruiseMotor "following_error_cruise_motor" Move LENGTH "0.8 mm" "following error of the motor at constant velocity",
    FollowingErrorCruiseLoad "following_error_cruise_load" Move LENGTH "0.8 mm" "following error of the load at constant velocity",
    VelocityErrorPeak "velocity_error_peak" Run VELOCITY "5 mm/s" "largest difference between commanded and actual motor velocity",
    ResidualVibrationPp "residual_vibration_pp" AfterMove LENGTH "1 um" "peak-to-peak vibration of the load after the profile",
    ResidualVibrationRms "residual_vibration_rms" AfterMove LENGTH "0.3 um" "RMS vibration of the load after the profile",
    ResidualVibrationAmplitude "residual_vibration_amplitude" AfterMove LENGTH "0.5 um" "amplitude of the dominant mode at the end of the profile",
    ResidualVibrationFrequency "residual_vibration_frequency" AfterMove FREQUENCY "40 Hz" "natural frequency of the dominant mode",
    ResidualVibrationDamping "residual_vibration_damping" AfterMove RATIO "0.02" "damping ratio of the dominant mode",
    ResidualVibrationShare "residual_vibration_share" AfterMove RATIO "0.9" "share of the vibration that the fitted modes explain",
    SetpointVelocityRatio "setpoint_velocity_ratio" Move RATIO "1" "peak velocity of the set-point over its limit",
    SetpointAccelerationRatio "setpoint_acceleration_ratio" Move RATIO "1" "peak acceleration of the set-point over its limit",
    SetpointJerkRatio "setpoint_jerk_ratio" Move RATIO "1" "peak jerk of the set-point over its limit",
    SetpointSnapRatio "setpoint_snap_ratio" Move RATIO "1" "peak snap of the set-point over its limit",
    CurrentPeak "current_peak" Run CURRENT "12 Apk" "largest current vector",
    CurrentRms "current_rms" Run CURRENT_RMS "4 Arms" "RMS phase current over the recording",
    CurrentSaturationTime "current_saturation_time" Run TIME "0 s" "time at the current limit",
    VoltagePeak "voltage_peak" Run VOLTAGE "300 V" "largest voltage vector of the inverter",
    VoltageSaturationTime "voltage_saturation_time" Run TIME "0 s" "time at the voltage limit",
    EffortSaturationTime "effort_saturation_time" Run TIME "0 s" "time at the effort limit",
    TorquePeak "torque_peak" Run EFFORT "8 Nm" "largest torque or force of the motor",
    TorqueReferencePeak "torque_reference_peak" Run EFFORT "8 Nm" "largest torque or force that the drive requests",
    TorqueRms "torque_rms" Run EFFORT "2 Nm" "RMS torque or force of the motor over the recording",
    ElectricalPowerPeak "electrical_power_peak" Run POWER "800 W" "largest electrical power of the motor, taken or returned",
    ShaftPowerPeak "shaft_power_peak" Run POWER "750 W" "largest power of the motor on its shaft, driving or braking",
    ElectricalEnergy "electrical_energy" Run ENERGY "120 J" "electrical energy that the motor takes, less the energy that it returns",
    CopperLoss "copper_loss" Run ENERGY "15 J" "energy lost in the winding",
    InverterLoss "inverter_loss" Run ENERGY "5 J" "energy lost in the devices of the inverter",
    DcLinkMin "dc_link_min" Run VOLTAGE "280 V" "lowest voltage of the DC link",
    DcLinkMax "dc_link_max" Run VOLTAGE "400 V" "highest voltage of the DC link",
    BrakeEnergy "brake_energy" Run ENERGY "20 J" "energy dissipated in the brake resistor",
    EndStopForcePeak "end_stop_force_peak" Run LOAD_EFFORT "0 N" "largest torque or force of the end stops on the load",
    EndStopSpeed "end_stop_speed" Run VELOCITY "0 mm/s" "largest velocity at which the load meets an end stop",
    WindingTemperaturePeak "winding_temperature_peak" Run TEMPERATURE "120 degC" "highest temperature of the winding",
    BufferErrors "buffer_errors" Run RATIO "0" "errors that the trajectory buffer of the drive latches",
    InternalLimitTime "internal_limit_time" Run TIME "0 s" "time in which a limit of the drive is active (bit 11)",
    BusFaultCycles "bus_fault_cycles" Run RATIO "20" "frames and task cycles that a fault of the scenario affects",
    CouplingError "coupling_error" Run RATIO "0.01" "estimated error of the signals exchanged with FMUs within a step",
}

/// Part of a run that a metric covers, and thereby the prerequisites of its measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scope {
    /// Any part of a run.
    Run,
    /// A move.
    Move,
    /// The time after a move, or from the start of the measurement of residual vibration.
    AfterMove,
}

impl Name {
    /// True if it needs a settling window.
    #[must_use]
    pub const fn needs_window(self) -> bool {
        matches!(self, Self::SettlingTime | Self::MoveAndSettlingTime | Self::ProgramTime)
    }

    /// True if it covers the time after a profile, and needs a [basis](crate::Question::basis).
    #[must_use]
    pub const fn needs_basis(self) -> bool {
        matches!(self, Self::SettlingTime | Self::MoveAndSettlingTime | Self::ProgramTime | Self::SteadyStateError)
            || matches!(self.scope(), Scope::AfterMove)
    }

    /// True if it is computed from the rows of a recording; others come from the plan, or from the master of a coupling.
    #[must_use]
    pub const fn is_of_rows(self) -> bool {
        !matches!(
            self,
            Self::MoveTime
                | Self::SetpointVelocityRatio
                | Self::SetpointAccelerationRatio
                | Self::SetpointJerkRatio
                | Self::SetpointSnapRatio
                | Self::CouplingError
        )
    }

    /// True if the sign of the value means a direction. A largest allowed value then bounds the magnitude.
    #[must_use]
    pub const fn is_signed(self) -> bool {
        matches!(self, Self::SteadyStateError | Self::FollowingErrorCruiseMotor | Self::FollowingErrorCruiseLoad)
    }

    /// Values that a largest allowed value may have.
    #[must_use]
    pub const fn largest(self) -> Measure {
        not_negative(self.kind(), self.example())
    }

    /// Values that an end of an allowed range may have: below zero only where the value can be, and its sign is not a direction (the
    /// damping of a vibration that grows); other bounds are of magnitudes.
    #[must_use]
    pub const fn end_of_range(self) -> Measure {
        match self {
            Self::ResidualVibrationDamping => any(self.kind(), self.example()),
            _ => self.largest(),
        }
    }
}

/// A name that no metric has.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("unknown metric `{name}`; docs/metrics.md lists them")]
pub struct UnknownMetric {
    /// Rejected name.
    pub name: String,
}

impl FromStr for Name {
    type Err = UnknownMetric;

    fn from_str(text: &str) -> Result<Self, UnknownMetric> {
        Self::ALL
            .iter()
            .copied()
            .find(|name| name.as_str() == text)
            .ok_or_else(|| UnknownMetric { name: text.to_owned() })
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Results files and scenarios depend on these names: the list of the first release, written out once more.
    #[test]
    fn names_are_stable() {
        let promised = "following_error_peak_motor following_error_peak_load following_error_rms_motor \
            following_error_rms_load following_error_cruise_motor following_error_cruise_load settling_time \
            residual_vibration_pp residual_vibration_rms residual_vibration_amplitude \
            residual_vibration_frequency residual_vibration_damping move_time setpoint_velocity_ratio \
            setpoint_acceleration_ratio setpoint_jerk_ratio setpoint_snap_ratio current_peak \
            voltage_saturation_time torque_rms";
        for name in promised.split_whitespace() {
            assert_eq!(name.parse::<Name>().map(Name::as_str), Ok(name));
        }
    }

    #[test]
    fn an_unknown_name_is_quoted() {
        let e = "settling".parse::<Name>().unwrap_err();
        assert_eq!(e.to_string(), "unknown metric `settling`; docs/metrics.md lists them");
    }

    #[test]
    fn the_documentation_defines_every_metric() {
        let page = include_str!("../../../docs/metrics.md");
        for name in Name::ALL {
            assert!(page.contains(&format!("`{name}`")), "docs/metrics.md lacks `{name}`");
        }
    }
}
