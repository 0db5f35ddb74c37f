//! An FMU as the mechanics of an axis.
//!
//! ```text
//! tick   k·n                  k·n+1 …                (k+1)·n
//! FMU    exchange, state ─────────────────────────── step of n ticks with the mean of the efforts, exchange
//! bodies as exchanged         as extrapolated        as exchanged
//! ```
//! With n = 1 nothing is extrapolated, and the effort of a tick is held over it, as for a built-in engine. With n > 1 the impulse of the
//! efforts is kept, and the axis sees the FMU as it was up to n ticks ago: a mean delay of n/2 ticks.
use crate::motion::Motion;
use servobench_base::Stateful;
use servobench_base::state::{Reader, Writer};
use servobench_fmi::{LogLine, Severity, Slave, SlaveError, StepEnd};
use servobench_plant::{
    Actuation, BodyState, EngineName, FmuModel, Input, LogMessage, Mechanics, MechanicsError, check_states,
};
use std::sync::atomic::{AtomicU64, Ordering};

/// The engine.
pub(crate) const NAME: EngineName = EngineName::Fmu;
/// Part of a step that is omitted at its end: the rounding of a time in seconds.
const ROUNDING: f64 = 1e-9;
/// Greatest number of consecutive early returns without progress.
const MOST_STALLS: u32 = 100;
/// Greatest number of early returns in one step.
const MOST_PARTS: u32 = 10_000;
/// Last lines of its log that an error message includes.
const LINES: usize = 5;

/// An FMU as the mechanics of an axis.
pub struct FmuMechanics {
    /// In SI units.
    slave: Box<dyn Slave>,
    /// Log lines not yet taken.
    said: Vec<LogLine>,
    model: FmuModel,
    /// Length of a base tick (s).
    tick: f64,
    state: State,
    /// Number of the state that the slave has saved, if any; unique in this process.
    saved: Option<u64>,
    inputs: Vec<[f64; 3]>,
    outputs: Vec<f64>,
}

/// Number of states saved by FMUs of this process.
static SAVED: AtomicU64 = AtomicU64::new(0);

/// The state at a tick, without that of the FMU.
#[derive(Debug, Clone, Default, Stateful)]
struct State {
    /// Ticks since the last exchange.
    since: u32,
    /// Exchanges so far.
    exchanges: u64,
    /// Sums of the inputs since the last exchange.
    #[state(fixed)]
    sums: Vec<f64>,
    #[state(fixed)]
    motions: Vec<Motion>,
    #[state(fixed)]
    bodies: Vec<BodyState>,
    /// Time when it wanted the simulation to end (s): at the end of the last step, so that only a further step is an error.
    ended: Option<f64>,
}

impl FmuMechanics {
    /// The mechanics at tick 0 of a slave with the inputs and outputs of `model`, in SI units; `tick` (s) is the length of a
    /// base tick.
    ///
    /// # Errors
    /// [`MechanicsError`] if its outputs cannot be read.
    pub fn new(slave: Box<dyn Slave>, model: &FmuModel, tick: f64) -> Result<Self, MechanicsError> {
        let period = f64::from(model.ticks) * tick;
        let motion = Motion::new(period);
        let (inputs, bodies) = (model.inputs().count(), model.bodies().count());
        let mut mechanics = Self {
            slave,
            said: Vec::new(),
            model: model.clone(),
            tick,
            state: State {
                since: 0,
                exchanges: 0,
                sums: vec![0.0; inputs],
                motions: vec![motion; bodies],
                bodies: vec![BodyState::default(); bodies],
                ended: None,
            },
            saved: None,
            inputs: vec![[0.0; 3]; inputs],
            outputs: vec![0.0; model.outputs().count()],
        };
        mechanics.read()?;
        mechanics.go_on();
        Ok(mechanics)
    }

    /// The error, with the FMU's log messages on it.
    fn wrong(&mut self, error: &SlaveError) -> MechanicsError {
        let mut message = error.to_string();
        self.said.extend(self.slave.take_log());
        let warnings = self.said.iter().filter(|line| line.severity > Severity::Info).map(|line| &line.message);
        // Some errors contain the last message already.
        let said: Vec<_> = warnings.filter(|said| !message.contains(said.as_str())).map(String::as_str).collect();
        if !said.is_empty() {
            message = format!("{message}; it said: {}", said[said.len().saturating_sub(LINES)..].join(" / "));
        }
        native(message)
    }

    /// Adds the efforts of this tick to the sums.
    fn add(&mut self, effort: f64, input: &Input) -> Result<(), MechanicsError> {
        let (mut effort, single) = (effort, self.state.bodies.len() == 1);
        if self.model.motor_disturbance.is_none() {
            effort += input.motor_disturbance;
        }
        if self.model.load_disturbance.is_none() {
            if single {
                effort += self.model.transmission * input.load_disturbance;
            } else if input.load_disturbance != 0.0 {
                return Err(MechanicsError::Unsupported {
                    engine: NAME,
                    what: "a disturbance of the load without an input of the FMU for it".into(),
                    help: "name that input with `load_disturbance`".into(),
                });
            }
        }
        let disturbances = [
            self.model.motor_disturbance.as_ref().map(|_| input.motor_disturbance),
            self.model.load_disturbance.as_ref().map(|_| input.load_disturbance),
        ];
        let all = std::iter::once(effort).chain(disturbances.into_iter().flatten());
        self.state.sums.iter_mut().zip(all).for_each(|(sum, value)| *sum += value);
        Ok(())
    }

    /// A step of the FMU over all ticks since the last exchange.
    fn step(&mut self) -> Result<(), MechanicsError> {
        let count = f64::from(self.model.ticks);
        for (input, sum) in self.inputs.iter_mut().zip(&mut self.state.sums) {
            *input = [*sum / count, 0.0, 0.0];
            *sum = 0.0;
        }
        let at = |exchanges: u64| exchanges as f64 * count * self.tick;
        let (mut time, end) = (at(self.state.exchanges), at(self.state.exchanges + 1));
        self.state.exchanges += 1;
        let mut length = count * self.tick;
        let (rounding, mut stalls) = (ROUNDING * length, 0);
        if let Some(ended) = self.state.ended {
            return Err(native(format!("the FMU wants the simulation to end at {ended} s")));
        }
        for _ in 0..MOST_PARTS {
            match self.slave.step(time, length, &self.inputs).map_err(|error| self.wrong(&error))? {
                StepEnd::Done => return self.read(),
                // An event at the very start counts too, but not for ever.
                StepEnd::Until(reached) if reached >= time && stalls < MOST_STALLS && reached < end - rounding => {
                    stalls = if reached > time { 0 } else { stalls + 1 };
                    time = reached;
                    length = end - reached;
                }
                StepEnd::Until(reached) if (reached - end).abs() <= rounding => return self.read(),
                StepEnd::Until(reached) => {
                    return Err(native(format!("the FMU came back from a step from {time} s at {reached} s")));
                }
                StepEnd::Terminated(reached) if (reached - end).abs() <= rounding => {
                    self.state.ended = Some(reached);
                    return self.read();
                }
                StepEnd::Terminated(reached) => {
                    return Err(native(format!("the FMU wants the simulation to end at {reached} s")));
                }
            }
        }
        Err(native(format!("the FMU came back early {MOST_PARTS} times in a step to {end} s")))
    }

    /// Reads the outputs of the FMU.
    fn read(&mut self) -> Result<(), MechanicsError> {
        self.slave.read(None, &mut self.outputs).map_err(|error| self.wrong(&error))?;
        for (port, value) in self.model.outputs().zip(&self.outputs) {
            if !value.is_finite() {
                return Err(native(format!("the FMU's output `{}` is {value}", port.variable)));
            }
        }
        let mut outputs = self.outputs.iter().copied();
        let mut next = || outputs.next().unwrap_or(f64::NAN);
        for (body, motion) in self.model.bodies().zip(&mut self.state.motions) {
            let position = next();
            motion.exchange(position, body.velocity.as_ref().map(|_| next()));
        }
        Ok(())
    }

    /// Extrapolates the bodies to the present tick.
    fn go_on(&mut self) {
        let t = f64::from(self.state.since) * self.tick;
        self.state.bodies.iter_mut().zip(&self.state.motions).for_each(|(body, motion)| *body = motion.after(t));
    }
}

impl Mechanics for FmuMechanics {
    fn bodies(&self) -> &[BodyState] {
        &self.state.bodies
    }

    fn advance(&mut self, input: &Input) -> Result<(), MechanicsError> {
        let Actuation::Effort(effort) = input.actuation else {
            return Err(MechanicsError::wrong_actuation(NAME));
        };
        input.check(NAME)?;
        self.add(effort, input)?;
        self.state.since += 1;
        if self.state.since == self.model.ticks {
            self.state.since = 0;
            self.step()?;
        }
        self.go_on();
        check_states(NAME, self.state.bodies.iter().copied())
    }

    fn saves(&mut self) -> bool {
        self.slave.capabilities().saves_state
    }

    /// The slave keeps only its last saved state; the data written here hold its number.
    fn save(&mut self, to: &mut dyn Writer) -> Result<(), MechanicsError> {
        self.saved = None;
        self.slave.save().map_err(|error| self.wrong(&error))?;
        let number = SAVED.fetch_add(1, Ordering::Relaxed);
        self.saved = Some(number);
        to.word(number);
        self.state.save(to);
        Ok(())
    }

    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), MechanicsError> {
        if self.saved != Some(from.word()?) {
            return Err(MechanicsError::Superseded { engine: NAME });
        }
        self.state.restore(from)?;
        self.slave.restore().map_err(|error| self.wrong(&error))
    }

    fn end(&mut self) {
        self.slave.end();
        // Its final messages are taken whatever the tick.
        let lines = self.slave.take_log();
        self.said.extend(lines);
    }

    /// The FMU logs only when it is called: between two exchanges there is nothing to take.
    fn take_log(&mut self) -> Vec<LogMessage> {
        let mut lines = std::mem::take(&mut self.said);
        if self.state.since == 0 {
            lines.extend(self.slave.take_log());
        }
        let said = |line: LogLine| LogMessage { time: line.time, severity: line.severity, text: line.words() };
        lines.into_iter().map(said).collect()
    }
}

fn native(message: String) -> MechanicsError {
    MechanicsError::Native { engine: NAME, message }
}
