//! The loop inside an FMU: effect of its inputs in a base tick, and source of its outputs.
use crate::error::{FmuError, Refusal};
use crate::interface::{INPUTS, Input, Kind, Output, Role, SETPOINT, Setting, TARGET, Variable, variables};
use crate::mover::Mover;
use crate::part::{Part, has_one_body};
use servobench_base::state::{Reader, words};
use servobench_base::{Rate, Setpoint, Stateful as _};
use servobench_cia402::PowerState;
use servobench_plant::{BodyState, Exact};
use servobench_plcopen::AxisState;
use servobench_scenario::Scenario;
use servobench_sim::{Bench, BuildError, External, Stepper};

/// Part, scenario and variables of an FMU, before parameters are set.
pub(crate) struct Model {
    pub(crate) part: Part,
    pub(crate) scenario: Scenario,
    pub(crate) variables: Vec<Variable>,
    /// Duration of a run of the scenario (s), a whole number of base ticks.
    pub(crate) length: f64,
}

impl Model {
    /// `part` of `scenario`.
    ///
    /// # Errors
    /// [`FmuError`] if the part does not exist or cannot be built.
    pub(crate) fn new(part: Part, scenario: &Scenario) -> Result<Self, FmuError> {
        let name = || scenario.name.clone();
        if part == Part::Drive && scenario.actuator.drive().is_none() {
            return Err(FmuError::NoDrive { scenario: name() });
        }
        if part == Part::Drive && scenario.direction() < 0.0 {
            return Err(FmuError::Reversed { scenario: name() });
        }
        let own = part.of(scenario);
        if !own.fmus.is_empty() {
            return Err(FmuError::Beside { scenario: name() });
        }
        let built = |error| FmuError::Build { scenario: name(), error };
        let stepper = stepper(&own).map_err(built)?;
        let variables = variables(part, &own, &stepper);
        // Mechanics have no program of their own, and are stepped for the duration of the scenario's program.
        let length = Bench::length(scenario).map_err(built)?;
        Ok(Self { part, scenario: own, variables, length })
    }

    /// Start values of all variables.
    pub(crate) fn start(&self) -> Vec<f64> {
        self.variables.iter().map(|variable| variable.start).collect()
    }

    /// The inputs among `values`.
    pub(crate) fn inputs(&self, values: &[f64]) -> [f64; INPUTS] {
        let mut inputs = [0.0; INPUTS];
        for (variable, value) in self.variables.iter().zip(values) {
            if let Role::Input(input) = variable.role {
                inputs[input as usize] = *value;
            }
        }
        inputs
    }
}

fn stepper(scenario: &Scenario) -> Result<Stepper, BuildError> {
    Ok(Bench::new(scenario, &Exact)?.into_stepper())
}

/// A running loop.
pub(crate) struct Machine {
    part: Part,
    stepper: Stepper,
    /// Command, an item of the enumeration.
    command: f64,
    mover: Mover,
    /// Axis coordinate per motor coordinate, if motor and load are one body.
    one_body: Option<f64>,
    failed: bool,
}

impl Machine {
    /// The loop of `model`, with parameters from `values`.
    ///
    /// # Errors
    /// [`Refusal::Build`].
    pub(crate) fn new(model: &Model, values: &[f64]) -> Result<Self, Refusal> {
        let mut scenario = model.scenario.clone();
        let (mut command, mut limits) = (0.0, [0.0; 3]);
        for (variable, value) in model.variables.iter().zip(values) {
            match variable.role {
                Role::Setting(Setting::Command) => command = *value,
                Role::Setting(Setting::Limit(at)) => limits[at] = *value,
                // Unset parameters keep their values, to the last bit.
                Role::Setting(Setting::Scenario(parameter)) if value.to_bits() != variable.start.to_bits() => {
                    parameter.apply(&mut scenario, *value);
                }
                _ => {}
            }
        }
        let stepper = stepper(&scenario).map_err(|error| Refusal::Build(error.to_string()))?;
        let mover = Mover::new(scenario.initial.load_position, limits);
        let one_body = has_one_body(&scenario).then_some(scenario.axis.transmission);
        Ok(Self { part: model.part, stepper, command, mover, one_body, failed: false })
    }

    pub(crate) const fn rate(&self) -> Rate {
        self.stepper.base_rate()
    }

    /// The next tick.
    pub(crate) const fn tick(&self) -> u64 {
        self.stepper.tick().0
    }

    /// Runs one base tick.
    ///
    /// # Errors
    /// [`Refusal::Failed`] or [`Refusal::Move`]; then only a saved state can be restored.
    pub(crate) fn step(&mut self, inputs: &[f64; INPUTS]) -> Result<(), Refusal> {
        let input = |input: Input| inputs[input as usize];
        let is_true = |one| input(one) != 0.0;
        let (k, rate) = (self.tick(), self.rate());
        let setpoint = if self.command == TARGET {
            let factor = input(Input::Override);
            let target = self.mover.at(k, rate, is_true(Input::Execute), input(Input::Target), factor);
            Some(target.map_err(|error| Refusal::Move(error.to_string())).inspect_err(|_| self.failed = true)?)
        } else if self.command == SETPOINT {
            let (x, v, a) = (input(Input::Position), input(Input::Velocity), input(Input::Acceleration));
            Some(Setpoint { x, v, a, ..Setpoint::default() })
        } else {
            None
        };
        let measured = (self.part == Part::Drive).then(|| {
            let body = |position, velocity| BodyState { position: input(position), velocity: input(velocity) };
            let shaft = body(Input::ShaftPosition, Input::ShaftVelocity);
            let load = match self.one_body {
                Some(ratio) => BodyState { position: ratio * shaft.position, velocity: ratio * shaft.velocity },
                None => body(Input::LoadPosition, Input::LoadVelocity),
            };
            [shaft, load]
        });
        let external = External {
            start: is_true(Input::Start),
            setpoint,
            motor_effort: input(Input::MotorEffort),
            load_effort: input(Input::LoadEffort),
            measured,
            ..External::default()
        };
        self.stepper.step(&external).map_err(|failure| {
            self.failed = true;
            Refusal::Failed(failure.to_string())
        })
    }

    /// Sets all outputs among `values`.
    pub(crate) fn read(&mut self, variables: &[Variable], values: &mut [f64]) {
        let (shaft, states) = (self.stepper.shaft(), self.stepper.states());
        let channels = self.stepper.values();
        let item = |at: Option<usize>| at.map_or(1.0, |at| at as f64 + 1.0);
        for (variable, value) in variables.iter().zip(values) {
            let Role::Output(output) = variable.role else { continue };
            *value = match output {
                Output::Channel(at) => channels[at],
                Output::ShaftPosition => shaft.position,
                Output::ShaftVelocity => shaft.velocity,
                Output::DriveState => item(PowerState::ALL.iter().position(|state| Some(*state) == states.drive)),
                Output::AxisState => item(AxisState::ALL.iter().position(|state| Some(*state) == states.axis)),
                Output::DriveFault => f64::from(states.drive_fault),
                Output::Faults => 0.0,
            };
            debug_assert!(variable.kind != Kind::Text || *value == 0.0, "a text is no number");
        }
    }

    /// The faults of drive and link in words.
    pub(crate) fn faults(&self) -> String {
        let states = self.stepper.states();
        let drive = (states.drive_fault != 0).then(|| format!("drive: {:04X}h", states.drive_fault));
        let link = states.link_fault.map(|fault| format!("link: {fault}"));
        [drive, link].into_iter().flatten().collect::<Vec<_>>().join("; ")
    }

    /// Saves the state.
    ///
    /// # Errors
    /// [`Refusal::Failed`] after a failure.
    pub(crate) fn save(&mut self) -> Result<Vec<u64>, Refusal> {
        if self.failed {
            return Err(Refusal::Failed("a loop that has failed has no state".into()));
        }
        let mut all = Vec::new();
        let mut to = words(|word| all.push(word));
        self.stepper.save(&mut to).map_err(|error| Refusal::Failed(error.to_string()))?;
        self.mover.save(&mut to);
        Ok(all)
    }

    /// Restores the state `saved`, of a machine with the same parameters.
    ///
    /// # Errors
    /// [`Refusal::State`]; then only another state can be restored.
    pub(crate) fn restore(&mut self, saved: &[u64]) -> Result<(), Refusal> {
        self.failed = true;
        let wrong = Refusal::State { why: "they are not of a loop with these parameters" };
        let mut from = Reader::new(saved);
        self.stepper.restore(&mut from).map_err(|_| wrong.clone())?;
        self.mover.restore(&mut from).and_then(|()| from.end()).map_err(|_| wrong)?;
        self.failed = false;
        Ok(())
    }
}
