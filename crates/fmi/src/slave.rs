//! An initialised co-simulation FMU, of either version, in this process or a separate one.
use crate::bits;
use crate::request::DeclaredNumber;
use serde::{Deserialize, Serialize};
use servobench_base::Severity;
pub use servobench_base::StepEnd;
use servobench_fmu_file::FmuMistake;
use std::borrow::Cow;
use thiserror::Error;

/// An exchanged scalar: a variable, or an element of an array.
///
/// Every type is exchanged as a number: integers and enumerations by value, FALSE and TRUE as 0 and 1. A number that the type cannot hold
/// is [`SlaveError::Value`].
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Port {
    /// Name in the model description.
    pub variable: String,
    /// Position in the array in row-major order, from 0; 0 for a scalar.
    pub element: usize,
}

/// Capabilities of an FMU beyond stepping.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Capabilities {
    /// True if its state can be saved and restored (`canGetAndSetFMUState`).
    pub saves_state: bool,
    /// True if it takes derivatives of its inputs (FMI 2.0: `canInterpolateInputs`).
    pub interpolates_inputs: bool,
    /// True if it takes communication steps of any length (`canHandleVariableCommunicationStepSize`).
    pub variable_step: bool,
}

/// A log message of an FMU.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LogLine {
    /// Simulation time (s): within a step its start, between two steps the present, before the first one the start of the simulation.
    #[serde(with = "bits::float")]
    pub time: f64,
    /// Severity: the status OK informs, warning warns, discard, error and fatal are errors.
    #[serde(with = "bits::severity")]
    pub severity: Severity,
    /// Category as the FMU names it.
    pub category: String,
    /// The text.
    pub message: String,
}

/// Categories of the standard that add nothing to the severity.
const PLAIN: [&str; 3] = ["logStatusWarning", "logStatusError", "logAll"];

impl LogLine {
    /// Category and text for display; without a category of the standard that adds nothing to the severity.
    #[must_use]
    pub fn words(&self) -> String {
        let Self { category, message, .. } = self;
        if category.is_empty() || PLAIN.contains(&category.as_str()) {
            message.clone()
        } else {
            format!("{category}: {message}")
        }
    }
}

/// An initialised FMU that is stepped. Its inputs and outputs are those of its wiring.
///
/// After an error other than [`SlaveError::Discarded`] it can only be dropped.
pub trait Slave: Send {
    /// Its capabilities; none by default.
    fn capabilities(&self) -> Capabilities {
        Capabilities::default()
    }

    /// True if an output may follow an input at once, without a step (direct feedthrough), or if that is not known. Both are given by
    /// position among the wired ones.
    fn feeds_through(&self, _output: usize, _input: usize) -> bool {
        true
    }

    /// True if an output, by position among the wired ones, changes at events only, as one that is not a real number or not continuous.
    /// Between two of its values the older one holds.
    fn is_discrete(&self, _output: usize) -> bool {
        false
    }

    /// Wired input number `input`, as the model description declares it; `None` if not known.
    fn declared_input(&self, _input: usize) -> Option<&DeclaredNumber> {
        None
    }

    /// Wired output number `output`, likewise.
    fn declared_output(&self, _output: usize) -> Option<&DeclaredNumber> {
        None
    }

    /// True if an exchanged number has single precision.
    fn is_single_precision(&self) -> bool {
        false
    }

    /// Doubts about the request by which it was opened.
    fn doubts(&self) -> &[FmuMistake] {
        &[]
    }

    /// True during its initialisation, which [`start`](Self::start) ends. Until then it is only read.
    fn is_initialising(&self) -> bool {
        false
    }

    /// True if an output may follow an input by the initial equations, or if that is not known.
    fn follows_at_start(&self, output: usize, input: usize) -> bool {
        self.feeds_through(output, input)
    }

    /// Ends the initialisation, with these inputs if given.
    ///
    /// # Errors
    /// [`SlaveError`]
    fn start(&mut self, _inputs: Option<&[f64]>) -> Result<(), SlaveError> {
        Ok(())
    }

    /// Terminates and frees it; afterwards only its log can be taken. A failure is a warning there: all results are known. Without this
    /// call, dropping does the same silently.
    fn end(&mut self) {}

    /// Goes from `time` to `time + length` (s). Each input is its value at `time` with its first and second time derivative; an FMU that
    /// takes no derivatives gets the mean over the step, u + u'·H/2 + u''·H²/6.
    ///
    /// # Errors
    /// [`SlaveError`]
    fn step(&mut self, time: f64, length: f64, inputs: &[[f64; 3]]) -> Result<StepEnd, SlaveError>;

    /// Reads all outputs. `inputs`, if given, are set before; between two steps outputs may follow them without a step (direct
    /// feedthrough).
    ///
    /// # Errors
    /// [`SlaveError`]
    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), SlaveError>;

    /// Saves its state, in place of the one saved before.
    ///
    /// # Errors
    /// [`SlaveError`], also if it cannot.
    fn save(&mut self) -> Result<(), SlaveError> {
        Err(SlaveError::unable("save its state"))
    }

    /// Restores the saved state, which can be restored again.
    ///
    /// # Errors
    /// [`SlaveError`], also without a saved state.
    fn restore(&mut self) -> Result<(), SlaveError> {
        Err(SlaveError::unable("go back to a state"))
    }

    /// Takes the log since the last call. Messages of a repeated step are repeated.
    fn take_log(&mut self) -> Vec<LogLine> {
        Vec::new()
    }
}

/// Reason why an FMU did not do what was requested.
#[derive(Debug, Clone, PartialEq, Error, Serialize, Deserialize)]
pub enum SlaveError {
    /// The FMU returned the status discard. If it can be taken back, parts of the step were tried as well, up to `time`.
    #[error("the FMU discarded {call} at {time} s{}", tried(*shortest))]
    Discarded {
        /// Function of the standard.
        call: Cow<'static, str>,
        /// Its time (s).
        #[serde(with = "bits::float")]
        time: f64,
        /// The shortest step tried from there (s), if it can be taken back.
        #[serde(with = "bits::optional")]
        shortest: Option<f64>,
    },
    /// The FMU returned the status error or fatal.
    #[error("the FMU failed in {call} at {time} s ({status}){}", said(.message))]
    Failed {
        /// Function of the standard.
        call: Cow<'static, str>,
        /// Time (s).
        #[serde(with = "bits::float")]
        time: f64,
        /// Status as the standard names it.
        status: Cow<'static, str>,
        /// The last message that it logged; empty without one.
        message: String,
    },
    /// An output is not a finite number.
    #[error("the FMU's output `{variable}` is {value} at {time} s")]
    NotFinite {
        /// Name of the variable.
        variable: String,
        /// Its value.
        #[serde(with = "bits::float")]
        value: f64,
        /// Time (s).
        #[serde(with = "bits::float")]
        time: f64,
    },
    /// A number that a variable cannot take.
    #[error("`{variable}` of the FMU takes {bound}, got {value} at {time} s")]
    Value {
        /// Name of the variable.
        variable: String,
        /// Values it takes.
        bound: Cow<'static, str>,
        /// The number.
        #[serde(with = "bits::float")]
        value: f64,
        /// Time (s).
        #[serde(with = "bits::float")]
        time: f64,
    },
    /// The FMU lacks the requested capability.
    #[error("the FMU cannot {what}: its model description does not say `{capability}`")]
    Unable {
        /// The request.
        what: Cow<'static, str>,
        /// The missing attribute.
        capability: Cow<'static, str>,
    },
    /// The FMU returned from a step at a time outside the step.
    #[error("the FMU was asked by {call} to go from {from} s to {to} s, and says that it is at {at} s")]
    Astray {
        /// Function of the standard.
        call: Cow<'static, str>,
        /// Start of the step (s).
        #[serde(with = "bits::float")]
        from: f64,
        /// End of the step (s).
        #[serde(with = "bits::float")]
        to: f64,
        /// Time reported by the FMU (s).
        #[serde(with = "bits::float")]
        at: f64,
    },
    /// The FMU's process ended.
    #[error("the FMU's process ended{} at {time} s: {how}", during(call))]
    Crashed {
        /// Function of the standard in progress; empty if none.
        call: Cow<'static, str>,
        /// Time (s).
        #[serde(with = "bits::float")]
        time: f64,
        /// Signal or exit code, and its output on standard error.
        how: String,
    },
    /// The FMU did not return in time.
    #[error("the FMU did not come back from {call} at {time} s within {call_timeout} s of real time; it was ended")]
    Hung {
        /// Function of the standard.
        call: Cow<'static, str>,
        /// Time (s).
        #[serde(with = "bits::float")]
        time: f64,
        /// Time limit (s).
        #[serde(with = "bits::float")]
        call_timeout: f64,
    },
}

impl SlaveError {
    /// Error: it cannot do `what` because it does not save its state.
    pub(crate) fn unable(what: &'static str) -> Self {
        Self::Unable { what: what.into(), capability: "canGetAndSetFMUState".into() }
    }
}

fn during(call: &str) -> String {
    if call.is_empty() { String::new() } else { format!(" in {call}") }
}

fn tried(shortest: Option<f64>) -> String {
    shortest.map_or_else(String::new, |shortest| format!(", over {shortest} s as over all longer steps"))
}

fn said(message: &str) -> String {
    if message.is_empty() { String::new() } else { format!(": {message}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_category_is_said_where_it_says_something() {
        let words = |category: &str| {
            let (category, message) = (category.to_owned(), "stiff".to_owned());
            LogLine { time: 0.0, severity: Severity::Warning, category, message }.words()
        };
        assert_eq!(["", "logStatusWarning", "logEvents"].map(words), ["stiff", "stiff", "logEvents: stiff"]);
    }
}
