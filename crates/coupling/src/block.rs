//! Blocks that can be coupled.
use servobench_base::StepEnd;

/// An input over a step: its value at the start and its first two derivatives to the time there.
pub type Input = [f64; 3];

/// A part of a simulation that is stepped separately: an FMU, or the axis.
pub trait Block {
    /// Error of a block that cannot continue.
    type Error;

    /// True if its state can be saved and restored.
    fn saves_state(&self) -> bool;

    /// True if `output` follows `input` without a step (direct feedthrough), or if that is unknown.
    fn feeds_through(&self, output: usize, input: usize) -> bool;

    /// True if `output` changes only at events, like integers, booleans and sampled values: between two of its values it has the
    /// older one, without extrapolation.
    fn is_discrete(&self, _output: usize) -> bool {
        false
    }

    /// True if it exchanges numbers of single precision, to which a loop with it can agree.
    fn is_single_precision(&self) -> bool {
        false
    }

    /// True if it is initialised by [`start`](Self::start): until then its outputs are those of its initial equations, which may
    /// be read with one set of inputs after another.
    fn has_initial_equations(&self) -> bool {
        false
    }

    /// True if `output` follows `input` by the initial equations, or if that is unknown.
    fn follows_at_start(&self, output: usize, input: usize) -> bool {
        self.feeds_through(output, input)
    }

    /// Ends the initialisation with the inputs at time 0. Called once, and only if there are initial equations.
    ///
    /// # Errors
    /// Error of the block; the simulation does not begin.
    fn start(&mut self, _inputs: &[f64]) -> Result<(), Self::Error> {
        Ok(())
    }

    /// Steps from `time` to `time + length` (s).
    ///
    /// # Errors
    /// Error of the block; the simulation ends.
    fn step(&mut self, time: f64, length: f64, inputs: &[Input]) -> Result<StepEnd, Self::Error>;

    /// Reads all outputs. `inputs`, if given, are the current ones, for outputs that follow them without a step (direct
    /// feedthrough).
    ///
    /// # Errors
    /// Error of the block.
    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), Self::Error>;

    /// Saves its state, replacing the one saved before.
    ///
    /// # Errors
    /// Error of the block.
    fn save(&mut self) -> Result<(), Self::Error>;

    /// Restores the saved state; this may be repeated.
    ///
    /// # Errors
    /// Error of the block.
    fn restore(&mut self) -> Result<(), Self::Error>;
}

impl<B: Block + ?Sized> Block for Box<B> {
    type Error = B::Error;

    fn saves_state(&self) -> bool {
        (**self).saves_state()
    }

    fn feeds_through(&self, output: usize, input: usize) -> bool {
        (**self).feeds_through(output, input)
    }

    fn is_discrete(&self, output: usize) -> bool {
        (**self).is_discrete(output)
    }

    fn is_single_precision(&self) -> bool {
        (**self).is_single_precision()
    }

    fn has_initial_equations(&self) -> bool {
        (**self).has_initial_equations()
    }

    fn follows_at_start(&self, output: usize, input: usize) -> bool {
        (**self).follows_at_start(output, input)
    }

    fn start(&mut self, inputs: &[f64]) -> Result<(), Self::Error> {
        (**self).start(inputs)
    }

    fn step(&mut self, time: f64, length: f64, inputs: &[Input]) -> Result<StepEnd, Self::Error> {
        (**self).step(time, length, inputs)
    }

    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), Self::Error> {
        (**self).read(inputs, outputs)
    }

    fn save(&mut self) -> Result<(), Self::Error> {
        (**self).save()
    }

    fn restore(&mut self) -> Result<(), Self::Error> {
        (**self).restore()
    }
}
