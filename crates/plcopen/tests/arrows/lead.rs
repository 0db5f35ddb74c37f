//! Leads an axis into each state and executes each block there.
use crate::bench::{Bench, LIMITS};
use servobench_fieldbus::Fault;
use servobench_motion::pvt::Knot;
use servobench_plcopen::{
    AccelerationProfile, AccelerationProfileInputs, AxisMove, AxisMoveInputs, AxisState, BlockName, ErrorId,
    FinishHoming, FinishHomingInputs, FunctionBlock, Halt, HaltInputs, Home, HomeAbsolute, HomeAbsoluteInputs,
    HomeDirect, HomeDirectInputs, HomeInputs, MoveAbsolute, MoveAbsoluteInputs, MoveAdditive, MoveAdditiveInputs,
    MoveContinuousAbsolute, MoveContinuousAbsoluteInputs, MoveContinuousRelative, MoveContinuousRelativeInputs,
    MoveRelative, MoveRelativeInputs, MoveSuperimposed, MoveSuperimposedInputs, MoveVelocity, MoveVelocityInputs,
    Output, Outputs, Pair, PositionProfile, PositionProfileInputs, Profile4th, Profile4thInputs, Reset, ResetInputs,
    StepBlock, StepBlockInputs, Stop, StopInputs, TimePosition, TorqueControl, TorqueControlInputs, VelocityProfile,
    VelocityProfileInputs,
};

/// An axis that a program has led to `state`, in motion if the state has one.
pub(crate) fn led_to(state: AxisState) -> Bench {
    let mut bench = match state {
        AxisState::Disabled => Bench::disabled(Bench::params()),
        _ => Bench::standstill(),
    };
    let block = match state {
        AxisState::Disabled | AxisState::Standstill | AxisState::ErrorStop => None,
        AxisState::Homing => Some(BlockName::Home),
        AxisState::DiscreteMotion => Some(BlockName::MoveAbsolute),
        AxisState::ContinuousMotion => Some(BlockName::MoveVelocity),
        AxisState::Stopping => Some(BlockName::Stop),
    };
    if let Some(block) = block {
        execute(&mut bench, block).unwrap();
    }
    for _ in 0..200 {
        bench.cycle(|_| ());
    }
    if state == AxisState::ErrorStop {
        bench.feedback.fault = Some(Fault::Drive(0x7305));
        bench.cycle(|_| ());
    }
    assert_eq!(bench.axis.state(), state);
    bench
}

/// One call of a new instance of `block` with Execute; its ErrorID.
pub(crate) fn execute(bench: &mut Bench, block: BlockName) -> Result<(), ErrorId> {
    let (execute, half) = (true, 0.5 * LIMITS.velocity);
    let limits = servobench_motion::Limits { acceleration: 2.0, jerk: 20.0, snap: 500.0, ..LIMITS };
    match block {
        BlockName::Home => call::<Home>(bench, &HomeInputs { execute, position: 1.5, ..HomeInputs::default() }),
        BlockName::Stop => call::<Stop>(bench, &StopInputs { execute, ..StopInputs::within(&limits) }),
        BlockName::Halt => call::<Halt>(bench, &HaltInputs { execute, ..HaltInputs::within(&limits) }),
        BlockName::Reset => call::<Reset>(bench, &ResetInputs { execute }),
        BlockName::MoveAbsolute => {
            let inputs =
                MoveAbsoluteInputs { execute, position: 0.5, velocity: half, ..MoveAbsoluteInputs::within(&limits) };
            call::<MoveAbsolute>(bench, &inputs)
        }
        BlockName::MoveRelative => call::<MoveRelative>(
            bench,
            &MoveRelativeInputs { execute, distance: 0.5, ..MoveRelativeInputs::within(&limits) },
        ),
        BlockName::MoveAdditive => call::<MoveAdditive>(
            bench,
            &MoveAdditiveInputs { execute, distance: 0.5, ..MoveAdditiveInputs::within(&limits) },
        ),
        BlockName::MoveSuperimposed => {
            let inputs = MoveSuperimposedInputs { execute, distance: 0.1, ..MoveSuperimposedInputs::within(&limits) };
            call::<MoveSuperimposed>(bench, &MoveSuperimposedInputs { velocity_diff: 0.1, ..inputs })
        }
        BlockName::MoveVelocity => {
            let inputs = MoveVelocityInputs { execute, velocity: half, ..MoveVelocityInputs::within(&limits) };
            call::<MoveVelocity>(bench, &inputs)
        }
        BlockName::MoveContinuousAbsolute => {
            let inputs = MoveContinuousAbsoluteInputs::within(&limits);
            let inputs = MoveContinuousAbsoluteInputs { execute, position: 0.6, end_velocity: 0.1, ..inputs };
            call::<MoveContinuousAbsolute>(bench, &inputs)
        }
        BlockName::MoveContinuousRelative => {
            let inputs = MoveContinuousRelativeInputs::within(&limits);
            let inputs = MoveContinuousRelativeInputs { execute, distance: 0.4, end_velocity: 0.1, ..inputs };
            call::<MoveContinuousRelative>(bench, &inputs)
        }
        BlockName::HomeDirect => {
            call::<HomeDirect>(bench, &HomeDirectInputs { execute, position: 1.5, ..HomeDirectInputs::default() })
        }
        BlockName::HomeAbsolute => {
            call::<HomeAbsolute>(bench, &HomeAbsoluteInputs { execute, ..HomeAbsoluteInputs::default() })
        }
        BlockName::StepBlock => {
            call::<StepBlock>(bench, &StepBlockInputs { execute, ..StepBlockInputs::pushing(0.2, &limits) })
        }
        BlockName::FinishHoming => call::<FinishHoming>(
            bench,
            &FinishHomingInputs { execute, distance: -0.1, ..FinishHomingInputs::within(&limits) },
        ),
        BlockName::TorqueControl => call::<TorqueControl>(
            bench,
            &TorqueControlInputs { execute, torque: 0.2, ..TorqueControlInputs::within(&limits) },
        ),
        BlockName::PositionProfile => {
            let pairs = [Pair { delta_time: 0.5, value: 0.15 }, Pair { delta_time: 0.5, value: 0.3 }];
            let time_position = TimePosition { pairs: &pairs, is_absolute: false };
            let inputs = PositionProfileInputs { execute, time_position, ..PositionProfileInputs::along(&pairs) };
            call_of(PositionProfile::new([Knot::default(); 3], [0.0; 3]), bench, &inputs)
        }
        BlockName::VelocityProfile => {
            let pairs = [Pair { delta_time: 0.2, value: 0.4 }];
            let inputs = VelocityProfileInputs { execute, ..VelocityProfileInputs::along(&pairs) };
            call_of(VelocityProfile::new([Pair::default(); 1]), bench, &inputs)
        }
        BlockName::AccelerationProfile => {
            let pairs = [Pair { delta_time: 0.1, value: 0.0 }];
            let inputs = AccelerationProfileInputs { execute, ..AccelerationProfileInputs::along(&pairs) };
            call_of(AccelerationProfile::new([Pair::default(); 1]), bench, &inputs)
        }
        BlockName::Profile4th => {
            call::<Profile4th>(bench, &Profile4thInputs { enable: execute, ..Profile4thInputs::to(0.2, limits) })
        }
        BlockName::AxisMove => call::<AxisMove>(bench, &AxisMoveInputs { execute, ..AxisMoveInputs::to(0.2, &limits) }),
        _ => unreachable!("{block} is no command"),
    }
}

fn call<B: FunctionBlock + Default>(bench: &mut Bench, inputs: &B::Inputs<'_>) -> Result<(), ErrorId> {
    call_of(B::default(), bench, inputs)
}

fn call_of<B: FunctionBlock>(mut block: B, bench: &mut Bench, inputs: &B::Inputs<'_>) -> Result<(), ErrorId> {
    let outputs = bench.cycle(|axis| block.step(axis, inputs));
    let place =
        B::Outputs::LIST.iter().position(|output| matches!(output, Output::Error | Output::MoveFailed)).unwrap();
    let mut values = Vec::new();
    outputs.each(|value| values.push(value));
    assert_eq!(values.len(), B::Outputs::LIST.len());
    let id = block.error().map(servobench_plcopen::BlockError::id);
    assert_eq!(values[place] > 0.0, id.is_some());
    id.map_or(Ok(()), Err)
}
