//! `MC_ReadAxisInfo`: switches, power, reference and warnings of the axis.
use super::outputs::FunctionBlock;
use super::read::ReadInputs;
use crate::axis::Axis;
use crate::blocks::BlockName;
use crate::error::ErrorId;
use crate::interface::outputs;
use servobench_base::Stateful;
use servobench_fieldbus::{Fault, LinkFault, Power};

/// Reads the status of the axis apart from its motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub struct ReadAxisInfo;

outputs! {
    /// Outputs of [`ReadAxisInfo`].
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub struct ReadAxisInfoOutputs {
        /// Valid.
        valid: bool = Valid,
        /// Busy: same as Valid.
        busy: bool = Busy,
        /// Error: the block cannot fail.
        error: bool = Error,
        /// ErrorID.
        error_id: ErrorId = ErrorId,
        /// HomeAbsSwitch: the home switch is met.
        home_abs_switch: bool = HomeAbsSwitch,
        /// LimitSwitchPos: the switch of the positive end is met.
        limit_switch_pos: bool = LimitSwitchPos,
        /// LimitSwitchNeg: the switch of the negative end is met.
        limit_switch_neg: bool = LimitSwitchNeg,
        /// Simulation: the axis has no drive; always FALSE.
        simulation: bool = Simulation,
        /// CommunicationReady: the drive answers.
        communication_ready: bool = CommunicationReady,
        /// ReadyForPowerOn: neither drive nor link has a fault.
        ready_for_power_on: bool = ReadyForPowerOn,
        /// PowerOn: the motor is powered.
        power_on: bool = PowerOn,
        /// IsHomed: the position counts from the reference.
        is_homed: bool = IsHomed,
        /// AxisWarning: the drive warns (bit 7 of its statusword).
        axis_warning: bool = AxisWarning,
    }
}

impl FunctionBlock for ReadAxisInfo {
    const NAME: BlockName = BlockName::ReadAxisInfo;
    type Inputs<'i> = ReadInputs;
    type Outputs = ReadAxisInfoOutputs;

    #[inline]
    fn step(&mut self, axis: &mut Axis, inputs: &ReadInputs) -> ReadAxisInfoOutputs {
        if !inputs.enable {
            return ReadAxisInfoOutputs::default();
        }
        let told = axis.actual();
        ReadAxisInfoOutputs {
            valid: true,
            busy: true,
            error: false,
            error_id: ErrorId::None,
            home_abs_switch: told.switches.home,
            limit_switch_pos: told.switches.positive_limit,
            limit_switch_neg: told.switches.negative_limit,
            simulation: false,
            communication_ready: told.fault != Some(Fault::Link(LinkFault::DriveTimeout)),
            ready_for_power_on: told.fault.is_none(),
            power_on: told.power == Power::On,
            is_homed: axis.is_homed(),
            axis_warning: told.has_warning,
        }
    }
}
