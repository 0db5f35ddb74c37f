//! What is coupled.
use servobench_base::StepEnd;

/// An input over a step: its value at the start and its first two derivatives to the time there.
pub type Input = [f64; 3];

/// A part of a simulation that is stepped for itself: an FMU, or the axis.
pub trait Block {
    /// Why it could not go on.
    type Error;

    /// Whether its state can be saved and restored.
    fn saves_state(&self) -> bool;

    /// Whether `output` follows `input` without a step (direct feedthrough); true where that is not known.
    fn feeds_through(&self, output: usize, input: usize) -> bool;

    /// Whether `output` changes at events only, as integers, booleans and what is sampled do: between two of its values it has the
    /// older one, and nothing leads on from it.
    fn is_discrete(&self, _output: usize) -> bool {
        false
    }

    /// True where it exchanges numbers of single precision: a loop that it is in agrees to that.
    fn is_single_precision(&self) -> bool {
        false
    }

    /// Whether it is initialised by [`start`](Self::start): until then its outputs are those of its initial equations, which may
    /// be read with one input after the other.
    fn has_initial_equations(&self) -> bool {
        false
    }

    /// Whether `output` follows `input` by the initial equations; true where that is not known.
    fn follows_at_start(&self, output: usize, input: usize) -> bool {
        self.feeds_through(output, input)
    }

    /// Ends the initialisation with the inputs at time 0. It is called once, and only where there are initial equations.
    ///
    /// # Errors
    /// The block's own; the simulation does not begin.
    fn start(&mut self, _inputs: &[f64]) -> Result<(), Self::Error> {
        Ok(())
    }

    /// Goes from `time` to `time + length` (s).
    ///
    /// # Errors
    /// The block's own; the simulation ends.
    fn step(&mut self, time: f64, length: f64, inputs: &[Input]) -> Result<StepEnd, Self::Error>;

    /// Reads all outputs. `inputs`, if given, are the present ones, for outputs that follow them without a step (direct
    /// feedthrough).
    ///
    /// # Errors
    /// The block's own.
    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), Self::Error>;

    /// Saves its state, in place of the one saved before.
    ///
    /// # Errors
    /// The block's own.
    fn save(&mut self) -> Result<(), Self::Error>;

    /// Goes back to the saved state; it can do so again.
    ///
    /// # Errors
    /// The block's own.
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
