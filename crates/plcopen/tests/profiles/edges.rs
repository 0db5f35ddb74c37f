//! Execute, aborts, buffered commands and refusals.
use crate::bench::{Bench, LIMITS};
use servobench_motion::pvt::Knot;
use servobench_plcopen::{
    AccelerationProfile, AccelerationProfileInputs, Axis, AxisState, BlockError, BufferMode, Follow, FunctionBlock,
    Halt, HaltInputs, MoveAbsolute, MoveAbsoluteInputs, Pair, PositionProfile, PositionProfileInputs, VelocityProfile,
    VelocityProfileInputs,
};

const UP: [Pair; 2] = [Pair { delta_time: 0.1, value: 0.3 }, Pair { delta_time: 0.1, value: 0.0 }];

fn executed() -> VelocityProfileInputs<'static> {
    VelocityProfileInputs { execute: true, ..VelocityProfileInputs::along(&UP) }
}

#[test]
fn outputs_last_as_long_as_execute_and_a_cycle_at_least() {
    for held in [true, false] {
        let (mut bench, mut block) = (Bench::standstill(), VelocityProfile::new([Pair::default(); 4]));
        let mut completed = 0;
        for k in 0..250 {
            let execute = k == 0 || (held && k < 240);
            let outputs = bench.cycle(|axis| block.step(axis, &VelocityProfileInputs { execute, ..executed() }));
            completed += usize::from(outputs.profile_completed);
            assert_eq!(outputs.busy, k < 200, "{k}");
        }
        // From cycle 200 to 239, or in 200 alone.
        assert_eq!(completed, if held { 40 } else { 1 });
    }
}

#[test]
fn another_command_takes_the_axis_without_a_jump() {
    let (mut bench, mut block, mut halt) =
        (Bench::standstill(), VelocityProfile::new([Pair::default(); 4]), Halt::default());
    for _ in 0..60 {
        bench.cycle(|axis| block.step(axis, &executed()));
    }
    let before = bench.axis.commanded();
    let inputs = HaltInputs { execute: true, ..HaltInputs::within(&LIMITS) };
    let outputs = bench.cycle(|axis| {
        halt.step(axis, &inputs);
        block.step(axis, &executed())
    });
    assert!(outputs.command_aborted && !outputs.busy);
    let after = bench.axis.commanded();
    assert!((after.v - before.v).abs() < LIMITS.acceleration * 1e-3);
    bench.until(AxisState::Standstill);
}

/// A buffered profile begins where the previous move ends.
#[test]
fn a_profile_waits_for_the_move_before_it() {
    let (mut bench, mut go) = (Bench::standstill(), MoveAbsolute::default());
    let mut block = PositionProfile::new([Knot::default(); 3], [0.0; 3]);
    let inputs = MoveAbsoluteInputs { execute: true, position: 0.05, ..MoveAbsoluteInputs::within(&LIMITS) };
    let pairs = [Pair { delta_time: 0.4, value: 0.1 }, Pair { delta_time: 0.4, value: 0.06 }];
    let profile = PositionProfileInputs {
        execute: true,
        buffer_mode: BufferMode::Buffered,
        follow: Follow::Plateaus(Some(0.4)),
        ..PositionProfileInputs::along(&pairs)
    };
    let mut began = None;
    for k in 0..5000 {
        let (moved, followed) = bench.cycle(|axis| (go.step(axis, &inputs), block.step(axis, &profile)));
        assert!(!moved.error && !followed.error, "{k}: {:?}", block.error());
        assert_eq!(moved.done, followed.active || followed.done, "{k}");
        if followed.active && began.is_none() {
            began = Some(k);
            assert!((bench.axis.commanded().x - 0.05).abs() < 1e-15);
        }
        if followed.done {
            assert_eq!(k - began.unwrap(), 800);
            assert!((bench.axis.commanded().x - 0.06).abs() < 1e-13);
            return;
        }
    }
    panic!("the profile never ends");
}

#[test]
fn an_instance_that_has_the_axis_cannot_wait_for_itself() {
    let (mut bench, mut block) = (Bench::standstill(), VelocityProfile::new([Pair::default(); 4]));
    let inputs = VelocityProfileInputs { buffer_mode: BufferMode::Buffered, ..executed() };
    for k in 0..300 {
        // A second edge in cycle 50.
        let outputs = bench.cycle(|axis| block.step(axis, &VelocityProfileInputs { execute: k != 49, ..inputs }));
        assert_eq!(outputs.error, k >= 50, "{k}");
        // The running profile continues to its end.
        assert_ne!(bench.axis.state(), AxisState::ErrorStop);
    }
    assert!(matches!(block.error(), Some(BlockError::BufferFull { held: 1, .. })));
    assert!((bench.axis.commanded().x - 0.03).abs() < 1e-14);
}

#[test]
fn a_profile_beyond_the_limits_is_refused_before_it_begins() {
    for (delta_time, value, quantity) in [(0.5, 4.5, "velocity"), (0.2, 5.5, "acceleration"), (0.01, 1.0, "jerk")] {
        let (mut bench, mut block) = (Bench::standstill(), AccelerationProfile::new([Pair::default(); 4]));
        let pairs = [Pair { delta_time, value }];
        let inputs = AccelerationProfileInputs { execute: true, ..AccelerationProfileInputs::along(&pairs) };
        assert!(bench.cycle(|axis| block.step(axis, &inputs)).error);
        let error = block.error().unwrap().to_string();
        let expected = format!("MC_AccelerationProfile: `{quantity} of the profile` must be at most ");
        assert!(error.starts_with(&expected), "{error}");
        assert_eq!(bench.axis.state(), AxisState::Standstill);
    }
    // After a move, the refusal comes when the profile begins: the axis stops with an error.
    let (mut bench, mut go, mut block) =
        (Bench::standstill(), MoveAbsolute::default(), VelocityProfile::new([Pair::default(); 4]));
    let inputs = MoveAbsoluteInputs { execute: true, position: 0.05, ..MoveAbsoluteInputs::within(&LIMITS) };
    let steep = [Pair { delta_time: 0.1, value: 0.9 }];
    let profile = VelocityProfileInputs {
        execute: true,
        buffer_mode: BufferMode::Buffered,
        ..VelocityProfileInputs::along(&steep)
    };
    let outputs = loop {
        let (moved, outputs) = bench.cycle(|axis| (go.step(axis, &inputs), block.step(axis, &profile)));
        if moved.done {
            break outputs;
        }
    };
    assert!(outputs.active || outputs.error);
    assert_eq!(bench.axis.state(), AxisState::ErrorStop);
    let error = bench.axis.error().unwrap().to_string();
    assert!(error.starts_with("MC_VelocityProfile: its acceleration of the profile 9"), "{error}");
}

#[test]
fn a_profile_that_is_not_called_stops_the_axis() {
    let (mut bench, mut block) = (Bench::standstill(), VelocityProfile::new([Pair::default(); 4]));
    bench.cycle(|axis| block.step(axis, &executed()));
    bench.cycle(|_| ());
    bench.cycle(|_| ());
    assert_eq!(bench.axis.state(), AxisState::ErrorStop);
    let error = bench.axis.error().unwrap().to_string();
    assert_eq!(error, "MC_VelocityProfile: gave no set-point in this cycle: call it in every cycle");
}

#[test]
fn tables_and_scales_that_mean_nothing_are_refused_at_the_edge() {
    let bad_time = [UP[0], Pair { delta_time: 0.0, value: 0.1 }];
    let negative = [Pair { delta_time: -0.1, value: 0.1 }];
    let nothing = [Pair { delta_time: 0.1, value: f64::NAN }];
    let start_only = [Pair { delta_time: 0.0, value: 0.0 }];
    let velocity = |inputs: VelocityProfileInputs<'static>| {
        refusal(|axis, execute| {
            let mut block = VelocityProfile::new([Pair::default(); 4]);
            block.step(axis, &VelocityProfileInputs { execute, ..inputs });
            block.error().copied()
        })
    };
    let message = |scale, got| format!("MC_VelocityProfile: `{scale}, got {got}: correct the input");
    assert_eq!(
        velocity(VelocityProfileInputs { time_scale: 0.0, ..executed() }),
        message("TimeScale` must be positive, from 1e-15 to 1e15", "0")
    );
    assert_eq!(
        velocity(VelocityProfileInputs { velocity_scale: 0.0, ..executed() }),
        message("VelocityScale` must be other than zero, from 1e-15 to 1e15 in magnitude", "0")
    );
    assert_eq!(
        velocity(VelocityProfileInputs { offset: f64::INFINITY, ..executed() }),
        message("Offset` must be a number within ±1e15", "inf")
    );
    assert_eq!(
        velocity(VelocityProfileInputs { time_velocity: &[], ..executed() }),
        message("TimeVelocity` must be a table of one pair at least", "0")
    );
    for (pairs, expected) in [
        (&bad_time[..], "must be a table of positive times since the pair before, got 0"),
        (&negative, "must be a table of times since the pair before, none negative, got -0.1"),
        (&nothing, "must be a table of values within ±1e15, scaled and moved, got NaN"),
        (&start_only, "must be a table that takes some time, got 0"),
        (&[UP[0]; 5], "`knots` must hold a value for each of 6 points, got room for 3: pass a longer slice"),
    ] {
        let said = refusal(|axis, execute| {
            let mut block = PositionProfile::new([Knot::default(); 3], [0.0; 3]);
            block.step(axis, &PositionProfileInputs { execute, ..PositionProfileInputs::along(pairs) });
            block.error().copied()
        });
        assert!(said.contains(expected), "{said}");
    }
}

/// Error message of an edge that leaves the axis where it is.
fn refusal(block: impl FnOnce(&mut Axis, bool) -> Option<BlockError>) -> String {
    let mut bench = Bench::standstill();
    let error = bench.cycle(|axis| block(axis, true)).unwrap();
    assert_eq!(bench.axis.state(), AxisState::Standstill);
    error.to_string()
}
