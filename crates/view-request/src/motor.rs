//! A synchronous motor and its bounds.
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use servobench_base::{Coordinate, Dq};
use servobench_plant::pmsm::{Bounds, Params};

/// A synchronous motor and its bounds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MotorLimits {
    /// The motor.
    #[serde(with = "by_name")]
    pub motor: Params,
    /// Largest current that the drive requests, and voltage that the inverter gives in every direction.
    #[serde(with = "BoundsFields")]
    pub bounds: Bounds,
    /// Voltage of the DC link (V).
    pub dc_link: f64,
    /// Largest effort that the drive requests (N·m or N); may be infinite.
    #[serde(with = "unbounded")]
    pub effort: f64,
    /// Axis coordinate per motor coordinate; negative for a motor that is mounted in reverse.
    pub transmission: f64,
    /// Motion of the motor.
    #[serde(with = "CoordinateName")]
    pub motion: Coordinate,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Bounds", deny_unknown_fields)]
struct BoundsFields {
    #[serde(with = "unbounded")]
    current: f64,
    voltage: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Coordinate", rename_all = "lowercase")]
enum CoordinateName {
    Linear,
    Rotary,
}

/// Parameters of the motor by their names.
mod by_name {
    use super::{Deserialize, Deserializer, Dq, Params, Serializer};
    use serde::de::Error as _;
    use std::collections::BTreeMap;

    const NAMES: [&str; 5] = ["electrical_ratio", "resistance", "inductance_d", "inductance_q", "flux_linkage"];

    pub(super) fn serialize<S: Serializer>(motor: &Params, to: S) -> Result<S::Ok, S::Error> {
        let Params { electrical_ratio, resistance, inductance: Dq { d, q }, flux_linkage } = *motor;
        to.collect_map(NAMES.into_iter().zip([electrical_ratio, resistance, d, q, flux_linkage]))
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Params, D::Error> {
        let mut named = BTreeMap::<String, f64>::deserialize(from)?;
        let mut values = [0.0; NAMES.len()];
        for (value, name) in values.iter_mut().zip(NAMES) {
            *value = named.remove(name).ok_or_else(|| D::Error::missing_field(name))?;
        }
        if let Some(other) = named.keys().next() {
            return Err(D::Error::unknown_field(other, &NAMES));
        }
        let [electrical_ratio, resistance, d, q, flux_linkage] = values;
        Ok(Params { electrical_ratio, resistance, inductance: Dq { d, q }, flux_linkage })
    }
}

/// A number that may be infinite: then `null`, since JSON has no infinity.
mod unbounded {
    use super::{Deserialize, Deserializer, Serialize, Serializer};

    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
    pub(super) fn serialize<S: Serializer>(value: &f64, to: S) -> Result<S::Ok, S::Error> {
        value.is_finite().then_some(*value).serialize(to)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
        Ok(Option::deserialize(from)?.unwrap_or(f64::INFINITY))
    }
}
