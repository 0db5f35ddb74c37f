//! Moves and events: a log to read and lanes to see when.
use crate::curves::TIMELINE;
use crate::run::Run;
use crate::style;
use rerun::{EntityPath, RecordingStream, RecordingStreamResult, StateChange, StateConfiguration, TextLog, TimeColumn};

/// Entities that were logged.
#[derive(Debug, Default)]
pub(crate) struct Happenings {
    /// Text logs.
    pub(crate) logs: Vec<EntityPath>,
    /// Lanes.
    pub(crate) lanes: Vec<EntityPath>,
}

/// Something with a start, an end and a text.
struct Span<'a> {
    start: f64,
    end: f64,
    text: &'a str,
}

impl Happenings {
    /// Entities that [`log`] would write for `runs`.
    pub(crate) fn of(runs: &[Run<'_>]) -> Self {
        let mut happenings = Self::default();
        for run in runs {
            let recording = run.recording;
            if !recording.moves.is_empty() || !recording.events.is_empty() {
                happenings.logs.push(run.path(&["log"]));
            }
            happenings.lanes.extend(lanes(run, 0).into_iter().map(|(path, _, _)| path));
        }
        happenings
    }
}

/// Logs moves and events of `run`.
pub(crate) fn log(stream: &RecordingStream, run: &Run<'_>, index: usize) -> RecordingStreamResult<()> {
    log_text(stream, run)?;
    for (path, spans, colour) in lanes(run, index) {
        log_lane(stream, &path, &spans, colour)?;
    }
    Ok(())
}

fn log_text(stream: &RecordingStream, run: &Run<'_>) -> RecordingStreamResult<()> {
    let mut lines = Vec::new();
    for made in &run.recording.moves {
        lines.push((made.start, "INFO", format!("{}: start", made.label)));
        lines.push((made.end, "INFO", format!("{}: end of the profile", made.label)));
    }
    for event in &run.recording.events {
        let until = if event.end > event.start { format!(" (until {:.4} s)", event.end) } else { String::new() };
        lines.push((event.start, "WARN", format!("{}: {}{until}", event.source, event.message)));
    }
    if lines.is_empty() {
        return Ok(());
    }
    if let Some(label) = run.label {
        for (_, _, text) in &mut lines {
            text.insert_str(0, &format!("{label}: "));
        }
    }
    lines.sort_by(|one, two| one.0.total_cmp(&two.0));
    let times = TimeColumn::new_duration_secs(TIMELINE, lines.iter().map(|(time, _, _)| *time));
    let columns = TextLog::update_fields()
        .with_many_text(lines.iter().map(|(_, _, text)| text.as_str()))
        .with_many_level(lines.iter().map(|(_, level, _)| *level))
        .columns_of_unit_batches()?;
    stream.send_columns(run.path(&["log"]), [times], columns)
}

/// Lanes of a run: its moves, then one for each source of events that last.
fn lanes<'a>(run: &Run<'a>, index: usize) -> Vec<(EntityPath, Vec<Span<'a>>, style::Rgb)> {
    let colour = run.label.map_or(style::MOTOR, |_| style::of_run(index));
    let moves = run.recording.moves.iter();
    let moves = moves.map(|made| Span { start: made.start, end: made.end, text: &made.label }).collect();
    let mut lanes: Vec<(EntityPath, Vec<Span<'a>>, style::Rgb)> = vec![(run.path(&["moves"]), moves, colour)];
    for event in run.recording.events.iter().filter(|event| event.end > event.start) {
        let path = run.path(&["events", &event.source]);
        let span = Span { start: event.start, end: event.end, text: &event.message };
        match lanes.iter_mut().find(|(known, _, _)| *known == path) {
            Some((_, spans, _)) => spans.push(span),
            None => lanes.push((path, vec![span], style::LIMIT)),
        }
    }
    lanes.retain(|(_, spans, _)| !spans.is_empty());
    lanes
}

fn log_lane(
    stream: &RecordingStream,
    path: &EntityPath,
    spans: &[Span<'_>],
    colour: style::Rgb,
) -> RecordingStreamResult<()> {
    let mut changes = Vec::new();
    for (index, span) in spans.iter().enumerate() {
        changes.push((span.start, span.text));
        if spans.get(index + 1).is_none_or(|next| next.start > span.end) {
            // An empty state ends the one before it.
            changes.push((span.end, ""));
        }
    }
    let times = TimeColumn::new_duration_secs(TIMELINE, changes.iter().map(|(time, _)| *time));
    let columns =
        StateChange::update_fields().with_state(changes.iter().map(|(_, text)| *text)).columns_of_unit_batches()?;
    let texts: Vec<&str> = spans.iter().map(|span| span.text).collect();
    let colours = vec![rerun::Color::from_rgb(colour[0], colour[1], colour[2]); texts.len()];
    let configuration = StateConfiguration::new().with_values(texts).with_colors(colours);
    stream.send_columns(path.clone(), [times], columns)?;
    stream.log_static(path.clone(), &configuration)
}
