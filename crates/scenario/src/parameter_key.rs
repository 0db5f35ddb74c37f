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
    use crate::reading::{names, read};
    use serde_json::Value;
    use servobench_config::Description;
    use servobench_motion::LimitParameter;
    use servobench_plant::{ChainParameter, EncoderParameter, FrictionParameter, pmsm};

    /// The reference shows the example of a parameter as a value of its key.
    #[test]
    fn every_example_is_a_value_of_its_parameter() {
        let drive = Parameter::ALL.iter().map(|one| (one.name(), one.description()));
        let chain = ChainParameter::ALL.iter().map(|one| (one.name(), one.description()));
        let friction = FrictionParameter::ALL.iter().map(|one| (one.name(), one.description()));
        let motor = pmsm::Parameter::ALL.iter().map(|one| (one.name(), one.description()));
        let encoder = EncoderParameter::ALL.iter().map(|one| (one.name(), one.description()));
        let limits = LimitParameter::ALL.iter().map(|one| (one.name(), one.description()));
        let all: Vec<_> = drive.chain(chain).chain(friction).chain(motor).chain(encoder).chain(limits).collect();
        assert!(all.len() > 40, "{}", all.len());
        for (name, Description { meaning, measure }) in all {
            let candidates: Vec<_> = measure.kind.candidates(None, None).collect();
            let value = match (read(measure.example, &candidates), measure.example.parse()) {
                (Ok((_, value)), _) => value,
                (Err(_), Ok(ratio)) if measure.is_ratio() => ratio,
                (Err(_), _) => panic!("{name}: `{}` is not {}", measure.example, names(&candidates)),
            };
            assert!(measure.bound.holds(value) && measure.bound.check(name, value).is_ok(), "{name}: {value}");
            assert!(!meaning.ends_with('.') && meaning.starts_with(char::is_uppercase), "{name}: {meaning}");
        }
    }

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
