//! One line of a plot, in SI.
use crate::rerun::EntityPath;
use crate::run::{Run, range};
use crate::style::Rgb;

/// One line in a plot.
#[derive(Debug)]
pub(crate) struct Series<'a> {
    /// Its entity.
    pub(crate) path: EntityPath,
    /// Name in the legend.
    pub(crate) name: String,
    /// Colour.
    pub(crate) colour: Rgb,
    /// Width (points).
    pub(crate) width: f32,
    /// True if the plot shows it; otherwise it is logged for the user to add.
    pub(crate) shown: bool,
    /// Its role in the plot.
    pub(crate) role: Role,
    /// Its values (SI).
    pub(crate) values: Values<'a>,
}

/// Role of a line in its plot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// The curve that the title describes.
    Lead,
    /// Another curve.
    Companion,
    /// A bound of the others.
    Bound,
}

/// Values of a line, in SI.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Values<'a> {
    /// A channel from the instant `first` on.
    Channel {
        /// Run that recorded it.
        run: Run<'a>,
        /// All its values.
        values: &'a [f64],
        /// First instant that is shown.
        first: usize,
        /// Offset that is subtracted.
        origin: f64,
    },
    /// A constant.
    Level {
        /// Value.
        value: f64,
        /// Start and end (s).
        span: (f64, f64),
    },
    /// An instant, as an upright line.
    Instant {
        /// Time (s).
        time: f64,
        /// Lower and upper end.
        range: (f64, f64),
    },
}

impl Series<'_> {
    /// Smallest and largest value that it shows.
    pub(crate) fn range(&self) -> Option<(f64, f64)> {
        match self.values {
            Values::Channel { values, first, origin, .. } => {
                range(&values[first..]).map(|(low, high)| (low - origin, high - origin))
            }
            Values::Level { value, .. } => Some((value, value)),
            Values::Instant { range, .. } => Some(range),
        }
    }

    /// First and last instant (s).
    pub(crate) fn time(&self) -> (f64, f64) {
        match self.values {
            Values::Channel { run, first, .. } => (run.recording.time_of(first), run.end()),
            Values::Level { span, .. } => span,
            Values::Instant { time, .. } => (time, time),
        }
    }

    /// Number of instants, among at most `looks` evenly spread over the times `from` to `to` (s), at which it lies between `low` and
    /// `high`.
    pub(crate) fn hits(&self, (from, to): (f64, f64), (low, high): (f64, f64), looks: usize) -> usize {
        let inside = |value: f64| low <= value && value <= high;
        match self.values {
            Values::Channel { run, values, first, origin } => {
                let start = run.recording.index_at(from).clamp(first, values.len());
                let end = (run.recording.index_at(to) + 1).clamp(start, values.len());
                let stride = (end - start).div_ceil(looks).max(1);
                values[start..end].iter().step_by(stride).filter(|value| inside(**value - origin)).count()
            }
            Values::Level { value, .. } => usize::from(inside(value)) * looks,
            // One line upright hides nothing behind a legend.
            Values::Instant { .. } => 0,
        }
    }
}
