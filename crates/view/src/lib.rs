//! `Recording` → Rerun: a file, or a viewer that is open.
//!
//! Everything stands on one timeline, `time` (s since the start of the run). A channel of more instants than
//! [`ViewOptions::max_instants`] is thinned to a minimum/maximum envelope: the run is cut into stretches of equal length
//! and of each the smallest and the largest value stay, at their own instants. The full rate is in the Parquet file.
//! Curves are logged in the unit that their view's title names, chosen by the largest value of the run (µm for a
//! following error); 3D poses are every n-th instant, at most 4 000.

mod blueprint;
mod catalogue;
mod curves;
mod error;
mod lanes;
mod layout;
mod legend;
mod linear;
mod operating;
mod options;
mod plan;
mod plane;
mod planned;
mod presentation;
mod reached;
mod rerun;
mod residual;
mod rotary;
mod run;
mod scale;
mod scene;
mod series;
mod settling;
mod signals;
mod style;
mod ticks;
mod timeline_events;
mod unlisted;
mod verdict;

pub use error::ViewError;
pub use layout::Layout;
pub use options::{MotorLimits, Outcome, Verdict, ViewOptions};
pub use presentation::{Presentation, check_labels};

use servobench_trace::Recording;
use std::path::Path;

/// Writes one run as an `.rrd` file with its blueprint.
///
/// # Errors
/// [`ViewError::Rerun`] and [`ViewError::Io`].
pub fn write_rrd(recording: &Recording, path: impl AsRef<Path>, options: &ViewOptions) -> Result<(), ViewError> {
    Presentation::of_run(recording, options).write(path)
}

/// Writes several labelled runs over each other as one `.rrd` file with its blueprint.
///
/// # Errors
/// As [`Presentation::of_comparison`]; [`ViewError::Rerun`] and [`ViewError::Io`].
pub fn write_comparison_rrd(
    runs: &[(&str, &Recording)],
    path: impl AsRef<Path>,
    options: &ViewOptions,
) -> Result<(), ViewError> {
    Presentation::of_comparison(runs, options)?.write(path)
}
