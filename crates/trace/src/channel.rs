//! One recorded quantity.
use crate::values::Values;
use serde::{Deserialize, Serialize};
use servobench_base::{AxisName, Rate};
use std::borrow::Cow;

/// Description of a channel, without values.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChannelSpec {
    /// Axis that it belongs to; left out where the axis has no name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<AxisName>,
    /// Name within the axis, with its group in front: `load.position`, `current.q`.
    pub name: String,
    /// Unit symbol: `m`, `rad/s`, `N`, `A`; empty for a pure number.
    pub unit: String,
    /// Stage of the loop that writes it: `set-point`, `position loop`, `mechanics`.
    pub writer: String,
    /// Rate at which the writer renews it; between renewals the value is held.
    pub rate: Rate,
}

impl ChannelSpec {
    /// Name among the channels of all axes, which is that of its column in a file: `x.load.position` of an axis `x`, `load.position` of one
    /// without a name.
    #[must_use]
    pub fn full_name(&self) -> Cow<'_, str> {
        match self.axis {
            Some(axis) => format!("{axis}.{}", self.name).into(),
            None => self.name.as_str().into(),
        }
    }
}

/// A channel and its values.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// Its description.
    pub spec: ChannelSpec,
    /// One value per recorded instant (SI).
    pub values: Values,
}
