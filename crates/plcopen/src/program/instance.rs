//! Blocks of a program: whatever their inputs and outputs are, it executes them and reads numbers.
use super::Inputs;
use crate::axis::Axis;
use crate::blocks::{FunctionBlock, Outputs as _};
use crate::error::BlockError;
use crate::interface::BlockInputs as _;
use alloc::boxed::Box;
use core::fmt;

/// An instance of a block, and its inputs.
pub(crate) trait Instance: fmt::Debug + Send + Sync {
    /// Takes other inputs.
    fn load(&mut self, inputs: Inputs);
    /// One call with Execute or Enable as `trigger`; fills `values` with the outputs, TRUE is 1.
    fn step(&mut self, axis: &mut Axis, trigger: bool, values: &mut [f64]);
    /// What its error is.
    fn error(&self) -> Option<&BlockError>;
    /// The same block in the same state.
    fn copy(&self) -> Box<dyn Instance>;
}

impl Clone for Box<dyn Instance> {
    fn clone(&self) -> Self {
        self.copy()
    }
}

/// A block that a program can make.
pub(crate) trait New: FunctionBlock {
    /// A new one, with room for the table that `inputs` have.
    fn new_for(inputs: &Inputs) -> Self;
}

impl<B: FunctionBlock + Default> New for B {
    fn new_for(_: &Inputs) -> Self {
        Self::default()
    }
}

/// A new instance of block `B`.
pub(crate) fn called<B: New + Clone + fmt::Debug + Send + Sync + 'static>(inputs: &Inputs) -> Box<dyn Instance> {
    Box::new(Called { block: B::new_for(inputs), inputs: inputs.clone() })
}

#[derive(Debug, Clone)]
struct Called<B> {
    block: B,
    inputs: Inputs,
}

impl<B: FunctionBlock + Clone + fmt::Debug + Send + Sync + 'static> Instance for Called<B> {
    fn load(&mut self, inputs: Inputs) {
        self.inputs = inputs;
    }

    fn step(&mut self, axis: &mut Axis, trigger: bool, values: &mut [f64]) {
        let outputs = self.block.step(axis, &B::Inputs::read(&self.inputs, trigger));
        let mut places = values.iter_mut();
        outputs.each(|value| {
            if let Some(place) = places.next() {
                *place = value;
            }
        });
    }

    fn error(&self) -> Option<&BlockError> {
        self.block.error()
    }

    fn copy(&self) -> Box<dyn Instance> {
        Box::new(self.clone())
    }
}
