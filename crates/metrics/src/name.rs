//! The stable names of the metrics.
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// Declares [`Name`] once: variant, name in files, meaning in a few words.
macro_rules! names {
    ($($variant:ident $text:literal $meaning:literal,)*) => {
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

            /// Meaning in a few words.
            #[must_use]
            pub const fn meaning(self) -> &'static str {
                match self { $(Self::$variant => $meaning,)* }
            }
        }
    };
}

names! {
    MoveTime "move_time" "duration of the longest set-point profile",
    SettlingTime "settling_time" "last exit of the load from the window after the end of the profile",
    MoveAndSettlingTime "move_and_settling_time" "longest profile with its settling time",
    Overshoot "overshoot" "largest excursion of the load beyond the target",
    SteadyStateError "steady_state_error" "target minus load position once at rest",
    FollowingErrorPeakMotor "following_error_peak_motor" "largest following error of the motor",
    FollowingErrorPeakLoad "following_error_peak_load" "largest following error of the load",
    FollowingErrorRmsMotor "following_error_rms_motor" "RMS following error of the motor during moves",
    FollowingErrorRmsLoad "following_error_rms_load" "RMS following error of the load during moves",
    FollowingErrorCruiseMotor "following_error_cruise_motor" "following error of the motor at constant velocity",
    FollowingErrorCruiseLoad "following_error_cruise_load" "following error of the load at constant velocity",
    VelocityErrorPeak "velocity_error_peak" "largest difference between commanded and actual motor velocity",
    ResidualVibrationPp "residual_vibration_pp" "peak-to-peak vibration of the load after the profile",
    ResidualVibrationRms "residual_vibration_rms" "RMS vibration of the load after the profile",
    ResidualVibrationAmplitude "residual_vibration_amplitude" "amplitude of the dominant mode at the end of the profile",
    ResidualVibrationFrequency "residual_vibration_frequency" "natural frequency of the dominant mode",
    ResidualVibrationDamping "residual_vibration_damping" "damping ratio of the dominant mode",
    ResidualVibrationShare "residual_vibration_share" "share of the vibration that the fitted modes explain",
    SetpointVelocityRatio "setpoint_velocity_ratio" "peak velocity of the set-point over its limit",
    SetpointAccelerationRatio "setpoint_acceleration_ratio" "peak acceleration of the set-point over its limit",
    SetpointJerkRatio "setpoint_jerk_ratio" "peak jerk of the set-point over its limit",
    SetpointSnapRatio "setpoint_snap_ratio" "peak snap of the set-point over its limit",
    CurrentPeak "current_peak" "largest current vector",
    CurrentRms "current_rms" "effective phase current over the recording",
    CurrentSaturationTime "current_saturation_time" "time at the current limit",
    VoltagePeak "voltage_peak" "largest voltage vector of the inverter",
    VoltageSaturationTime "voltage_saturation_time" "time at the voltage limit",
    EffortSaturationTime "effort_saturation_time" "time at the effort limit",
    TorquePeak "torque_peak" "largest torque or force of the motor",
    TorqueReferencePeak "torque_reference_peak" "largest torque or force that the drive asks for",
    TorqueRms "torque_rms" "RMS torque or force of the motor over the recording",
    ElectricalPowerPeak "electrical_power_peak" "largest electrical power of the motor, taken or given back",
    ShaftPowerPeak "shaft_power_peak" "largest power of the motor on its shaft, driving or braking",
    ElectricalEnergy "electrical_energy" "electrical energy that the motor takes, less what it gives back",
    CopperLoss "copper_loss" "energy lost in the winding",
}

impl Name {
    /// Whether the sign of the value means a direction. A largest allowed value then bounds the magnitude.
    #[must_use]
    pub const fn is_signed(self) -> bool {
        matches!(self, Self::SteadyStateError | Self::FollowingErrorCruiseMotor | Self::FollowingErrorCruiseLoad)
    }
}

/// A name that no metric has.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("there is no metric `{name}`; docs/metrics.md lists them")]
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

    /// Results files and scenarios depend on these names: the list of the first release, typed out once more.
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
        assert_eq!(e.to_string(), "there is no metric `settling`; docs/metrics.md lists them");
    }

    #[test]
    fn the_documentation_defines_every_metric() {
        let page = include_str!("../../../docs/metrics.md");
        for name in Name::ALL {
            assert!(page.contains(&format!("`{name}`")), "docs/metrics.md lacks `{name}`");
        }
    }
}
