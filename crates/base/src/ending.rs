//! How a move ends.

use servobench_base::Stateful;
/// How a move ends, which says whether the axis is to arrive at its target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
pub enum Ending {
    /// At rest at its target.
    #[default]
    AtRest,
    /// Another move takes over before its end.
    Aborted,
    /// In motion: its target is passed, or the axis keeps a velocity.
    InMotion,
}
