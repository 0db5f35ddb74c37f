//! Signals: a lane for each, those of one source together; a lane for the reason why a call never completed.
use crate::curves::TIMELINE;
use crate::lanes::{Lane, Span};
use crate::rerun::{
    Color, EntityPath, RecordingStream, RecordingStreamResult, StateChange, StateConfiguration, TimeColumn,
};
use crate::run::Run;
use crate::style::{self, Rgb};
use servobench_trace::{Call, CallFate, Recording, Signal};

/// Colours of the values of a signal, in the order in which they first appear.
const COLOURS: [Rgb; 6] =
    [style::MOTOR, style::LOAD, style::TABLE, style::AUXILIARY, style::DISTURBANCE, style::REFERENCE];

/// Values of an inactive signal.
const OFF: [&str; 5] = ["FALSE", "0", "none", "Off", "Disabled"];
/// Parts of values that indicate an error.
const WRONG: [&str; 5] = ["Error", "Fault", "fault", "Underflow", "Overflow"];

/// Lanes of signals.
#[derive(Debug)]
pub(crate) struct Lanes {
    /// Their entities.
    pub(crate) paths: Vec<EntityPath>,
    /// Those of calls that were never executed or failed, which stand above the others.
    pub(crate) fates: Vec<EntityPath>,
    /// True if there is a program of function blocks.
    pub(crate) has_program: bool,
}

/// The lanes of `runs`.
pub(crate) fn lanes(runs: &[Run<'_>]) -> Lanes {
    let lanes = |run: &Run<'_>| eventful(run).map(|signal| path(run, signal)).collect::<Vec<_>>();
    let calls = |run: &Run<'_>| fates(run).map(|lane| lane.path).collect::<Vec<_>>();
    let has_program = |run: &Run<'_>| {
        !run.recording.calls.is_empty() || run.recording.signals.iter().any(|signal| signal.source == "axis")
    };
    Lanes {
        paths: runs.iter().flat_map(lanes).collect(),
        fates: runs.iter().flat_map(calls).collect(),
        has_program: runs.iter().any(has_program),
    }
}

/// Logs the signals of `run`.
pub(crate) fn log(stream: &RecordingStream, run: &Run<'_>) -> RecordingStreamResult<()> {
    eventful(run).try_for_each(|signal| {
        let path = path(run, signal);
        let times = TimeColumn::new_duration_secs(TIMELINE, signal.changes.iter().map(|(time, _)| *time));
        let values = signal.changes.iter().map(|(_, value)| value.as_str());
        let columns = StateChange::update_fields().with_state(values).columns_of_unit_batches()?;
        let (texts, colours): (Vec<&str>, Vec<Color>) =
            coloured(signal).into_iter().map(|(text, [r, g, b])| (text, Color::from_rgb(r, g, b))).unzip();
        let labels: Vec<&str> = texts.iter().map(|text| label(text)).collect();
        let configuration = StateConfiguration::new().with_values(texts).with_labels(labels).with_colors(colours);
        stream.send_columns(path.clone(), [times], columns)?;
        stream.log_static(path, &configuration)
    })?;
    fates(run).try_for_each(|lane| lane.log(stream))
}

/// A lane for each call that was never executed, and for each that failed: start and reason.
fn fates<'a>(run: &Run<'a>) -> impl Iterator<Item = Lane<'a>> {
    run.recording.calls.iter().filter_map(move |call| fate(run, call))
}

fn fate<'a>(run: &Run<'a>, call: &'a Call) -> Option<Lane<'a>> {
    let (name, since, why) = match &call.fate {
        CallFate::Executed => return None,
        CallFate::NeverExecuted(why) => ("never_executed", 0.0, why),
        CallFate::Unfinished(why) => ("unfinished", 0.0, why),
        CallFate::Failed { time, message, .. } => ("failed", *time, message),
    };
    let span = Span {
        start: since,
        end: f64::INFINITY,
        text: why.as_str().into(),
        colour: if call.is_optional { style::REFERENCE } else { style::LIMIT },
    };
    Some(Lane { path: block_path(run, &call.name, name), spans: vec![span], otherwise: "no error" })
}

/// Signals with active values: those of a block that is never in error would hide the others.
fn eventful<'a>(run: &Run<'a>) -> impl Iterator<Item = &'a Signal> {
    let happens = |signal: &&Signal| signal.changes.iter().any(|(_, value)| !OFF.contains(&value.as_str()));
    run.recording.signals.iter().filter(happens)
}

fn path(run: &Run<'_>, signal: &Signal) -> EntityPath {
    // The viewer sorts lanes by their paths: the axis, the blocks, then the entities below them.
    match signal.source.as_str() {
        source if is_no_block(source) => run.path(&[source, &signal.name]),
        block => block_path(run, block, &signal.name),
    }
}

fn is_no_block(source: &str) -> bool {
    matches!(source, "axis" | "drive" | "link")
}

/// The lane `name` of a block. Its number in the program precedes its name, since the viewer sorts by paths, numbers in them by their
/// value.
fn block_path(run: &Run<'_>, block: &str, name: &str) -> EntityPath {
    let Recording { calls, signals, .. } = run.recording;
    let mut order: Vec<&str> = calls.iter().map(|call| call.name.as_str()).collect();
    // A recording that was stored by an earlier version lists no calls.
    for source in signals.iter().map(|signal| signal.source.as_str()).filter(|source| !is_no_block(source)) {
        if !order.contains(&source) {
            order.push(source);
        }
    }
    let numbered = order.iter().position(|own| *own == block).map(|at| format!("{}.{block}", at + 1));
    run.path(&["blocks", numbered.as_deref().unwrap_or(block), name])
}

/// Text of a value in a lane: none for FALSE, so that TRUE stands out.
fn label(value: &str) -> &str {
    // Without a label the viewer shows the value.
    if value == "FALSE" { " " } else { value }
}

/// The values of `signal` with their colours.
fn coloured(signal: &Signal) -> Vec<(&str, Rgb)> {
    let mut values: Vec<(&str, Rgb)> = Vec::new();
    let mut colours = COLOURS.iter().cycle();
    for (_, value) in &signal.changes {
        if values.iter().any(|(known, _)| known == value) {
            continue;
        }
        let colour = if OFF.contains(&value.as_str()) {
            style::IDLE
        } else if WRONG.iter().any(|wrong| value.contains(wrong)) || (signal.name.contains("Error") && value == "TRUE")
        {
            style::LIMIT
        } else {
            *colours.next().unwrap_or(&style::MOTOR)
        };
        values.push((value, colour));
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    fn signal(name: &str, values: &[&str]) -> Signal {
        let changes = values.iter().enumerate().map(|(k, value)| (k as f64, (*value).to_owned())).collect();
        Signal { source: "first".into(), name: name.into(), changes }
    }

    #[test]
    fn what_is_off_is_grey_and_what_went_wrong_is_red() {
        let done = signal("Done", &["FALSE", "TRUE", "FALSE"]);
        assert_eq!(coloured(&done), [("FALSE", style::IDLE), ("TRUE", style::MOTOR)]);
        assert_eq!(coloured(&signal("Error", &["FALSE", "TRUE"]))[1].1, style::LIMIT);
        let state = signal("state", &["Disabled", "Standstill", "Discrete motion", "Error stop", "Standstill"]);
        let colours: Vec<Rgb> = coloured(&state).into_iter().map(|(_, colour)| colour).collect();
        assert_eq!(colours, [style::IDLE, style::MOTOR, style::LOAD, style::LIMIT]);
    }
}
