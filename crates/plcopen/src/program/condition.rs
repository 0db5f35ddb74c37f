//! When something happens in a program.
use crate::blocks::Output;
use alloc::vec::Vec;
use servobench_base::Stateful;

/// How far after its time a cycle may be by rounding (s).
const ROUNDING: f64 = 1e-9;

/// When something happens: in the first cycle in which it holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Condition {
    /// In the first cycle of the run; of an update: of the execution.
    AtOnce,
    /// At a time of the run (s).
    At(f64),
    /// So long after an output has become TRUE.
    After {
        /// Index of the call whose output it is.
        call: usize,
        /// Which output.
        output: Output,
        /// How long after (s).
        delay: f64,
    },
    /// The actual position passes this one upwards, or is above it already.
    Above(f64),
    /// The actual position passes this one downwards, or is below it already.
    Below(f64),
}

/// What conditions are about, in a cycle.
#[derive(Debug, Clone, Stateful)]
pub(super) struct Situation {
    /// Time (s).
    pub(super) t: f64,
    /// Actual position.
    pub(super) position: f64,
    /// Of each call, when each of its outputs first became TRUE (s).
    pub(super) rises: Vec<Vec<(Output, Option<f64>)>>,
}

impl Situation {
    /// Whether a condition holds; `begun` is when the execution began that an update or a stop belongs to.
    pub(super) fn holds(&self, condition: Condition, begun: f64) -> bool {
        match condition {
            Condition::AtOnce => self.t >= begun,
            Condition::At(time) => self.t >= time - ROUNDING,
            Condition::After { call, output, delay } => {
                let risen = self.risen(call, output);
                risen.is_some_and(|risen| self.t >= risen + delay - ROUNDING)
            }
            Condition::Above(x) => self.position >= x,
            Condition::Below(x) => self.position <= x,
        }
    }

    /// When `output` of `call` first became TRUE (s).
    pub(super) fn risen(&self, call: usize, output: Output) -> Option<f64> {
        self.rises.get(call)?.iter().find(|(own, _)| *own == output)?.1
    }
}
