//! An FMU known only by its description: its library is not loaded.
use servobench_fmi::{Capabilities, Feedthrough, ModelDescription, Setup, Slave, SlaveError, StepEnd, Version};

/// Stand-in for an FMU whose code must not run: it has the capabilities of the description, is wired as the FMU would be, and all its
/// outputs are zero. It takes no step.
pub(crate) struct Described {
    capabilities: Capabilities,
    feedthrough: Feedthrough,
    is_initialising: bool,
}

impl Described {
    pub(crate) fn new(it: &ModelDescription, setup: &Setup) -> Self {
        let can = &it.co_simulation;
        let capabilities = Capabilities {
            saves_state: can.can_get_and_set_state,
            interpolates_inputs: it.version == Version::Two && can.can_interpolate_inputs,
            variable_step: can.can_handle_variable_communication_step_size,
        };
        Self { capabilities, feedthrough: Feedthrough::new(it, setup), is_initialising: setup.waits }
    }
}

impl Slave for Described {
    fn capabilities(&self) -> Capabilities {
        self.capabilities
    }

    fn feeds_through(&self, output: usize, input: usize) -> bool {
        self.feedthrough.between(output, input)
    }

    fn is_discrete(&self, output: usize) -> bool {
        self.feedthrough.is_discrete(output)
    }

    fn is_initialising(&self) -> bool {
        self.is_initialising
    }

    fn follows_at_start(&self, output: usize, input: usize) -> bool {
        self.feedthrough.at_start(output, input)
    }

    fn start(&mut self, _: Option<&[f64]>) -> Result<(), SlaveError> {
        self.is_initialising = false;
        Ok(())
    }

    /// Fails: there are no results without the FMU's code.
    fn step(&mut self, time: f64, _: f64, _: &[[f64; 3]]) -> Result<StepEnd, SlaveError> {
        Err(SlaveError::Failed {
            call: "the step".into(),
            time,
            status: "not loaded".into(),
            message: "only its description was read".into(),
        })
    }

    fn read(&mut self, _: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), SlaveError> {
        outputs.fill(0.0);
        Ok(())
    }

    fn save(&mut self) -> Result<(), SlaveError> {
        Ok(())
    }

    fn restore(&mut self) -> Result<(), SlaveError> {
        Ok(())
    }
}
