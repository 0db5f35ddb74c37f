//! The signals of an axis that are kept, and their places in a row.
use crate::equipment::{Equipment, Rates};
use crate::instant::Instant;
use crate::signal::{COUNT, Signal, row};
use servobench_base::Rate;
use servobench_trace::{About, ChannelSpec, Recorder};
use thiserror::Error;

/// Some signals of an axis.
#[derive(Debug, Clone)]
pub struct Selection {
    signals: Vec<Signal>,
    specs: Vec<ChannelSpec>,
    kept: Vec<f64>,
}

/// A signal that the axis does not have.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("the axis has no signal `{signal}`")]
pub struct NotRecorded {
    /// The signal.
    pub signal: Signal,
}

impl Selection {
    /// All signals that an axis with `equipment` has.
    #[must_use]
    pub fn all(equipment: &Equipment, rates: &Rates) -> Self {
        let there = Signal::ALL.iter().copied().filter(|signal| signal.presence().holds(equipment));
        let (signals, specs): (Vec<_>, Vec<_>) = there.map(|signal| (signal, signal.spec(equipment, rates))).unzip();
        let kept = vec![0.0; signals.len()];
        Self { signals, specs, kept }
    }

    /// Selects the `wanted` of these, in the order of [`Signal`]; all when the list is empty.
    ///
    /// # Errors
    /// [`NotRecorded`] for a signal that is not among these.
    pub fn of(&self, wanted: &[Signal]) -> Result<Self, NotRecorded> {
        if wanted.is_empty() {
            return Ok(self.clone());
        }
        if let Some(signal) = wanted.iter().copied().find(|signal| !self.has(*signal)) {
            return Err(NotRecorded { signal });
        }
        let mut sorted = wanted.to_vec();
        sorted.sort_unstable();
        sorted.dedup();
        Ok(self.only(&sorted))
    }

    /// Selects those of `wanted` that are among these, in the order of `wanted`.
    #[must_use]
    pub fn only(&self, wanted: &[Signal]) -> Self {
        let places: Vec<usize> = wanted.iter().filter_map(|signal| self.place(*signal)).collect();
        Self {
            signals: places.iter().map(|at| self.signals[*at]).collect(),
            specs: places.iter().map(|at| self.specs[*at].clone()).collect(),
            kept: vec![0.0; places.len()],
        }
    }

    /// The signals.
    #[must_use]
    pub fn signals(&self) -> &[Signal] {
        &self.signals
    }

    /// Descriptions of the signals for a recording.
    #[must_use]
    pub fn specs(&self) -> &[ChannelSpec] {
        &self.specs
    }

    /// True if `signal` is among these.
    #[must_use]
    pub fn has(&self, signal: Signal) -> bool {
        self.place(signal).is_some()
    }

    /// Place of `signal` among these.
    #[must_use]
    pub fn place(&self, signal: Signal) -> Option<usize> {
        self.signals.iter().position(|one| *one == signal)
    }

    /// A recorder of these signals, for [`write_row`](crate::write_row), with room for `rows` rows.
    #[must_use]
    pub fn recorder(&self, about: About, rate: Rate, rows: usize) -> Recorder {
        let columns = self.signals.iter().map(|signal| *signal as usize).collect();
        Recorder::new(about, rate, self.specs.clone(), rows).with_rows(COUNT, columns)
    }

    /// Their values at `now`.
    pub fn values(&mut self, now: &Instant) -> &[f64] {
        let row = row(now);
        for (kept, signal) in self.kept.iter_mut().zip(&self.signals) {
            *kept = row[*signal as usize];
        }
        &self.kept
    }
}
