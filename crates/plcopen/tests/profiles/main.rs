//! Blocks that follow a table, on an axis whose drive follows at once.
#![expect(clippy::float_cmp, reason = "scales of one and offsets of zero change nothing")]

mod axis_move;
#[path = "../shared/bench.rs"]
mod bench;
mod edges;
mod positions;
mod random;
mod rates;
mod velocity_commands;
