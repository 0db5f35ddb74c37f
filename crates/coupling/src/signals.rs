//! Exchanged signals: the last values of each output, and the inputs computed from them.
//!
//! The values of an output are those at the ends of its own block's steps, the newest first. The newest may lie ahead of the
//! present: a block that has completed its step is known to later ones, and a slow one to faster ones. An
//! output that changes only at events is not known ahead of time: it is held at its previous value.
use crate::Input;
use crate::network::{Wire, Wiring};
use crate::polynomial::{Order, later, through};

/// The exchanged values of all outputs.
pub(crate) struct Signals {
    samples: Vec<[f64; 3]>,
    /// Newest value as predicted from the values before it.
    expected: Vec<f64>,
    /// True for outputs that change only at events, and are held between them.
    discrete: Vec<bool>,
    tracks: Vec<Track>,
    order: Order,
    /// The communication step (s).
    step: f64,
}

/// Common data of the outputs of a block.
#[derive(Debug, Clone, Copy)]
struct Track {
    /// Communication step of the newest value.
    at: u64,
    /// Number of known values, at most 3.
    count: u8,
    /// Communication steps between two values.
    every: u32,
    first: usize,
    outputs: usize,
}

impl Signals {
    pub(crate) fn new(wiring: &Wiring, order: Order, step: f64) -> Self {
        let track = |shape: &crate::network::Shape| Track {
            at: 0,
            count: 0,
            every: shape.every,
            first: shape.first_output,
            outputs: shape.outputs,
        };
        Self {
            samples: vec![[0.0; 3]; wiring.outputs()],
            expected: vec![0.0; wiring.outputs()],
            discrete: wiring.discrete.clone(),
            tracks: wiring.shapes.iter().map(track).collect(),
            order,
            step,
        }
    }

    /// The input at `now` (communication steps).
    pub(crate) fn input(&self, wire: &Wire, now: u64) -> Input {
        let Some(source) = wire.source else { return [wire.offset, 0.0, 0.0] };
        if wire.is_discrete {
            return [wire.gain * self.newest(source.output) + wire.offset, 0.0, 0.0];
        }
        let [value, slope, bend] = self.output(source.block, source.output, now);
        [wire.gain * value + wire.offset, wire.gain * slope, wire.gain * bend]
    }

    /// The polynomial of an output from `now` on.
    fn output(&self, block: usize, output: usize, now: u64) -> Input {
        let track = &self.tracks[block];
        if self.discrete[output] {
            return [self.held(block, output, now), 0.0, 0.0];
        }
        // A value that lies ahead is not held: the signal would be ahead of its time, and drive the blocks after it.
        let order = if track.at <= now { self.order } else { self.order.max(Order::Linear) };
        let degree = order.degree().min(track.count.saturating_sub(1));
        let since = if track.at <= now { (now - track.at) as f64 } else { -((track.at - now) as f64) };
        through(&self.samples[output], degree, f64::from(track.every) * self.step, since * self.step)
    }

    /// The newest value of an output that does not lie ahead of `now`; the oldest known, if all of them do.
    fn held(&self, block: usize, output: usize, now: u64) -> f64 {
        let track = &self.tracks[block];
        let ahead = track.at.saturating_sub(now).div_ceil(u64::from(track.every));
        let oldest = track.count.saturating_sub(1);
        self.samples[output][usize::from(u8::try_from(ahead).unwrap_or(oldest).min(oldest))]
    }

    /// The value of an output at `now`.
    pub(crate) fn value(&self, block: usize, output: usize, now: u64) -> f64 {
        self.output(block, output, now)[0]
    }

    /// The value of an input at the end of its step.
    pub(crate) fn at_end(&self, wire: &Wire, now: u64, until: u64) -> f64 {
        match wire.source {
            Some(source) if !wire.is_discrete && self.discrete[source.output] => {
                wire.gain * self.held(source.block, source.output, until) + wire.offset
            }
            _ => later(&self.input(wire, now), (until - now) as f64 * self.step)[0],
        }
    }

    /// Makes room for the values of `block` at `at`, filled with their predictions. Does nothing if it is there.
    pub(crate) fn open(&mut self, block: usize, at: u64) {
        let track = self.tracks[block];
        if track.count > 0 && track.at >= at {
            return;
        }
        let spacing = f64::from(track.every) * self.step;
        let degree = self.order.degree().min(track.count.saturating_sub(1));
        for output in track.first..track.first + track.outputs {
            let [y0, y1, _] = self.samples[output];
            let since = (at - track.at) as f64 * self.step;
            self.expected[output] =
                if self.discrete[output] { y0 } else { through(&self.samples[output], degree, spacing, since)[0] };
            self.samples[output] = [self.expected[output], y0, y1];
        }
        self.tracks[block] = Track { at, count: (track.count + 1).min(3), ..track };
    }

    /// Sets the newest values of `block`, for which room has been made. On failure returns the number of an output that is not finite.
    pub(crate) fn set(&mut self, block: usize, values: &[f64]) -> Result<(), usize> {
        let track = &self.tracks[block];
        for (output, value) in (track.first..).zip(values) {
            if !value.is_finite() {
                return Err(output);
            }
            self.samples[output][0] = *value;
        }
        Ok(())
    }

    /// Forgets all but the newest values of `block`: after an event its signals may change abruptly.
    pub(crate) fn restart(&mut self, block: usize) {
        self.tracks[block].count = self.tracks[block].count.min(1);
    }

    /// The newest value of an output.
    pub(crate) fn newest(&self, output: usize) -> f64 {
        self.samples[output][0]
    }

    /// Replaces the newest value of an output.
    pub(crate) fn replace(&mut self, output: usize, value: f64) {
        self.samples[output][0] = value;
    }

    /// Newest value minus its prediction.
    pub(crate) fn defect(&self, output: usize) -> f64 {
        self.samples[output][0] - self.expected[output]
    }

    /// Greatest magnitude among the last values of an output of `block`.
    pub(crate) fn magnitude(&self, block: usize, output: usize) -> f64 {
        let known = usize::from(self.tracks[block].count);
        self.samples[output][..known].iter().fold(0.0, |most: f64, value| most.max(value.abs()))
    }
}
