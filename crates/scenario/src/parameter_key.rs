//! Keys of a scenario file for the parameters of drive, switches and end stops.
use crate::schema::json_schema;
use serde_json::Value;
use servobench_config::Parameter;
use servobench_drive::measurement::mt;
use servobench_drive::{self as drive, cogging, current, delay, feedforward, filter, velocity};
use servobench_plant::SwitchPoint;
use std::collections::VecDeque;
use std::sync::LazyLock;

/// Parameters of the firmware that the file expresses in another way (a bandwidth, a rate, a share), with their key or, where several
/// keys decide, their table.
const SAID_OTHERWISE: [(&Parameter, &str); 19] = [
    (drive::Parameter::TRANSMISSION, "axis"),
    (drive::Parameter::POSITION_GAIN, "drive.position.gain"),
    (drive::Parameter::POSITION_RATE, "drive.position.rate"),
    (drive::Parameter::VELOCITY_RATE, "drive.velocity.rate"),
    (velocity::Parameter::GAIN, "drive.velocity.gain"),
    (velocity::Parameter::MAX_EFFORT, "drive"),
    (current::Parameter::POLE_PAIRS, "motor.pole_pairs"),
    (feedforward::Parameter::VELOCITY, "drive.feedforward.velocity"),
    (feedforward::Parameter::MOTOR_INERTIA, "drive.estimate.motor_inertia"),
    (delay::Parameter::DELAY, "drive.feedforward.delay"),
    (cogging::Parameter::AMPLITUDE, "drive.cogging"),
    (cogging::Parameter::PHASE, "drive.cogging"),
    (mt::Parameter::STEP, "motor.encoder"),
    (filter::Parameter::FREQUENCY, "drive.filter"),
    (filter::Parameter::DAMPING, "drive.filter"),
    (filter::Parameter::ZERO_FREQUENCY, "drive.filter"),
    (filter::Parameter::ZERO_DAMPING, "drive.filter"),
    (filter::Parameter::POLE_FREQUENCY, "drive.filter"),
    (filter::Parameter::POLE_DAMPING, "drive.filter"),
];

/// Keys of the file that hold a parameter as declared by its owner: the names of the parameters with their keys, those nearest to the
/// root first.
static KEYS: LazyLock<Vec<(String, String)>> = LazyLock::new(|| {
    let schema = json_schema();
    let mut tables = VecDeque::from([(String::new(), &schema)]);
    let mut keys = Vec::new();
    while let Some((path, table)) = tables.pop_front() {
        if let Some(title) = table["title"].as_str().filter(|_| !path.is_empty()) {
            keys.push((title.to_owned(), path.clone()));
        }
        for key in table["x-order"].as_array().into_iter().flatten().filter_map(Value::as_str) {
            let path = if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
            tables.push_back((path, &table["properties"][key]));
        }
    }
    keys
});

/// Key from which a parameter of the drive's firmware or of the end stops follows, or the table where several keys decide.
#[must_use]
pub fn parameter_key(parameter: &Parameter) -> &'static str {
    let otherwise = SAID_OTHERWISE.iter().find(|(known, _)| known.name == parameter.name).map(|(_, key)| *key);
    let key = || KEYS.iter().find(|(name, _)| name == parameter.name).map(|(_, key)| key.as_str());
    otherwise.or_else(key).unwrap_or("drive")
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
    use servobench_motion::LimitParameter;
    use servobench_plant::{ChainParameter, EncoderParameter, EndStopParameter, FrictionParameter, pmsm};

    fn of_the_drive() -> impl Iterator<Item = &'static Parameter> {
        let all = [
            drive::Parameter::ALL,
            velocity::Parameter::ALL,
            current::Parameter::ALL,
            feedforward::Parameter::ALL,
            delay::Parameter::ALL,
            filter::Parameter::ALL,
            cogging::Parameter::ALL,
            current::operating_point::Parameter::ALL,
            current::dead_time::Parameter::ALL,
            drive::BlockParameter::ALL,
            drive::overload::Parameter::ALL,
            drive::schedule::Parameter::ALL,
            drive::supervision::Parameter::ALL,
            drive::derivative::Parameter::ALL,
            drive::position::Parameter::ALL,
            mt::Parameter::ALL,
            drive::measurement::observer::Parameter::ALL,
        ];
        all.into_iter().flatten().copied()
    }

    /// The reference shows the example of a parameter as a value of its key.
    #[test]
    fn every_example_is_a_value_of_its_parameter() {
        let others = [
            ChainParameter::ALL,
            EndStopParameter::ALL,
            FrictionParameter::ALL,
            pmsm::Parameter::ALL,
            EncoderParameter::ALL,
            LimitParameter::ALL,
        ];
        let all: Vec<_> = of_the_drive().chain(others.into_iter().flatten().copied()).collect();
        assert!(all.len() > 40, "{}", all.len());
        for Parameter { name, meaning, measure } in all {
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

    /// The schema is made of the tables that read the files. A parameter is looked up by its name, so names must be unique.
    #[test]
    fn every_parameter_has_its_own_name_and_a_key_of_the_file() {
        let schema = json_schema();
        let of_drive: Vec<_> = of_the_drive().collect();
        for (index, parameter) in of_drive.iter().enumerate() {
            assert!(of_drive[..index].iter().all(|other| other.name != parameter.name), "{parameter}");
            let is_said_otherwise = SAID_OTHERWISE.iter().any(|(known, _)| known == parameter);
            assert_ne!(is_said_otherwise, KEYS.iter().any(|(name, _)| name == parameter.name), "{parameter}");
        }
        let at = |key: &str| -> &Value {
            let found = key.split('.').fold(&schema, |table, part| &table["properties"][part]);
            assert_ne!(found, &Value::Null, "{key}");
            found
        };
        for parameter in of_drive {
            // A parameter of another crate may have the name as long as no key does.
            let found = at(parameter_key(parameter));
            let meaning = found["description"].as_str().unwrap();
            assert!(found["title"].is_null() || meaning.starts_with(parameter.meaning), "{parameter}: {meaning}");
        }
        for point in SwitchPoint::ALL {
            at(switch_key(point));
        }
        for (parameter, key) in EndStopParameter::ALL.iter().zip(["negative", "positive", "stiffness", "damping"]) {
            assert_eq!(parameter_key(parameter), format!("axis.end_stops.{key}"));
        }
        assert_eq!(parameter_key(current::Parameter::DC_LINK), "drive.dc_link", "not that of the estimate");
        assert_eq!(parameter_key(current::Parameter::RESISTANCE), "drive.estimate.motor.resistance");
    }
}
