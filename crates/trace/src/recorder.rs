//! Fills a recording row by row, without allocating per row.
use crate::channel::{Channel, ChannelSpec};
use crate::log::Log;
use crate::recording::{About, Call, Event, LimitReversals, Move, Recording, Signal};
use crate::values::{GrowingValues, Values};
use servobench_base::{Rate, Severity};
use std::io;

/// Rows that are collected before they are moved to the channels: a block stays in the first-level cache, in which columns of 9 lines
/// do not collide, as columns of 8 would.
pub const BLOCK: usize = 72;

/// Values of one column in the rows of a block.
pub type Column = [f64; BLOCK];

/// A row to be filled in.
#[derive(Debug)]
pub struct Row<'a> {
    columns: &'a mut [Column],
    at: usize,
}

impl<'a> Row<'a> {
    /// The columns of the block, and the place of this row in each of them.
    ///
    /// # Panics
    /// When there are not `N` columns: a bug in the writer of the row.
    #[inline]
    #[must_use]
    pub fn of_columns<const N: usize>(self) -> (&'a mut [Column; N], usize) {
        (self.columns.try_into().expect("the row of this recorder has another width"), self.at)
    }
}

/// A signal of a recorder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SignalId(usize);

/// Position in a recording, for going back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark {
    rows: usize,
    moves: usize,
    events: usize,
    time: f64,
}

/// Takes one row per recorded instant.
#[derive(Debug)]
pub struct Recorder {
    recording: Recording,
    /// Columns of a block, of which the first `rows` rows are filled.
    block: Vec<Column>,
    rows: usize,
    /// The values of each channel.
    values: Vec<GrowingValues>,
    /// The column of each channel.
    columns: Vec<usize>,
    /// Reason why no more rows are kept.
    failure: Option<io::Error>,
    log: Log,
    is_silent: bool,
}

impl Recorder {
    /// A recorder with room for `rows` rows; more rows work, but allocate.
    #[must_use]
    pub fn new(about: About, rate: Rate, channels: Vec<ChannelSpec>, rows: usize) -> Self {
        let (block, columns) = (vec![[0.0; BLOCK]; channels.len()], (0..channels.len()).collect());
        let values = channels.iter().map(|_| GrowingValues::with_room(rows)).collect();
        let channels = channels.into_iter().map(|spec| Channel { spec, values: Values::default() }).collect();
        let recording = Recording { channels, ..Recording::new(about, rate) };
        Self { recording, block, rows: 0, values, columns, failure: None, log: Log::default(), is_silent: false }
    }

    /// The same recorder for rows of `width` values, of which it keeps the one at `columns[i]` in channel i.
    ///
    /// # Panics
    /// When there is not one column in the row for each channel.
    #[must_use]
    pub fn with_rows(self, width: usize, columns: Vec<usize>) -> Self {
        assert_eq!(columns.len(), self.recording.channels.len(), "a row has one value for each channel");
        assert!(columns.iter().all(|column| *column < width), "a row has one value for each channel");
        Self { block: vec![[0.0; BLOCK]; width], columns, ..self }
    }

    /// Drops the channels that are not `wanted`, before the first row.
    pub fn retain(&mut self, wanted: impl Fn(&ChannelSpec) -> bool) {
        let of_channels = std::mem::take(&mut self.values).into_iter().zip(std::mem::take(&mut self.columns));
        let of_channels = of_channels.zip(&self.recording.channels).filter(|(_, channel)| wanted(&channel.spec));
        (self.values, self.columns) = of_channels.map(|(of_channel, _)| of_channel).unzip();
        self.recording.channels.retain(|channel| wanted(&channel.spec));
    }

    /// A recorder that keeps nothing, for a loop without a recording that may run for ever.
    #[must_use]
    pub fn silent(about: About, rate: Rate) -> Self {
        Self { is_silent: true, ..Self::new(about, rate, vec![], 0) }
    }

    /// False if nothing is kept.
    #[must_use]
    pub const fn keeps(&self) -> bool {
        !self.is_silent
    }

    /// Appends a row.
    ///
    /// # Panics
    /// When `row` is not as long as the recorder's rows: a bug in the loop that writes it.
    pub fn push(&mut self, row: &[f64]) {
        self.push_with(|Row { columns, at }| {
            assert_eq!(columns.len(), row.len(), "the row of this recorder has another width");
            for (column, value) in columns.iter_mut().zip(row) {
                column[at] = *value;
            }
        });
    }

    /// Appends the row that `write` fills in, if it is kept.
    #[inline]
    pub fn push_with(&mut self, write: impl FnOnce(Row<'_>)) {
        if self.is_silent {
            return;
        }
        write(Row { columns: &mut self.block, at: self.rows });
        self.rows += 1;
        if self.rows == BLOCK {
            self.flush();
        }
    }

    /// Moves the block to the channels.
    fn flush(&mut self) {
        if self.failure.is_none() {
            let mut channels = self.values.iter_mut().zip(&self.columns);
            let done = channels.try_for_each(|(values, column)| values.extend(&self.block[*column][..self.rows]));
            self.failure = done.err();
        }
        self.rows = 0;
    }

    /// Reason why rows are no longer kept: the disk is full.
    #[must_use]
    pub const fn failure(&self) -> Option<&io::Error> {
        self.failure.as_ref()
    }

    /// Description of the recorded run.
    #[must_use]
    pub const fn about(&self) -> &About {
        &self.recording.about
    }

    /// Notes a move.
    pub fn note_move(&mut self, made: Move) {
        if !self.is_silent {
            self.recording.moves.push(made);
        }
    }

    /// Notes the fate of a call.
    pub fn note_call(&mut self, call: Call) {
        if !self.is_silent {
            self.recording.calls.push(call);
        }
    }

    /// Notes the limits between which a quantity alternated.
    pub fn note_limit_reversals(&mut self, reversals: LimitReversals) {
        if !self.is_silent {
            self.recording.limit_reversals.push(reversals);
        }
    }

    /// Notes an event.
    pub fn note_event(&mut self, event: Event) {
        if !self.is_silent {
            self.recording.events.push(event);
        }
    }

    /// Notes a log message of `source` at `time` (s). Frequent repetitions are only counted.
    pub fn note_said(&mut self, source: &str, severity: Severity, time: f64, text: &str) {
        if !self.is_silent {
            self.log.note(source, severity, time, text);
        }
    }

    /// Adds a signal, which has no value yet.
    pub fn add_signal(&mut self, source: &str, name: &str) -> SignalId {
        self.recording.signals.push(Signal { source: source.into(), name: name.into(), changes: Vec::new() });
        SignalId(self.recording.signals.len() - 1)
    }

    /// Notes that a signal has `value` from `time` (s) on; nothing if it has it already.
    ///
    /// # Panics
    /// When the signal is that of another recorder: a bug in the loop that notes it.
    pub fn note_value(&mut self, SignalId(index): SignalId, time: f64, value: &str) {
        if self.is_silent {
            return;
        }
        let changes = &mut self.recording.signals[index].changes;
        if changes.last().is_none_or(|(_, last)| last != value) {
            changes.push((time, value.into()));
        }
    }

    /// Position of the recording at `time` (s), at and after which nothing is noted yet.
    #[must_use]
    pub fn mark(&self, time: f64) -> Mark {
        let rows = self.values.first().map_or(0, GrowingValues::len) + self.rows;
        Mark { rows, moves: self.recording.moves.len(), events: self.recording.events.len(), time }
    }

    /// Forgets everything since `mark`, except log messages.
    pub fn rewind(&mut self, mark: &Mark) {
        self.flush();
        for values in &mut self.values {
            values.truncate(mark.rows);
        }
        let Recording { moves, events, signals, .. } = &mut self.recording;
        moves.truncate(mark.moves);
        events.truncate(mark.events);
        for signal in signals {
            while signal.changes.last().is_some_and(|(time, _)| *time >= mark.time) {
                signal.changes.pop();
            }
        }
    }

    /// The recording, events in order of their start; and the reason if it is incomplete: it ends where rows could no longer be kept.
    #[must_use]
    pub fn finish(mut self) -> (Recording, Option<io::Error>) {
        self.flush();
        let Self { mut recording, values, failure, log, .. } = self;
        let (values, failure) = together(values, failure);
        for (channel, values) in recording.channels.iter_mut().zip(values) {
            channel.values = values;
        }
        recording.events.sort_by(|one, two| one.start.total_cmp(&two.start));
        recording.log = log.finish();
        (recording, failure)
    }
}

/// The values of all channels, as many of each as could be kept of every one.
fn together(mut all: Vec<GrowingValues>, failure: Option<io::Error>) -> (Vec<Values>, Option<io::Error>) {
    let written = all.iter_mut().map(GrowingValues::settle).fold(Ok(()), Result::and);
    let failure = failure.or(written.err());
    let rows = all.iter().map(GrowingValues::len).min().unwrap_or(0);
    let finished = all.into_iter().map(|mut values| {
        values.truncate(rows);
        values.finish()
    });
    match finished.collect() {
        Ok(values) => (values, failure),
        Err(error) => (Vec::new(), failure.or(Some(error))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn about() -> About {
        About {
            scenario: "s".into(),
            engine: "none".into(),
            axis_unit: "m".into(),
            bodies: vec!["motor".into()],
            overrides: vec![],
        }
    }

    fn rate() -> Rate {
        Rate::new(1_000).unwrap()
    }

    fn spec(name: &str) -> ChannelSpec {
        ChannelSpec { axis: None, name: name.into(), unit: "m".into(), writer: "test".into(), rate: rate() }
    }

    #[test]
    fn rows_become_columns_whatever_their_number() {
        for rows in [0_u32, 1, 71, 72, 73, 200] {
            let mut recorder = Recorder::new(about(), rate(), vec![spec("up"), spec("down")], 10);
            for k in 0..rows {
                recorder.push(&[f64::from(k), -f64::from(k)]);
            }
            let recording = recorder.finish().0;
            let up: Vec<f64> = (0..rows).map(f64::from).collect();
            let down: Vec<f64> = up.iter().map(|k| -k).collect();
            assert_eq!((recording.channel("up"), recording.channel("down")), (Some(&up[..]), Some(&down[..])));
        }
    }

    #[test]
    fn channels_that_nobody_wants_are_left_out() {
        let mut recorder =
            Recorder::new(about(), rate(), ["a", "b", "c"].map(spec).to_vec(), 1).with_rows(4, vec![3, 1, 0]);
        recorder.retain(|spec| spec.name != "b");
        recorder.push(&[1.0, 2.0, 3.0, 4.0]);
        let recording = recorder.finish().0;
        assert_eq!((recording.channel("a"), recording.channel("c")), (Some(&[4.0][..]), Some(&[1.0][..])));
        assert_eq!(recording.channels.len(), 2);
    }

    /// Oracle: a recorder that received only the values that stay.
    #[test]
    fn what_comes_after_a_mark_can_be_taken_back() {
        let recorder = || Recorder::new(about(), rate(), vec![spec("up"), spec("down")], 10);
        for kept in [0_u32, 1, 71, 72, 73, 150] {
            let (mut with, mut without) = (recorder(), recorder());
            let [one, other] = [&mut with, &mut without].map(|recorder| recorder.add_signal("axis", "state"));
            let note = |recorder: &mut Recorder, signal, k: u32, sign: f64| {
                let k = f64::from(k);
                recorder.push(&[sign * k, -sign * k]);
                recorder.note_value(signal, k, if (k / 5.0) % 2.0 < 1.0 { "A" } else { "B" });
                let message = format!("{k}");
                recorder.note_event(Event::new(k, k, "test", message));
            };
            for k in 0..kept {
                note(&mut with, one, k, 1.0);
                note(&mut without, other, k, 1.0);
            }
            let mark = with.mark(f64::from(kept));
            for _ in 0..3 {
                for k in kept..kept + 80 {
                    note(&mut with, one, k, 2.0);
                }
                with.rewind(&mark);
            }
            for k in kept..kept + 9 {
                note(&mut with, one, k, 1.0);
                note(&mut without, other, k, 1.0);
            }
            assert_eq!(with.finish().0, without.finish().0, "{kept} rows");
        }
    }

    #[test]
    fn a_signal_keeps_its_changes_only() {
        let mut recorder = Recorder::new(about(), rate(), vec![], 0);
        let [state, done] = ["state", "Done"].map(|name| recorder.add_signal("axis", name));
        for (time, value) in [(0.0, "Disabled"), (0.1, "Disabled"), (0.2, "Standstill"), (0.3, "Disabled")] {
            recorder.note_value(state, time, value);
        }
        recorder.note_value(done, 0.1, "TRUE");
        let recording = recorder.finish().0;
        let state = recording.signal("axis", "state").unwrap();
        assert_eq!(state.changes.len(), 3, "{state:?}");
        let values = [-0.1, 0.0, 0.15, 0.2, 0.29, 9.0].map(|time| state.at(time));
        let (disabled, standstill) = (Some("Disabled"), Some("Standstill"));
        assert_eq!(values, [None, disabled, disabled, standstill, standstill, disabled]);
        assert_eq!(recording.signal("axis", "Done").unwrap().changes, [(0.1, "TRUE".to_owned())]);
        assert_eq!(recording.signal("drive", "state"), None);
    }
}
