//! Properties of an FMU as a whole.
use super::element::Element;
use crate::error::{DescriptionProblem, FmuError};

/// Capabilities and requirements of the FMU in co-simulation.
#[derive(Debug, Clone, PartialEq, Default)]
#[expect(clippy::struct_excessive_bools, reason = "the flags of the standard")]
pub struct CoSimulation {
    /// File name of the library, and prefix of its functions when they are linked statically.
    pub model_identifier: String,
    /// True if a tool has to be installed.
    pub needs_execution_tool: bool,
    /// True if only one instance per process is possible.
    pub can_be_instantiated_only_once_per_process: bool,
    /// True if its state can be saved and restored.
    pub can_get_and_set_state: bool,
    /// True if its state can be serialised to bytes.
    pub can_serialize_state: bool,
    /// True if it provides directional derivatives.
    pub provides_directional_derivatives: bool,
    /// True if it takes communication steps of any length.
    pub can_handle_variable_communication_step_size: bool,
    /// True if it takes derivatives of inputs (FMI 2.0).
    pub can_interpolate_inputs: bool,
    /// Highest order of the derivatives of outputs.
    pub max_output_derivative_order: u32,
    /// Its internal step (s); communication steps are multiples of it (FMI 3.0).
    pub fixed_internal_step_size: Option<f64>,
    /// True if it has the event mode (FMI 3.0).
    pub has_event_mode: bool,
    /// True if it calls back between communication points (FMI 3.0).
    pub provides_intermediate_update: bool,
    /// True if a step may end early (FMI 3.0).
    pub might_return_early_from_do_step: bool,
    /// True if a callback can end a step (FMI 3.0).
    pub can_return_early_after_intermediate_update: bool,
}

impl CoSimulation {
    /// Reads `<CoSimulation>` of either version; the names of some attributes differ.
    pub(super) fn read(element: Element) -> Result<Self, FmuError> {
        let either = |two, three| Ok::<_, FmuError>(element.boolean(two)? || element.boolean(three)?);
        let step = element.number("fixedInternalStepSize")?;
        if step.is_some_and(|step| step <= 0.0) {
            return Err(element.wrong("fixedInternalStepSize", "a positive number of seconds"));
        }
        Ok(Self {
            model_identifier: model_identifier(element)?,
            needs_execution_tool: element.boolean("needsExecutionTool")?,
            can_be_instantiated_only_once_per_process: element.boolean("canBeInstantiatedOnlyOncePerProcess")?,
            can_get_and_set_state: either("canGetAndSetFMUstate", "canGetAndSetFMUState")?,
            can_serialize_state: either("canSerializeFMUstate", "canSerializeFMUState")?,
            provides_directional_derivatives: either(
                "providesDirectionalDerivative",
                "providesDirectionalDerivatives",
            )?,
            can_handle_variable_communication_step_size: element.boolean("canHandleVariableCommunicationStepSize")?,
            can_interpolate_inputs: element.boolean("canInterpolateInputs")?,
            max_output_derivative_order: element.unsigned("maxOutputDerivativeOrder")?.unwrap_or(0),
            fixed_internal_step_size: step,
            has_event_mode: element.boolean("hasEventMode")?,
            provides_intermediate_update: element.boolean("providesIntermediateUpdate")?,
            might_return_early_from_do_step: element.boolean("mightReturnEarlyFromDoStep")?,
            can_return_early_after_intermediate_update: element.boolean("canReturnEarlyAfterIntermediateUpdate")?,
        })
    }
}

/// Reads the model identifier. It becomes a file name, so a path in it is an error.
fn model_identifier(element: Element) -> Result<String, FmuError> {
    let name = element.required("modelIdentifier")?;
    let is_word = name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
    let is_identifier = is_word && name.starts_with(|first: char| !first.is_ascii_digit());
    if !is_identifier || name.len() > 200 {
        let expected = "an identifier of C: at most 200 letters, digits and underscores, no digit first";
        return Err(element.wrong("modelIdentifier", expected));
    }
    Ok(name.to_owned())
}

/// Finds the interface for co-simulation.
pub(super) fn co_simulation(root: Element) -> Result<CoSimulation, FmuError> {
    if let Some(element) = root.child("CoSimulation") {
        return CoSimulation::read(element);
    }
    let export = "export it for co-simulation";
    for (name, what) in [("ModelExchange", "model exchange alone"), ("ScheduledExecution", "scheduled execution alone")]
    {
        if let Some(element) = root.child(name) {
            let what = format!("an FMU for {what} (`<{name}>`)");
            return Err(element.error(DescriptionProblem::Unsupported { what, help: export }));
        }
    }
    let parent = root.name().to_owned();
    Err(root.error(DescriptionProblem::NoElement { parent, expected: "`<CoSimulation>`" }))
}

/// A category of log messages.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LogCategory {
    /// Its name.
    pub name: String,
    /// Description of its messages.
    pub description: String,
}

/// Suggested settings of a simulation.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DefaultExperiment {
    /// Start (s).
    pub start_time: Option<f64>,
    /// End (s).
    pub stop_time: Option<f64>,
    /// Relative tolerance.
    pub tolerance: Option<f64>,
    /// Communication step (s).
    pub step_size: Option<f64>,
}

impl DefaultExperiment {
    pub(super) fn read(root: Element) -> Result<Self, FmuError> {
        let Some(element) = root.child("DefaultExperiment") else { return Ok(Self::default()) };
        Ok(Self {
            start_time: element.number("startTime")?,
            stop_time: element.number("stopTime")?,
            tolerance: element.number("tolerance")?,
            step_size: element.number("stepSize")?,
        })
    }
}
