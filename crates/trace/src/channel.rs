//! One recorded quantity.
use crate::values::Values;
use serde::{Deserialize, Serialize};
use servobench_base::Rate;

/// Description of a channel, without values.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChannelSpec {
    /// Name with its group in front: `load.position`, `current.q`.
    pub name: String,
    /// Unit symbol: `m`, `rad/s`, `N`, `A`; empty for a pure number.
    pub unit: String,
    /// Stage of the loop that writes it: `set-point`, `position loop`, `mechanics`.
    pub writer: String,
    /// Rate at which the writer renews it; between renewals the value is held.
    pub rate: Rate,
}

/// A channel and its values.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// Its description.
    pub spec: ChannelSpec,
    /// One value per recorded instant (SI).
    pub values: Values,
}
