//! The power state machine of the drive (IEC 61800-7-201): one transition per step at most.
//!
//! Order of precedence: a fault (13) goes before everything else. No two other transitions can be due at once, because
//! the commands of one state have different bits.
//!
//! While the drive is not remote, the last controlword that was processed keeps its effect.
//!
//! A stop that Shutdown or Disable operation asks for brakes in Operation enabled; the transition is taken at
//! standstill. A master that takes the command back before has the axis follow its set-points again.
use crate::controlword::{Command, ControlBit, Controlword};
use crate::option_code::{
    Deceleration, DisableOperationOption, FaultReactionOption, HaltOption, QuickStopOption, ShutdownOption,
};
use crate::state::PowerState;
use crate::statusword::{StatusBit, Statusword};
use crate::transitions::{Cause, Causes, Transition, set_off};
use servobench_base::Stateful;

/// The option codes of a drive; those of [`Default`] are the profile's.
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

/// What the machine remembers from step to step; [`Default`] is the drive after power-on (transition 0).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub struct PowerMemory {
    /// State of the drive.
    state: PowerState,
    /// Last controlword that was processed.
    controlword: Controlword,
    /// Whether the axis was powered before the last transition: the fault reaction does not power one that was not.
    was_powered: bool,
}

impl PowerMemory {
    /// State of the drive.
    #[must_use]
    pub const fn state(&self) -> PowerState {
        self.state
    }
}

/// What the drive knows of itself at a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a signal of its own, and most are bits of the statusword")]
pub struct PowerInputs {
    /// The self-test is over.
    pub initialised: bool,
    /// A fault is present.
    pub fault: bool,
    /// The axis stands still: what is braked has stopped.
    pub standstill: bool,
    /// The controlword is processed (bit 9).
    pub remote: bool,
    /// The high-level power is applied (bit 4).
    pub main_voltage: bool,
    /// A warning is present (bit 7).
    pub warning: bool,
    /// The mode of operation says that the target is reached (bit 10).
    pub target_reached: bool,
    /// The drive limits something (bit 11).
    pub internal_limit: bool,
}

/// What the power stage is used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DriveFunction {
    /// For nothing: the motor carries no current.
    Disabled,
    /// The axis follows the set-points of the mode of operation.
    Follow,
    /// The axis brakes and is held at standstill.
    Brake(Deceleration),
}

/// What a step says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PowerOutputs {
    /// Word for the master (6041h), with the state after the step.
    pub statusword: Statusword,
    /// What the power stage is used for from now on.
    pub drive: DriveFunction,
    /// Transition that was taken.
    pub transition: Option<&'static Transition>,
}

/// Takes the transition that is due, if any.
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

/// All that decides what is due.
struct Moment<'a> {
    params: &'a PowerParams,
    memory: PowerMemory,
    inputs: PowerInputs,
}

impl Moment<'_> {
    /// What could set a transition off; a fault reset does when its bit has risen.
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

    /// The transition to be taken.
    #[inline]
    fn due(&self, given: Causes) -> Option<&'static Transition> {
        let fault = Causes::NONE.with(Cause::Fault, self.inputs.fault);
        set_off(self.memory.state, fault)
            .next()
            .or_else(|| set_off(self.memory.state, given).find(|transition| self.is_allowed(transition.number)))
    }

    /// The column "condition" of the table.
    fn is_allowed(&self, number: u8) -> bool {
        match number {
            5 => self.has_stopped(self.params.disable_operation.deceleration()),
            8 => self.has_stopped(self.params.shutdown.deceleration()),
            15 => !self.inputs.fault,
            16 => self.params.quick_stop.stays(),
            _ => true,
        }
    }

    /// Whether nothing is left to brake: what is switched off at once is not waited for.
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
