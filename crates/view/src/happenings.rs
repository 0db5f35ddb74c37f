//! Moves, disturbances, events and what FMUs say: a log to read, and lanes to see when.
use crate::curves::TIMELINE;
use crate::run::{Run, range};
use crate::scale::{Scale, shown_unit};
use crate::style::{self, Rgb};
use rerun::{EntityPath, RecordingStream, RecordingStreamResult, StateChange, StateConfiguration, TextLog, TimeColumn};
use servobench_base::Severity;
use std::borrow::Cow;

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
    text: Cow<'a, str>,
}

/// A row of the view.
struct Lane<'a> {
    path: EntityPath,
    spans: Vec<Span<'a>>,
    colour: Rgb,
    /// What is when no span is.
    otherwise: &'static str,
}

/// Channel, its lane, and what it is.
const DISTURBANCES: [(&str, &str, &str); 2] = [
    ("disturbance.motor", "motor_disturbance", "disturbance on the motor"),
    ("disturbance.load", "load_disturbance", "disturbance on the load"),
];

impl Happenings {
    /// Entities that [`log`] would write for `runs`.
    pub(crate) fn of(runs: &[Run<'_>]) -> Self {
        let mut happenings = Self::default();
        for run in runs {
            let recording = run.recording;
            let lanes = lanes(run, 0);
            if !lanes.is_empty() || !recording.events.is_empty() || !recording.log.is_empty() {
                happenings.logs.push(run.path(&["log"]));
            }
            happenings.lanes.extend(lanes.into_iter().map(|lane| lane.path));
        }
        happenings
    }
}

/// Logs moves, events and what was said in `run`.
pub(crate) fn log(stream: &RecordingStream, run: &Run<'_>, index: usize) -> RecordingStreamResult<()> {
    log_text(stream, run)?;
    lanes(run, index).iter().try_for_each(|lane| log_lane(stream, lane))
}

fn log_text(stream: &RecordingStream, run: &Run<'_>) -> RecordingStreamResult<()> {
    let mut lines = Vec::new();
    for made in &run.recording.moves {
        lines.push((made.start, "INFO", format!("{}: start", made.label)));
        lines.push((made.end, "INFO", format!("{}: end of the profile", made.label)));
    }
    for (channel, _, what) in DISTURBANCES {
        for span in disturbed(run, channel) {
            lines.push((span.start, "INFO", format!("{what}: {}", span.text)));
            lines.push((span.end, "INFO", format!("{what}: end")));
        }
    }
    for event in &run.recording.events {
        let until = if event.end > event.start { format!(" (until {:.4} s)", event.end) } else { String::new() };
        lines.push((event.start, "WARN", format!("{}: {}{until}", event.source, event.message)));
    }
    for entry in &run.recording.log {
        lines.push((entry.start, level(entry.severity), format!("{}: {}", entry.source, entry.words())));
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
    // Rerun's own column of times is too narrow for them.
    for (time, _, text) in &mut lines {
        text.insert_str(0, &format!("{time:.4} s  "));
    }
    let times = TimeColumn::new_duration_secs(TIMELINE, lines.iter().map(|(time, _, _)| *time));
    let columns = TextLog::update_fields()
        .with_many_text(lines.iter().map(|(_, _, text)| text.as_str()))
        .with_many_level(lines.iter().map(|(_, level, _)| *level))
        .columns_of_unit_batches()?;
    stream.send_columns(run.path(&["log"]), [times], columns)
}

/// What Rerun calls it.
const fn level(severity: Severity) -> &'static str {
    match severity {
        Severity::Info => "INFO",
        Severity::Warning => "WARN",
        Severity::Error => "ERROR",
    }
}

/// Lanes of a run: its moves, its disturbances, then one for each source of events that last.
fn lanes<'a>(run: &Run<'a>, index: usize) -> Vec<Lane<'a>> {
    let colour = run.label.map_or(style::MOTOR, |_| style::of_run(index));
    let moves = run.recording.moves.iter();
    let moves = moves.map(|made| Span { start: made.start, end: made.end, text: (&made.label).into() }).collect();
    let mut lanes = vec![Lane { path: run.path(&["moves"]), spans: moves, colour, otherwise: "at rest" }];
    for (channel, name, _) in DISTURBANCES {
        let spans = disturbed(run, channel);
        lanes.push(Lane { path: run.path(&[name]), spans, colour: style::DISTURBANCE, otherwise: "none" });
    }
    for event in run.recording.events.iter().filter(|event| event.end > event.start) {
        let path = run.path(&["events", &event.source.replace(' ', "_")]);
        let span = Span { start: event.start, end: event.end, text: (&event.message).into() };
        match lanes.iter_mut().find(|lane| lane.path == path) {
            Some(lane) => lane.spans.push(span),
            None => lanes.push(Lane { path, spans: vec![span], colour: style::LIMIT, otherwise: "none" }),
        }
    }
    lanes.retain(|lane| !lane.spans.is_empty());
    lanes
}

/// When the effort in `channel` acts and how large it is. A row of zero between two others is a sine on its way.
fn disturbed(run: &Run<'_>, channel: &str) -> Vec<Span<'static>> {
    let Some(channel) = run.first_of(&[channel]) else { return Vec::new() };
    let unit = shown_unit(&channel.spec.unit, false);
    let acts = |row: &usize| channel.values[*row] != 0.0;
    let rows: Vec<usize> = (0..channel.values.len()).filter(acts).collect();
    let spans = rows.chunk_by(|row, next| next - row <= 2).filter_map(|rows| Some((*rows.first()?, *rows.last()?)));
    let span = |(first, last): (usize, usize)| {
        let (low, high) = range(&channel.values[first..=last])?;
        let peak = high.max(-low);
        let value = if low < 0.0 && high <= 0.0 { -peak } else { peak };
        let signs = if low < 0.0 && high > 0.0 { "±" } else { "" };
        let text = format!("{signs}{}", Scale::for_peak(&unit, peak).show(value, 3));
        Some(Span { start: run.recording.time_of(first), end: run.recording.time_of(last + 1), text: text.into() })
    };
    spans.filter_map(span).collect()
}

fn log_lane(stream: &RecordingStream, lane: &Lane<'_>) -> RecordingStreamResult<()> {
    let Lane { path, spans, colour, otherwise } = lane;
    // From the start of the run on, or the view would begin with the first span.
    let mut changes =
        if spans.first().is_some_and(|span| span.start > 0.0) { vec![(0.0, *otherwise)] } else { Vec::new() };
    for (index, span) in spans.iter().enumerate() {
        changes.push((span.start, &*span.text));
        if spans.get(index + 1).is_none_or(|next| next.start > span.end) {
            changes.push((span.end, *otherwise));
        }
    }
    let times = TimeColumn::new_duration_secs(TIMELINE, changes.iter().map(|(time, _)| *time));
    let columns =
        StateChange::update_fields().with_state(changes.iter().map(|(_, text)| *text)).columns_of_unit_batches()?;
    let states = spans.iter().map(|span| (&*span.text, *colour)).chain([(*otherwise, style::IDLE)]);
    let (texts, colours): (Vec<&str>, Vec<rerun::Color>) =
        states.map(|(text, [r, g, b])| (text, rerun::Color::from_rgb(r, g, b))).unzip();
    let configuration = StateConfiguration::new().with_values(texts).with_colors(colours);
    stream.send_columns(path.clone(), [times], columns)?;
    stream.log_static(path.clone(), &configuration)
}
