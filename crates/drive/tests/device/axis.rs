//! A drive with an ideal axis, which follows every demand exactly, and a master that holds its frame.
use servobench_base::Setpoint;
use servobench_cia402::{Actuals, Command, Commands, ControlBit, Controlword, Mode, StatusBit};
use servobench_drive::Demand;
use servobench_drive::device::{self, Inputs, Measured, Outputs, Params, State};

/// Drive, axis and the frame that the master holds.
pub(crate) struct Axis {
    pub(crate) params: Params,
    pub(crate) state: State,
    pub(crate) frame: Commands,
    pub(crate) measured: Measured,
    pub(crate) fault: Option<u16>,
    pub(crate) main_voltage: bool,
    /// Position of the axis (m).
    pub(crate) position: f64,
    pub(crate) velocity: f64,
    pub(crate) last: Demand,
}

impl Axis {
    pub(crate) fn new(params: &Params) -> Self {
        let state = State::new(params).unwrap();
        Self {
            params: *params,
            state,
            frame: Commands::default(),
            measured: Measured::default(),
            fault: None,
            main_voltage: true,
            position: 0.0,
            velocity: 0.0,
            last: Demand::Off,
        }
    }

    /// Runs one period, with or without a frame; the axis has then followed the demand.
    pub(crate) fn step(&mut self, with_frame: bool) -> Outputs {
        self.measured.increments = self.params.units.increments(self.position);
        self.measured.velocity = self.velocity;
        let frame = with_frame.then_some(&self.frame);
        let inputs = Inputs { frame, measured: self.measured, fault: self.fault, main_voltage: self.main_voltage };
        let outputs = device::step(&self.params, &mut self.state, &inputs);
        self.last = outputs.demand;
        match outputs.demand {
            Demand::Position { setpoint, .. } => {
                let next = setpoint.after(self.params.period);
                (self.position, self.velocity) = (next.x, next.v);
            }
            Demand::Velocity { setpoint, .. } => {
                self.position += self.params.period * (setpoint.v + 0.5 * self.params.period * setpoint.a);
                self.velocity = setpoint.v + self.params.period * setpoint.a;
            }
            Demand::Effort(_) | Demand::Off => self.position += self.params.period * self.velocity,
        }
        outputs
    }

    /// A cycle: a frame, then the steps until the next one.
    pub(crate) fn cycle(&mut self) -> Vec<Outputs> {
        (0..self.params.cycle.steps).map(|k| self.step(k == 0)).collect()
    }

    pub(crate) fn cycles(&mut self, count: u32) {
        for _ in 0..count {
            self.cycle();
        }
    }

    pub(crate) fn command(&mut self, command: Command) {
        self.frame.controlword = Controlword::of(command);
    }

    /// The sequence that leads to Operation enabled, in a mode.
    pub(crate) fn enabled(params: &Params, mode: Mode) -> Self {
        let mut axis = Self::new(params);
        axis.enable(mode);
        axis
    }

    pub(crate) fn enable(&mut self, mode: Mode) {
        self.frame.mode = mode.code();
        for command in [Command::DisableVoltage, Command::Shutdown, Command::SwitchOn, Command::EnableOperation] {
            self.command(command);
            self.frame.target_position = self.actuals().position;
            self.cycle();
        }
    }

    pub(crate) fn set(&mut self, bit: ControlBit, set: bool) {
        self.frame.controlword = self.frame.controlword.with(bit, set);
    }

    /// Clears bit 4, then sets it with `target`; true if the set-point was acknowledged at once.
    pub(crate) fn give(&mut self, target: i32) -> bool {
        self.set(ControlBit::ModeSpecific4, false);
        self.step(true);
        let was_free = !self.has(StatusBit::ModeSpecific12);
        self.frame.target_position = target;
        self.set(ControlBit::ModeSpecific4, true);
        self.step(true);
        was_free && self.has(StatusBit::ModeSpecific12)
    }

    /// Steps until the target is reached.
    pub(crate) fn settle(&mut self) -> u32 {
        (1..100_000)
            .find(|_| {
                self.step(true);
                self.has(StatusBit::TargetReached)
            })
            .unwrap()
    }

    pub(crate) fn actuals(&self) -> Actuals {
        self.state.actuals(&self.params)
    }

    pub(crate) fn has(&self, bit: StatusBit) -> bool {
        self.actuals().statusword.has(bit)
    }
}

/// The set-point that a demand follows.
pub(crate) fn setpoint(demand: &Demand) -> Setpoint {
    match demand {
        Demand::Position { setpoint, .. } | Demand::Velocity { setpoint, .. } => *setpoint,
        Demand::Effort(_) | Demand::Off => panic!("{demand:?} follows no set-point"),
    }
}
