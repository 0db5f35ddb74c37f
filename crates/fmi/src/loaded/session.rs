//! State of an instance between calls, common to both versions.
use super::batch::Misfit;
use super::instance::{Attempt, Slot};
use crate::description::ModelDescription;
use crate::error::{FmuError, LibraryProblem};
use crate::log::Clock;
use crate::setup::Setup;
use crate::slave::{Capabilities, Port, SlaveError, StepEnd};
use std::ffi::CString;

/// Part of a step that counts as rounding of its times.
const ROUNDING: f64 = 1e-9;

/// State of a running instance.
pub(super) struct Session {
    pub(super) capabilities: Capabilities,
    /// Its time (s).
    pub(super) time: f64,
    /// Its time, as stamped on log lines.
    clock: Clock,
    /// Stop time, which no step exceeds (s).
    stop: Option<f64>,
    /// True in the initialisation mode.
    pub(super) is_initialising: bool,
    /// Its time when it was saved (s), by slot.
    saved: [f64; Slot::COUNT],
    inputs: Vec<Port>,
    outputs: Vec<Port>,
}

impl Session {
    pub(super) fn new(capabilities: Capabilities, setup: &Setup, clock: Clock) -> Self {
        let (inputs, outputs) = (setup.inputs.clone(), setup.outputs.clone());
        let time = setup.start_time;
        let stop = setup.stop_time;
        Self { capabilities, time, clock, stop, is_initialising: true, saved: [time; Slot::COUNT], inputs, outputs }
    }

    /// Shortens a step that exceeds the stop time by a rounding: an FMU may treat that as an error (FMI 2.0.4, §2.1.6).
    pub(super) fn within_stop(&self, time: f64, length: f64) -> f64 {
        let Some(stop) = self.stop.filter(|stop| time + length > *stop && time + length - stop <= ROUNDING * length)
        else {
            return length;
        };
        let mut fitting = stop - time;
        while time + fitting > stop {
            fitting = fitting.next_down();
        }
        fitting
    }

    /// Outputs read before all inputs are known: values that are not finite are only initial guesses and become zero.
    pub(super) fn guess(outputs: &mut [f64]) {
        outputs.iter_mut().filter(|value| !value.is_finite()).for_each(|value| *value = 0.0);
    }

    /// The mean of an input over a step of length `h`: u + u'·h/2 + u''·h²/6.
    pub(super) fn mean([value, first, second]: [f64; 3], h: f64) -> f64 {
        value + first * h / 2.0 + second * h * h / 6.0
    }

    /// Error: an input that its variable cannot take.
    pub(super) fn misfit(&self, misfit: Misfit) -> SlaveError {
        let variable = self.inputs[misfit.port].variable.clone();
        SlaveError::Value { variable, bound: misfit.bound.into(), value: misfit.value, time: self.time }
    }

    /// Checks that all outputs are finite.
    pub(super) fn check_finite(&self, outputs: &[f64]) -> Result<(), SlaveError> {
        let Some(port) = outputs.iter().position(|value| !value.is_finite()) else { return Ok(()) };
        let variable = self.outputs[port].variable.clone();
        Err(SlaveError::NotFinite { variable, value: outputs[port], time: self.time })
    }

    /// Sets its time.
    pub(super) fn go_to(&mut self, time: f64) {
        self.time = time;
        self.clock.set(time);
    }

    /// Sets its time to the end of an attempted step.
    pub(super) fn reach(&mut self, time: f64, length: f64, attempt: Attempt) {
        self.go_to(match attempt {
            Attempt::Came(StepEnd::Done) => time + length,
            Attempt::Came(StepEnd::Until(reached) | StepEnd::Terminated(reached)) => reached,
            Attempt::Discarded { within, .. } => within.unwrap_or(time),
        });
    }

    pub(super) fn save(&mut self, slot: Slot) {
        self.saved[slot as usize] = self.time;
    }

    pub(super) fn restore(&mut self, slot: Slot) {
        self.go_to(self.saved[slot as usize]);
    }
}

/// The name of the instance, which must not be empty.
pub(super) fn instance_name(setup: &Setup, it: &ModelDescription) -> Result<CString, FmuError> {
    let name = if setup.instance_name.is_empty() { &it.co_simulation.model_identifier } else { &setup.instance_name };
    CString::new(name.as_str()).map_err(|_| FmuError::Library {
        path: name.into(),
        problem: LibraryProblem::Instantiate { call: "the instance", why: "its name has a zero byte".into() },
    })
}
