//! Limits of the drive that were reached: a lane for each, so that none covers another.
use crate::lanes::{Lane, Span};
use crate::rerun::{EntityPath, RecordingStream, RecordingStreamResult};
use crate::run::Run;
use crate::scale::Scale;
use crate::style::{self, Rgb};
use servobench_trace::{Channel, Recording};

/// First part of the name of a channel of the share of ticks in which a controller was at a limit.
pub(crate) const GROUP: &str = "saturation.";
/// Largest number of stretches of a lane: a screen shows no more.
const STRETCHES: usize = 1_000;
/// A share from here on counts as all of the ticks; the rest is rounding.
const ALL: f64 = 1.0 - 1e-9;

/// Texts and colours of a stretch by its share of saturated ticks, from the largest share down.
const LEVELS: [(f64, &str, Rgb); 3] =
    [(ALL, "at every tick", style::LIMIT), (0.5, "at most ticks", style::LOAD), (0.0, "at some ticks", style::TABLE)];

/// Lanes of limits.
#[derive(Debug)]
pub(crate) struct Reached {
    /// The limits, each with its total duration.
    pub(crate) title: String,
    /// Their entities.
    pub(crate) paths: Vec<EntityPath>,
}

impl Reached {
    /// Limits reached in `runs`; `None` where there are none.
    pub(crate) fn of(runs: &[Run<'_>]) -> Option<Self> {
        let mut said = Vec::new();
        let mut paths = Vec::new();
        for (run, channel) in runs.iter().flat_map(|run| cutting(run.recording).map(move |channel| (run, channel))) {
            let of = run.label.map_or(String::new(), |label| format!(" ({label})"));
            let shares = channel.values.iter().filter(|share| share.is_finite());
            let time = shares.sum::<f64>() * run.recording.rate.period();
            said.push(format!("{}{of} for {}", limit(channel), Scale::for_peak("s", time).show(time, 3)));
            paths.push(path(run, channel));
        }
        (!paths.is_empty()).then(|| Self { title: format!("Limits reached: {}", said.join(", ")), paths })
    }
}

/// Logs the lanes of `run`.
pub(crate) fn log(stream: &RecordingStream, run: &Run<'_>) -> RecordingStreamResult<()> {
    cutting(run.recording).try_for_each(|channel| {
        let spans = spans(run.recording, &channel.values);
        Lane { path: path(run, channel), spans, otherwise: "not reached" }.log(stream)
    })
}

/// The channels of limits that were reached.
fn cutting(recording: &Recording) -> impl Iterator<Item = &Channel> {
    let cuts =
        |channel: &&Channel| channel.spec.name.starts_with(GROUP) && channel.values.iter().any(|share| *share > 0.0);
    recording.channels.iter().filter(cuts)
}

/// `voltage`
fn limit(channel: &Channel) -> &str {
    channel.spec.name.trim_start_matches(GROUP)
}

fn path(run: &Run<'_>, channel: &Channel) -> EntityPath {
    run.path(&["limit_reached", limit(channel)])
}

/// Stretches in which the limit was reached, those of one level together.
fn spans(recording: &Recording, shares: &[f64]) -> Vec<Span<'static>> {
    let length = shares.len().div_ceil(STRETCHES).max(1);
    let mut spans: Vec<Span<'static>> = Vec::new();
    for (index, stretch) in shares.chunks(length).enumerate() {
        // A non-number counts as not reached.
        let mean = stretch.iter().filter(|share| **share > 0.0).sum::<f64>() / stretch.len() as f64;
        let Some((_, text, colour)) = LEVELS.iter().find(|(least, ..)| mean > 0.0 && mean >= *least) else { continue };
        let [start, end] = [index * length, index * length + stretch.len()].map(|row| recording.time_of(row));
        match spans.last_mut() {
            Some(last) if last.end.to_bits() == start.to_bits() && last.text == *text => last.end = end,
            _ => spans.push(Span { start, end, text: (*text).into(), colour: *colour }),
        }
    }
    spans
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_base::Rate;
    use servobench_trace::About;

    #[test]
    fn a_lane_says_how_many_ticks_of_a_stretch_were_at_the_limit() {
        let about = About {
            scenario: String::new(),
            engine: String::new(),
            axis_unit: "m".into(),
            bodies: vec![],
            overrides: vec![],
        };
        let recording = Recording::new(about, Rate::new(12_000).unwrap());
        // 3 600 rows, so four to a stretch.
        let share = |row: usize| match row {
            400..800 => 1.0,
            800..1200 => [1.0, 0.0, 1.0, 0.5][row % 4],
            1200..1204 => [0.0, 0.0, 0.25, 0.0][row % 4],
            2000..2004 => f64::NAN,
            _ => 0.0,
        };
        let shares: Vec<f64> = (0..3600).map(share).collect();
        let found = spans(&recording, &shares);
        let said: Vec<_> = found.iter().map(|span| (&*span.text, span.start * 12e3, span.end * 12e3)).collect();
        let expected =
            [("at every tick", 400.0, 800.0), ("at most ticks", 800.0, 1200.0), ("at some ticks", 1200.0, 1204.0)];
        assert_eq!(said.len(), expected.len(), "{said:?}");
        for (one, other) in said.iter().zip(expected) {
            // Times are rows times a period that is not a binary fraction.
            assert!(one.0 == other.0 && (one.1 - other.1).abs() + (one.2 - other.2).abs() < 1e-9, "{said:?}");
        }
    }
}
