//! The variables of an FMU: the one table from which `modelDescription.xml` is generated, and in which the functions of the
//! standard look up variables. A value reference is the position in it.
use crate::parameter::{Least, OF_DRIVE, OF_MECHANICS, Parameter, effort, limits_of_moves};
use crate::part::{Part, has_one_body};
use servobench_cia402::PowerState;
use servobench_plcopen::AxisState;
use servobench_scenario::{Actuator, Scenario};
use servobench_signals::Writer;
use servobench_sim::Stepper;

/// Kind of a variable. All kinds but texts are stored as numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Real,
    Integer,
    Boolean,
    Enumeration(Choice),
    Text,
}

/// An enumeration; its items count from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Choice {
    Command,
    DriveState,
    AxisState,
}

impl Choice {
    /// Name of the type.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Command => "Command",
            Self::DriveState => "DriveState",
            Self::AxisState => "AxisState",
        }
    }

    /// Names and meanings of the items.
    pub(crate) fn items(self) -> Vec<(&'static str, &'static str)> {
        match self {
            Self::Command => vec![
                ("program", "the program of the scenario, from the first step on at which `start` is true"),
                ("target", "moves to `target`, one with each rising edge of `execute`"),
                ("setpoint", "`demand.position`, `demand.velocity` and `demand.acceleration`, new at every step"),
            ],
            Self::DriveState => PowerState::ALL.iter().map(|state| (state.name(), "")).collect(),
            Self::AxisState => AxisState::ALL.iter().map(|state| (state.name(), "")).collect(),
        }
    }
}

/// Item `program` of [`Choice::Command`]; the others follow.
pub(crate) const PROGRAM: f64 = 1.0;
pub(crate) const TARGET: f64 = 2.0;
pub(crate) const SETPOINT: f64 = 3.0;

/// Inputs, which are held over a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Input {
    Start,
    Target,
    Execute,
    Override,
    Position,
    Velocity,
    Acceleration,
    MotorEffort,
    LoadEffort,
    ShaftPosition,
    ShaftVelocity,
    LoadPosition,
    LoadVelocity,
}

/// Largest override.
const MOST_OVERRIDE: f64 = 2.0;

/// Number of inputs.
pub(crate) const INPUTS: usize = 13;

/// Outputs, which are updated by a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Output {
    /// Value of this channel of a recording.
    Channel(usize),
    ShaftPosition,
    ShaftVelocity,
    DriveState,
    DriveFault,
    AxisState,
    Faults,
}

/// Settings before the simulation begins.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Setting {
    Command,
    /// Limit of moves to a target: 0 velocity, 1 acceleration, 2 jerk.
    Limit(usize),
    Scenario(&'static Parameter),
}

/// Role of a variable.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Role {
    Time,
    Input(Input),
    Setting(Setting),
    Output(Output),
}

/// A variable.
#[derive(Debug, Clone)]
pub(crate) struct Variable {
    pub(crate) name: String,
    pub(crate) description: String,
    pub(crate) kind: Kind,
    /// Symbol of its unit as in recordings; empty for a pure number.
    pub(crate) unit: String,
    pub(crate) role: Role,
    /// Start value of an input or a parameter.
    pub(crate) start: f64,
    pub(crate) least: Least,
}

impl Variable {
    /// Range of its values.
    pub(crate) fn range(&self) -> (f64, f64) {
        match self.kind {
            Kind::Boolean => (0.0, 1.0),
            Kind::Enumeration(choice) => (1.0, choice.items().len() as f64),
            Kind::Integer => (f64::from(i32::MIN), f64::from(i32::MAX)),
            Kind::Real if matches!(self.role, Role::Input(Input::Override)) => (0.0, MOST_OVERRIDE),
            Kind::Real | Kind::Text => match self.least {
                Least::Any => (f64::MIN, f64::MAX),
                Least::Zero => (0.0, f64::MAX),
                Least::Positive => (f64::MIN_POSITIVE, f64::MAX),
            },
        }
    }
}

/// The variables of `part` of `scenario`; `stepper` is its loop.
pub(crate) fn variables(part: Part, scenario: &Scenario, stepper: &Stepper) -> Vec<Variable> {
    let (axis, motor) = (scenario.axis.motion.unit(), scenario.axis.motor_motion.unit());
    let is_commanded = part != Part::Mechanics && !matches!(scenario.actuator, Actuator::Off(_));
    let table = Table { axis, motor, all: Vec::new() };
    table
        .time()
        .settings(part, scenario, is_commanded)
        .inputs(part, scenario, is_commanded)
        .outputs(part, scenario, stepper)
}

/// The table under construction.
struct Table {
    axis: &'static str,
    motor: &'static str,
    all: Vec<Variable>,
}

impl Table {
    fn add(&mut self, name: &str, kind: Kind, unit: impl Into<String>, role: Role, description: impl Into<String>) {
        self.all.push(Variable {
            name: name.into(),
            description: description.into(),
            kind,
            unit: unit.into(),
            role,
            start: 0.0,
            least: Least::Any,
        });
    }

    fn time(mut self) -> Self {
        self.add("time", Kind::Real, "s", Role::Time, "simulation time");
        self
    }

    fn settings(mut self, part: Part, scenario: &Scenario, is_commanded: bool) -> Self {
        let axis = self.axis;
        if is_commanded {
            let text = "what commands the axis";
            let kind = Kind::Enumeration(Choice::Command);
            self.add("command", kind, "", Role::Setting(Setting::Command), text);
            self.start(PROGRAM);
            let limits = limits_of_moves(scenario).unwrap_or_default();
            for (at, name, power) in [(0, "velocity", ""), (1, "acceleration", "²"), (2, "jerk", "³")] {
                let text = format!("limit of {name} of moves to `target`; at 0 they are refused");
                let (name, unit) = (format!("target.{name}"), format!("{axis}/s{power}"));
                self.add(&name, Kind::Real, unit, Role::Setting(Setting::Limit(at)), text);
                self.start(limits[at]);
                self.least(Least::Zero);
            }
        }
        let of_drive = if part == Part::Mechanics { &[][..] } else { OF_DRIVE };
        let of_mechanics = if part == Part::Drive { &[][..] } else { OF_MECHANICS };
        for parameter in of_drive.iter().chain(of_mechanics) {
            if let Some(value) = parameter.value(scenario) {
                let role = Role::Setting(Setting::Scenario(parameter));
                self.add(parameter.name, Kind::Real, (parameter.unit)(scenario), role, parameter.description);
                self.start(value);
                self.least(parameter.least);
            }
        }
        self
    }

    fn inputs(mut self, part: Part, scenario: &Scenario, is_commanded: bool) -> Self {
        let (axis, motor) = (self.axis, self.motor);
        let velocity = |unit| format!("{unit}/s");
        let mut input = |name, kind, unit: &str, role, text: &str| {
            self.add(name, kind, unit, Role::Input(role), text);
        };
        if is_commanded {
            let text = "the program begins with the first step at which it is true";
            input("start", Kind::Boolean, "", Input::Start, text);
            input("target", Kind::Real, axis, Input::Target, "where to move, for the command `target`");
            let text = "its rising edge begins a move to `target` by the limits `target.*`";
            input("execute", Kind::Boolean, "", Input::Execute, text);
            let text = "factor of the velocity limit of moves to `target`; at 0 the axis stops";
            input("override", Kind::Real, "", Input::Override, text);
            let text =
                "position of the set-point, for the command `setpoint`; held over a step, so step at the base rate";
            input("demand.position", Kind::Real, axis, Input::Position, text);
            input("demand.velocity", Kind::Real, &velocity(axis), Input::Velocity, "its velocity");
            input("demand.acceleration", Kind::Real, &format!("{axis}/s²"), Input::Acceleration, "its acceleration");
        }
        if part == Part::Drive {
            let text = "measured position of the motor, in its own coordinate";
            input("shaft.position", Kind::Real, motor, Input::ShaftPosition, text);
            input("shaft.velocity", Kind::Real, &velocity(motor), Input::ShaftVelocity, "its velocity");
            if !has_one_body(scenario) {
                let text = "measured position of the load";
                input("load.position", Kind::Real, axis, Input::LoadPosition, text);
                input("load.velocity", Kind::Real, &velocity(axis), Input::LoadVelocity, "its velocity");
            }
        } else {
            let text = if part == Part::Mechanics {
                "torque or force on the motor, in its own coordinate"
            } else {
                "external torque or force on the motor, in its own coordinate, beside the disturbances of the scenario"
            };
            let name = if part == Part::Mechanics { "effort.motor" } else { "force.motor" };
            input(name, Kind::Real, effort(motor), Input::MotorEffort, text);
            let text = "external force or torque on the load";
            input("force.load", Kind::Real, effort(axis), Input::LoadEffort, text);
        }
        for one in &mut self.all {
            if matches!(one.role, Role::Input(Input::Start | Input::Override)) {
                one.start = 1.0;
            }
        }
        self
    }

    fn outputs(mut self, part: Part, scenario: &Scenario, stepper: &Stepper) -> Vec<Variable> {
        let motor = self.motor;
        for (at, (signal, channel)) in stepper.signals().iter().zip(stepper.channels()).enumerate() {
            let is_of_a_body = signal.writer() == Writer::Mechanics;
            let is_there = match part {
                Part::Axis => true,
                Part::Drive => !is_of_a_body,
                Part::Mechanics => is_of_a_body,
            };
            if is_there {
                let when = if is_of_a_body { "now" } else { "of the base tick that has ended" };
                let text = format!("{} ({when})", signal.meaning());
                self.add(signal.name(), Kind::Real, channel.unit.clone(), Role::Output(Output::Channel(at)), text);
            }
        }
        let mut output = |name, kind, unit: &str, role, text: &str| {
            self.add(name, kind, unit, Role::Output(role), text);
        };
        if part == Part::Mechanics {
            let text = "position of the motor, in its own coordinate";
            output("shaft.position", Kind::Real, motor, Output::ShaftPosition, text);
            output("shaft.velocity", Kind::Real, &format!("{motor}/s"), Output::ShaftVelocity, "its velocity");
            return self.all;
        }
        if scenario.bus.is_some() {
            let text = "power state of the drive (CiA 402)";
            output("drive.state", Kind::Enumeration(Choice::DriveState), "", Output::DriveState, text);
            output("drive.fault", Kind::Integer, "", Output::DriveFault, "error code of the drive (603Fh), 0 for none");
            output("faults", Kind::Text, "", Output::Faults, "faults of drive and link in words; empty without one");
        }
        if scenario.plc.is_some() {
            let text = "state of the axis (PLCopen)";
            output("axis.state", Kind::Enumeration(Choice::AxisState), "", Output::AxisState, text);
        }
        self.all
    }

    fn start(&mut self, value: f64) {
        self.all.last_mut().into_iter().for_each(|last| last.start = value);
    }

    fn least(&mut self, least: Least) {
        self.all.last_mut().into_iter().for_each(|last| last.least = least);
    }
}
