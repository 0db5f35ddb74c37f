//! Cost of a PLC cycle of one axis with a few blocks, and of the calls that plan: `cargo bench -p servobench-plcopen --bench cycle`.
//!
//! An ordinary cycle is one in which nothing is planned: `begin`, MC_Power, the calls of a program, `end`.
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use servobench_fieldbus::{AxisFeedback, Power as DrivePower, ProbeFeedback};
use servobench_motion::Limits;
use servobench_plcopen::{
    Axis, AxisParams, BufferMode, FunctionBlock, MoveAbsolute, MoveAbsoluteInputs, MoveVelocity, MoveVelocityInputs,
    Power, PowerInputs, ReadActualPosition, ReadInputs, ReadStatus, SetOverride, SetOverrideInputs, Stop, StopInputs,
};

fn main() {
    divan::main();
}

const LIMITS: Limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
const FEEDBACK: AxisFeedback = AxisFeedback {
    position: 0.0,
    following_error: 0.0,
    velocity: 0.0,
    effort: 0.0,
    power: DrivePower::On,
    fault: None,
    interpolation: servobench_fieldbus::Interpolation::Off,
    homing: servobench_fieldbus::Homing::Idle,
    profile: servobench_fieldbus::ProfileFeedback {
        acknowledged: 0,
        target_reached: false,
        is_active: false,
        buffer_free: 0,
        buffer_status: 0,
    },
    switches: servobench_fieldbus::Switches { negative_limit: false, home: false, positive_limit: false },
    has_warning: false,
    digital_inputs: 0,
    touch_probe: ProbeFeedback { number: 0, position: None },
};
const CYCLES: usize = 1000;

fn standstill() -> Axis {
    let params = AxisParams { needs_homing: false, ..AxisParams::new(1e-3, LIMITS) };
    let mut axis = Axis::new(params).unwrap();
    axis.begin(&FEEDBACK);
    Power.step(&mut axis, &PowerInputs { enable: true, ..PowerInputs::default() });
    axis.end();
    axis
}

fn to(position: f64) -> MoveAbsoluteInputs {
    MoveAbsoluteInputs { execute: true, position, ..MoveAbsoluteInputs::within(&LIMITS) }
}

/// An axis on a long move.
fn under_way() -> (Axis, MoveAbsolute) {
    let (mut axis, mut go) = (standstill(), MoveAbsolute::default());
    axis.begin(&FEEDBACK);
    go.step(&mut axis, &to(2.0));
    axis.end();
    (axis, go)
}

#[divan::bench]
fn move_with_power_and_nothing_else(bencher: Bencher) {
    bencher.counter(ItemsCount::new(CYCLES)).with_inputs(under_way).bench_local_values(|(mut axis, mut go)| {
        for _ in 0..CYCLES {
            axis.begin(black_box(&FEEDBACK));
            Power.step(&mut axis, &PowerInputs { enable: true, ..PowerInputs::default() });
            black_box(go.step(&mut axis, black_box(&to(2.0))));
            black_box(axis.end());
        }
        axis
    });
}

#[divan::bench]
fn move_with_six_blocks(bencher: Bencher) {
    bencher.counter(ItemsCount::new(CYCLES)).with_inputs(under_way).bench_local_values(|(mut axis, mut go)| {
        let (mut second, mut stop, mut slow) = (MoveAbsolute::default(), Stop::default(), SetOverride::default());
        for _ in 0..CYCLES {
            axis.begin(black_box(&FEEDBACK));
            Power.step(&mut axis, &PowerInputs { enable: true, ..PowerInputs::default() });
            black_box(slow.step(&mut axis, &SetOverrideInputs { enable: true, ..SetOverrideInputs::default() }));
            black_box(go.step(&mut axis, black_box(&to(2.0))));
            black_box(second.step(&mut axis, black_box(&MoveAbsoluteInputs { execute: false, ..to(1.0) })));
            black_box(stop.step(&mut axis, black_box(&StopInputs::within(&LIMITS))));
            black_box(ReadStatus.step(&mut axis, &ReadInputs { enable: true }));
            black_box(ReadActualPosition.step(&mut axis, &ReadInputs { enable: true }));
            black_box(axis.end());
        }
        axis
    });
}

#[divan::bench]
fn standstill_with_a_block(bencher: Bencher) {
    bencher.counter(ItemsCount::new(CYCLES)).with_inputs(standstill).bench_local_values(|mut axis| {
        let mut go = MoveAbsolute::default();
        for _ in 0..CYCLES {
            axis.begin(black_box(&FEEDBACK));
            Power.step(&mut axis, &PowerInputs { enable: true, ..PowerInputs::default() });
            black_box(go.step(&mut axis, black_box(&MoveAbsoluteInputs { execute: false, ..to(1.0) })));
            black_box(axis.end());
        }
        axis
    });
}

/// The call that aborts a move.
#[divan::bench]
fn abort(bencher: Bencher) {
    bencher.with_inputs(half_way).bench_local_values(|(mut axis, _)| {
        let outputs = MoveAbsolute::default().step(&mut axis, black_box(&to(1.0)));
        (axis, outputs)
    });
}

/// The call that blends a move with the one that runs.
#[divan::bench]
fn blend(bencher: Bencher) {
    let inputs = MoveAbsoluteInputs { buffer_mode: BufferMode::BlendingHigh, velocity: 0.5, ..to(3.0) };
    bencher.with_inputs(half_way).bench_local_values(|(mut axis, _)| {
        let outputs = MoveAbsolute::default().step(&mut axis, black_box(&inputs));
        (axis, outputs)
    });
}

/// The call that goes over to a velocity.
#[divan::bench]
fn run(bencher: Bencher) {
    let inputs = MoveVelocityInputs { execute: true, velocity: 0.3, ..MoveVelocityInputs::within(&LIMITS) };
    bencher.with_inputs(half_way).bench_local_values(|(mut axis, _)| {
        let outputs = MoveVelocity::default().step(&mut axis, black_box(&inputs));
        (axis, outputs)
    });
}

fn half_way() -> (Axis, MoveAbsolute) {
    let (mut axis, go) = under_way();
    for _ in 0..150 {
        axis.begin(&FEEDBACK);
        axis.end();
    }
    (axis, go)
}
