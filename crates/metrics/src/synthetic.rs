//! Recordings with known answers, for the tests.
use servobench_base::Rate;
use servobench_trace::{About, Channel, ChannelSpec, Ending, Move, Recording, Signal};

/// Builds a recording channel by channel.
pub(crate) struct Build {
    recording: Recording,
    rows: usize,
}

impl Build {
    /// `rows` rows at `hertz`.
    pub(crate) fn new(hertz: u32, rows: usize) -> Self {
        let about = About {
            scenario: "synthetic".into(),
            engine: "closed form".into(),
            axis_unit: "m".into(),
            bodies: vec!["motor".into(), "load".into()],
            overrides: vec![],
        };
        let rate = Rate::new(hertz).unwrap();
        let recording = Recording::new(about, rate);
        Self { recording, rows }
    }

    /// Adds a channel that is `value(t)`.
    pub(crate) fn channel(mut self, name: impl AsRef<str>, unit: &str, value: impl Fn(f64) -> f64) -> Self {
        let rate = self.recording.rate;
        let spec =
            ChannelSpec { axis: None, name: name.as_ref().into(), unit: unit.into(), writer: "test".into(), rate };
        let values = (0..self.rows).map(|k| value(k as f64 * rate.period())).collect();
        self.recording.channels.push(Channel { spec, values });
        self
    }

    /// Adds a signal with its changes.
    pub(crate) fn signal(mut self, source: &str, name: &str, changes: &[(f64, &str)]) -> Self {
        let changes = changes.iter().map(|(time, value)| (*time, (*value).to_owned())).collect();
        self.recording.signals.push(Signal { source: source.into(), name: name.into(), changes });
        self
    }

    /// Sets the requests of the task: start (s) and kind of each.
    pub(crate) fn requests(self, changes: &[(f64, &str)]) -> Self {
        let (source, name) = crate::requirement::REQUEST_KIND;
        self.signal(source, name, changes)
    }

    /// Sets the moves.
    pub(crate) fn moves(mut self, moves: impl IntoIterator<Item = Move>) -> Self {
        self.recording.moves = moves.into_iter().collect();
        self
    }

    /// The recording.
    pub(crate) fn finish(self) -> Recording {
        self.recording
    }
}

/// A move under construction.
pub(crate) struct Planned(Move);

/// A move from `from` at `start` (s) to `to` at `end` (s), without cruise.
pub(crate) fn planned(start: f64, end: f64, from: f64, to: f64) -> Planned {
    Planned(Move {
        label: format!("move to {to} m"),
        start,
        end,
        from,
        to,
        peaks: [1.0, 5.0, 50.0, f64::INFINITY],
        limits: [Some(1.0), Some(5.0), Some(50.0), None],
        cruise: (start, 0.0),
        ending: Ending::AtRest,
    })
}

impl Planned {
    /// At constant velocity from `start` (s) for `length` (s).
    pub(crate) fn cruising(mut self, start: f64, length: f64) -> Self {
        self.0.cruise = (start, length);
        self
    }

    /// With these peaks and limits.
    pub(crate) fn bounded(mut self, peaks: [f64; 4], limits: [Option<f64>; 4]) -> Self {
        (self.0.peaks, self.0.limits) = (peaks, limits);
        self
    }

    /// The move.
    pub(crate) fn made(self) -> Move {
        self.0
    }
}
