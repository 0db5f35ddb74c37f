//! FMI 2.0 in the order of FMI 2.0.5, §4.2.4 (state machine of co-simulation).
use super::batch::{self, Batches, batches};
use super::instance::{Attempt, Instance, Slot, reached, within};
use super::session::{Session, instance_name};
use crate::archive::Unpacked;
use crate::description::{Causality, DataType, ModelDescription, Values, Variability};
use crate::error::FmuError;
use crate::library::status::Outcome;
use crate::library::two::{Flag, Two};
use crate::library::{Access, Called};
use crate::log::Clock;
use crate::setup::{Plan, Setup, Start};
use crate::slave::{Capabilities, LogLine, SlaveError, StepEnd};
use std::ffi::CString;

/// An FMU of version 2.0.
pub(super) struct LoadedTwo {
    instance: Two,
    session: Session,
    /// Inputs of type `Real` that change at any time.
    continuous: Batches<Two>,
    /// All other inputs, which are set to their present value.
    discrete: Batches<Two>,
    outputs: Batches<Two>,
    /// Outputs that may be read in the initialization mode.
    initial_outputs: Batches<Two>,
    derivatives: Option<Derivatives>,
}

/// Derivatives of the continuous inputs, for an FMU that takes them.
struct Derivatives {
    references: Vec<u32>,
    ports: Vec<usize>,
    values: Vec<f64>,
    /// The orders 1 and 2, one for each input.
    orders: [Vec<i32>; 2],
    /// True once a second derivative has been other than zero: until then it is not set.
    is_curved: bool,
}

impl LoadedTwo {
    pub(super) fn new(fmu: &Unpacked, setup: &Setup) -> Result<Self, FmuError> {
        let it = fmu.description();
        let plan = setup.plan(fmu)?;
        let clock = Clock::at(setup.start_time);
        let instance = Two::new(fmu, &instance_name(setup, it)?, setup.logging, clock.clone())?;
        let can = &it.co_simulation;
        let capabilities = Capabilities {
            saves_state: can.can_get_and_set_state,
            interpolates_inputs: can.can_interpolate_inputs,
            variable_step: can.can_handle_variable_communication_step_size,
        };
        let counts = &plan.counts;
        let mut loaded = Self {
            instance,
            session: Session::new(capabilities, setup, clock),
            continuous: batches(it, &plan.inputs, counts, |variability| variability == Variability::Continuous),
            discrete: batches(it, &plan.inputs, counts, |variability| variability != Variability::Continuous),
            outputs: batches(it, &plan.outputs, counts, |_| true),
            initial_outputs: readable_at_start(it, &plan),
            derivatives: can.can_interpolate_inputs.then(|| Derivatives::of(fmu, &plan)),
        };
        let initialised = loaded.initialise(fmu, setup, &plan.starts);
        initialised.map_err(|source| FmuError::Initialise { path: fmu.path().to_owned(), source })?;
        Ok(loaded)
    }

    fn check(&mut self, call: &'static str, outcome: Outcome) -> Result<(), SlaveError> {
        let Self { instance, session, .. } = self;
        let mut health = instance.health;
        let checked = outcome.check(call, session.time, &mut health, || instance.log().last());
        instance.health = health;
        checked
    }

    fn initialise(&mut self, fmu: &Unpacked, setup: &Setup, starts: &[Start]) -> Result<(), SlaveError> {
        let outcome = self.instance.setup_experiment(setup.tolerance, setup.start_time, setup.stop_time);
        self.check("fmi2SetupExperiment", outcome)?;
        for start in starts {
            let variable = &fmu.description().variables[start.variable];
            let (call, outcome) = set(&self.instance, variable.value_reference, &start.values);
            self.check(call, outcome)?;
        }
        let outcome = self.instance.enter_initialization_mode();
        self.check("fmi2EnterInitializationMode", outcome)?;
        if setup.waits { Ok(()) } else { self.start(None) }
    }

    /// Sets all inputs that are given: those that change at any time by `continuous`, all others by `discrete`.
    fn set_inputs(
        &mut self,
        continuous: &dyn Fn(usize) -> f64,
        discrete: &dyn Fn(usize) -> f64,
    ) -> Result<(), SlaveError> {
        for (is_continuous, number) in [(true, continuous), (false, discrete)] {
            let group = if is_continuous { &mut self.continuous } else { &mut self.discrete };
            let Self { instance, session, .. } = self;
            for batch in group.iter_mut() {
                batch.take(number).map_err(|misfit| session.misfit(misfit))?;
            }
            let (call, outcome) = batch::all(group.iter().map(|batch| batch.set(instance)));
            self.check(call, outcome)?;
        }
        Ok(())
    }

    /// Result of a discarded step.
    fn discarded(&self, time: f64, length: f64) -> Result<Attempt, SlaveError> {
        let (call, at) = ("fmi2DoStep", self.instance.last_successful_time());
        if self.instance.wants_to_end() {
            let at = reached(call, time, length, at.unwrap_or(time))?;
            return Ok(Attempt::Came(StepEnd::Terminated(at)));
        }
        Ok(Attempt::Discarded { call, within: within(at, time, length) })
    }
}

impl Instance for LoadedTwo {
    fn capabilities(&self) -> Capabilities {
        self.session.capabilities
    }

    fn start(&mut self, inputs: Option<&[f64]>) -> Result<(), SlaveError> {
        if let Some(inputs) = inputs {
            let now = |port: usize| inputs[port];
            self.set_inputs(&now, &now)?;
        }
        let outcome = self.instance.exit_initialization_mode();
        self.check("fmi2ExitInitializationMode", outcome)?;
        self.session.is_initialising = false;
        Ok(())
    }

    fn end(&mut self) {
        self.instance.end();
    }

    fn attempt(&mut self, time: f64, length: f64, inputs: &[[f64; 3]]) -> Result<Attempt, SlaveError> {
        self.session.go_to(time);
        let length = self.session.within_stop(time, length);
        let now = |port: usize| inputs[port][0];
        let mean = |port: usize| Session::mean(inputs[port], length);
        if self.derivatives.is_some() {
            self.set_inputs(&now, &now)?;
            self.set_derivatives(inputs)?;
        } else {
            self.set_inputs(&mean, &now)?;
        }
        let outcome = self.instance.do_step(time, length, !self.instance.has_saved());
        let attempt = match outcome {
            Outcome::Discarded => self.discarded(time, length)?,
            outcome => {
                self.check("fmi2DoStep", outcome)?;
                Attempt::Came(StepEnd::Done)
            }
        };
        self.session.reach(time, length, attempt);
        Ok(attempt)
    }

    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), SlaveError> {
        if let Some(inputs) = inputs {
            let now = |port: usize| inputs[port];
            self.set_inputs(&now, &now)?;
        }
        let is_initialising = self.session.is_initialising;
        let Self { instance, outputs: all, initial_outputs, .. } = self;
        if is_initialising {
            outputs.fill(0.0);
        }
        let (call, outcome) = batch::read(if is_initialising { initial_outputs } else { all }, instance, outputs);
        // While inputs are missing, an output that it cannot compute yet is only an initial guess.
        let is_guess = is_initialising && inputs.is_none();
        if !(is_guess && outcome == Outcome::Discarded) {
            self.check(call, outcome)?;
        }
        if is_guess {
            Session::guess(outputs);
        }
        self.session.check_finite(outputs)
    }

    fn save(&mut self, slot: Slot) -> Result<(), SlaveError> {
        let saved = if self.session.capabilities.saves_state { self.instance.save(slot) } else { None };
        let outcome = saved.ok_or_else(|| unable("save its state"))?;
        self.check("fmi2GetFMUstate", outcome)?;
        self.session.save(slot);
        Ok(())
    }

    fn restore(&mut self, slot: Slot) -> Result<(), SlaveError> {
        let restored = self.instance.restore(slot);
        self.check("fmi2SetFMUstate", restored.ok_or_else(|| unable("go back to a state that was not saved"))?)?;
        self.session.restore(slot);
        Ok(())
    }

    fn take_log(&mut self) -> Vec<LogLine> {
        self.instance.log().take()
    }
}

/// FMI 2.0.4, §4.2.4: in the initialization mode outputs and initial unknowns are read. All others count as their start values until it
/// is over.
fn readable_at_start(it: &ModelDescription, plan: &Plan) -> Batches<Two> {
    let is_readable = |variable: usize| {
        let mut unknowns = it.structure.initial_unknowns.iter();
        it.variables[variable].causality == Causality::Output || unknowns.any(|unknown| unknown.variable == variable)
    };
    let all = plan.outputs.iter().enumerate().filter(|(_, wire)| is_readable(wire.variable));
    batch::batches_of(it, all, &plan.counts, |_| true)
}

impl Derivatives {
    fn of(fmu: &Unpacked, plan: &Plan) -> Self {
        let it = fmu.description();
        let all = plan.inputs.iter().enumerate().map(|(port, wire)| (port, &it.variables[wire.variable]));
        let is_continuous =
            |variability, data_type| variability == Variability::Continuous && data_type == DataType::Float64;
        let (ports, references): (Vec<_>, Vec<_>) = all
            .filter(|(_, variable)| is_continuous(variable.variability, variable.data_type))
            .map(|(port, variable)| (port, variable.value_reference))
            .unzip();
        let count = references.len();
        let orders = [vec![1; count], vec![2; count]];
        Self { references, ports, values: vec![0.0; count], orders, is_curved: false }
    }
}

impl LoadedTwo {
    fn set_derivatives(&mut self, inputs: &[[f64; 3]]) -> Result<(), SlaveError> {
        let Self { instance, derivatives: Some(known), .. } = self else { return Ok(()) };
        known.is_curved |= known.ports.iter().any(|port| inputs[*port][2] != 0.0);
        let most = if known.references.is_empty() { 0 } else { 1 + usize::from(known.is_curved) };
        let mut outcome = Outcome::Done;
        for order in 0..most {
            for (value, port) in known.values.iter_mut().zip(&known.ports) {
                *value = inputs[*port][order + 1];
            }
            outcome = instance.set_input_derivatives(&known.references, &known.orders[order], &known.values);
            if outcome != Outcome::Done {
                break;
            }
        }
        self.check("fmi2SetRealInputDerivatives", outcome)
    }
}

/// Sets a start value; returns the function used.
fn set(instance: &Two, reference: u32, values: &Values) -> Called {
    let one = &[reference];
    match values {
        Values::Float(values) => instance.set(one, values),
        Values::Integer(values) => {
            // They are of 32 bits, which was checked.
            let values: Vec<i32> = values.iter().filter_map(|value| i32::try_from(*value).ok()).collect();
            instance.set(one, &values)
        }
        Values::Boolean(values) => {
            let values: Vec<Flag> = values.iter().map(|is| Flag((*is).into())).collect();
            instance.set(one, &values)
        }
        Values::String(values) => {
            // One, without zero bytes, which was checked.
            let text = values.first().and_then(|text| CString::new(text.as_str()).ok()).unwrap_or_default();
            ("fmi2SetString", instance.set_string(reference, &text))
        }
        // FMI 2.0 lacks this type.
        Values::Binary(_) => ("fmi2SetString", Outcome::Done),
    }
}

fn unable(what: &'static str) -> SlaveError {
    SlaveError::Unable { what: what.into(), capability: "canGetAndSetFMUstate".into() }
}
