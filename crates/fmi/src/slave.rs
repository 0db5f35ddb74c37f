//! A co-simulation FMU that is initialised, whichever version it is of, and whether it runs here or in a process of its own.
use crate::bits;
use crate::request::DeclaredNumber;
use serde::{Deserialize, Serialize};
use servobench_base::Severity;
pub use servobench_base::StepEnd;
use servobench_fmu_file::FmuMistake;
use std::borrow::Cow;
use thiserror::Error;

/// A scalar that is exchanged: a variable, or an element of an array.
///
/// Whatever its type is, it is exchanged as a number: integers and enumerations by value, FALSE and TRUE as 0 and 1. A number
/// that its type cannot hold is [`SlaveError::Value`].
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Port {
    /// Name in the model description.
    pub variable: String,
    /// Position in the array in row-major order, from 0; 0 for a scalar.
    pub element: usize,
}

/// What an FMU can do beyond stepping.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Capabilities {
    /// Its state can be saved and restored (`canGetAndSetFMUState`).
    pub saves_state: bool,
    /// It takes derivatives of its inputs (FMI 2.0: `canInterpolateInputs`).
    pub interpolates_inputs: bool,
    /// It takes communication steps of any length (`canHandleVariableCommunicationStepSize`).
    pub variable_step: bool,
}

/// What an FMU said.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LogLine {
    /// Simulation time (s): the start of the step in which it was said; between two steps where it was; before the first one
    /// its start.
    #[serde(with = "bits::float")]
    pub time: f64,
    /// How much it matters: the status OK informs, warning warns, discard, error and fatal are errors.
    #[serde(with = "bits::severity")]
    pub severity: Severity,
    /// Category as the FMU names it.
    pub category: String,
    /// The text.
    pub message: String,
}

/// Categories of the standard that say no more than the severity, or nothing.
const PLAIN: [&str; 3] = ["logStatusWarning", "logStatusError", "logAll"];

impl LogLine {
    /// Category and text, as a person reads it; without a category of the standard that says no more than the severity.
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

/// An initialised FMU that is stepped. Its inputs and outputs are those that it was wired with.
///
/// After an error it can only be dropped, [`SlaveError::Discarded`] apart.
pub trait Slave: Send {
    /// What it can do: nothing, unless it says so.
    fn capabilities(&self) -> Capabilities {
        Capabilities::default()
    }

    /// Whether an output may follow an input at once, without a step (direct feedthrough), each by its position among those
    /// that were wired; true where that is not known.
    fn feeds_through(&self, _output: usize, _input: usize) -> bool {
        true
    }

    /// Whether an output, by its position among those that were wired, changes at events only: what is no real number, and what is
    /// not continuous. Between two of its values it has the older one.
    fn is_discrete(&self, _output: usize) -> bool {
        false
    }

    /// Input number `input` of those that were wired, as the model description declares it; `None` where that is not known.
    fn declared_input(&self, _input: usize) -> Option<&DeclaredNumber> {
        None
    }

    /// Output number `output` of those that were wired, likewise.
    fn declared_output(&self, _output: usize) -> Option<&DeclaredNumber> {
        None
    }

    /// True where a number that is exchanged has single precision.
    fn is_single_precision(&self) -> bool {
        false
    }

    /// What is doubtful in the request by which it was opened.
    fn doubts(&self) -> &[FmuMistake] {
        &[]
    }

    /// Whether it is in its initialisation, which [`start`](Self::start) ends. Until then it is only read.
    fn is_initialising(&self) -> bool {
        false
    }

    /// Whether an output may follow an input by the initial equations; true where that is not known.
    fn follows_at_start(&self, output: usize, input: usize) -> bool {
        self.feeds_through(output, input)
    }

    /// Ends the initialisation, with these inputs if they are given.
    ///
    /// # Errors
    /// [`SlaveError`]
    fn start(&mut self, _inputs: Option<&[f64]>) -> Result<(), SlaveError> {
        Ok(())
    }

    /// Terminates and frees it, after which only its log can be taken. What goes wrong with that is a warning there: its results
    /// are all known. Where it is not called, dropping does the same without a word.
    fn end(&mut self) {}

    /// Goes from `time` to `time + length` (s). Each input is its value at `time` with its first and second derivative to the
    /// time; an FMU that takes none gets the mean over the step, u + u'·H/2 + u''·H²/6.
    ///
    /// # Errors
    /// [`SlaveError`]
    fn step(&mut self, time: f64, length: f64, inputs: &[[f64; 3]]) -> Result<StepEnd, SlaveError>;

    /// Reads all outputs. With `inputs`, which an FMU between two steps may answer without one (direct feedthrough), these are
    /// set before.
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

    /// Goes back to the state that was saved; it can do so again.
    ///
    /// # Errors
    /// [`SlaveError`], also if there is none.
    fn restore(&mut self) -> Result<(), SlaveError> {
        Err(SlaveError::unable("go back to a state"))
    }

    /// What it has said since the last time. What it says in a step that is repeated it says again.
    fn take_log(&mut self) -> Vec<LogLine> {
        Vec::new()
    }
}

/// Why an FMU did not do what it was asked for.
#[derive(Debug, Clone, PartialEq, Error, Serialize, Deserialize)]
pub enum SlaveError {
    /// It returned the status discard. A step that it can be taken back from was tried in parts as well: it is where these came to.
    #[error("the FMU discarded {call} at {time} s{}", tried(*shortest))]
    Discarded {
        /// Function of the standard.
        call: Cow<'static, str>,
        /// Where it is (s).
        #[serde(with = "bits::float")]
        time: f64,
        /// The shortest step that was tried from there (s), if it can be taken back.
        #[serde(with = "bits::optional")]
        shortest: Option<f64>,
    },
    /// It returned the status error or fatal.
    #[error("the FMU failed in {call} at {time} s ({status}){}", said(.message))]
    Failed {
        /// Function of the standard.
        call: Cow<'static, str>,
        /// When (s).
        #[serde(with = "bits::float")]
        time: f64,
        /// Status as the standard names it.
        status: Cow<'static, str>,
        /// The last that it logged; empty if nothing.
        message: String,
    },
    /// An output is not a finite number.
    #[error("the FMU's output `{variable}` is {value} at {time} s")]
    NotFinite {
        /// Name of the variable.
        variable: String,
        /// What it is.
        #[serde(with = "bits::float")]
        value: f64,
        /// When (s).
        #[serde(with = "bits::float")]
        time: f64,
    },
    /// A variable cannot take the number.
    #[error("`{variable}` of the FMU takes {bound}, got {value} at {time} s")]
    Value {
        /// Name of the variable.
        variable: String,
        /// What it takes.
        bound: Cow<'static, str>,
        /// What it should have taken.
        #[serde(with = "bits::float")]
        value: f64,
        /// When (s).
        #[serde(with = "bits::float")]
        time: f64,
    },
    /// It does not have what it was asked for.
    #[error("the FMU cannot {what}: its model description does not say `{capability}`")]
    Unable {
        /// What it was asked for.
        what: Cow<'static, str>,
        /// Attribute that it lacks.
        capability: Cow<'static, str>,
    },
    /// It came back from a step at a time where it cannot be.
    #[error("the FMU was asked by {call} to go from {from} s to {to} s, and says that it is at {at} s")]
    Astray {
        /// Function of the standard.
        call: Cow<'static, str>,
        /// Where the step began (s).
        #[serde(with = "bits::float")]
        from: f64,
        /// Where it should have ended (s).
        #[serde(with = "bits::float")]
        to: f64,
        /// Where it says that it is (s).
        #[serde(with = "bits::float")]
        at: f64,
    },
    /// Its process ended.
    #[error("the FMU's process ended{} at {time} s: {how}", during(call))]
    Crashed {
        /// Function of the standard that it was in; empty if it was in none.
        call: Cow<'static, str>,
        /// When (s).
        #[serde(with = "bits::float")]
        time: f64,
        /// Signal or exit code, and what it left on standard error.
        how: String,
    },
    /// It did not come back in time.
    #[error("the FMU did not come back from {call} at {time} s within {call_timeout} s of real time; it was ended")]
    Hung {
        /// Function of the standard.
        call: Cow<'static, str>,
        /// When (s).
        #[serde(with = "bits::float")]
        time: f64,
        /// How long it was waited for (s).
        #[serde(with = "bits::float")]
        call_timeout: f64,
    },
}

impl SlaveError {
    /// It cannot do `what` since it does not save its state.
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
