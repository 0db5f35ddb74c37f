//! NaN and useless numbers as inputs: refused at the edge, and the axis stays where it is.
use crate::bench::{Bench, LIMITS};
use servobench_fieldbus::ProbeTrigger;
use servobench_plcopen::{
    Axis, AxisParameter, AxisState, BlockError, FunctionBlock, Halt, HaltInputs, HaltSuperimposed,
    HaltSuperimposedInputs, Home, HomeDirect, HomeDirectInputs, HomeInputs, MoveAbsolute, MoveAbsoluteInputs,
    MoveAdditive, MoveAdditiveInputs, MoveContinuousAbsolute, MoveContinuousAbsoluteInputs, MoveContinuousRelative,
    MoveContinuousRelativeInputs, MoveRelative, MoveRelativeInputs, MoveSuperimposed, MoveSuperimposedInputs,
    MoveVelocity, MoveVelocityInputs, SetOverride, SetOverrideInputs, SetPosition, SetPositionInputs, Stop, StopInputs,
    TorqueControl, TorqueControlInputs, TouchProbe, TouchProbeInputs, WriteParameter, WriteParameterInputs,
};

/// Error of a new block of the type `B` with `inputs`.
fn said<B: FunctionBlock + Default>(axis: &mut Axis, inputs: &B::Inputs<'_>) -> Option<BlockError> {
    let mut block = B::default();
    block.step(axis, inputs);
    block.error().copied()
}

/// Calls with `$value` at each input `$input` of a block in turn, and valid values at the others.
macro_rules! calls {
    ($value:expr, $($block:ty, $inputs:expr => $($input:ident)*;)*) => {
        vec![$($(
            (
                concat!(stringify!($block), ".", stringify!($input)),
                Box::new(move |axis: &mut Axis| {
                    let mut inputs = $inputs;
                    inputs.$input = $value.into();
                    said::<$block>(axis, &inputs)
                }) as Box<dyn Fn(&mut Axis) -> Option<BlockError>>,
            ),
        )*)*]
    };
}

#[test]
fn what_is_no_number_is_refused() {
    let execute = true;
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1e300, 1e300] {
        let calls = calls! { value,
            MoveAbsolute, MoveAbsoluteInputs { execute, position: 0.2, ..MoveAbsoluteInputs::within(&LIMITS) } =>
                position velocity acceleration deceleration jerk snap;
            MoveRelative, MoveRelativeInputs { execute, distance: 0.2, ..MoveRelativeInputs::within(&LIMITS) } =>
                distance velocity acceleration deceleration jerk snap;
            MoveAdditive, MoveAdditiveInputs { execute, distance: 0.2, ..MoveAdditiveInputs::within(&LIMITS) } =>
                distance velocity acceleration deceleration jerk snap;
            MoveSuperimposed, MoveSuperimposedInputs { execute, distance: 0.2, ..MoveSuperimposedInputs::within(&LIMITS) } =>
                distance velocity_diff acceleration deceleration jerk snap;
            MoveVelocity, MoveVelocityInputs { execute, ..MoveVelocityInputs::within(&LIMITS) } =>
                velocity acceleration deceleration jerk snap;
            MoveContinuousAbsolute, MoveContinuousAbsoluteInputs {
                execute, position: 0.2, end_velocity: 0.1, ..MoveContinuousAbsoluteInputs::within(&LIMITS)
            } => position end_velocity velocity acceleration deceleration jerk snap;
            MoveContinuousRelative, MoveContinuousRelativeInputs {
                execute, distance: 0.2, end_velocity: 0.1, ..MoveContinuousRelativeInputs::within(&LIMITS)
            } => distance end_velocity velocity acceleration deceleration jerk snap;
            HaltSuperimposed, HaltSuperimposedInputs { execute, deceleration: 1.0, jerk: None, snap: None } =>
                deceleration jerk snap;
            HomeDirect, HomeDirectInputs { execute, ..HomeDirectInputs::default() } => position;
            WriteParameter, WriteParameterInputs { execute, parameter: AxisParameter::MaxVelocity, value: 0.5 } => value;
            WriteParameter, WriteParameterInputs { execute, parameter: AxisParameter::PositiveLimit, value: 0.5 } => value;
            TouchProbe, TouchProbeInputs {
                execute, trigger: ProbeTrigger::IndexPulse, first_position: None, last_position: None
            } => first_position last_position;
            TorqueControl, TorqueControlInputs { execute, torque: 0.2, ..TorqueControlInputs::within(&LIMITS) } => torque velocity;
            Halt, HaltInputs { execute, ..HaltInputs::within(&LIMITS) } => deceleration jerk snap;
            Stop, StopInputs { execute, ..StopInputs::within(&LIMITS) } => deceleration jerk snap;
            Home, HomeInputs { execute, ..HomeInputs::default() } => position;
            SetPosition, SetPositionInputs { execute, position: 0.0, relative: false } => position;
            SetOverride, SetOverrideInputs { enable: true, ..SetOverrideInputs::default() } => vel_factor acc_factor jerk_factor;
        };
        for (input, call) in calls {
            let mut bench = Bench::standstill();
            let error = bench.cycle(|axis| call(axis)).unwrap_or_else(|| panic!("{input} takes {value}"));
            let text = error.to_string();
            assert!(text.contains(&value.to_string()), "{input}: {text}");
            assert_eq!(bench.axis.state(), AxisState::Standstill, "{input} at {value}");
        }
    }
}

/// An infinite ramp is a step, as documented; NaN is not a ramp.
#[test]
fn a_torque_ramp_is_a_number_or_without_bound() {
    for (torque_ramp, is_taken) in [(f64::INFINITY, true), (0.3, true), (f64::NAN, false), (0.0, false), (-2.0, false)]
    {
        let inputs = TorqueControlInputs { execute: true, torque_ramp, ..TorqueControlInputs::within(&LIMITS) };
        let mut bench = Bench::standstill();
        assert_eq!(bench.cycle(|axis| said::<TorqueControl>(axis, &inputs)).is_none(), is_taken, "{torque_ramp}");
    }
}
