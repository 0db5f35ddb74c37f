//! One run of a presentation.
use crate::rerun::{EntityPath, EntityPathPart};
use servobench_trace::{Channel, Recording};
use servobench_view_request::check_labels;

/// A recording and the place of its entities.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Run<'a> {
    /// First part of its entity paths; `None` for the only run.
    pub(crate) label: Option<&'a str>,
    /// Its data.
    pub(crate) recording: &'a Recording,
}

impl<'a> Run<'a> {
    /// Entity path of `parts` in this run, below the name of its axis where it has one.
    pub(crate) fn path(&self, parts: &[&str]) -> EntityPath {
        // Views of the motor and of bounds have some names to themselves.
        let axis = self.recording.axis().map(|axis| match self.label {
            None if check_labels(&[axis.as_str()]).is_err() => format!("axis-{axis}"),
            _ => axis.to_string(),
        });
        let parts = self.label.into_iter().chain(axis.as_deref()).chain(parts.iter().copied());
        EntityPath::new(parts.map(EntityPathPart::new).collect())
    }

    /// The first of the channels `names` that was recorded.
    pub(crate) fn first_of(&self, names: &[&str]) -> Option<&'a Channel> {
        names.iter().find_map(|name| self.recording.find(name))
    }

    /// `text`, in a comparison preceded by the label of the run.
    pub(crate) fn labelled(&self, text: &str) -> String {
        self.label.map_or_else(|| text.to_owned(), |label| format!("{label} {text}"))
    }

    /// True if motor and load are one body.
    pub(crate) fn is_rigid(&self) -> bool {
        self.recording.about.bodies.len() == 1
    }

    /// End of the last profile (s) and the target of that move (axis unit).
    pub(crate) fn after_the_last_move(&self) -> Option<(f64, f64)> {
        let last = self.recording.moves.iter().max_by(|one, two| one.end.total_cmp(&two.end))?;
        Some((last.end, last.to))
    }

    /// Time of the last instant (s).
    pub(crate) fn end(&self) -> f64 {
        self.recording.time_of(self.recording.len().saturating_sub(1))
    }
}

/// Smallest and largest finite value.
pub(crate) fn range<'v>(values: impl IntoIterator<Item = &'v f64>) -> Option<(f64, f64)> {
    let finite = values.into_iter().filter(|value| value.is_finite());
    finite.fold(None, |range, value| {
        let (low, high) = range.unwrap_or((*value, *value));
        Some((low.min(*value), high.max(*value)))
    })
}
