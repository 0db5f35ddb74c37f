//! What varies from run to run of a sweep: keys of a scenario over values, and draws of what has a tolerance.
//!
//! ```text
//! point = combination of the axes × draw        index = combination · draws + draw
//! ```
//! A point is made from its index alone, whenever and wherever it is asked for, so that a sweep of any length takes no memory, can be
//! gone on with, and is the same on every machine.
//!
//! And what the runs of a sweep say together:
//!
//! ```text
//! Table (a row for each run) → Sample: quantiles · Proportion: share of good ones · Sensitivity: which key costs how much · front
//! ```

mod axis;
mod binomial;
mod cover;
mod distribution;
mod draws;
mod error;
mod pareto;
mod proportion;
mod quantile;
mod random;
mod sensitivity;
mod sweep;
mod table;
mod worst;

pub use axis::{Axis, Spacing, Value, spaced};
pub use cover::KeyColumn;
pub use distribution::Distribution;
pub use draws::{Drawn, Draws, Method};
pub use error::SweepError;
pub use pareto::{front, front_apart};
pub use proportion::Proportion;
pub use quantile::Sample;
pub use sensitivity::{End, Influence, Sensitivity};
pub use sweep::{Arrangement, MOST_POINTS, Setting, Sweep};
pub use table::{Column, Outcome, Table};
