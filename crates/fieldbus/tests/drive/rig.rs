//! A motion task, a link, a bus and a drive with an ideal axis, tick by tick.
use servobench_base::{Rate, Setpoint, Tick};
use servobench_cia402::counter::Counter;
use servobench_cia402::{Commands, Controlword};
use servobench_drive::Demand;
use servobench_drive::device::{self, CycleParams, Inputs, Measured};
use servobench_fieldbus::bus::{self, BusFault};
use servobench_fieldbus::link::{self, Control, Input, Mailbox, Params, Sequencing, Settings, Units};
use servobench_fieldbus::{AxisCommand, AxisFeedback};
use servobench_motion::Limits;
use servobench_motion::interpolate::Mode;

/// Base ticks per second, per cycle of the motion task, of the bus, and per step of the drive.
pub(crate) const RATE: u32 = 16_000;
pub(crate) const MOTION: u64 = 320;
pub(crate) const BUS: u64 = 16;
pub(crate) const DRIVE: u64 = 4;
/// Delay of a frame (bus cycles).
pub(crate) const DELAY: u32 = 1;

const fn hz(hz: u32) -> Rate {
    Rate::new(hz).unwrap()
}

fn settings() -> Settings {
    Settings {
        base_rate: hz(RATE),
        bus_cycle: hz(RATE).divider(hz(1_000)).unwrap(),
        motion_cycle: hz(RATE).divider(hz(50)).unwrap(),
        interpolation: Mode::Quintic,
        margin: 0,
        run_ahead: 0,
        control: Control::Position { velocity_offset: true, torque_offset: true },
        sequencing: Sequencing::Strict,
        drive_timeout: 8_000,
        round_trip: 2 * DELAY + 1,
        answer_age: 0,
        reverse_switches: false,
        units: Units {
            drive_units: 1e6,
            axis_units: 1.0,
            velocity_factor: 1.0,
            rated_effort: 1.0,
            counter: Counter::signed(32).unwrap(),
        },
        velocity_from_differences: false,
        recovery: Limits { velocity: 0.5, acceleration: 5.0, jerk: 200.0, snap: 0.0 },
        velocity_limit: 4.0,
    }
}

/// Link, bus, drive and axis.
pub(crate) struct Rig {
    pub(crate) params: Params,
    pub(crate) link: link::State,
    pub(crate) mailbox: Mailbox,
    wire: bus::State,
    pub(crate) faults: Vec<BusFault>,
    pub(crate) drive_params: device::Params,
    pub(crate) drive: device::State,
    pub(crate) measured: Measured,
    pub(crate) fault: Option<u16>,
    frame: Option<Commands>,
    pub(crate) controlword: Controlword,
    /// Set-point of the axis, by the encoder, and the distance of the axis from it.
    pub(crate) axis: Setpoint,
    pub(crate) behind: f64,
    pub(crate) tick: u64,
    /// Largest velocity and acceleration that the drive demanded between its steps.
    pub(crate) peaks: [f64; 2],
}

impl Rig {
    pub(crate) fn new() -> Self {
        let cycle = CycleParams { steps: u32::try_from(BUS / DRIVE).unwrap(), shift: 0, bridged: 3 };
        let drive_params = device::Params { cycle, interpolation: Mode::Cubic, ..device::Params::default() };
        Self {
            params: Params::new(settings()).unwrap(),
            link: link::State::default(),
            mailbox: Mailbox::default(),
            wire: bus::State::default(),
            faults: Vec::new(),
            drive_params,
            drive: device::State::new(&drive_params).unwrap(),
            measured: Measured::default(),
            fault: None,
            frame: None,
            controlword: Controlword::default(),
            axis: Setpoint::default(),
            behind: 0.0,
            tick: 0,
            peaks: [0.0; 2],
        }
    }

    pub(crate) fn feedback(&self) -> AxisFeedback {
        self.link.feedback(&self.params)
    }

    /// Runs base ticks with a command for each cycle of the motion task.
    pub(crate) fn run(&mut self, ticks: u64, command: impl Fn(u64) -> AxisCommand) {
        for _ in 0..ticks {
            self.step(&command);
        }
    }

    fn step(&mut self, command: impl Fn(u64) -> AxisCommand) {
        let faults = core::mem::take(&mut self.faults);
        let wire = bus::Params::new(self.params.settings().bus_cycle, DELAY, &faults).unwrap();
        if let Some(cycle) = bus::step(&wire, &mut self.wire, Tick(self.tick)) {
            let actuals = self.wire.to_master(&wire, &cycle, self.drive.actuals(&self.drive_params));
            if cycle.due.0.is_multiple_of(MOTION) && !cycle.master_stopped {
                self.mailbox.write(cycle.due, command(cycle.due.0));
            }
            let external_fault = cycle.external_fault;
            let input = Input { tick: cycle.due, mailbox: &self.mailbox, actuals, external_fault };
            let commands = link::step(&self.params, &mut self.link, input);
            self.controlword = commands.controlword;
            self.frame = self.wire.to_drive(&wire, &cycle, commands).or(self.frame);
        }
        self.faults = faults;
        if self.tick.is_multiple_of(DRIVE) {
            self.turn();
        }
        self.tick += 1;
    }

    fn turn(&mut self) {
        self.measured.increments = self.drive_params.units.increments(self.axis.x - self.behind);
        self.measured.velocity = self.axis.v;
        let frame = self.frame.take();
        let inputs = Inputs { frame: frame.as_ref(), measured: self.measured, fault: self.fault, main_voltage: true };
        let period = self.drive_params.period;
        let before = self.axis;
        self.axis = match device::step(&self.drive_params, &mut self.drive, &inputs).demand {
            Demand::Position { setpoint, .. } | Demand::Velocity { setpoint, .. } => setpoint.after(period),
            Demand::Effort(_) => panic!("no effort was asked for"),
            // Friction holds an undriven axis.
            Demand::Off => Setpoint::at_rest(before.x),
        };
        let v = (self.axis.x - before.x) / period;
        let a = (v - before.v) / period;
        self.axis.v = v;
        self.peaks = [self.peaks[0].max(v.abs()), self.peaks[1].max(a.abs())];
    }
}
