//! Type-erased blocks of a program: an instance is executed with the inputs of its call and returns its outputs as numbers.
use super::Inputs;
use crate::axis::Axis;
use crate::blocks::{FunctionBlock, Outputs as _};
use crate::error::BlockError;
use crate::interface::BlockInputs as _;
use alloc::boxed::Box;
use core::fmt;
use servobench_base::Stateful;
use servobench_base::state::{Damaged, Reader, Writer};

/// An instance of a block.
pub(crate) trait Instance: fmt::Debug + Stateful + Send + Sync {
    /// Handles one call with these inputs and Execute or Enable as `trigger`; fills `values` with the outputs, TRUE is 1.
    fn step(&mut self, axis: &mut Axis, inputs: &Inputs, trigger: bool, values: &mut [f64]);
    /// Error of the block.
    fn error(&self) -> Option<&BlockError>;
}

impl Stateful for Box<dyn Instance> {
    fn save(&self, to: &mut dyn Writer) {
        (**self).save(to);
    }

    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
        (**self).restore(from)
    }
}

/// A block that a program can instantiate.
pub(crate) trait New: FunctionBlock {
    /// A new instance, with room for the table of `inputs`.
    fn new_for(inputs: &Inputs) -> Self;
}

impl<B: FunctionBlock + Default> New for B {
    fn new_for(_: &Inputs) -> Self {
        Self::default()
    }
}

/// A new instance of block `B`.
pub(crate) fn called<B: New + Stateful + fmt::Debug + Send + Sync + 'static>(inputs: &Inputs) -> Box<dyn Instance> {
    Box::new(Called(B::new_for(inputs)))
}

#[derive(Debug, Stateful)]
#[state(fixed)]
struct Called<B>(B);

impl<B: FunctionBlock + Stateful + fmt::Debug + Send + Sync + 'static> Instance for Called<B> {
    fn step(&mut self, axis: &mut Axis, inputs: &Inputs, trigger: bool, values: &mut [f64]) {
        let outputs = self.0.step(axis, &B::Inputs::read(inputs, trigger));
        let mut places = values.iter_mut();
        outputs.each(|value| {
            if let Some(place) = places.next() {
                *place = value;
            }
        });
    }

    fn error(&self) -> Option<&BlockError> {
        self.0.error()
    }
}
