//! What varies from run to run of a sweep: keys of a scenario over values, and draws of what has a tolerance.
//!
//! ```text
//! point = combination of the axes × draw        index = combination · draws + draw
//! ```
//! A point is made from its index alone, whenever and wherever it is asked for, so that a sweep of any length takes no memory, can be
//! gone on with, and is the same on every machine.

mod axis;
mod distribution;
mod draws;
mod error;
mod random;
mod sweep;

pub use axis::{Axis, Spacing, Value, spaced};
pub use distribution::Distribution;
pub use draws::{Drawn, Draws, Method};
pub use error::SweepError;
pub use sweep::{Arrangement, MOST_POINTS, Setting, Sweep};
