//! Into each state, and each block executed there.
use crate::bench::{Bench, LIMITS};
use servobench_fieldbus::Fault;
use servobench_plcopen::{
    AxisState, BlockName, ErrorId, FunctionBlock, Halt, HaltInputs, Home, HomeInputs, MoveAbsolute, MoveAbsoluteInputs,
    MoveAdditive, MoveAdditiveInputs, MoveContinuousAbsolute, MoveContinuousAbsoluteInputs, MoveRelative,
    MoveRelativeInputs, MoveSuperimposed, MoveSuperimposedInputs, MoveVelocity, MoveVelocityInputs, Outputs, Reset,
    ResetInputs, Stop, StopInputs, TorqueControl, TorqueControlInputs,
};

/// An axis that a program has led to `state`; in motion where the state has one.
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

/// The blocks whose course is a table; they are tested with their tables.
pub(crate) fn is_a_profile(block: BlockName) -> bool {
    matches!(block, BlockName::PositionProfile | BlockName::VelocityProfile | BlockName::AccelerationProfile)
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
        BlockName::TorqueControl => call::<TorqueControl>(
            bench,
            &TorqueControlInputs { execute, torque: 0.2, ..TorqueControlInputs::within(&limits) },
        ),
        _ => unreachable!("{block} is no command"),
    }
}

fn call<B: FunctionBlock + Default>(bench: &mut Bench, inputs: &B::Inputs) -> Result<(), ErrorId> {
    let mut block = B::default();
    let outputs = bench.cycle(|axis| block.step(axis, inputs));
    let place = B::Outputs::NAMES.iter().position(|name| *name == "Error").unwrap();
    let mut values = Vec::new();
    outputs.each(|value| values.push(value));
    assert_eq!(values.len(), B::Outputs::NAMES.len());
    let id = block.error().map(servobench_plcopen::BlockError::id);
    assert_eq!(values[place] > 0.0, id.is_some());
    id.map_or(Ok(()), Err)
}
