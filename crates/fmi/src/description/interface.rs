//! What an FMU says of itself as a whole.
use super::element::Element;
use crate::error::{DescriptionProblem, FmuError};

/// What the FMU can do and needs as a co-simulation FMU.
#[derive(Debug, Clone, PartialEq, Default)]
#[expect(clippy::struct_excessive_bools, reason = "the flags of the standard")]
pub struct CoSimulation {
    /// File name of the library, and prefix of its functions when they are linked statically.
    pub model_identifier: String,
    /// A tool has to be installed.
    pub needs_execution_tool: bool,
    /// One instance in a process.
    pub can_be_instantiated_only_once_per_process: bool,
    /// Its state can be saved and restored.
    pub can_get_and_set_state: bool,
    /// Its state can be turned into bytes.
    pub can_serialize_state: bool,
    /// It gives directional derivatives.
    pub provides_directional_derivatives: bool,
    /// It takes communication steps of any length.
    pub can_handle_variable_communication_step_size: bool,
    /// It takes derivatives of inputs (FMI 2.0).
    pub can_interpolate_inputs: bool,
    /// Derivatives of outputs up to this order.
    pub max_output_derivative_order: u32,
    /// Its internal step (s); communication steps are multiples of it (FMI 3.0).
    pub fixed_internal_step_size: Option<f64>,
    /// It has the event mode (FMI 3.0).
    pub has_event_mode: bool,
    /// It calls back between communication points (FMI 3.0).
    pub provides_intermediate_update: bool,
    /// A step may end before its end (FMI 3.0).
    pub might_return_early_from_do_step: bool,
    /// A step can be ended from a call back (FMI 3.0).
    pub can_return_early_after_intermediate_update: bool,
}

impl CoSimulation {
    /// Of `<CoSimulation>` of both versions, in which the names of some attributes differ.
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

/// It becomes a file name: a path in it would lead anywhere.
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
    /// What belongs to it.
    pub description: String,
}

/// How the FMU is meant to be run.
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
