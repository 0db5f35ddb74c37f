//! Cost of a step of the drive as the fieldbus sees it: `cargo bench -p servobench-drive --bench device`.
//!
//! An ideal axis, a position loop of four steps per frame; a thousand steps per sample. The master's readings are made once per frame.
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use servobench_cia402::{Command, Commands, ControlBit, Controlword, Mode};
use servobench_drive::Demand;
use servobench_drive::device::{self, Inputs, Measured, Params, State};
use servobench_drive::modes::profile::Ramp;
use servobench_motion::interpolate;

const STEPS: u32 = 1000;

struct Axis {
    params: Params,
    state: State,
    frame: Commands,
    measured: Measured,
    step: u32,
}

impl Axis {
    fn enabled(params: &Params, mode: Mode) -> Self {
        let state = State::new(params).unwrap_or_else(|error| panic!("{error}"));
        let mut axis =
            Self { params: *params, state, frame: Commands::default(), measured: Measured::default(), step: 0 };
        axis.frame.mode = mode.code();
        for command in [Command::DisableVoltage, Command::Shutdown, Command::SwitchOn, Command::EnableOperation] {
            axis.frame.controlword = Controlword::of(command);
            (0..4).for_each(|_| axis.run_step());
        }
        axis
    }

    fn run_step(&mut self) {
        let is_due = self.step.is_multiple_of(4);
        self.step += 1;
        let frame = is_due.then_some(&self.frame);
        let inputs = Inputs { frame, measured: self.measured, fault: None, main_voltage: true };
        let outputs = device::step(&self.params, &mut self.state, black_box(&inputs));
        if let Demand::Position { setpoint, .. } = outputs.demand {
            self.measured.increments = self.params.units.increments(setpoint.x);
            self.measured.velocity = setpoint.v;
        }
        black_box(outputs);
        if is_due {
            black_box(self.state.actuals(&self.params));
        }
    }

    fn bench(mut self, bencher: Bencher, mut change: impl FnMut(&mut Self)) {
        bencher.counter(ItemsCount::new(STEPS)).bench_local(|| {
            for _ in 0..STEPS / 4 {
                change(&mut self);
                (0..4).for_each(|_| self.run_step());
            }
        });
    }
}

fn cyclic(bencher: Bencher, interpolation: interpolate::Mode) {
    let params = Params { interpolation, ..Params::default() };
    Axis::enabled(&params, Mode::CyclicSynchronousPosition).bench(bencher, |axis| {
        axis.frame.target_position = axis.frame.target_position.wrapping_add(100);
        axis.frame.velocity_offset = 100_000;
    });
}

#[divan::bench]
fn csp_linear(bencher: Bencher) {
    cyclic(bencher, interpolate::Mode::Linear);
}

#[divan::bench]
fn csp_cubic(bencher: Bencher) {
    cyclic(bencher, interpolate::Mode::Cubic);
}

#[divan::bench]
fn csp_cubic_b_spline(bencher: Bencher) {
    cyclic(bencher, interpolate::Mode::CubicBSpline);
}

#[divan::bench]
fn csv(bencher: Bencher) {
    Axis::enabled(&Params::default(), Mode::CyclicSynchronousVelocity)
        .bench(bencher, |axis| axis.frame.target_velocity = (axis.frame.target_velocity + 100) % 100_000);
}

#[divan::bench]
fn pv(bencher: Bencher) {
    Axis::enabled(&Params::default(), Mode::ProfileVelocity)
        .bench(bencher, |axis| axis.frame.target_velocity = if axis.step % 4096 < 2048 { 100_000 } else { 0 });
}

/// There and back: a new set-point every 4096 steps.
fn profile(bencher: Bencher, ramp: Ramp) {
    let mut params = Params::default();
    params.profile.ramp = ramp;
    Axis::enabled(&params, Mode::ProfilePosition).bench(bencher, |axis| {
        axis.frame.target_position = if axis.step % 4096 < 2048 { 50_000 } else { 0 };
        let given = axis.step % 2048 < 1024;
        axis.frame.controlword = axis.frame.controlword.with(ControlBit::ModeSpecific4, given);
    });
}

#[divan::bench]
fn pp_linear(bencher: Bencher) {
    profile(bencher, Ramp::Linear);
}

#[divan::bench]
fn pp_jerk_limited(bencher: Bencher) {
    profile(bencher, Ramp::JerkLimited(50.0));
}

#[divan::bench]
fn switched_off(bencher: Bencher) {
    let mut axis = Axis::enabled(&Params::default(), Mode::CyclicSynchronousPosition);
    axis.frame.controlword = Controlword::of(Command::DisableVoltage);
    axis.bench(bencher, |_| ());
}

fn main() {
    divan::main();
}
