//! Where the parameters of drive and switches stand in a scenario file.
use servobench_drive::Parameter;
use servobench_plant::SwitchPoint;

/// Key from which a parameter of the drive's firmware follows, or the table where several keys decide on it.
#[must_use]
pub const fn parameter_key(parameter: Parameter) -> &'static str {
    match parameter {
        Parameter::Transmission => "axis",
        Parameter::PositionGain => "drive.position.gain",
        Parameter::PositionRate => "drive.position.rate",
        Parameter::VelocityGain => "drive.velocity.gain",
        Parameter::VelocityIntegralTime => "drive.velocity.integral_time",
        Parameter::VelocityFilterTime => "drive.velocity.filter_time",
        Parameter::VelocityRate => "drive.velocity.rate",
        Parameter::MaxEffort => "drive",
        Parameter::CurrentGainD => "drive.current.gain_d",
        Parameter::CurrentGainQ => "drive.current.gain_q",
        Parameter::CurrentIntegralTimeD => "drive.current.integral_time_d",
        Parameter::CurrentIntegralTimeQ => "drive.current.integral_time_q",
        Parameter::CurrentReferenceD => "drive.current.d_reference",
        Parameter::MaxCurrent => "motor.max_current",
        Parameter::DcLink => "drive.dc_link",
        Parameter::DirectGain => "motor.gain",
        Parameter::PolePairs => "motor.pole_pairs",
        Parameter::Resistance => "drive.estimate.motor.resistance",
        Parameter::InductanceD => "drive.estimate.motor.inductance_d",
        Parameter::InductanceQ => "drive.estimate.motor.inductance_q",
        Parameter::FluxLinkage => "drive.estimate.motor.flux_linkage",
        Parameter::VelocityFeedforward => "drive.feedforward.velocity",
        Parameter::ReferenceDelay => "drive.feedforward.delay",
        Parameter::Coulomb => "drive.estimate.coulomb",
        Parameter::Bias => "drive.estimate.bias",
        Parameter::MotorInertia => "drive.estimate.motor_inertia",
        Parameter::LoadInertia => "drive.estimate.load_inertia",
        Parameter::Stiffness => "drive.estimate.stiffness",
        Parameter::MotorViscous => "drive.estimate.motor_viscous",
        Parameter::LoadViscous => "drive.estimate.load_viscous",
    }
}

/// Key of a point of the switches.
#[must_use]
pub const fn switch_key(point: SwitchPoint) -> &'static str {
    match point {
        SwitchPoint::Negative => "axis.switches.negative",
        SwitchPoint::Positive => "axis.switches.positive",
        SwitchPoint::HomeFrom => "axis.switches.home.from",
        SwitchPoint::HomeTo => "axis.switches.home.to",
        SwitchPoint::Index => "axis.switches.index",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    /// The schema is made of the tables that read the files.
    #[test]
    fn every_key_is_one_of_the_file() {
        let schema = crate::json_schema();
        let keys = Parameter::ALL.iter().map(|parameter| parameter_key(*parameter));
        for key in keys.chain(SwitchPoint::ALL.map(switch_key)) {
            let mut table = &schema;
            for part in key.split('.') {
                table = &table["properties"][part];
                assert_ne!(table, &Value::Null, "{key}");
            }
        }
    }
}
