//! Tables, edges and aborts at random: nothing jumps.
use crate::bench::{Bench, CYCLE_TIME, LIMITS};
use proptest::prelude::*;
use servobench_motion::pvt::Knot;
use servobench_plcopen::{
    AccelerationProfile, AccelerationProfileInputs, AxisState, BufferMode, Follow, FunctionBlock, Halt, HaltInputs,
    Outputs, Pair, PositionProfile, PositionProfileInputs, Reset, ResetInputs, TimePosition, VelocityProfile,
    VelocityProfileInputs,
};

/// A profile, and a command that takes over from it, keep the limits of the axis but for jumps of the jerk.
const STEEPEST: f64 = LIMITS.acceleration * (1.0 + 1e-9);
const FASTEST: f64 = LIMITS.velocity * (1.0 + 1e-9);

fn table(value: f64) -> impl Strategy<Value = Vec<Pair>> {
    let pair = (0.02..0.6_f64, -value..value).prop_map(|(delta_time, value)| Pair { delta_time, value });
    proptest::collection::vec(pair, 1..6)
}

/// At most one of Done, Busy, `CommandAborted` and Error; Active with Busy only.
fn exclusive<O: Outputs>(outputs: &O) {
    let mut values = Vec::new();
    outputs.each(|value| values.push(value));
    let [done, busy, active, aborted, error, _] = values[..] else { panic!("{values:?}") };
    assert!(done + busy + aborted + error <= 1.0 && active <= busy, "{values:?}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn nothing_jumps(
        positions in table(0.4),
        velocities in table(1.1),
        accelerations in table(5.5),
        follow in prop_oneof![(0.05..0.5_f64).prop_map(|share| Follow::Plateaus(Some(share))), Just(Follow::Spline)],
        is_absolute: bool,
        end_velocity in -0.5..0.5_f64,
        calls in proptest::collection::vec((0..5_u8, any::<bool>(), 1..200_usize), 1..40),
    ) {
        let mut by_positions = PositionProfile::new([Knot::default(); 6], [0.0; 6]);
        let (mut by_velocities, mut by_accelerations) = (VelocityProfile::new([Pair::default(); 6]), AccelerationProfile::new([Pair::default(); 6]));
        let (mut halt, mut reset) = (Halt::default(), Reset::default());
        let mut bench = Bench::standstill();
        let mut before = bench.axis.commanded();
        for (called, is_buffered, cycles) in calls {
            let buffer_mode = if is_buffered { BufferMode::Buffered } else { BufferMode::Aborting };
            for _ in 0..cycles {
                let due = |number| called == number;
                let state = bench.axis.state();
                bench.cycle(|axis| {
                    let time_position = TimePosition { pairs: &positions, is_absolute };
                    exclusive(&by_positions.step(axis, &PositionProfileInputs {
                        execute: due(0), time_position, follow, end_velocity, buffer_mode,
                        ..PositionProfileInputs::along(&positions)
                    }));
                    exclusive(&by_velocities.step(axis, &VelocityProfileInputs {
                        execute: due(1), buffer_mode, ..VelocityProfileInputs::along(&velocities)
                    }));
                    exclusive(&by_accelerations.step(axis, &AccelerationProfileInputs {
                        execute: due(2), buffer_mode, ..AccelerationProfileInputs::along(&accelerations)
                    }));
                    exclusive(&halt.step(axis, &HaltInputs { execute: due(3), ..HaltInputs::within(&LIMITS) }));
                    reset.step(axis, &ResetInputs { execute: due(4) });
                });
                let at = bench.axis.commanded();
                let (way, gain) = ((at.x - before.x) / CYCLE_TIME, (at.v - before.v) / CYCLE_TIME);
                prop_assert!(way.abs() <= FASTEST, "{state:?} {before:?} {at:?}");
                prop_assert!(gain.abs() <= STEEPEST, "{state:?} {before:?} {at:?}");
                prop_assert_ne!(bench.axis.state(), AxisState::Disabled);
                before = at;
            }
        }
    }
}
