//! The end of a move.

use servobench_base::Stateful;
/// The end of a move, which determines if the axis should arrive at its target.
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
