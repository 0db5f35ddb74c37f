//! Parameters that blocks read and write, and the supervision of the axis by them.
use crate::bench::{Bench, LIMITS};
use crate::calls::{at, running, to};
use servobench_config::Choice as _;
use servobench_plcopen::{
    Axis, AxisBoolParameter, AxisParameter, AxisState, ErrorId, FunctionBlock, MoveAbsolute, MoveRelative,
    MoveRelativeInputs, MoveSuperimposed, MoveSuperimposedInputs, MoveVelocity, ReadBoolParameter,
    ReadBoolParameterInputs, ReadParameter, ReadParameterInputs, WriteBoolParameter, WriteBoolParameterInputs,
    WriteParameter, WriteParameterInputs,
};

fn read(axis: &mut Axis, parameter: AxisParameter) -> f64 {
    let outputs = ReadParameter.step(axis, &ReadParameterInputs { enable: true, parameter });
    assert!(outputs.valid && outputs.busy && !outputs.error);
    outputs.value
}

fn write(axis: &mut Axis, parameter: AxisParameter, value: f64) -> Result<(), String> {
    let mut block = WriteParameter::default();
    let outputs = block.step(axis, &WriteParameterInputs { execute: true, parameter, value });
    assert!(outputs.done != outputs.error);
    block.error().map_or(Ok(()), |error| Err(error.to_string()))
}

fn switch(axis: &mut Axis, parameter: AxisBoolParameter, value: bool) {
    let inputs = WriteBoolParameterInputs { execute: true, parameter, value };
    assert!(WriteBoolParameter::default().step(axis, &inputs).done);
    let outputs = ReadBoolParameter.step(axis, &ReadBoolParameterInputs { enable: true, parameter });
    assert_eq!((outputs.valid, outputs.value), (true, value));
}

#[test]
fn the_parameters_are_those_of_the_axis() {
    let mut bench = Bench::standstill();
    let mut run = MoveVelocity::default();
    for _ in 0..137 {
        bench.cycle(|axis| run.step(axis, &running(0.4)));
    }
    let (commanded, measured) = (bench.axis.commanded(), bench.feedback.velocity);
    bench.cycle(|axis| {
        let now = axis.commanded();
        assert!(now.x > commanded.x);
        for (parameter, value) in [
            (AxisParameter::CommandedPosition, now.x),
            (AxisParameter::CommandedVelocity, now.v),
            (AxisParameter::ActualVelocity, measured),
            (AxisParameter::MaxVelocitySystem, LIMITS.velocity),
            (AxisParameter::MaxVelocity, LIMITS.velocity),
            (AxisParameter::MaxAccelerationSystem, LIMITS.acceleration),
            (AxisParameter::MaxDeceleration, LIMITS.acceleration),
            (AxisParameter::MaxJerkSystem, LIMITS.jerk),
            (AxisParameter::MaxJerk, LIMITS.jerk),
            (AxisParameter::PositiveLimit, f64::INFINITY),
            (AxisParameter::MaxLag, f64::INFINITY),
        ] {
            assert_eq!(read(axis, parameter).to_bits(), value.to_bits(), "{parameter:?}");
        }
        let off = ReadParameter.step(axis, &ReadParameterInputs { enable: false, parameter: AxisParameter::MaxJerk });
        assert!(!off.valid && off.value.to_bits() == 0);
    });
}

/// A written limit is read back and bounds the following commands, but not the system limit; it is refused in motion.
#[test]
fn limits_are_lowered_at_rest() {
    let mut bench = Bench::standstill();
    bench.cycle(|axis| {
        write(axis, AxisParameter::MaxVelocity, 0.3).unwrap();
        let limits =
            [AxisParameter::MaxVelocity, AxisParameter::MaxVelocitySystem].map(|limit| read(axis, limit).to_bits());
        assert_eq!(limits, [0.3, LIMITS.velocity].map(f64::to_bits));
        assert_eq!(
            write(axis, AxisParameter::MaxAcceleration, 5.1).unwrap_err(),
            "MC_WriteParameter: `Value` must be at most 5, the limit of the axis, got 5.1: lower it or raise the limit"
        );
        assert_eq!(
            write(axis, AxisParameter::ActualVelocity, 0.1).unwrap_err(),
            "MC_WriteParameter: `ParameterNumber` \"actual-velocity\" is read-only: write one that is not"
        );
    });
    let outputs = bench.cycle(|axis| MoveVelocity::default().step(axis, &running(0.31)));
    assert_eq!(outputs.error_id, ErrorId::AboveLimit);
    let mut run = MoveVelocity::default();
    assert!(!bench.cycle(|axis| run.step(axis, &running(0.3))).error);
    let refused = bench.cycle(|axis| write(axis, AxisParameter::MaxVelocity, 1.0)).unwrap_err();
    assert!(refused.starts_with("MC_WriteParameter: the state of the axis, ContinuousMotion"), "{refused}");
}

/// A target beyond a software limit is refused, one at it is not, and the way back from beyond it is free.
#[test]
fn software_limits_bound_targets() {
    let mut bench = Bench::standstill();
    bench.cycle(|axis| {
        write(axis, AxisParameter::PositiveLimit, 0.3).unwrap();
        assert!(write(axis, AxisParameter::NegativeLimit, 0.3).unwrap_err().contains("SWLimitNeg is below SWLimitPos"));
    });
    // It does not hold yet.
    let (mut go, mut beyond) = (MoveAbsolute::default(), MoveAbsolute::default());
    bench.cycle(|axis| go.step(axis, &to(0.4)));
    bench.until(AxisState::Standstill);
    bench.cycle(|axis| switch(axis, AxisBoolParameter::EnablePositiveLimit, true));
    let outputs = bench.cycle(|axis| beyond.step(axis, &to(0.35)));
    assert_eq!(outputs.error_id, ErrorId::SoftwareLimit);
    assert_eq!(
        beyond.error().unwrap().to_string(),
        "MC_MoveAbsolute: leads to 0.35, beyond the software limit 0.3 of the axis: correct the target or write the \
         parameter SWLimitPos or SWLimitNeg"
    );
    let mut back = MoveAbsolute::default();
    assert!(!bench.cycle(|axis| back.step(axis, &to(0.3))).error);
    bench.until(AxisState::Standstill);
    at(&bench, 0.3);
    let inputs = MoveRelativeInputs { execute: true, distance: 1e-9, ..MoveRelativeInputs::within(&LIMITS) };
    let outputs = bench.cycle(|axis| MoveRelative::default().step(axis, &inputs));
    assert_eq!(outputs.error_id, ErrorId::SoftwareLimit);
}

/// A motion without a target stops with an error, within the limit and less than the distance of two cycles before it.
#[test]
fn endless_motion_stops_before_a_software_limit() {
    for (velocity, limit, parameter, enable) in [
        (0.731, 0.9, AxisParameter::PositiveLimit, AxisBoolParameter::EnablePositiveLimit),
        (-0.412, -0.55, AxisParameter::NegativeLimit, AxisBoolParameter::EnableNegativeLimit),
    ] {
        let (mut bench, mut run) = (Bench::standstill(), MoveVelocity::default());
        bench.cycle(|axis| {
            write(axis, parameter, limit).unwrap();
            switch(axis, enable, true);
        });
        bench.cycle(|axis| run.step(axis, &running(velocity)));
        bench.until(AxisState::ErrorStop);
        assert_eq!(bench.axis.error().unwrap().id(), ErrorId::SoftwareLimitPassed);
        for _ in 0..2000 {
            bench.cycle(|_| ());
        }
        let left = (limit - bench.axis.commanded().x) * f64::signum(velocity);
        // The distance of two cycles at most.
        assert!((0.0..2.0 * velocity.abs() * 1e-3).contains(&left), "{left}");
        assert_eq!(bench.axis.commanded().v.to_bits() << 1, 0);
    }
}

/// The sum of a move to a target and a superimposed motion has no target.
#[test]
fn a_superimposed_move_stops_before_a_software_limit() {
    let (mut bench, mut go, mut on_top) = (Bench::standstill(), MoveAbsolute::default(), MoveSuperimposed::default());
    let half = servobench_motion::Limits { velocity: 0.5, acceleration: 2.0, jerk: 20.0, snap: 500.0 };
    bench.cycle(|axis| {
        write(axis, AxisParameter::PositiveLimit, 0.5).unwrap();
        switch(axis, AxisBoolParameter::EnablePositiveLimit, true);
    });
    let below = servobench_plcopen::MoveAbsoluteInputs {
        execute: true,
        position: 0.45,
        ..servobench_plcopen::MoveAbsoluteInputs::within(&half)
    };
    let top = MoveSuperimposedInputs { execute: true, distance: 0.3, ..MoveSuperimposedInputs::within(&half) };
    bench.cycle(|axis| (go.step(axis, &below), on_top.step(axis, &top)));
    bench.until(AxisState::ErrorStop);
    for _ in 0..2000 {
        bench.cycle(|_| ());
        assert!(bench.axis.commanded().x <= 0.5);
    }
}

#[test]
fn a_following_error_that_is_too_large_stops_the_axis() {
    let mut bench = Bench::standstill();
    bench.feedback.following_error = 0.002;
    bench.cycle(|axis| write(axis, AxisParameter::MaxLag, 0.0019).unwrap());
    bench.cycle(|_| ());
    assert_eq!(bench.axis.state(), AxisState::Standstill, "it is not monitored");
    bench.cycle(|axis| switch(axis, AxisBoolParameter::EnableLagMonitoring, true));
    bench.cycle(|_| ());
    assert_eq!(bench.axis.state(), AxisState::ErrorStop);
    assert_eq!(
        bench.axis.error().unwrap().to_string(),
        "the following error 0.002 is larger than MaxPositionLag, 0.0019: see what holds the axis, or raise the parameter"
    );
}

#[test]
fn each_parameter_has_a_name_of_its_own() {
    let names: Vec<_> = AxisParameter::ALL.iter().map(|(name, ..)| *name).collect();
    for (place, name) in names.iter().enumerate() {
        assert!(!names[..place].contains(name), "{name}");
    }
}
