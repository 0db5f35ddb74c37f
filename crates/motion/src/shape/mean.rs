//! The mean of the last set-points of a stream.
use super::difference::{checked, minus, plus};
use crate::PlanError;
use servobench_base::{ParamError, Setpoint};

/// A moving average of as many samples as its memory `M` holds: an array, a slice of one, or on the heap a `Vec`.
///
/// A step through averages of n1 … n4 samples, one after the other, is the sampled move of order 4 with these lengths: its
/// backward differences are those of the forward-Euler cascade. The set-points of a step do not contain its derivatives,
/// which are impulses; those of [`MovingAverages::of_step`](super::MovingAverages::of_step) do.
///
/// The sum is recomputed for every block of `length` samples, forwards within the block and backwards over the one
/// before it, as differences from the first of the newer block: nothing drifts, and a rest gives exactly its value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MovingAverage<M> {
    /// The first `filled` set-points of this block; behind them, for each place, the sum of the block before from there on,
    /// as differences from `base`.
    memory: M,
    filled: usize,
    base: Setpoint,
    /// Sum of this block, as differences from `base`.
    sum: Setpoint,
    received: u64,
}

impl<M: AsRef<[Setpoint]> + AsMut<[Setpoint]>> MovingAverage<M> {
    /// The mean of the last samples, as many as `memory` is long, after a long rest at `rest`.
    ///
    /// # Errors
    /// [`PlanError::Parameter`] for a memory of no length; [`PlanError::Sample`] for a rest that [`next`](Self::next) would
    /// refuse.
    pub fn over(mut memory: M, rest: Setpoint) -> Result<Self, PlanError> {
        let rest = checked(0, rest)?;
        let filled = memory.as_ref().len();
        if filled == 0 {
            return Err(ParamError { name: "length", value: 0.0, bound: "at least one sample" }.into());
        }
        memory.as_mut().fill(rest);
        Ok(Self { memory, filled, base: rest, sum: Setpoint::default(), received: 0 })
    }

    /// Takes the next set-point and returns the mean of it and those before it.
    ///
    /// # Errors
    /// [`PlanError::Sample`] with the number of the set-point, from 0, when a value is not finite or above 1e150 in
    /// magnitude. Nothing changes then.
    pub fn next(&mut self, setpoint: Setpoint) -> Result<Setpoint, PlanError> {
        let setpoint = checked(self.received, setpoint)?;
        self.received += 1;
        let length = self.memory.as_ref().len();
        if self.filled == length {
            self.begin_block(setpoint);
        }
        let memory = self.memory.as_mut();
        memory[self.filled] = setpoint;
        self.filled += 1;
        self.sum = plus(self.sum, minus(setpoint, self.base));
        let older = memory.get(self.filled).copied().unwrap_or_default();
        Ok(plus(self.base, plus(self.sum, older).scaled(1.0 / length as f64)))
    }

    /// Turns the block in memory into its sums from behind.
    fn begin_block(&mut self, base: Setpoint) {
        let mut sum = Setpoint::default();
        for place in self.memory.as_mut().iter_mut().rev() {
            sum = plus(sum, minus(*place, base));
            *place = sum;
        }
        (self.base, self.sum, self.filled) = (base, Setpoint::default(), 0);
    }
}
