//! Conditions in a program.
use crate::blocks::Output;
use alloc::vec::Vec;
use servobench_base::Stateful;

/// Tolerance of a time for rounding (s).
const ROUNDING: f64 = 1e-9;

/// Condition of an event, which happens in the first cycle in which it holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Condition {
    /// In the first cycle of the run; of an update: of the execution.
    AtOnce,
    /// At a time of the run (s).
    At(f64),
    /// After an output has become TRUE, with a delay.
    After {
        /// Index of the call that has the output.
        call: usize,
        /// Output.
        output: Output,
        /// Delay (s).
        delay: f64,
    },
    /// The actual position passes this one upwards, or is above it already.
    Above(f64),
    /// The actual position passes this one downwards, or is below it already.
    Below(f64),
}

/// State of a cycle on which conditions depend.
#[derive(Debug, Clone, Stateful)]
pub(super) struct Situation {
    /// Time (s).
    pub(super) t: f64,
    /// Actual position.
    pub(super) position: f64,
    /// For each call, the times at which its outputs first became TRUE (s).
    pub(super) rises: Vec<Vec<(Output, Option<f64>)>>,
}

impl Situation {
    /// True if a condition holds; `begun` is the beginning of the execution to which an update or a stop belongs (s).
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

    /// Time at which `output` of `call` first became TRUE (s).
    pub(super) fn risen(&self, call: usize, output: Output) -> Option<f64> {
        self.rises.get(call)?.iter().find(|(own, _)| *own == output)?.1
    }
}
