//! Fills a recording row by row, without allocating per row.
use crate::channel::{Channel, ChannelSpec};
use crate::recording::{About, Event, Move, Recording};
use servobench_base::Rate;

/// Takes one row per recorded instant.
#[derive(Debug)]
pub struct Recorder {
    recording: Recording,
}

impl Recorder {
    /// A recorder with room for `rows` rows; more rows work, but allocate.
    #[must_use]
    pub fn new(about: About, rate: Rate, channels: Vec<ChannelSpec>, rows: usize) -> Self {
        let channels = channels
            .into_iter()
            .map(|spec| Channel { spec, values: Vec::with_capacity(rows) })
            .collect();
        Self {
            recording: Recording { about, rate, channels, moves: Vec::new(), events: Vec::new() },
        }
    }

    /// Appends one value to every channel, in the order of the channels.
    ///
    /// # Panics
    /// When `row` has not as many values as there are channels: the loop that writes it is wrong.
    pub fn push(&mut self, row: &[f64]) {
        assert_eq!(
            row.len(),
            self.recording.channels.len(),
            "a row has one value for each channel"
        );
        for (channel, value) in self.recording.channels.iter_mut().zip(row) {
            channel.values.push(*value);
        }
    }

    /// Notes a move.
    pub fn note_move(&mut self, made: Move) {
        self.recording.moves.push(made);
    }

    /// Notes an event.
    pub fn note_event(&mut self, event: Event) {
        self.recording.events.push(event);
    }

    /// The recording, events in order of their start.
    #[must_use]
    pub fn finish(mut self) -> Recording {
        self.recording.events.sort_by(|one, two| one.start.total_cmp(&two.start));
        self.recording
    }
}
