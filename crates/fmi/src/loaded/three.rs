//! FMI 3.0 in the order of FMI 3.0.2, §4.2 (state machine of co-simulation), with the event mode where the FMU has it.
use super::batch::{self, Batches, batches};
use super::instance::{Attempt, Instance, Slot, reached, within};
use super::session::{Session, instance_name};
use super::time_event::TimeEvent;
use crate::archive::Unpacked;
use crate::description::{Causality, DataType, Values, Variability, Variable};
use crate::error::FmuError;
use crate::library::status::{Health, Outcome};
use crate::library::three::{Flag, Three};
use crate::library::{Access, Called};
use crate::log::Clock;
use crate::setup::{Setup, Start};
use crate::slave::{Capabilities, LogLine, SlaveError, StepEnd};
use std::ffi::CString;

/// Most updates of discrete states at one event. An FMU that wants more loops for ever.
const MOST_UPDATES: usize = 1_000;

/// An FMU of version 3.0.
pub(super) struct LoadedThree {
    instance: Three,
    session: Session,
    has_event_mode: bool,
    event: TimeEvent,
    /// The event at the time of saving, by slot.
    saved_event: [TimeEvent; Slot::COUNT],
    /// Inputs that change at any time.
    continuous: Batches<Three>,
    /// All other inputs, which change at events.
    discrete: Batches<Three>,
    outputs: Batches<Three>,
}

impl LoadedThree {
    pub(super) fn new(fmu: &Unpacked, setup: &Setup) -> Result<Self, FmuError> {
        let it = fmu.description();
        let plan = setup.plan(fmu)?;
        let clock = Clock::at(setup.start_time);
        let can = &it.co_simulation;
        let has_event_mode = can.has_event_mode && !setup.without_event_mode;
        let instance = Three::new(fmu, &instance_name(setup, it)?, setup.logging, has_event_mode, clock.clone())?;
        let capabilities = Capabilities {
            saves_state: can.can_get_and_set_state,
            interpolates_inputs: false,
            variable_step: can.can_handle_variable_communication_step_size,
        };
        let counts = &plan.counts;
        let event = TimeEvent::new(capabilities.variable_step, setup.stop_time);
        let mut loaded = Self {
            instance,
            session: Session::new(capabilities, setup, clock),
            has_event_mode,
            event,
            saved_event: [event; Slot::COUNT],
            continuous: batches(it, &plan.inputs, counts, |variability| variability == Variability::Continuous),
            discrete: batches(it, &plan.inputs, counts, |variability| variability != Variability::Continuous),
            outputs: batches(it, &plan.outputs, counts, |_| true),
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
        let variable = |start: &Start| &fmu.description().variables[start.variable];
        let is_structural = |start: &&Start| variable(start).causality == Causality::StructuralParameter;
        let structural = starts.iter().take_while(is_structural).count();
        if structural > 0 {
            if !self.instance.has_configuration_mode() {
                let (what, capability) = ("change the extents of arrays".into(), "fmi3EnterConfigurationMode".into());
                return Err(SlaveError::Unable { what, capability });
            }
            let outcome = self.instance.enter_configuration_mode();
            self.check("fmi3EnterConfigurationMode", outcome)?;
        }
        for (at, start) in starts.iter().enumerate() {
            if at == structural && structural > 0 {
                let outcome = self.instance.exit_configuration_mode();
                self.check("fmi3ExitConfigurationMode", outcome)?;
            }
            let (call, outcome) = set(&self.instance, variable(start), &start.values);
            self.check(call, outcome)?;
        }
        if structural > 0 && structural == starts.len() {
            let outcome = self.instance.exit_configuration_mode();
            self.check("fmi3ExitConfigurationMode", outcome)?;
        }
        let outcome = self.instance.enter_initialization_mode(setup.tolerance, setup.start_time, setup.stop_time);
        self.check("fmi3EnterInitializationMode", outcome)?;
        self.read_unwired_elements()?;
        if setup.waits { Ok(()) } else { self.start(None) }
    }

    /// Reads the elements that are not wired: an array is set as a whole, and they keep their start values.
    fn read_unwired_elements(&mut self) -> Result<(), SlaveError> {
        let Self { instance, continuous, discrete, .. } = self;
        let arrays = continuous.iter_mut().chain(discrete).filter(|batch| batch.has_others());
        let (call, outcome) = batch::all(arrays.map(|batch| batch.get(instance)));
        self.check(call, outcome)
    }

    /// Updates the discrete states until they stay, from the event mode, then enters the step mode. Returns true if the FMU wants the
    /// simulation to end.
    fn settle(&mut self) -> Result<bool, SlaveError> {
        let call = "fmi3UpdateDiscreteStates";
        for _ in 0..MOST_UPDATES {
            let (outcome, updated) = self.instance.update_discrete_states();
            self.check(call, outcome)?;
            self.event.announce(updated.next_event_time);
            if updated.terminate_simulation {
                return Ok(true);
            }
            if !updated.again {
                let outcome = self.instance.enter_step_mode();
                self.check("fmi3EnterStepMode", outcome)?;
                return Ok(false);
            }
        }
        self.instance.health = Health::Broken;
        let message = format!("its discrete states did not settle in {MOST_UPDATES} updates");
        Err(SlaveError::Failed { call: call.into(), time: self.session.time, status: "fmi3OK".into(), message })
    }

    /// Sets inputs: those that change at any time by `continuous`; all others by `discrete`, at an event if one is new. Also handles
    /// another event that is due. Returns true if the FMU wants the simulation to end.
    fn set_inputs(
        &mut self,
        continuous: &dyn Fn(usize) -> f64,
        discrete: &dyn Fn(usize) -> f64,
    ) -> Result<bool, SlaveError> {
        let has_event_mode = self.has_event_mode && !self.session.is_initialising;
        let mut is_new = false;
        for batch in &mut self.discrete {
            is_new |= batch.take(discrete).map_err(|misfit| self.session.misfit(misfit))?;
        }
        let is_event = has_event_mode && (is_new || self.event.is_due(self.session.time));
        if is_event {
            let outcome = self.instance.enter_event_mode();
            self.check("fmi3EnterEventMode", outcome)?;
        }
        self.set_continuous(continuous)?;
        if is_new || !has_event_mode {
            let (call, outcome) = batch::all(self.discrete.iter().map(|batch| batch.set(&self.instance)));
            self.check(call, outcome)?;
        }
        if is_event { self.settle() } else { Ok(false) }
    }

    fn set_continuous(&mut self, continuous: &dyn Fn(usize) -> f64) -> Result<(), SlaveError> {
        for batch in &mut self.continuous {
            batch.take(continuous).map_err(|misfit| self.session.misfit(misfit))?;
        }
        let (call, outcome) = batch::all(self.continuous.iter().map(|batch| batch.set(&self.instance)));
        self.check(call, outcome)
    }
}

impl Instance for LoadedThree {
    fn capabilities(&self) -> Capabilities {
        self.session.capabilities
    }

    fn start(&mut self, inputs: Option<&[f64]>) -> Result<(), SlaveError> {
        if let Some(inputs) = inputs {
            let now = |port: usize| inputs[port];
            self.set_inputs(&now, &now)?;
        }
        let outcome = self.instance.exit_initialization_mode();
        self.check("fmi3ExitInitializationMode", outcome)?;
        self.session.is_initialising = false;
        if self.has_event_mode && self.settle()? {
            let message = "it wants to end at its start".to_owned();
            let (call, time) = ("fmi3UpdateDiscreteStates".into(), self.session.time);
            return Err(SlaveError::Failed { call, time, status: "fmi3OK".into(), message });
        }
        Ok(())
    }

    fn end(&mut self) {
        self.instance.end();
    }

    fn attempt(&mut self, time: f64, length: f64, inputs: &[[f64; 3]]) -> Result<Attempt, SlaveError> {
        self.session.go_to(time);
        let length = self.session.within_stop(time, length);
        let leg = self.event.leg(time, length);
        let mean = |port: usize| Session::mean(inputs[port], leg.length);
        if self.set_inputs(&mean, &|port| inputs[port][0])? {
            return Ok(Attempt::Came(StepEnd::Terminated(time)));
        }
        // An event at the start may have changed the time of the next one.
        let before = leg;
        let leg = self.event.leg(time, length);
        if leg != before {
            self.set_continuous(&|port| Session::mean(inputs[port], leg.length))?;
        }
        let (outcome, stepped) = self.instance.do_step(time, leg.length, !self.instance.has_saved());
        if outcome == Outcome::Discarded {
            let within = within(Some(stepped.last_successful_time), time, leg.length);
            let discarded = Attempt::Discarded { call: "fmi3DoStep", within };
            self.session.reach(time, length, discarded);
            return Ok(discarded);
        }
        self.check("fmi3DoStep", outcome)?;
        let end = time + leg.length;
        // Without an early return an FMU may be at a slightly different time, that of its own solver (FMI 3.0.1, §4.2.1).
        let is_early = stepped.early_return || stepped.terminate_simulation;
        let at = if is_early { reached("fmi3DoStep", time, leg.length, stepped.last_successful_time)? } else { end };
        let mut progress = if stepped.terminate_simulation {
            StepEnd::Terminated(at)
        } else if at < end {
            StepEnd::Until(at)
        } else if leg.is_cut {
            StepEnd::Until(end)
        } else {
            StepEnd::Done
        };
        self.session.reach(time, length, Attempt::Came(progress));
        let is_event = stepped.event_handling_needed || self.event.is_due(self.session.time);
        if is_event && self.has_event_mode && !stepped.terminate_simulation {
            let outcome = self.instance.enter_event_mode();
            self.check("fmi3EnterEventMode", outcome)?;
            if self.settle()? {
                progress = StepEnd::Terminated(self.session.time);
            }
        }
        Ok(Attempt::Came(progress))
    }

    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), SlaveError> {
        if let Some(inputs) = inputs {
            let now = |port: usize| inputs[port];
            // An FMU that wants to end here repeats that at the next step.
            self.set_inputs(&now, &now)?;
        }
        let is_guess = self.session.is_initialising && inputs.is_none();
        let Self { instance, outputs: batches, .. } = self;
        let (call, outcome) = batch::read(batches, instance, outputs);
        // While inputs are missing, an output that it cannot compute yet is only an initial guess.
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
        let outcome = saved.ok_or_else(|| SlaveError::unable("save its state"))?;
        self.check("fmi3GetFMUState", outcome)?;
        self.session.save(slot);
        self.saved_event[slot as usize] = self.event;
        self.discrete.iter_mut().for_each(|batch| batch.keep(slot));
        Ok(())
    }

    fn restore(&mut self, slot: Slot) -> Result<(), SlaveError> {
        let restored = self.instance.restore(slot);
        self.check(
            "fmi3SetFMUState",
            restored.ok_or_else(|| SlaveError::unable("go back to a state that was not saved"))?,
        )?;
        self.session.restore(slot);
        self.event = self.saved_event[slot as usize];
        self.discrete.iter_mut().for_each(|batch| batch.recall(slot));
        Ok(())
    }

    fn take_log(&mut self) -> Vec<LogLine> {
        self.instance.log().take()
    }
}

/// Sets a start value; returns the function used. Values are within their types, which was checked.
fn set(instance: &Three, variable: &Variable, values: &Values) -> Called {
    fn integers<T: TryFrom<i128>>(instance: &Three, reference: u32, values: &[i128]) -> Called
    where
        Three: Access<T>,
    {
        let values: Vec<T> = values.iter().filter_map(|value| T::try_from(*value).ok()).collect();
        instance.set(&[reference], &values)
    }
    let reference = variable.value_reference;
    match values {
        Values::Float(values) if variable.data_type == DataType::Float32 => {
            #[expect(clippy::cast_possible_truncation, reason = "rounded to what the variable holds")]
            let values: Vec<f32> = values.iter().map(|value| *value as f32).collect();
            instance.set(&[reference], &values)
        }
        Values::Float(values) => instance.set(&[reference], values),
        Values::Boolean(values) => {
            let values: Vec<Flag> = values.iter().map(|is| Flag((*is).into())).collect();
            instance.set(&[reference], &values)
        }
        Values::String(values) => {
            let texts: Vec<CString> = values.iter().filter_map(|text| CString::new(text.as_str()).ok()).collect();
            ("fmi3SetString", instance.set_strings(reference, &texts))
        }
        Values::Binary(values) => ("fmi3SetBinary", instance.set_binaries(reference, values)),
        Values::Integer(values) => match variable.data_type {
            DataType::Int8 => integers::<i8>(instance, reference, values),
            DataType::UInt8 => integers::<u8>(instance, reference, values),
            DataType::Int16 => integers::<i16>(instance, reference, values),
            DataType::UInt16 => integers::<u16>(instance, reference, values),
            DataType::Int32 => integers::<i32>(instance, reference, values),
            DataType::UInt32 => integers::<u32>(instance, reference, values),
            DataType::UInt64 => integers::<u64>(instance, reference, values),
            _ => integers::<i64>(instance, reference, values),
        },
    }
}
