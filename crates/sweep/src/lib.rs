//! Keys of a scenario that vary from run to run of a sweep, over given values or as draws within tolerances.
//!
//! ```text
//! point = combination of the axes × draw        index = combination · draws + draw
//! ```
//! A point follows from its index alone, at any time and on any machine, so that a sweep of any length takes no memory, can be
//! continued, and is reproducible everywhere.
//!
//! Statistics of all runs of a sweep:
//!
//! ```text
//! Table (a row for each run) → Sample: quantiles · Proportion: share of good runs · Sensitivity: effect of each key · front
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
