//! Lanes: states over time, as texts with colours.
use crate::curves::TIMELINE;
use crate::rerun::{
    Color, EntityPath, RecordingStream, RecordingStreamResult, StateChange, StateConfiguration, TimeColumn,
};
use crate::style::{self, Rgb};
use std::borrow::Cow;

/// Something with a start, an end and a text.
#[derive(Debug)]
pub(crate) struct Span<'a> {
    /// Start (s).
    pub(crate) start: f64,
    /// End (s); infinite where it lasts to the end of the run, whenever that is.
    pub(crate) end: f64,
    /// Its text.
    pub(crate) text: Cow<'a, str>,
    /// Its colour; the same for the same text.
    pub(crate) colour: Rgb,
}

/// A row of a view of lanes.
#[derive(Debug)]
pub(crate) struct Lane<'a> {
    /// Its entity.
    pub(crate) path: EntityPath,
    /// Spans in order of time.
    pub(crate) spans: Vec<Span<'a>>,
    /// Text outside of the spans.
    pub(crate) otherwise: &'static str,
}

impl Lane<'_> {
    /// Logs it.
    pub(crate) fn log(&self, stream: &RecordingStream) -> RecordingStreamResult<()> {
        let Self { path, spans, otherwise } = self;
        // From the start of the run on; otherwise the view would begin with the first span.
        let mut changes =
            if spans.first().is_some_and(|span| span.start > 0.0) { vec![(0.0, *otherwise)] } else { Vec::new() };
        for (index, span) in spans.iter().enumerate() {
            changes.push((span.start, &*span.text));
            if span.end.is_finite() && spans.get(index + 1).is_none_or(|next| next.start > span.end) {
                changes.push((span.end, *otherwise));
            }
        }
        let times = TimeColumn::new_duration_secs(TIMELINE, changes.iter().map(|(time, _)| *time));
        let columns =
            StateChange::update_fields().with_state(changes.iter().map(|(_, text)| *text)).columns_of_unit_batches()?;
        let mut states: Vec<(&str, Rgb)> = vec![(*otherwise, style::IDLE)];
        for span in spans {
            if states.iter().all(|(text, _)| *text != &*span.text) {
                states.push((&*span.text, span.colour));
            }
        }
        let (texts, colours): (Vec<&str>, Vec<Color>) =
            states.into_iter().map(|(text, [r, g, b])| (text, Color::from_rgb(r, g, b))).unzip();
        let configuration = StateConfiguration::new().with_values(texts).with_colors(colours);
        stream.send_columns(path.clone(), [times], columns)?;
        stream.log_static(path.clone(), &configuration)
    }
}
