//! An FMU as the mechanics of an axis.
//!
//! ```text
//! tick   k·n                  k·n+1 …                (k+1)·n
//! FMU    exchange, state ─────────────────────────── step of n ticks with the mean of the efforts, exchange
//! bodies as exchanged         as they would go on    as exchanged
//! ```
//! With n = 1 nothing is extrapolated, and the effort of a tick is held over it: what an engine of our own gets. With n > 1 the
//! impulse of the efforts is kept, and the axis sees of the FMU what was so up to n ticks ago: a delay of n/2 ticks in the mean.
use crate::motion::Motion;
use crate::ports::MechanicsPorts;
use servobench_fmi::{LogLine, Progress, Severity, Slave, SlaveError};
use servobench_plant::{Actuation, BodyState, FmuModel, Input, Mechanics, MechanicsError};

/// Name of the engine.
pub(crate) const NAME: &str = "fmu";
/// Times that an FMU may return early in one step.
const MOST_PARTS: u32 = 10_000;
/// Lines of its log in the message of what went wrong: the last ones.
const LINES: usize = 5;

/// The mechanics that an FMU is.
pub struct FmuMechanics {
    slave: Box<dyn Slave>,
    ports: MechanicsPorts,
    /// Axis coordinate per motor coordinate.
    transmission: f64,
    /// Length of a base tick (s).
    tick: f64,
    /// Ticks between two exchanges.
    ticks: u32,
    /// Ticks since the last exchange.
    since: u32,
    /// Exchanges up to now.
    exchanges: u64,
    /// Sums of the SI inputs since the last exchange, then their means in the FMU's units.
    sums: Vec<f64>,
    inputs: Vec<[f64; 3]>,
    outputs: Vec<f64>,
    motions: Vec<Motion>,
    bodies: Vec<BodyState>,
}

impl FmuMechanics {
    /// The mechanics of a slave that was wired with `ports`, at tick 0; `tick` (s) is the length of a base tick.
    ///
    /// # Errors
    /// [`MechanicsError`] if its outputs cannot be read.
    pub fn new(
        slave: Box<dyn Slave>,
        ports: MechanicsPorts,
        model: &FmuModel,
        tick: f64,
    ) -> Result<Self, MechanicsError> {
        let period = f64::from(model.ticks) * tick;
        let motion = Motion::new(model.extrapolation, period);
        let mut mechanics = Self {
            slave,
            transmission: model.transmission,
            tick,
            ticks: model.ticks,
            since: 0,
            exchanges: 0,
            sums: vec![0.0; ports.inputs().count()],
            inputs: vec![[0.0; 3]; ports.inputs().count()],
            outputs: vec![0.0; ports.outputs().count()],
            motions: vec![motion; ports.bodies.len()],
            bodies: vec![BodyState::default(); ports.bodies.len()],
            ports,
        };
        mechanics.read()?;
        mechanics.go_on();
        Ok(mechanics)
    }

    /// What the FMU has said since the last time.
    pub fn take_log(&mut self) -> Vec<LogLine> {
        self.slave.take_log()
    }

    /// What went wrong, with what the FMU said of it.
    fn wrong(&mut self, error: &SlaveError) -> MechanicsError {
        let mut message = error.to_string();
        let log = self.slave.take_log();
        let warnings = log.iter().filter(|line| line.severity > Severity::Info).map(|line| &line.message);
        // The last one is a part of some errors.
        let said: Vec<_> = warnings.filter(|said| !message.contains(said.as_str())).map(String::as_str).collect();
        if !said.is_empty() {
            message = format!("{message}; it said: {}", said[said.len().saturating_sub(LINES)..].join(" / "));
        }
        match error {
            SlaveError::NotFinite { .. } => MechanicsError::Diverged { engine: NAME, message },
            _ => native(message),
        }
    }

    /// Adds what acts in this tick.
    fn add(&mut self, effort: f64, input: &Input) -> Result<(), MechanicsError> {
        let (mut effort, single) = (effort, self.bodies.len() == 1);
        if self.ports.motor_disturbance.is_none() {
            effort += input.motor_disturbance;
        }
        if self.ports.load_disturbance.is_none() {
            if single {
                effort += self.transmission * input.load_disturbance;
            } else if input.load_disturbance != 0.0 {
                return Err(MechanicsError::Unsupported {
                    engine: NAME,
                    what: "a disturbance of the load without an input of the FMU for it".into(),
                    way_out: "name that input with `load_disturbance`".into(),
                });
            }
        }
        let disturbances = [
            self.ports.motor_disturbance.as_ref().map(|_| input.motor_disturbance),
            self.ports.load_disturbance.as_ref().map(|_| input.load_disturbance),
        ];
        let all = std::iter::once(effort).chain(disturbances.into_iter().flatten());
        self.sums.iter_mut().zip(all).for_each(|(sum, value)| *sum += value);
        Ok(())
    }

    /// A step of the FMU over all ticks since the last exchange.
    fn step(&mut self) -> Result<(), MechanicsError> {
        let count = f64::from(self.ticks);
        for ((input, sum), wire) in self.inputs.iter_mut().zip(&mut self.sums).zip(self.ports.input_wires()) {
            *input = [wire.of_si(*sum / count), 0.0, 0.0];
            *sum = 0.0;
        }
        let at = |exchanges: u64| exchanges as f64 * count * self.tick;
        let (mut time, end) = (at(self.exchanges), at(self.exchanges + 1));
        self.exchanges += 1;
        let mut length = count * self.tick;
        for _ in 0..MOST_PARTS {
            match self.slave.step(time, length, &self.inputs).map_err(|error| self.wrong(&error))? {
                Progress::Done => return self.read(),
                Progress::Until(reached) if reached > time && reached < end => {
                    time = reached;
                    length = end - reached;
                }
                Progress::Until(reached) if reached >= end => return self.read(),
                Progress::Until(reached) => {
                    return Err(native(format!("the FMU came back from a step from {time} s at {reached} s")));
                }
                Progress::Terminated(reached) => {
                    return Err(native(format!("the FMU wants the simulation to end at {reached} s")));
                }
            }
        }
        Err(native(format!("the FMU came back early {MOST_PARTS} times in a step to {end} s")))
    }

    /// Takes the outputs of the FMU.
    fn read(&mut self) -> Result<(), MechanicsError> {
        self.slave.read(None, &mut self.outputs).map_err(|error| self.wrong(&error))?;
        let mut outputs = self.outputs.iter().copied();
        for (wires, motion) in self.ports.bodies.iter().zip(&mut self.motions) {
            let mut next = |wire: &crate::ports::Wire| wire.to_si(outputs.next().unwrap_or(f64::NAN));
            let position = next(&wires.position);
            let velocity = wires.velocity.as_ref().map(next);
            for (value, wire) in
                std::iter::once((position, &wires.position)).chain(velocity.zip(wires.velocity.as_ref()))
            {
                if !value.is_finite() {
                    let message = format!("the FMU's output `{}` is {value}", wire.port.variable);
                    return Err(MechanicsError::Diverged { engine: NAME, message });
                }
            }
            motion.exchange(position, velocity);
        }
        Ok(())
    }

    /// The bodies at the present tick.
    fn go_on(&mut self) {
        let t = f64::from(self.since) * self.tick;
        self.bodies.iter_mut().zip(&self.motions).for_each(|(body, motion)| *body = motion.after(t));
    }
}

impl Mechanics for FmuMechanics {
    fn bodies(&self) -> &[BodyState] {
        &self.bodies
    }

    fn advance(&mut self, input: &Input) -> Result<(), MechanicsError> {
        let Actuation::Effort(effort) = input.actuation else {
            return Err(MechanicsError::wrong_actuation(NAME));
        };
        self.add(effort, input)?;
        self.since += 1;
        if self.since == self.ticks {
            self.since = 0;
            self.step()?;
        }
        self.go_on();
        Ok(())
    }
}

fn native(message: String) -> MechanicsError {
    MechanicsError::Native { engine: NAME, message }
}
