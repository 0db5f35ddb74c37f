//! An instance of the FMU, for both versions of the standard: its state machine, its values and its time.
//!
//! ```text
//! Instantiated → Initialization → Step → Terminated       any → Instantiated by reset
//!        an error leads to Failed, where only reset, a saved state and the end are allowed
//! ```
//! Source: FMI 2.0.5, §4.2.4; FMI 3.0.2, §2.3 and §4.2.
//!
//! Time of the FMU is the tick of its loop: t = start + k/f. A step covers a whole number of base ticks and holds the inputs;
//! any other step is an error: it never fits, whatever is requested next.
use crate::error::Refusal;
use crate::interface::{Kind, Role, Variable};
use crate::machine::{Machine, Model};
use servobench_base::Rate;
use std::ffi::{CStr, CString};
use std::sync::Arc;

/// Largest distance of a communication point from the time of a tick, in ticks. Hosts that add up their step are off by some
/// roundings, 1e-9 of a tick in an hour at 16 kHz; an intentionally different length differs by more than a thousandth.
const NEAR: f64 = 1e-3;

/// Longest step computed, in ticks: times up to it are exact.
const MOST_TICKS: f64 = 9_007_199_254_740_992.0;

/// State of an instance in the state machine of the standard.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Phase {
    Instantiated,
    Initialization,
    Step,
    Terminated,
    Failed,
}

impl Phase {
    const fn name(self) -> &'static str {
        match self {
            Self::Instantiated => "the state Instantiated",
            Self::Initialization => "Initialization Mode",
            Self::Step => "Step Mode",
            Self::Terminated => "the state Terminated",
            Self::Failed => "the state after an error",
        }
    }
}

/// Start and end of the simulation (s).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Experiment {
    pub(crate) start: f64,
    pub(crate) stop: Option<f64>,
}

/// An instance.
pub(crate) struct Instance {
    model: Arc<Model>,
    phase: Phase,
    experiment: Experiment,
    /// Values of all variables; outputs as of the last reading.
    values: Vec<f64>,
    /// True if the outputs among them are current.
    is_read: bool,
    machine: Option<Machine>,
    /// End of the last step (s).
    last_successful_time: f64,
    text: CString,
}

/// State of an instance at a time, which can be restored.
pub(crate) struct State {
    pub(crate) phase: Phase,
    pub(crate) experiment: Experiment,
    pub(crate) values: Vec<f64>,
    /// The loop, if it was built.
    pub(crate) machine: Option<Vec<u64>>,
}

impl Instance {
    pub(crate) fn new(model: Arc<Model>) -> Self {
        let values = model.start();
        let experiment = Experiment { start: 0.0, stop: None };
        let text = CString::default();
        let phase = Phase::Instantiated;
        Self { model, phase, experiment, values, is_read: false, machine: None, last_successful_time: 0.0, text }
    }

    pub(crate) fn model(&self) -> &Model {
        &self.model
    }

    /// End of the last step (s).
    pub(crate) const fn last_successful_time(&self) -> f64 {
        self.last_successful_time
    }

    /// Marks the instance as failed: only a reset or a saved state continues it.
    pub(crate) fn fail(&mut self) {
        self.phase = Phase::Failed;
    }

    fn expect(&self, phases: &[Phase], allowed: &'static str) -> Result<(), Refusal> {
        if phases.contains(&self.phase) { Ok(()) } else { Err(Refusal::Phase { phase: self.phase.name(), allowed }) }
    }

    /// Sets start and end of the simulation.
    pub(crate) fn set_experiment(&mut self, experiment: Experiment) -> Result<(), Refusal> {
        self.expect(&[Phase::Instantiated], "before initialization mode only")?;
        let Experiment { start, stop } = experiment;
        if !start.is_finite() {
            return Err(Refusal::Number { argument: "startTime", and: "", value: start });
        }
        if let Some(value) = stop.filter(|stop| !(stop.is_finite() && *stop >= start)) {
            return Err(Refusal::Number { argument: "stopTime", and: " and not before the start", value });
        }
        (self.experiment, self.last_successful_time) = (experiment, start);
        Ok(())
    }

    pub(crate) fn enter_initialization(&mut self) -> Result<(), Refusal> {
        self.expect(&[Phase::Instantiated], "after instantiation or reset only")?;
        self.phase = Phase::Initialization;
        Ok(())
    }

    pub(crate) fn exit_initialization(&mut self) -> Result<(), Refusal> {
        self.expect(&[Phase::Initialization], "in initialization mode only")?;
        self.built()?;
        self.phase = Phase::Step;
        Ok(())
    }

    pub(crate) fn terminate(&mut self) -> Result<(), Refusal> {
        self.expect(&[Phase::Step], "in step mode only")?;
        self.phase = Phase::Terminated;
        Ok(())
    }

    pub(crate) fn reset(&mut self) {
        *self = Self::new(Arc::clone(&self.model));
    }

    /// Builds the loop with the present parameters, if it is missing.
    fn built(&mut self) -> Result<(), Refusal> {
        if self.machine.is_none() {
            self.machine = Some(Machine::new(&self.model, &self.values)?);
            self.is_read = false;
        }
        Ok(())
    }

    fn variable(&self, reference: u32) -> Result<(usize, &Variable), Refusal> {
        let count = self.model.variables.len();
        let at = usize::try_from(reference).ok().filter(|at| *at < count);
        at.map(|at| (at, &self.model.variables[at])).ok_or(Refusal::Reference { reference, count })
    }

    /// The variable of a reference, if it has the requested type.
    fn typed(&self, reference: u32, asked: &Asked) -> Result<(usize, &Variable), Refusal> {
        let (at, variable) = self.variable(reference)?;
        if (asked.takes)(variable.kind) {
            return Ok((at, variable));
        }
        let (name, is) = (variable.name.clone(), (asked.name_of)(variable.kind));
        Err(Refusal::Type { name, reference, is, asked: asked.name })
    }

    /// Reads a number.
    pub(crate) fn get(&mut self, reference: u32, asked: &Asked) -> Result<f64, Refusal> {
        let (at, variable) = self.typed(reference, asked)?;
        match variable.role {
            Role::Input(_) | Role::Setting(_) => Ok(self.values[at]),
            Role::Time => Ok(self.time()),
            Role::Output(_) => {
                self.read_outputs(at)?;
                Ok(self.values[at])
            }
        }
    }

    /// Reads a text, which remains valid until the next call.
    pub(crate) fn get_text(&mut self, reference: u32, asked: &Asked) -> Result<&CStr, Refusal> {
        let (at, _) = self.typed(reference, asked)?;
        self.read_outputs(at)?;
        let text = self.machine.as_ref().map(Machine::faults).unwrap_or_default();
        self.text = CString::new(text).unwrap_or_default();
        Ok(&self.text)
    }

    /// Updates the outputs from the machine; `at` is the requested one.
    fn read_outputs(&mut self, at: usize) -> Result<(), Refusal> {
        if self.phase == Phase::Instantiated {
            return Err(Refusal::NotYet { name: self.model.variables[at].name.clone() });
        }
        if self.phase == Phase::Initialization {
            self.built()?;
        }
        if let (false, Some(machine)) = (self.is_read, &mut self.machine) {
            machine.read(&self.model.variables, &mut self.values);
            self.is_read = true;
        }
        Ok(())
    }

    /// Sets a number.
    pub(crate) fn set(&mut self, reference: u32, asked: &Asked, value: f64) -> Result<(), Refusal> {
        let (at, variable) = self.typed(reference, asked)?;
        let refuse = |what| Err(Refusal::NotSettable { name: variable.name.clone(), what });
        let is_before = matches!(self.phase, Phase::Instantiated | Phase::Initialization);
        match variable.role {
            Role::Time => return refuse("the independent variable"),
            Role::Output(_) => return refuse("an output"),
            Role::Setting(_) if !is_before => return refuse("a fixed parameter, and initialization is over"),
            Role::Input(_) if !is_before && self.phase != Phase::Step => {
                return refuse("an input, and nothing follows");
            }
            Role::Setting(_) | Role::Input(_) => {}
        }
        let (min, max) = variable.range();
        // Neither NaN nor infinity is in any range.
        if !(min..=max).contains(&value) {
            return Err(Refusal::Range { name: variable.name.clone(), min, max, value });
        }
        if matches!(variable.role, Role::Setting(_)) && self.values[at].to_bits() != value.to_bits() {
            (self.machine, self.is_read) = (None, false);
        }
        self.values[at] = value;
        Ok(())
    }

    /// Current time (s).
    fn time(&self) -> f64 {
        let rate = self.model.scenario.base_rate;
        let tick = self.machine.as_ref().map_or(0, Machine::tick);
        self.experiment.start + time_of(tick, rate)
    }

    /// Steps from `point` to `point + length` (s).
    pub(crate) fn step(&mut self, point: f64, length: f64) -> Result<(), Refusal> {
        self.expect(&[Phase::Step], "in step mode only")?;
        if !point.is_finite() {
            return Err(Refusal::Number { argument: "currentCommunicationPoint", and: "", value: point });
        }
        if !(length.is_finite() && length > 0.0) {
            return Err(Refusal::Number { argument: "communicationStepSize", and: " and above zero", value: length });
        }
        let Experiment { start, stop } = self.experiment;
        let rate = self.model.scenario.base_rate;
        let hertz = f64::from(rate.hertz());
        let ticks = |time: f64| (time - start) * hertz;
        let inputs = self.model.inputs(&self.values);
        let now = self.time();
        let Some(machine) = &mut self.machine else {
            return Err(Refusal::Phase { phase: self.phase.name(), allowed: "after initialization" });
        };
        let first = machine.tick();
        if (ticks(point) - first as f64).abs() > NEAR {
            return Err(Refusal::Point { given: point, now });
        }
        let to = point + length;
        if let Some(stop) = stop.filter(|stop| ticks(to) > ticks(*stop) + NEAR) {
            return Err(Refusal::Stop { to, stop });
        }
        let end = ticks(to).round();
        let is_whole = (ticks(to) - end).abs() <= NEAR && end > first as f64 && end < MOST_TICKS;
        if !is_whole {
            return Err(Refusal::Step { from: point, length, rate: rate.hertz(), tick: 1.0 / hertz });
        }
        self.is_read = false;
        while (machine.tick() as f64) < end {
            machine.step(&inputs)?;
        }
        self.last_successful_time = to;
        Ok(())
    }

    /// Saves the state of the instance.
    pub(crate) fn save(&mut self) -> Result<State, Refusal> {
        let machine = self.machine.as_mut().map(Machine::save).transpose()?;
        Ok(State { phase: self.phase, experiment: self.experiment, values: self.values.clone(), machine })
    }

    /// Restores `state`, which may be of another instance of the same FMU.
    pub(crate) fn restore(&mut self, state: &State) -> Result<(), Refusal> {
        let machine = match &state.machine {
            None => None,
            Some(saved) => {
                let mut machine = match self.machine.take() {
                    Some(machine) if self.has_settings_of(&state.values) => machine,
                    _ => Machine::new(&self.model, &state.values)?,
                };
                machine.restore(saved)?;
                Some(machine)
            }
        };
        (self.phase, self.experiment, self.machine) = (state.phase, state.experiment, machine);
        self.values.clone_from(&state.values);
        self.is_read = false;
        self.last_successful_time = self.time();
        Ok(())
    }

    fn has_settings_of(&self, values: &[f64]) -> bool {
        let all = self.model.variables.iter().zip(self.values.iter().zip(values));
        let mut settings = all.filter(|(variable, _)| matches!(variable.role, Role::Setting(_)));
        settings.all(|(_, (own, other))| own.to_bits() == other.to_bits())
    }
}

/// Time of a tick after the start (s).
fn time_of(tick: u64, rate: Rate) -> f64 {
    rate.time(servobench_base::Tick(tick))
}

/// A type requested by a function of the standard.
pub(crate) struct Asked {
    /// Its name in the standard.
    pub(crate) name: &'static str,
    /// True for kinds of variables of this type.
    pub(crate) takes: fn(Kind) -> bool,
    /// Name in the standard of the type of variables of a kind.
    pub(crate) name_of: fn(Kind) -> &'static str,
}
