//! Runs programs of function blocks on an axis that follows its set-points, and prints every edge of every output, to compare another
//! implementation of the blocks with this one, cycle by cycle.
//!
//! Programs are read from standard input:
//!
//! ```text
//! program CYCLES on|off                  on a new axis, powered at Standstill or Disabled; a cycle takes 1 s
//! limits VELOCITY ACCELERATION JERK      of the axis
//! block NAME BLOCK                       an instance; they are called in this order
//! CYCLE NAME KEY VALUE                   an input of an instance from this cycle on
//! CYCLE axis KEY VALUE                   what happens to the drive: input.N, fault, warning, power
//! end
//! ```
//!
//! Lines with a cycle are in the order of time. Keys are those of programs (`Input::key`), beside `execute` and `enable`; a table is
//! `TIME:VALUE,TIME:VALUE`. The answer to a program is `outputs NAME OUTPUT …` for each instance, `CYCLE NAME OUTPUT VALUE` for
//! each output that changes, where all are 0 before, and `end`.
use servobench_config::Choice as _;
use servobench_fieldbus::{
    AxisCommand, AxisFeedback, Fault, Homing, Power, ProbeFeedback, ProbeTrigger, Switches, Task, TouchProbe,
};
use servobench_motion::Limits;
use servobench_motion::pvt::Knot;
use servobench_plcopen as plc;
use servobench_plcopen::program::{Inputs, Rows};
use servobench_plcopen::{
    Axis, AxisParams, BlockInputs as _, BlockName, BufferMode, Direction, FunctionBlock, Input, InputType,
    Outputs as _, Pair, Value,
};
use std::error::Error;
use std::io::{self, BufWriter, Write};

type Failure = Box<dyn Error>;

/// Rows of a table at most.
const ROWS: usize = 16;
/// The bits of the digital inputs that are switches (60FDh).
const NEGATIVE: u32 = 0;
const POSITIVE: u32 = 1;
const HOME: u32 = 2;
/// The bit that stands for the index pulse.
const INDEX: u32 = 3;

fn main() -> Result<(), Failure> {
    let mut out = BufWriter::new(io::stdout().lock());
    let mut program = None;
    for (number, line) in io::stdin().lines().enumerate() {
        let line = line?;
        read(&line, &mut program, &mut out).map_err(|error| format!("line {}, `{line}`: {error}", number + 1))?;
    }
    Ok(out.flush()?)
}

/// Takes a line of a program, and runs it at its end.
fn read(line: &str, program: &mut Option<Program>, out: &mut impl Write) -> Result<(), Failure> {
    let words: Vec<&str> = line.split_whitespace().collect();
    match (words.as_slice(), program) {
        (["program", cycles, power], program) => {
            *program = Some(Program::new(cycles.parse()?, *power == "on"));
        }
        (["limits", limits @ ..], Some(program)) => {
            let limits: Vec<f64> = limits.iter().map(|word| word.parse()).collect::<Result<_, _>>()?;
            let [velocity, acceleration, jerk] = *limits else { return Err("there are three limits".into()) };
            program.limits = Limits { velocity, acceleration, jerk, snap: f64::INFINITY };
        }
        (["block", name, block], Some(program)) => {
            let block = BlockName::from_name(block).ok_or("there is no such block")?;
            program.instances.push(Instance::new(name, block)?);
        }
        (["end"], program) => program.take().ok_or("no program has begun")?.run(out)?,
        ([cycle, name, key, value], Some(program)) => {
            let [name, key, value] = [name, key, value].map(|word| (*word).to_owned());
            program.events.push(Event { cycle: cycle.parse()?, name, key, value });
        }
        _ => return Err("it is no line of a program".into()),
    }
    Ok(())
}

/// A program and its axis.
struct Program {
    cycles: u32,
    is_powered: bool,
    limits: Limits,
    instances: Vec<Instance>,
    events: Vec<Event>,
}

/// A change before the calls of a cycle.
struct Event {
    cycle: u32,
    name: String,
    key: String,
    value: String,
}

impl Program {
    fn new(cycles: u32, is_powered: bool) -> Self {
        let limits = Limits { velocity: 10.0, acceleration: 10.0, jerk: 10.0, snap: f64::INFINITY };
        Self { cycles, is_powered, limits, instances: Vec::new(), events: Vec::new() }
    }

    fn run(mut self, out: &mut impl Write) -> Result<(), Failure> {
        let params = AxisParams { needs_homing: false, buffered_commands: 8, ..AxisParams::new(1.0, self.limits) };
        let (mut axis, mut drive) = (Axis::new(params)?, Drive::default());
        for _ in 0..if self.is_powered { 3 } else { 0 } {
            axis.begin(&drive.feedback);
            let enabled = plc::PowerInputs { enable: true, enable_positive: true, enable_negative: true };
            plc::Power.step(&mut axis, &enabled);
            drive.follow(&axis.end());
        }
        for instance in &self.instances {
            let names: Vec<&str> = instance.block.outputs().iter().map(|output| output.name()).collect();
            writeln!(out, "outputs {} {}", instance.name, names.join(" "))?;
        }
        let mut events = self.events.iter().peekable();
        for cycle in 0..self.cycles {
            while let Some(event) = events.next_if(|event| event.cycle <= cycle) {
                if event.name == "axis" {
                    drive.set(&event.key, &event.value)?;
                } else {
                    let mut named = self.instances.iter_mut().filter(|instance| instance.name == event.name);
                    named.next().ok_or("there is no such instance")?.set(&event.key, &event.value)?;
                }
            }
            drive.watch();
            axis.begin(&drive.feedback);
            for instance in &mut self.instances {
                instance.step(cycle, &mut axis, out)?;
            }
            drive.follow(&axis.end());
        }
        if events.next().is_some() {
            return Err("an event is after the end, or not in the order of time".into());
        }
        Ok(writeln!(out, "end")?)
    }
}

/// An instance of a block with its inputs, and its outputs in the cycle before.
struct Instance {
    name: String,
    block: BlockName,
    called: Box<dyn Called>,
    trigger: bool,
    inputs: Inputs,
    told: Vec<f64>,
}

impl Instance {
    fn new(name: &str, block: BlockName) -> Result<Self, Failure> {
        let told = vec![0.0; block.outputs().len()];
        Ok(Self { name: name.to_owned(), block, called: made(block)?, trigger: false, inputs: Inputs::default(), told })
    }

    fn set(&mut self, key: &str, value: &str) -> Result<(), Failure> {
        if key == self.block.trigger().name().to_lowercase() {
            self.trigger = value.parse()?;
            return Ok(());
        }
        let input = Input::ALL.iter().copied().find(|input| input.key() == key && self.block.input(*input).is_some());
        let input = input.ok_or_else(|| format!("{} has no such input", self.block))?;
        let value = match input.value_type() {
            InputType::Quantity(_) | InputType::Whole(..) | InputType::ParameterValue => Value::Number(value.parse()?),
            InputType::Flag => Value::Flag(value.parse()?),
            InputType::Direction => Value::Direction(Direction::from_name(value).ok_or("no direction")?),
            InputType::BufferMode => Value::BufferMode(BufferMode::from_name(value).ok_or("no buffer mode")?),
            InputType::Table => {
                let (is_relative, follow) = (false, plc::Follow::Spline);
                Value::Table(Rows::Profile(plc::Table { pairs: rows(value)?, is_relative, follow }))
            }
            InputType::Switches | InputType::Tracks => return Err("cams are not compared".into()),
            InputType::Choice(names) => {
                Value::Choice(names.iter().find(|(name, _)| *name == value).ok_or("no such alternative")?.0)
            }
        };
        self.inputs.set(input, value);
        Ok(())
    }

    /// Calls the block, and prints what has changed.
    fn step(&mut self, cycle: u32, axis: &mut Axis, out: &mut impl Write) -> io::Result<()> {
        let values = self.called.call(axis, &self.inputs, self.trigger);
        for ((output, before), value) in self.block.outputs().iter().zip(&mut self.told).zip(values) {
            if before.to_bits() != value.to_bits() {
                *before = value;
                writeln!(out, "{cycle} {} {} {value:e}", self.name, output.name())?;
            }
        }
        Ok(())
    }
}

/// `TIME:VALUE,TIME:VALUE`, times from row to row.
fn rows(words: &str) -> Result<Vec<Pair>, Failure> {
    let row = |word: &str| -> Result<Pair, Failure> {
        let (delta_time, value) = word.split_once(':').ok_or("a row is TIME:VALUE")?;
        Ok(Pair { delta_time: delta_time.parse()?, value: value.parse()? })
    };
    words.split(',').map(row).collect()
}

/// A block of any type.
trait Called {
    fn call(&mut self, axis: &mut Axis, inputs: &Inputs, trigger: bool) -> Vec<f64>;
}

impl<B: FunctionBlock> Called for B {
    fn call(&mut self, axis: &mut Axis, inputs: &Inputs, trigger: bool) -> Vec<f64> {
        let mut values = Vec::new();
        self.step(axis, &B::Inputs::read(inputs, trigger)).each(|value| values.push(value));
        values
    }
}

/// Makes blocks by their names: those without memory for a table, and those with it. Others are not blocks of the standard.
macro_rules! made {
    ($($block:ident)+; $($with_table:ident: $memory:expr,)+) => {
        fn made(block: BlockName) -> Result<Box<dyn Called>, Failure> {
            Ok(match block {
                $(BlockName::$block => Box::new(plc::$block::default()),)+
                $(BlockName::$with_table => Box::new($memory),)+
                other => return Err(format!("{other} is not compared").into()),
            })
        }
    };
}

made! {
    Power Home HomeDirect HomeAbsolute Stop Halt Reset MoveAbsolute MoveRelative MoveAdditive MoveSuperimposed
    HaltSuperimposed MoveVelocity MoveContinuousAbsolute MoveContinuousRelative SetPosition SetOverride TorqueControl
    ReadStatus ReadMotionState ReadAxisInfo ReadDigitalInput ReadDigitalOutput WriteDigitalOutput TouchProbe
    AbortTrigger ReadParameter ReadBoolParameter WriteParameter WriteBoolParameter ReadAxisError ReadActualPosition
    ReadActualVelocity ReadActualTorque Profile4th;
    PositionProfile: plc::PositionProfile::new([Knot::default(); ROWS], [0.0; ROWS]),
    VelocityProfile: plc::VelocityProfile::new([Pair::default(); ROWS]),
    AccelerationProfile: plc::AccelerationProfile::new([Pair::default(); ROWS]),
}

/// An ideal drive: the command of one cycle is the feedback of the next.
#[derive(Default)]
struct Drive {
    feedback: AxisFeedback,
    command: Option<AxisCommand>,
    /// True if there is no power to switch on.
    has_no_power: bool,
    /// Its digital inputs in the cycle before.
    inputs_before: u32,
    /// The touch probe that is armed.
    armed: Option<TouchProbe>,
}

impl Drive {
    /// Applies an event to the drive.
    fn set(&mut self, key: &str, value: &str) -> Result<(), Failure> {
        if let Some(bit) = key.strip_prefix("input.") {
            let bit: u32 = bit.parse()?;
            let level: bool = value.parse()?;
            self.feedback.digital_inputs = self.feedback.digital_inputs & !(1 << bit) | u32::from(level) << bit;
            return Ok(());
        }
        match key {
            "fault" => self.feedback.fault = value.parse::<bool>()?.then_some(Fault::Drive(0x2310)),
            "warning" => self.feedback.has_warning = value.parse()?,
            "power" => {
                self.has_no_power = !value.parse::<bool>()?;
                self.switch();
            }
            _ => return Err("the drive has no such thing".into()),
        }
        Ok(())
    }

    /// Evaluates the changes of the inputs since the cycle before.
    fn watch(&mut self) {
        let (now, before) = (self.feedback.digital_inputs, self.inputs_before);
        let is = |levels: u32, bit: u32| levels >> bit & 1 == 1;
        self.feedback.switches =
            Switches { negative_limit: is(now, NEGATIVE), home: is(now, HOME), positive_limit: is(now, POSITIVE) };
        let has_come = self.armed.is_some_and(|probe| match probe.trigger {
            ProbeTrigger::HomeSwitchMet => is(now, HOME) && !is(before, HOME),
            ProbeTrigger::HomeSwitchLeft => !is(now, HOME) && is(before, HOME),
            ProbeTrigger::IndexPulse => is(now, INDEX) && !is(before, INDEX),
        });
        if has_come && self.feedback.touch_probe.position.is_none() {
            self.feedback.touch_probe.position = Some(self.feedback.position);
        }
        self.inputs_before = now;
    }

    fn follow(&mut self, command: &AxisCommand) {
        let resets = command.reset && self.command.is_some_and(|before| !before.reset);
        if resets {
            self.feedback.fault = None;
        }
        // Without mass and friction it takes no effort to move.
        (self.feedback.homing, self.feedback.effort) = (Homing::Idle, 0.0);
        match command.task {
            Task::Follow(sample) => (self.feedback.position, self.feedback.velocity) = (sample.x, sample.v),
            Task::Home { position } => {
                (self.feedback.position, self.feedback.homing) = (position, Homing::Attained);
            }
            Task::Effort(effort) => self.feedback.effort = effort,
            Task::Drive(_) => unreachable!("no block leaves its way to the drive"),
        }
        if command.touch_probe != self.armed {
            self.armed = command.touch_probe;
            self.feedback.touch_probe =
                ProbeFeedback { number: self.armed.map_or(0, |probe| probe.number), position: None };
        }
        self.command = Some(*command);
        self.switch();
    }

    /// Switches the power as commanded.
    fn switch(&mut self) {
        let is_on = self.command.is_some_and(|command| command.power) && !self.has_no_power;
        self.feedback.power = if is_on && self.feedback.fault.is_none() { Power::On } else { Power::Off };
    }
}
