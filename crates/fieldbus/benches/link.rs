//! Cost of link and bus, by the base tick at 16 kHz with a bus of 1 ms and a motion task of 20 ms:
//! `cargo bench -p servobench-fieldbus`.
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use servobench_base::{Rate, Tick};
use servobench_cia402::counter::Counter;
use servobench_cia402::{Actuals, Commands, PowerState, Statusword};
use servobench_fieldbus::link::{self, Control, Input, Mailbox, Params, PositionGains, Sequencing, Settings, Units};
use servobench_fieldbus::{AxisCommand, FieldbusError, Task, bus};
use servobench_motion::Limits;
use servobench_motion::interpolate::{Mode, Sample};

fn main() {
    divan::main();
}

const BUS: u64 = 16;
const MOTION: u64 = 320;
/// Ticks of one measurement, a whole number of cycles of both tasks.
const TICKS: u64 = 16_000;
const RATE: f64 = 16e3;

fn hz(hz: u32) -> Rate {
    Rate::new(hz).unwrap()
}

fn params(interpolation: Mode, control: Control) -> Result<Params, FieldbusError> {
    let divider = |rate| hz(16_000).divider(hz(rate)).unwrap();
    Params::new(Settings {
        base_rate: hz(16_000),
        bus_cycle: divider(1_000),
        motion_cycle: divider(50),
        interpolation,
        margin: 16,
        run_ahead: 0,
        control,
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
    })
}

/// An axis that swings by 10 mm at 1 Hz, with an ideal drive.
struct Axis {
    params: Params,
    state: link::State,
    mailbox: Mailbox,
    actuals: Actuals,
    /// Delay of each sample (base ticks).
    late: u64,
}

impl Axis {
    fn new(interpolation: Mode, control: Control) -> Self {
        let actuals = Actuals { statusword: Statusword::of(PowerState::OperationEnabled), ..Actuals::default() };
        let params = params(interpolation, control).unwrap();
        let mut axis = Self { params, state: link::State::default(), mailbox: Mailbox::default(), actuals, late: 0 };
        for tick in 0..TICKS {
            axis.tick(tick);
        }
        assert!(axis.state.interpolation().is_running(), "{:?}", axis.state.fault());
        axis
    }

    fn tick(&mut self, tick: u64) -> i32 {
        if tick % MOTION == self.late {
            let tick = tick - self.late;
            let phase = core::f64::consts::TAU * (tick % TICKS) as f64 / RATE;
            let (x, v) = (0.01 * phase.sin(), 0.01 * core::f64::consts::TAU * phase.cos());
            let task = Task::Follow(Sample { x, v, a: 0.0, torque: 0.1 });
            self.mailbox.write(Tick(tick), AxisCommand::of(task));
        }
        if tick.is_multiple_of(BUS) {
            let input = Input {
                tick: Tick(tick),
                mailbox: &self.mailbox,
                actuals: Some(black_box(self.actuals)),
                external_fault: false,
            };
            let commands = link::step(&self.params, &mut self.state, input);
            (self.actuals.position, self.actuals.mode) = (commands.target_position, commands.mode);
        }
        self.actuals.position
    }
}

const CSP: Control = Control::Position { velocity_offset: true, torque_offset: true };
const CSV: Control =
    Control::Velocity { gains: PositionGains::proportional(20.0), feedforward: 1.0, limit: 4.0, torque_offset: true };

fn ticks(bencher: Bencher<'_, '_>, mut axis: Axis) {
    let mut start = TICKS;
    bencher.counter(ItemsCount::new(TICKS)).bench_local(|| {
        let sum = (start..start + TICKS).map(|tick| i64::from(axis.tick(tick))).sum::<i64>();
        start += TICKS;
        sum
    });
}

#[divan::bench(args = [Mode::Linear, Mode::Cubic, Mode::Quintic, Mode::QuinticBSpline, Mode::AllCubic])]
fn positions_by_the_base_tick(bencher: Bencher<'_, '_>, mode: Mode) {
    ticks(bencher, Axis::new(mode, CSP));
}

#[divan::bench]
fn velocities_by_the_base_tick(bencher: Bencher<'_, '_>) {
    ticks(bencher, Axis::new(Mode::Quintic, CSV));
}

/// Every sample is late: each cycle of the motion task has a prediction and a correction, which plans a recovery.
#[divan::bench]
fn late_samples_by_the_base_tick(bencher: Bencher<'_, '_>) {
    ticks(bencher, Axis { late: 10 * BUS, ..Axis::new(Mode::Quintic, CSP) });
}

/// The set-point in SI at every base tick, for a recording.
#[divan::bench]
fn set_point_of_a_base_tick(bencher: Bencher<'_, '_>) {
    let axis = Axis::new(Mode::Quintic, CSP);
    bencher.counter(ItemsCount::new(TICKS)).bench_local(|| {
        let at = |tick| axis.state.setpoint(black_box(&axis.params), Tick(TICKS - BUS + tick % BUS)).x;
        (0..TICKS).map(at).sum::<f64>()
    });
}

/// Cost of the bus per tick, every sixteenth of which has a cycle.
#[divan::bench]
fn bus_by_the_base_tick(bencher: Bencher<'_, '_>) {
    let faults = [bus::BusFault { kind: bus::BusFaultKind::Jitter { by: 4, seed: 1 }, cycles: 0..u64::MAX }];
    let params = bus::Params::new(hz(16_000).divider(hz(1_000)).unwrap(), 1, &faults).unwrap();
    let mut state = bus::State::default();
    let mut start = 0;
    bencher.counter(ItemsCount::new(TICKS)).bench_local(|| {
        let mut arrived = 0;
        for tick in start..start + TICKS {
            if let Some(cycle) = bus::step(&params, &mut state, black_box(Tick(tick))) {
                arrived += u32::from(state.to_master(&params, &cycle, Actuals::default()).is_some());
                arrived += u32::from(state.to_drive(&params, &cycle, Commands::default()).is_some());
            }
        }
        start += TICKS;
        arrived
    });
}

/// Between two cycles.
#[divan::bench]
fn bus_at_an_ordinary_tick(bencher: Bencher<'_, '_>) {
    let params = bus::Params::new(hz(16_000).divider(hz(1_000)).unwrap(), 1, &[]).unwrap();
    let mut state = bus::State::default();
    assert!(bus::step(&params, &mut state, Tick(0)).is_some());
    bencher
        .counter(ItemsCount::new(TICKS))
        .bench_local(|| (0..TICKS).filter(|_| bus::step(&params, &mut state, black_box(Tick(15))).is_some()).count());
}
