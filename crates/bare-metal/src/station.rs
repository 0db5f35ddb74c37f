//! A PLC program that moves an axis through a fieldbus, with a drive that follows at once.
use servobench_base::{Rate, Tick};
use servobench_cia402::counter::Counter;
use servobench_cia402::{Actuals, Commands, DriveFunction, PowerInputs, PowerMemory, PowerParams};
use servobench_fieldbus::link::{self, Control, Input, Mailbox, Params, Sequencing, Settings, Units};
use servobench_fieldbus::{AxisCommand, AxisFeedback};
use servobench_motion::Limits;
use servobench_motion::interpolate::Mode;
use servobench_motion::pvt::Knot;
use servobench_plcopen::{
    Axis, AxisParams, FunctionBlock, MoveAbsolute, MoveAbsoluteInputs, Pair, PositionProfile, PositionProfileInputs,
    Power, PowerInputs as PowerBlockInputs, TimePosition,
};

const LIMITS: Limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
/// Base ticks of 62.5 µs per cycle of the bus, and per cycle of the PLC.
const BUS: u64 = 16;
const PLC: u64 = 160;
/// Counts of the drive per metre.
const COUNTS: f64 = 1e6;

/// Position of the drive (m) `bus_cycles` after power-on, when the program moves to `position` (m), and from there back and forth by a
/// tenth of a metre; NaN when something cannot be set up.
#[expect(unsafe_code, reason = "the name is for a caller in C, and no other symbol of the program has it")]
#[unsafe(no_mangle)]
extern "C" fn servobench_station_position(position: f64, bus_cycles: u32) -> f64 {
    let Some(params) = link_params() else { return f64::NAN };
    let Some(mut program) = Program::new(position) else { return f64::NAN };
    let (mut link, mut mailbox, mut drive) = (link::State::default(), Mailbox::default(), Drive::default());
    let mut actuals = None;
    for cycle in 0..u64::from(bus_cycles) {
        let tick = Tick(cycle * BUS);
        if tick.0.is_multiple_of(PLC) {
            mailbox.write(tick, program.cycle(&link.feedback(&params)));
        }
        let input = Input { tick, mailbox: &mailbox, actuals, external_fault: false };
        let commands = link::step(&params, &mut link, input);
        actuals = Some(drive.cycle(&commands));
    }
    f64::from(drive.position) / COUNTS
}

fn link_params() -> Option<Params> {
    let base_rate = Rate::from_hertz(16e3).ok()?;
    let units = Units {
        drive_units: COUNTS,
        axis_units: 1.0,
        velocity_factor: 1.0,
        rated_effort: 2.4,
        counter: Counter::signed(32).ok()?,
    };
    Params::new(Settings {
        base_rate,
        bus_cycle: base_rate.divider(Rate::from_hertz(1e3).ok()?).ok()?,
        motion_cycle: base_rate.divider(Rate::from_hertz(100.0).ok()?).ok()?,
        interpolation: Mode::Cubic,
        margin: 16,
        run_ahead: 0,
        control: Control::Position { velocity_offset: true, torque_offset: false },
        sequencing: Sequencing::Strict,
        drive_timeout: 1600,
        round_trip: 2,
        answer_age: 0,
        reverse_switches: false,
        units,
        velocity_from_differences: false,
        recovery: LIMITS,
        velocity_limit: 1.5,
    })
    .ok()
}

/// The program of the PLC: power, a move, a table.
struct Program {
    axis: Axis,
    power: Power,
    go: MoveAbsolute,
    back_and_forth: PositionProfile<[Knot; 3], [f64; 3]>,
    position: f64,
}

impl Program {
    fn new(position: f64) -> Option<Self> {
        let params = AxisParams { needs_homing: false, ..AxisParams::new(10e-3, LIMITS) };
        let axis = Axis::new(params).ok()?;
        let back_and_forth = PositionProfile::new([Knot::default(); 3], [0.0; 3]);
        Some(Self { axis, power: Power, go: MoveAbsolute::default(), back_and_forth, position })
    }

    fn cycle(&mut self, feedback: &AxisFeedback) -> AxisCommand {
        const PAIRS: &[Pair] = &[Pair { delta_time: 1.0, value: 0.1 }, Pair { delta_time: 1.0, value: 0.0 }];
        let Self { axis, power, go, back_and_forth, position } = self;
        axis.begin(feedback);
        let execute = power.step(axis, &PowerBlockInputs { enable: true, ..PowerBlockInputs::default() }).status;
        let there = MoveAbsoluteInputs { execute, position: *position, ..MoveAbsoluteInputs::within(&LIMITS) };
        let execute = go.step(axis, &there).done;
        let time_position = TimePosition { pairs: PAIRS, is_absolute: false };
        back_and_forth
            .step(axis, &PositionProfileInputs { execute, time_position, ..PositionProfileInputs::along(PAIRS) });
        axis.end()
    }
}

/// A drive that follows its commanded position at once, as far as its power state lets it.
#[derive(Default)]
struct Drive {
    power: PowerMemory,
    position: i32,
}

impl Drive {
    fn cycle(&mut self, commands: &Commands) -> Actuals {
        let inputs = PowerInputs {
            initialised: true,
            standstill: true,
            remote: true,
            main_voltage: true,
            ..PowerInputs::default()
        };
        let (params, controlword) = (PowerParams::default(), commands.controlword);
        let outputs = servobench_cia402::step(&params, &mut self.power, controlword, inputs);
        if outputs.drive == DriveFunction::Follow {
            self.position = commands.target_position;
        }
        let (position, position_demand) = (self.position, self.position);
        Actuals { statusword: outputs.statusword, mode: commands.mode, position, position_demand, ..Actuals::default() }
    }
}
