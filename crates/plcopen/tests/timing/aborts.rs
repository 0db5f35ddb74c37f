//! Aborts: the new command continues from the present state and keeps its limits.
use crate::bench::{Bench, CYCLE_TIME, LIMITS};
use servobench_fieldbus::{Fault, Homing};
use servobench_motion::Limits;
use servobench_plcopen::{
    AxisParams, AxisState, BufferMode, ErrorId, FunctionBlock, Home, HomeInputs, MoveAbsolute, MoveAbsoluteInputs,
    MoveAdditive, MoveAdditiveInputs, MoveRelative, MoveRelativeInputs, MoveSuperimposed, MoveSuperimposedInputs,
    MoveVelocity, MoveVelocityInputs, Power, PowerInputs, Stop, StopInputs,
};

const ORDERS: [Limits; 3] =
    [Limits { jerk: f64::INFINITY, snap: f64::INFINITY, ..LIMITS }, Limits { snap: f64::INFINITY, ..LIMITS }, LIMITS];

fn to(limits: &Limits, position: f64) -> MoveAbsoluteInputs {
    MoveAbsoluteInputs { execute: true, position, ..MoveAbsoluteInputs::within(limits) }
}

/// The second command reverses the axis, or not; it accelerates at 3 m/s² and decelerates at 1 m/s², or the other way round.
#[test]
fn acceleration_and_deceleration_are_kept_on_any_way() {
    for limits in &ORDERS {
        for (acceleration, deceleration) in [(3.0, 1.0), (1.0, 3.0)] {
            for target in [2.0, 0.35, 0.2, -1.0] {
                let mut bench = Bench::powered(AxisParams { limits: *limits, ..Bench::params() });
                let (mut run, mut go) = (MoveVelocity::default(), MoveAbsolute::default());
                let running = MoveVelocityInputs { execute: true, velocity: 0.6, ..MoveVelocityInputs::within(limits) };
                for _ in 0..600 {
                    bench.cycle(|axis| run.step(axis, &running));
                }
                let inputs = MoveAbsoluteInputs { acceleration, deceleration, ..to(limits, target) };
                bench.cycle(|axis| go.step(axis, &inputs));
                let mut last = bench.axis.commanded();
                while bench.axis.state() != AxisState::Standstill {
                    bench.cycle(|_| ());
                    let now = bench.axis.commanded();
                    // Where the velocity changes its sign within a cycle, either counts.
                    let limit = if now.v * last.v < 0.0 {
                        acceleration.max(deceleration)
                    } else if now.v.abs() > last.v.abs() {
                        acceleration
                    } else {
                        deceleration
                    };
                    let mean = (now.v - last.v).abs() / CYCLE_TIME;
                    assert!(mean <= limit * (1.0 + 1e-9) + 1e-9, "{target} {acceleration}: {mean} {last:?} {now:?}");
                    last = now;
                }
                assert_eq!(last.x.to_bits(), target.to_bits());
            }
        }
    }
}

/// An axis that is about to reach its velocity, aborted by a command with a hundredth of the jerk.
#[test]
fn a_gentle_command_does_not_carry_the_axis_beyond_its_limits() {
    for limits in &ORDERS[1..] {
        let mut bench = Bench::powered(AxisParams { limits: *limits, ..Bench::params() });
        let (mut go, mut gentle) = (MoveAbsolute::default(), MoveAbsolute::default());
        bench.cycle(|axis| go.step(axis, &to(limits, 3.0)));
        while bench.axis.commanded().v < 0.85 {
            bench.cycle(|_| ());
        }
        assert!(bench.axis.commanded().a > 1.0);
        let jerk = MoveAbsoluteInputs { jerk: Some(0.5), ..to(limits, 5.0) };
        bench.cycle(|axis| gentle.step(axis, &jerk));
        let mut highest = 0.0_f64;
        while bench.axis.state() != AxisState::Standstill {
            bench.cycle(|_| ());
            highest = highest.max(bench.axis.commanded().v);
        }
        assert!(highest <= limits.velocity * (1.0 + 1e-9), "{highest}");
        assert_eq!(bench.axis.commanded().x.to_bits(), 5.0_f64.to_bits());
    }
}

#[test]
fn a_relative_move_that_is_updated_goes_on_counting_from_where_it_began() {
    let mut bench = Bench::standstill();
    let mut go = MoveRelative::default();
    for cycle in 0..3000 {
        let distance = if cycle < 400 { 0.5 } else { 0.75 };
        let inputs = MoveRelativeInputs {
            execute: true,
            continuous_update: true,
            distance,
            ..MoveRelativeInputs::within(&LIMITS)
        };
        bench.cycle(|axis| go.step(axis, &inputs));
    }
    assert_eq!(bench.axis.commanded().x.to_bits(), 0.75_f64.to_bits());
}

#[test]
fn an_additive_move_keeps_what_a_superimposed_one_has_added() {
    let mut bench = Bench::standstill();
    let gentle = Limits { velocity: 0.5, acceleration: 2.0, jerk: 20.0, snap: 500.0 };
    let (mut go, mut on_top, mut further) =
        (MoveAbsolute::default(), MoveSuperimposed::default(), MoveAdditive::default());
    bench.cycle(|axis| go.step(axis, &to(&gentle, 2.0)));
    let top = MoveSuperimposedInputs { execute: true, distance: 0.25, ..MoveSuperimposedInputs::within(&gentle) };
    while !bench.cycle(|axis| on_top.step(axis, &top)).done {}
    assert_eq!(bench.axis.state(), AxisState::DiscreteMotion);
    let inputs = MoveAdditiveInputs { execute: true, distance: 0.5, ..MoveAdditiveInputs::within(&gentle) };
    bench.cycle(|axis| further.step(axis, &inputs));
    bench.until(AxisState::Standstill);
    assert_eq!(bench.axis.commanded().x.to_bits(), 2.75_f64.to_bits());
}

#[test]
fn a_stop_aborts_homing() {
    let mut bench = Bench::powered(AxisParams { needs_homing: true, ..Bench::params() });
    let (mut home, mut stop) = (Home::default(), Stop::default());
    let homing = HomeInputs { execute: true, ..HomeInputs::default() };
    for _ in 0..5 {
        (bench.feedback.position, bench.feedback.velocity) = (0.3, 0.1);
        bench.cycle(|axis| home.step(axis, &homing));
    }
    let (outputs, _) = bench.cycle(|axis| {
        let stopped = stop.step(axis, &StopInputs { execute: true, ..StopInputs::within(&LIMITS) });
        (home.step(axis, &homing), stopped)
    });
    assert!(outputs.command_aborted);
    assert_eq!(bench.axis.state(), AxisState::Stopping);
    assert!((bench.axis.commanded().x - 0.3).abs() < 1e-3, "it brakes from where it is");
    bench.homing = Homing::Attained;
    for _ in 0..200 {
        bench.cycle(|axis| stop.step(axis, &StopInputs { execute: false, ..StopInputs::within(&LIMITS) }));
    }
    assert_eq!((bench.axis.state(), bench.axis.is_homed()), (AxisState::Standstill, false));
}

/// PLCopen part 1, section 2.2.2: not CommandAborted.
#[test]
fn a_fault_ends_the_active_command_and_those_that_wait_with_an_error() {
    let mut bench = Bench::standstill();
    let (mut go, mut next) = (MoveAbsolute::default(), MoveRelative::default());
    let waiting = MoveRelativeInputs {
        execute: true,
        distance: 0.5,
        buffer_mode: BufferMode::Buffered,
        ..MoveRelativeInputs::within(&LIMITS)
    };
    bench.cycle(|axis| (go.step(axis, &to(&LIMITS, 0.5)), next.step(axis, &waiting)));
    bench.feedback.fault = Some(Fault::Drive(0x7305));
    let (active, waited) = bench.cycle(|axis| (go.step(axis, &to(&LIMITS, 0.5)), next.step(axis, &waiting)));
    assert_eq!(active.error_id, ErrorId::DriveFault);
    assert_eq!(
        go.error().unwrap().to_string(),
        "MC_MoveAbsolute: fault 7305h of the drive: remove its cause and call MC_Reset"
    );
    assert_eq!((waited.command_aborted, waited.error_id), (false, ErrorId::DriveFault));
    assert_eq!(
        next.error().unwrap().to_string(),
        "MC_MoveRelative: fault 7305h of the drive: remove its cause and call MC_Reset"
    );
    let power = bench.cycle(|axis| Power.step(axis, &PowerInputs { enable: true, ..PowerInputs::default() }));
    assert!(power.error && !power.valid);
}
