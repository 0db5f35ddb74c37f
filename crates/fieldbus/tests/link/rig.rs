//! A motion task, a link and an ideal drive, tick by tick.
use core::cmp::Ordering;
use servobench_base::{Rate, Setpoint, Tick};
use servobench_cia402::counter::Counter;
use servobench_cia402::{
    Actuals, Commands, ControlBit, DriveFunction, Mode, PowerInputs, PowerMemory, PowerParams, StatusBit,
    step as step_power,
};
use servobench_fieldbus::link::{self, Control, Input, Mailbox, Params, Sequencing, Settings, State, Units};
use servobench_fieldbus::{AxisCommand, AxisFeedback, Task};
use servobench_motion::Limits;
use servobench_motion::interpolate::{self, Sample};

/// Base ticks per bus cycle: 1 ms at 16 kHz.
pub(crate) const BUS: u64 = 16;
/// Base ticks per cycle of the motion task: 20 ms.
pub(crate) const MOTION: u64 = 320;
/// Base rate (Hz).
pub(crate) const RATE: f64 = 16e3;

const fn hz(hz: u32) -> Rate {
    Rate::new(hz).unwrap()
}

/// A linear axis of 1 µm per count.
pub(crate) fn settings() -> Settings {
    Settings {
        base_rate: hz(16_000),
        bus_cycle: hz(16_000).divider(hz(1_000)).unwrap(),
        motion_cycle: hz(16_000).divider(hz(50)).unwrap(),
        interpolation: interpolate::Mode::Quintic,
        margin: 0,
        run_ahead: 0,
        control: Control::Position { velocity_offset: true, torque_offset: true },
        sequencing: Sequencing::Strict,
        drive_timeout: 1_600,
        round_trip: 2,
        answer_age: 0,
        reverse_switches: false,
        units: Units {
            drive_units: 1e6,
            axis_units: 1.0,
            velocity_factor: 1.0,
            rated_effort: 10.0,
            counter: Counter::signed(32).unwrap(),
        },
        velocity_from_differences: false,
        recovery: Limits { velocity: 0.5, acceleration: 5.0, jerk: 200.0, snap: 0.0 },
        velocity_limit: 4.0,
    }
}

/// An ideal drive: it is at its target one cycle later.
#[derive(Debug, Clone, Copy)]
#[expect(clippy::struct_excessive_bools, reason = "each is a separate signal")]
pub(crate) struct Drive {
    pub(crate) power: PowerParams,
    pub(crate) memory: PowerMemory,
    pub(crate) counter: Counter,
    pub(crate) fault: bool,
    /// True if the drive ignores the controlword.
    pub(crate) deaf: bool,
    /// True if the axis does not come to rest when it is braked.
    pub(crate) rolls: bool,
    /// Counts by which an undriven axis moves in a cycle.
    pub(crate) coasts: i128,
    /// Torque that its loops need while it follows positions.
    pub(crate) holding_torque: i16,
    /// Counts since the start, wraps included.
    pub(crate) counts: i128,
    /// Cycles since the start of homing, which takes `HOMING` and moves by 37 counts in each.
    pub(crate) homing: u32,
    /// True if bit 4 was set.
    pub(crate) asked: bool,
    pub(crate) actuals: Actuals,
}

/// Cycles of homing.
pub(crate) const HOMING: u32 = 50;

impl Drive {
    pub(crate) fn new(counter: Counter) -> Self {
        let (power, memory) = (PowerParams::default(), PowerMemory::default());
        let (homing, asked, actuals) = (0, false, Actuals::default());
        Self {
            power,
            memory,
            counter,
            fault: false,
            deaf: false,
            rolls: false,
            coasts: 0,
            holding_torque: 0,
            counts: 0,
            homing,
            asked,
            actuals,
        }
    }

    pub(crate) fn step(&mut self, commands: &Commands) -> Actuals {
        let inputs = PowerInputs {
            initialised: true,
            fault: self.fault,
            standstill: !self.rolls,
            remote: !self.deaf,
            main_voltage: true,
            ..PowerInputs::default()
        };
        let outputs = step_power(&self.power, &mut self.memory, commands.controlword, inputs);
        let before = self.counts;
        let (mut bit_10, mut bit_12, mut torque) = (true, false, 0);
        if outputs.drive != DriveFunction::Follow {
            self.counts += self.coasts;
        }
        if outputs.drive == DriveFunction::Follow {
            match Mode::from_code(commands.mode) {
                Some(Mode::CyclicSynchronousPosition) => {
                    // The nearest position with this reading of the counter.
                    let range = self.counter.range();
                    let shown = [commands.target_position, commands.target_position_high];
                    let way = (self.counter.reading_of(shown) - self.counts).rem_euclid(range);
                    self.counts += if way >= range / 2 { way - range } else { way };
                    torque = self.holding_torque;
                }
                Some(Mode::CyclicSynchronousVelocity) => self.counts += i128::from(commands.target_velocity / 1000),
                Some(Mode::CyclicSynchronousTorque) => torque = commands.target_torque,
                Some(Mode::Homing) => (bit_10, bit_12) = self.home(commands),
                _ => {}
            }
        }
        let mode = if self.deaf { self.actuals.mode } else { commands.mode };
        let [position, position_high] = self.counter.words(self.counts);
        self.actuals = Actuals {
            statusword: outputs
                .statusword
                .with(StatusBit::ModeSpecific12, bit_12)
                .with(StatusBit::TargetReached, bit_10),
            mode,
            position,
            position_high,
            position_demand: position,
            position_demand_high: position_high,
            velocity: i32::try_from((self.counts - before) * 1000).unwrap_or(i32::MAX),
            torque,
            error_code: if self.fault { 0x7121 } else { self.actuals.error_code },
            ..self.actuals
        };
        self.actuals
    }

    /// Bits 10 and 12 of the statusword. An earlier result is shown until bit 4 rises.
    fn home(&mut self, commands: &Commands) -> (bool, bool) {
        let asked = commands.controlword.has(ControlBit::ModeSpecific4);
        if asked && !self.asked {
            self.homing = 0;
        }
        self.asked = asked;
        if asked {
            self.homing += 1;
            match self.homing.cmp(&HOMING) {
                Ordering::Less => self.counts += 37,
                Ordering::Equal => self.counts = commands.home_offset.into(),
                Ordering::Greater => {}
            }
        }
        (!asked || self.homing >= HOMING, self.homing >= HOMING)
    }
}

/// Motion task, link and drive.
pub(crate) struct Rig {
    pub(crate) params: Params,
    pub(crate) state: State,
    pub(crate) mailbox: Mailbox,
    pub(crate) drive: Drive,
    pub(crate) tick: u64,
    pub(crate) commands: Commands,
    /// Answer of the drive in the last cycle.
    pub(crate) answer: Option<Actuals>,
    pub(crate) external_fault: bool,
}

impl Rig {
    pub(crate) fn new(settings: Settings) -> Self {
        Self {
            params: Params::new(settings).unwrap(),
            state: State::default(),
            mailbox: Mailbox::default(),
            drive: Drive::new(settings.units.counter),
            tick: 0,
            commands: Commands::default(),
            answer: None,
            external_fault: false,
        }
    }

    /// Writes the command of the motion task's cycle that is due at `due`.
    pub(crate) fn write(&mut self, due: u64, command: AxisCommand) {
        self.mailbox.write(Tick(due), command);
    }

    /// Runs a cycle of the bus. The drive answers in the next one.
    pub(crate) fn cycle(&mut self) -> Commands {
        let input = Input {
            tick: Tick(self.tick),
            mailbox: &self.mailbox,
            actuals: self.answer.take(),
            external_fault: self.external_fault,
        };
        self.commands = link::step(&self.params, &mut self.state, input);
        self.answer = Some(self.drive.step(&self.commands));
        self.tick += BUS;
        self.commands
    }

    /// Runs cycles of the motion task whose commands come in time.
    pub(crate) fn run(&mut self, cycles: u64, command: impl Fn(u64) -> AxisCommand) {
        for _ in 0..cycles * MOTION / BUS {
            if self.tick.is_multiple_of(MOTION) {
                self.write(self.tick, command(self.tick / MOTION));
            }
            self.cycle();
        }
    }

    pub(crate) fn feedback(&self) -> AxisFeedback {
        self.state.feedback(&self.params)
    }

    /// The set-point of the last cycle.
    pub(crate) fn setpoint(&self) -> Setpoint {
        self.state.setpoint(&self.params, Tick(self.tick - BUS))
    }
}

/// Powered, following a sample.
pub(crate) fn follow(sample: Sample) -> AxisCommand {
    AxisCommand::of(Task::Follow(sample))
}

/// A sample of a set-point.
pub(crate) fn sample(setpoint: Setpoint) -> Sample {
    Sample { x: setpoint.x, v: setpoint.v, a: setpoint.a, torque: 0.5 * setpoint.a }
}
