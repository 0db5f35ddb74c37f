//! `Recording` → Rerun: the bytes of a file, or an open viewer.
//!
//! All data are on one timeline, `time` (s since the start of the run). A channel of more instants than [`ViewOptions::max_instants`] is
//! thinned to a minimum/maximum envelope: the run is cut into stretches of equal length and the smallest and the largest value of each
//! stay, at their instants. The full rate is in the Parquet file. Curves are logged in the unit in their view's title, chosen by the
//! largest value of the run (µm for a following error); 3D poses are every n-th instant, at most 4 000.

mod blueprint;
mod catalogue;
mod curves;
mod error;
mod lanes;
mod layout;
mod legend;
mod linear;
mod operating;
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
pub use presentation::Presentation;
pub use servobench_view_request::{MotorLimits, Outcome, Verdict, ViewOptions};

use servobench_trace::Recording;
use servobench_view_request::Request;

/// One run as an `.rrd` file with its blueprint.
///
/// # Errors
/// [`ViewError::Rerun`].
pub fn run_rrd(recording: &Recording, options: &ViewOptions) -> Result<Vec<u8>, ViewError> {
    Presentation::of_run(recording, options).to_rrd()
}

/// Several labelled runs overlaid, as one `.rrd` file with its blueprint.
///
/// # Errors
/// As [`Presentation::of_comparison`]; [`ViewError::Rerun`].
pub fn comparison_rrd(runs: &[(&str, &Recording)], options: &ViewOptions) -> Result<Vec<u8>, ViewError> {
    Presentation::of_comparison(runs, options)?.to_rrd()
}

/// The `.rrd` file requested by `request` for `recordings`: a single one without a label, or several with one each.
///
/// # Errors
/// [`ViewError::Labels`]; as [`run_rrd`] and [`comparison_rrd`].
pub fn requested_rrd(recordings: &[Recording], request: &Request) -> Result<Vec<u8>, ViewError> {
    let Request { labels, options } = request;
    match recordings {
        [one] if labels.is_empty() => run_rrd(one, options),
        all if labels.len() == all.len() => {
            let runs: Vec<_> = labels.iter().map(String::as_str).zip(all).collect();
            comparison_rrd(&runs, options)
        }
        all => Err(ViewError::Labels { labels: labels.len(), recordings: all.len() }),
    }
}
