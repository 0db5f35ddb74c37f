//! Continuity of set-points: each follows from the one before, whichever block takes over and in any order of calls.
use crate::bench::{Bench, CYCLE_TIME, LIMITS};
use crate::calls::{running, to};
use servobench_base::Setpoint;
use servobench_plcopen::{
    AxisParams, AxisState, BufferMode, FunctionBlock, Halt, HaltInputs, MoveAbsolute, MoveContinuousAbsolute,
    MoveContinuousAbsoluteInputs, MoveRelative, MoveRelativeInputs, MoveSuperimposed, MoveSuperimposedInputs,
    MoveVelocity, MoveVelocityInputs, Pair, Power, PowerInputs, SetOverride, SetOverrideInputs, Stop, StopInputs,
    TorqueControl, TorqueControlInputs, VelocityProfile, VelocityProfileInputs,
};

/// Records of the set-points: the distance of each from the continuation of the cycle before, and the largest of each derivative.
#[derive(Default)]
struct Watch {
    last: Option<Setpoint>,
    /// Velocity, mean acceleration and mean jerk over a cycle.
    most: [f64; 3],
}

impl Watch {
    fn see(&mut self, bench: &Bench) {
        let now = bench.axis.commanded();
        if let Some(last) = self.last {
            let h = CYCLE_TIME;
            let (way, mean) = (now.x - last.x, 0.5 * (last.v + now.v) * h);
            // Half a step of the acceleration, as at a corner of a table, makes up to a·h²/4 of it.
            assert!((way - mean).abs() <= LIMITS.acceleration * h * h / 3.9, "{last:?} {now:?}");
            let means = [way, now.v - last.v, now.a - last.a].map(|step| (step / h).abs());
            self.most = core::array::from_fn(|k| self.most[k].max(means[k]));
        }
        self.last = Some(now);
    }
}

/// To 0.98 m/s at 5 m/s², the acceleration limit: the remaining velocity range is less than the 0.25 m/s that it takes to end the
/// acceleration at 50 m/s³.
const STEEP: [Pair; 1] = [Pair { delta_time: 0.1961, value: 0.9805 }];

fn along_steep() -> VelocityProfileInputs<'static> {
    VelocityProfileInputs { execute: true, ..VelocityProfileInputs::along(&STEEP) }
}

/// A table leads to states that no motion within the axis limits reaches. A command that takes over, called before or after the table's
/// block, keeps the velocity; so does the axis itself when the block is no longer called.
#[test]
fn what_takes_over_from_a_table_keeps_the_velocity() {
    for (snap, jerk) in
        [(f64::INFINITY, None), (LIMITS.snap, None), (f64::INFINITY, Some(21.3)), (LIMITS.snap, Some(21.3))]
    {
        let limits = servobench_motion::Limits { snap, ..LIMITS };
        for (takes_over, is_first) in [(0, true), (0, false), (1, true), (1, false), (2, true), (3, true), (3, false)] {
            let mut bench = Bench::powered(AxisParams { limits, ..Bench::params() });
            let (mut block, mut stop) = (VelocityProfile::new([Pair::default(); 1]), Stop::default());
            let (mut halt, mut other) = (Halt::default(), VelocityProfile::new([Pair::default(); 1]));
            let mut watch = Watch::default();
            for cycle in 0..2000 {
                let execute = cycle >= 190;
                bench.cycle(|axis| {
                    let mut take = |axis: &mut _| match takes_over {
                        0 => assert!(
                            !stop.step(axis, &StopInputs { execute, jerk, ..StopInputs::within(&limits) }).error
                        ),
                        1 => assert!(
                            !halt.step(axis, &HaltInputs { execute, jerk, ..HaltInputs::within(&limits) }).error
                        ),
                        2 => {}
                        _ => {
                            let down = [Pair { delta_time: 0.4, value: -0.3 }];
                            let inputs = VelocityProfileInputs { execute, ..VelocityProfileInputs::along(&down) };
                            assert!(!other.step(axis, &inputs).error);
                        }
                    };
                    if is_first {
                        take(axis);
                    }
                    if takes_over != 2 || !execute {
                        block.step(axis, &along_steep());
                    }
                    if !is_first {
                        take(axis);
                    }
                });
                watch.see(&bench);
            }
            let [velocity, acceleration, _] = watch.most;
            let place = format!("{takes_over} with {jerk:?} on {snap}, first: {is_first}");
            assert!(velocity <= LIMITS.velocity * (1.0 + 1e-9), "{place}: {velocity} m/s");
            assert!(acceleration <= LIMITS.acceleration * (1.0 + 1e-9), "{place}: {acceleration} m/s²");
            assert_eq!(bench.axis.commanded().v == 0.0, takes_over != 3, "{place}");
        }
    }
}

/// A buffered move is refused when its turn comes, as MC_Power no longer permits its direction.
#[test]
fn a_waiting_command_that_is_refused_repeats_no_setpoint() {
    for end_velocity in [0.45, 0.731] {
        let (mut bench, mut watch) = (Bench::standstill(), Watch::default());
        let (mut pass, mut back) = (MoveContinuousAbsolute::default(), MoveAbsolute::default());
        let pass_inputs = MoveContinuousAbsoluteInputs {
            execute: true,
            position: 0.3,
            end_velocity,
            ..MoveContinuousAbsoluteInputs::within(&LIMITS)
        };
        let mut refused = false;
        for cycle in 0..3000 {
            bench.permits_negative = cycle < 20;
            refused |= bench.cycle(|axis| {
                pass.step(axis, &pass_inputs);
                let inputs = to(0.1);
                let behind = BufferMode::Buffered;
                back.step(axis, &servobench_plcopen::MoveAbsoluteInputs { buffer_mode: behind, ..inputs }).error
            });
            watch.see(&bench);
        }
        assert!(refused && bench.axis.state() == AxisState::Standstill);
        let [velocity, acceleration, jerk] = watch.most;
        assert!(
            velocity <= 1.0 && acceleration <= 5.0 * (1.0 + 1e-9) && jerk <= 50.0 * (1.0 + 1e-6),
            "{:?}",
            watch.most
        );
    }
}

/// MC_TorqueControl and a move that takes the axis from it in the same cycle: the drive never saw the effort, and the axis lags.
#[test]
fn an_effort_that_was_never_given_leaves_the_setpoint_where_it_was() {
    let (mut bench, mut watch) = (Bench::standstill(), Watch::default());
    let (mut run, mut torque, mut go) = (MoveVelocity::default(), TorqueControl::default(), MoveRelative::default());
    for cycle in 0..4000 {
        let execute = cycle >= 700;
        bench.feedback.position -= 0.013 * bench.feedback.velocity;
        bench.cycle(|axis| {
            run.step(axis, &running(0.37));
            let efforts = TorqueControlInputs { execute, torque: 0.2, ..TorqueControlInputs::within(&LIMITS) };
            torque.step(axis, &efforts);
            go.step(axis, &MoveRelativeInputs { execute, distance: 0.3, ..MoveRelativeInputs::within(&LIMITS) });
        });
        watch.see(&bench);
    }
    let [velocity, acceleration, jerk] = watch.most;
    assert!(velocity <= 1.0 && acceleration <= 5.0 * (1.0 + 1e-9) && jerk <= 50.0 * (1.0 + 1e-6), "{:?}", watch.most);
    assert_eq!(bench.axis.state(), AxisState::Standstill);
}

/// Both motions exceed the limits that the override leaves to their commands, and are brought back at once.
#[test]
fn an_override_of_two_motions_keeps_the_limits_of_the_axis() {
    let mut most = 0.0_f64;
    for cycle in (90..230).step_by(7) {
        for jerk_factor in [0.07, 0.31] {
            let (mut bench, mut watch) = (Bench::standstill(), Watch::default());
            let (mut run, mut on_top, mut slow) =
                (MoveVelocity::default(), MoveSuperimposed::default(), SetOverride::default());
            let below = MoveVelocityInputs { jerk: Some(20.0), snap: Some(400.0), acceleration: 2.0, ..running(0.5) };
            let below = MoveVelocityInputs { deceleration: 2.0, ..below };
            let top =
                MoveSuperimposedInputs { execute: true, distance: 0.2, ..MoveSuperimposedInputs::within(&LIMITS) };
            let top = MoveSuperimposedInputs { velocity_diff: 0.4, acceleration: 2.1, deceleration: 2.1, ..top };
            let top = MoveSuperimposedInputs { jerk: Some(20.0), snap: Some(400.0), ..top };
            for k in 0..3000 {
                let factors = SetOverrideInputs { enable: k >= cycle, jerk_factor, ..SetOverrideInputs::default() };
                bench.cycle(|axis| {
                    run.step(axis, &below);
                    assert!(!on_top.step(axis, &top).error);
                    assert!(!slow.step(axis, &factors).error);
                });
                watch.see(&bench);
            }
            let [velocity, acceleration, jerk] = watch.most;
            assert!(velocity <= 1.0 + 1e-9 && acceleration <= 5.0 * (1.0 + 1e-9), "{:?}", watch.most);
            assert!(jerk <= LIMITS.jerk * (1.0 + 1e-6), "from cycle {cycle} on: {jerk} m/s³");
            most = most.max(jerk);
        }
    }
    assert!(most > 41.0, "the axis was never asked for more than both commands: {most}");
}

/// A block that is not called is an error of the program; the axis brakes from its present state in the same cycle.
#[test]
fn a_table_that_is_not_called_repeats_no_setpoint() {
    let (mut bench, mut block, mut watch) =
        (Bench::standstill(), VelocityProfile::new([Pair::default(); 1]), Watch::default());
    for cycle in 0..1500 {
        bench.cycle(|axis| {
            if cycle < 143 {
                block.step(axis, &along_steep());
            }
        });
        watch.see(&bench);
        assert_eq!(bench.axis.state() == AxisState::ErrorStop, cycle >= 143, "{cycle}");
    }
    assert!(bench.axis.commanded().v.abs() < 1e-15);
    // MC_Power is still evaluated while the axis stands.
    assert!(bench.cycle(|axis| Power.step(axis, &PowerInputs { enable: true, ..PowerInputs::default() })).status);
}
