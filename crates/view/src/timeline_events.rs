//! Moves, disturbances, events and messages of FMUs: a log of texts, and lanes of times.
use crate::curves::TIMELINE;
use crate::lanes::{Lane, Span};
use crate::rerun::{EntityPath, RecordingStream, RecordingStreamResult, TextLog, TimeColumn};
use crate::run::{Run, range};
use crate::scale::{Scale, shown_unit};
use crate::style;
use servobench_base::Severity;
use servobench_signals::Signal;
use servobench_trace::{Call, CallFate};

/// Entities that were logged.
#[derive(Debug, Default)]
pub(crate) struct Happenings {
    /// Text logs.
    pub(crate) logs: Vec<EntityPath>,
    /// Lanes.
    pub(crate) lanes: Vec<EntityPath>,
}

/// Channel, its lane, and its text.
const DISTURBANCES: [(&str, &str, &str); 2] = [
    (Signal::DisturbanceMotor.name(), "motor_disturbance", "disturbance on the motor"),
    (Signal::DisturbanceLoad.name(), "load_disturbance", "disturbance on the load"),
];

impl Happenings {
    /// Entities that [`log`] would write for `runs`.
    pub(crate) fn of(runs: &[Run<'_>]) -> Self {
        let mut timeline_events = Self::default();
        for run in runs {
            let recording = run.recording;
            let lanes = lanes(run, 0);
            let says = [recording.events.is_empty(), recording.log.is_empty(), calls(run).is_empty()].contains(&false);
            if !lanes.is_empty() || says {
                timeline_events.logs.push(run.path(&["log"]));
            }
            timeline_events.lanes.extend(lanes.into_iter().map(|lane| lane.path));
        }
        timeline_events
    }
}

/// Logs moves, events and messages of `run`.
pub(crate) fn log(stream: &RecordingStream, run: &Run<'_>, index: usize) -> RecordingStreamResult<()> {
    log_text(stream, run)?;
    lanes(run, index).iter().try_for_each(|lane| lane.log(stream))
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
    let is_of_a_call = |message: &str| run.recording.calls.iter().any(|call| says(call, message));
    for event in run.recording.events.iter().filter(|event| !is_of_a_call(&event.message)) {
        let until = if event.end > event.start { format!(" (until {:.4} s)", event.end) } else { String::new() };
        lines.push((event.start, "WARN", format!("{}: {}{until}", event.source, event.message)));
    }
    lines.extend(calls(run));
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
    // The view shows no column of times.
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

/// True if `message` is the outcome of `call`: it is then logged with the call and its block.
fn says(call: &Call, message: &str) -> bool {
    match &call.fate {
        CallFate::Executed => false,
        CallFate::NeverExecuted(why) | CallFate::Unfinished(why) => why == message,
        CallFate::Failed { message: own, .. } => own == message,
    }
}

/// Lines of calls that were never executed, which is known at the end of the run, and of those that failed.
fn calls(run: &Run<'_>) -> Vec<(f64, &'static str, String)> {
    let line = |call: &servobench_trace::Call| {
        let who = format!("`{}` ({})", call.name, call.block);
        let level = if call.is_optional { "INFO" } else { "ERROR" };
        match &call.fate {
            CallFate::NeverExecuted(why) => {
                // The reason begins with the name of the call.
                let why = why.strip_prefix(&format!("`{}` was not executed: ", call.name)).unwrap_or(why);
                Some((run.end(), level, format!("{who} was never executed: {why}")))
            }
            CallFate::Failed { time, id, message } => {
                Some((*time, level, format!("{who} failed: {message} (ErrorID {id:X}h)")))
            }
            CallFate::Unfinished(why) => Some((run.end(), level, format!("{who} did not finish: {why}"))),
            CallFate::Executed => None,
        }
    };
    run.recording.calls.iter().filter_map(line).collect()
}

/// Rerun's name of `severity`.
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
    let moves =
        moves.map(|made| Span { start: made.start, end: made.end, text: short(&made.label).into(), colour }).collect();
    let mut lanes = vec![Lane { path: run.path(&["moves"]), spans: moves, otherwise: "at rest" }];
    for (channel, name, _) in DISTURBANCES {
        let spans = disturbed(run, channel);
        lanes.push(Lane { path: run.path(&[name]), spans, otherwise: "none" });
    }
    for event in run.recording.events.iter().filter(|event| event.end > event.start) {
        let path = run.path(&["events", &event.source.replace(' ', "_")]);
        let (start, end, text) = (event.start, event.end, (&event.message).into());
        let span = Span { start, end, text, colour: style::LIMIT };
        match lanes.iter_mut().find(|lane| lane.path == path) {
            Some(lane) => lane.spans.push(span),
            None => lanes.push(Lane { path, spans: vec![span], otherwise: "none" }),
        }
    }
    lanes.retain(|lane| !lane.spans.is_empty());
    lanes
}

/// Label of a move in a lane: start and target come first in the limited space.
fn short(label: &str) -> &str {
    label.strip_prefix("move from ").unwrap_or(label)
}

/// Times and size of the effort in `channel`. A single row of zero between two others is a zero crossing of a sine.
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
        let [start, end] = [first, last + 1].map(|row| run.recording.time_of(row));
        Some(Span { start, end, text: text.into(), colour: style::DISTURBANCE })
    };
    spans.filter_map(span).collect()
}
