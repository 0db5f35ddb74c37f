//! The power state machine of the drive (IEC 61800-7-201): at most one transition per step.
//!
//! Order of precedence: a fault (13) comes before everything else. No two other transitions can be due at once, because the commands of one
//! state have different bits.
//!
//! While the drive is not remote, the last controlword that was processed keeps its effect.
//!
//! A stop by Shutdown or Disable operation brakes in Operation enabled; the transition is taken at standstill. If the master withdraws the
//! command before, the axis follows its set-points again.
use crate::controlword::{Command, ControlBit, Controlword};
use crate::option_code::{
    Deceleration, DisableOperationOption, FaultReactionOption, HaltOption, QuickStopOption, ShutdownOption,
};
use crate::state::PowerState;
use crate::statusword::{StatusBit, Statusword};
use crate::transitions::{Cause, Causes, Transition, set_off};
use servobench_base::Stateful;

/// Option codes of a drive; [`Default`] has the defaults of the profile.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PowerParams {
    /// 605Ah.
    pub quick_stop: QuickStopOption,
    /// 605Bh.
    pub shutdown: ShutdownOption,
    /// 605Ch.
    pub disable_operation: DisableOperationOption,
    /// 605Dh.
    pub halt: HaltOption,
    /// 605Eh.
    pub fault_reaction: FaultReactionOption,
}

/// State of the machine from step to step; [`Default`] is the drive after power-on (transition 0).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub struct PowerMemory {
    /// State of the drive.
    state: PowerState,
    /// Last processed controlword.
    controlword: Controlword,
    /// True if the axis was powered before the last transition: the fault reaction does not power an unpowered one.
    was_powered: bool,
}

impl PowerMemory {
    /// State of the drive.
    #[must_use]
    pub const fn state(&self) -> PowerState {
        self.state
    }
}

/// Inputs from the drive at a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a separate signal, and most are bits of the statusword")]
pub struct PowerInputs {
    /// The self-test is over.
    pub initialised: bool,
    /// A fault is present.
    pub fault: bool,
    /// The axis stands still: braking is over.
    pub standstill: bool,
    /// The controlword is processed (bit 9).
    pub remote: bool,
    /// The high-level power is applied (bit 4).
    pub main_voltage: bool,
    /// A warning is present (bit 7).
    pub warning: bool,
    /// The mode of operation reports that the target is reached (bit 10).
    pub target_reached: bool,
    /// A limit of the drive is active (bit 11).
    pub internal_limit: bool,
}

/// Use of the power stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DriveFunction {
    /// None: the motor carries no current.
    Disabled,
    /// The axis follows the set-points of the mode of operation.
    Follow,
    /// The axis brakes and is held at standstill.
    Brake(Deceleration),
}

/// Outputs of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PowerOutputs {
    /// Word for the master (6041h), with the state after the step.
    pub statusword: Statusword,
    /// Use of the power stage from now on.
    pub drive: DriveFunction,
    /// Transition that was taken.
    pub transition: Option<&'static Transition>,
}

/// Takes the pending transition, if any.
#[inline]
pub fn step(
    params: &PowerParams,
    memory: &mut PowerMemory,
    controlword: Controlword,
    inputs: PowerInputs,
) -> PowerOutputs {
    let was_powered = drive_function(params, *memory) != DriveFunction::Disabled;
    let before = memory.controlword;
    if inputs.remote {
        memory.controlword = controlword;
    }
    let resets = memory.controlword.gives(Command::FaultReset) && !before.gives(Command::FaultReset);
    let moment = Moment { params, memory: *memory, inputs };
    let transition = moment.due(moment.given(resets));
    if let Some(transition) = transition {
        memory.state = transition.to;
        memory.was_powered = was_powered;
    }
    PowerOutputs { statusword: statusword(memory.state, inputs), drive: drive_function(params, *memory), transition }
}

/// Everything that determines the pending transition.
struct Moment<'a> {
    params: &'a PowerParams,
    memory: PowerMemory,
    inputs: PowerInputs,
}

impl Moment<'_> {
    /// Causes that are present; a fault reset is one when its bit has risen.
    #[inline]
    fn given(&self, resets: bool) -> Causes {
        let quick_stop = self.params.quick_stop;
        let reaction = self.params.fault_reaction.deceleration();
        Causes::of(self.memory.controlword)
            .without(Cause::Command(Command::FaultReset))
            .with(Cause::Command(Command::FaultReset), resets)
            .with(Cause::Initialised, self.inputs.initialised)
            .with(Cause::QuickStopCompleted, !quick_stop.stays() && self.has_stopped(quick_stop.deceleration()))
            .with(Cause::Fault, self.inputs.fault)
            .with(Cause::FaultReactionCompleted, !self.memory.was_powered || self.has_stopped(reaction))
    }

    /// Transition to be taken.
    #[inline]
    fn due(&self, given: Causes) -> Option<&'static Transition> {
        let fault = Causes::NONE.with(Cause::Fault, self.inputs.fault);
        set_off(self.memory.state, fault)
            .next()
            .or_else(|| set_off(self.memory.state, given).find(|transition| self.is_allowed(transition.number)))
    }

    /// Checks the column "condition" of the table.
    fn is_allowed(&self, number: u8) -> bool {
        match number {
            5 => self.has_stopped(self.params.disable_operation.deceleration()),
            8 => self.has_stopped(self.params.shutdown.deceleration()),
            15 => !self.inputs.fault,
            16 => self.params.quick_stop.stays(),
            _ => true,
        }
    }

    /// True if braking is over; a stop by switching off is not awaited.
    fn has_stopped(&self, deceleration: Option<Deceleration>) -> bool {
        deceleration.is_none() || self.inputs.standstill
    }
}

#[inline]
fn statusword(state: PowerState, inputs: PowerInputs) -> Statusword {
    Statusword::of(state)
        .with(StatusBit::VoltageEnabled, inputs.main_voltage)
        .with(StatusBit::Warning, inputs.warning)
        .with(StatusBit::Remote, inputs.remote)
        .with(StatusBit::TargetReached, inputs.target_reached)
        .with(StatusBit::InternalLimitActive, inputs.internal_limit)
}

#[inline]
fn drive_function(params: &PowerParams, memory: PowerMemory) -> DriveFunction {
    let brake = |deceleration: Option<_>| deceleration.map_or(DriveFunction::Disabled, DriveFunction::Brake);
    match memory.state {
        PowerState::OperationEnabled if memory.controlword.gives(Command::Shutdown) => {
            brake(params.shutdown.deceleration())
        }
        PowerState::OperationEnabled if memory.controlword.gives(Command::DisableOperation) => {
            brake(params.disable_operation.deceleration())
        }
        PowerState::OperationEnabled if memory.controlword.has(ControlBit::Halt) => brake(params.halt.deceleration()),
        PowerState::OperationEnabled => DriveFunction::Follow,
        PowerState::QuickStopActive => brake(params.quick_stop.deceleration()),
        PowerState::FaultReactionActive if memory.was_powered => brake(params.fault_reaction.deceleration()),
        _ => DriveFunction::Disabled,
    }
}
