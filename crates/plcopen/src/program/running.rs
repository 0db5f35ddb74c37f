//! A call in a run: its execution and its result.
use super::condition::{Condition, Situation};
use super::executor::Listener;
use super::instance::Instance;
use super::motion_tracker::{Motion, MotionTracker};
use super::{Call, Inputs, Update};
use crate::axis::Axis;
use crate::blocks::{BlockName, Output};
use crate::interface::Trigger;
use alloc::boxed::Box;
use alloc::string::{String, ToString as _};
use alloc::vec::Vec;
use alloc::{format, vec};
use servobench_base::{Ending, Setpoint, Stateful};
use thiserror::Error;

/// Outputs that report success of a block; of several outputs of a block, the first one counts.
const AIMS: [Output; 9] = [
    Output::Done,
    Output::ProcessComplete,
    Output::InVelocity,
    Output::InEndVelocity,
    Output::InTorque,
    Output::ProfileCompleted,
    Output::Status,
    Output::Enabled,
    Output::Valid,
];

/// Outputs that report that a block controls the axis, that it has an error, and that its command has ended.
const ACTIVE: [Output; 2] = [Output::Active, Output::MoveActive];
const WRONG: [Output; 2] = [Output::Error, Output::MoveFailed];
const ENDED: [Output; 2] = [Output::Done, Output::ProcessComplete];

/// Result of a call.
#[derive(Debug, Clone, PartialEq)]
pub enum Fate {
    /// The call reported success, or another command took the axis.
    Executed,
    /// The call ended in Error.
    Failed {
        /// Time (s).
        time: f64,
        /// ErrorID.
        id: u16,
        /// Error message.
        message: String,
    },
    /// The `start` of the call never held: the condition, in words.
    NeverExecuted(String),
    /// This output, which reports success, did not become TRUE.
    Unfinished(Output),
}

/// A call waited longer than its timeout.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{waiting} within {timeout} s")]
pub struct Overdue {
    /// The call and its condition, in words.
    pub waiting: String,
    /// Timeout (s).
    pub timeout: f64,
}

/// A call in a run.
#[expect(clippy::struct_excessive_bools, reason = "each is a state that a cycle asks for, and they are independent")]
#[derive(Debug, Stateful)]
pub(super) struct RunningCall {
    /// Index in the program.
    #[state(constant)]
    index: usize,
    #[state(constant)]
    pub(super) name: String,
    /// Unit of positions, for messages.
    #[state(constant)]
    unit: &'static str,
    #[state(constant)]
    block: BlockName,
    instance: Box<dyn Instance>,
    #[state(constant)]
    start: Condition,
    #[state(constant)]
    stop: Option<Condition>,
    #[state(constant)]
    timeout: f64,
    /// Inputs of the first execution, and their updates.
    #[state(constant)]
    inputs: Inputs,
    #[state(constant)]
    updates: Vec<Update>,
    /// Updates so far.
    updated: usize,
    /// Time at which Execute or Enable became TRUE (s).
    started: Option<f64>,
    #[state(constant)]
    is_optional: bool,
    /// Time at which the call first ended in Error (s), ErrorID, and the error message.
    error: Option<(f64, u16, String)>,
    /// True if Execute or Enable became FALSE again.
    is_over: bool,
    trigger: bool,
    /// Last reported Execute or Enable.
    told: Option<bool>,
    has_ended: bool,
    /// Outputs in this cycle, and as last reported.
    values: Vec<f64>,
    told_values: Vec<f64>,
    motion: Option<MotionTracker>,
}

impl RunningCall {
    pub(super) fn new(index: usize, call: &Call, unit: &'static str) -> Self {
        let outputs = call.block.outputs().len();
        Self {
            index,
            name: call.name.clone(),
            unit,
            block: call.block,
            instance: call.block.instance(&call.inputs),
            start: call.start,
            stop: call.stop,
            timeout: call.timeout,
            inputs: call.inputs.clone(),
            updates: call.updates.clone(),
            updated: 0,
            started: None,
            is_optional: call.is_optional,
            error: None,
            is_over: false,
            trigger: false,
            told: None,
            has_ended: false,
            values: vec![0.0; outputs],
            told_values: vec![f64::NAN; outputs],
            motion: None,
        }
    }

    /// Executes one cycle.
    ///
    /// # Errors
    /// [`Overdue`] if `start` has not held within the timeout.
    pub(super) fn cycle(
        &mut self,
        situation: &mut Situation,
        names: &[String],
        axis: &mut Axis,
        listener: &mut impl Listener,
    ) -> Result<(), Overdue> {
        let t = situation.t;
        self.decide(situation);
        if self.started.is_none() && t > self.timeout {
            return Err(Overdue { waiting: self.waiting(names), timeout: self.timeout });
        }
        if self.told != Some(self.trigger) {
            self.told = Some(self.trigger);
            listener.on_trigger(t, self.index, self.trigger);
        }
        let last = self.updated.checked_sub(1).and_then(|last| self.updates.get(last));
        let inputs = last.map_or(&self.inputs, |update| &update.inputs);
        self.instance.step(axis, inputs, self.trigger, &mut self.values);
        for (place, output) in self.block.outputs().iter().enumerate() {
            self.tell(place, *output, situation, listener);
        }
        Ok(())
    }

    /// Updates Execute or Enable and the inputs for this cycle.
    fn decide(&mut self, situation: &Situation) {
        match self.started {
            None => {
                if situation.holds(self.start, 0.0) {
                    (self.started, self.trigger) = (Some(situation.t), true);
                }
            }
            Some(_) if self.is_over => {}
            Some(started) => {
                let stops = match self.stop {
                    Some(stop) => situation.holds(stop, started),
                    None => self.block.trigger() == Trigger::Execute && self.has_ended,
                };
                if stops {
                    (self.trigger, self.is_over) = (false, true);
                    return;
                }
                while self.updates.get(self.updated).is_some_and(|update| situation.holds(update.when, started)) {
                    self.updated += 1;
                }
            }
        }
    }

    /// Reports an output that has changed.
    fn tell(&mut self, place: usize, output: Output, situation: &mut Situation, listener: &mut impl Listener) {
        let t = situation.t;
        let value = self.values[place];
        if value > 0.0 {
            situation.rises[self.index][place].1.get_or_insert(t);
        }
        if self.told_values[place].to_bits() == value.to_bits() {
            return;
        }
        self.told_values[place] = value;
        listener.on_output(t, self.index, place, value);
        match output {
            Output::ErrorId | Output::AxisErrorId => {
                if let Some(error) = self.instance.error() {
                    let message = error.to_string();
                    listener.on_error(t, self.index, &message);
                    if output == Output::ErrorId && self.error.is_none() {
                        self.error = Some((t, error.id().number(), message));
                    }
                }
            }
            output if output == Output::CommandAborted || ENDED.contains(&output) || WRONG.contains(&output) => {
                self.has_ended |= value > 0.0;
            }
            _ => {}
        }
    }

    /// True if `output` is TRUE.
    fn is(&self, output: Output) -> bool {
        self.block.outputs().iter().zip(&self.values).any(|(own, value)| *own == output && *value > 0.0)
    }

    /// Tracks the motion that the block commands.
    pub(super) fn follow_motion(&mut self, t: f64, commanded: Setpoint, motions: &mut Vec<Motion>) {
        // An effort leaves the motion to the load.
        let moves = self.block.is_command() && self.block != BlockName::TorqueControl;
        let is_active = ACTIVE.into_iter().any(|output| self.is(output));
        match (&mut self.motion, is_active) {
            (Some(motion), true) => motion.follow(commanded),
            (None, true) if moves => self.motion = Some(MotionTracker::begin(t, commanded)),
            (Some(_), false) => self.end_motion(t, commanded, motions),
            (None, _) => {}
        }
    }

    pub(super) fn end_motion(&mut self, t: f64, commanded: Setpoint, motions: &mut Vec<Motion>) {
        if let Some(motion) = self.motion.take() {
            // A motion that ends as commanded ends in Done and at rest; any other is aborted, or continues.
            let is_aborted = self.is(Output::CommandAborted) || WRONG.into_iter().any(|output| self.is(output));
            let ending = match (is_aborted, commanded.v == 0.0) {
                (true, _) => Ending::Aborted,
                (false, true) => Ending::AtRest,
                (false, false) => Ending::InMotion,
            };
            motions.extend(motion.end(self.index, t, commanded, ending));
        }
    }

    /// True if the call was never executed.
    pub(super) const fn is_idle(&self) -> bool {
        self.started.is_none()
    }

    /// True if the run may succeed without this call: its program allows it, or it waits for the failure of another call, or for one of the
    /// `idle` ones, which are optional and were never executed.
    pub(super) fn may_be_left_out(&self, idle: &[bool]) -> bool {
        let waits_in_vain = match self.start {
            Condition::After { output, .. } if output == Output::CommandAborted || WRONG.contains(&output) => true,
            Condition::After { call, .. } => idle.get(call).is_some_and(|is_idle| *is_idle),
            Condition::AtOnce | Condition::At(_) | Condition::Above(_) | Condition::Below(_) => false,
        };
        self.is_optional || waits_in_vain
    }

    /// True if the call need not succeed: one that waits in vain may fail to start; an executed one has to succeed unless it is marked
    /// optional.
    pub(super) fn is_optional(&self, idle: &[bool]) -> bool {
        self.is_optional || (self.is_idle() && self.may_be_left_out(idle))
    }

    /// Result of the call so far.
    pub(super) fn fate(&self, situation: &Situation, names: &[String]) -> Fate {
        if let Some((time, id, message)) = self.error.clone() {
            return Fate::Failed { time, id, message };
        }
        if self.is_idle() {
            return Fate::NeverExecuted(self.waiting(names));
        }
        let risen = |output: Output| situation.risen(self.index, output).is_some();
        let aim = self.block.outputs().iter().copied().find(|output| AIMS.contains(output));
        match aim {
            Some(aim) if !risen(aim) && !risen(Output::CommandAborted) => Fate::Unfinished(aim),
            _ => Fate::Executed,
        }
    }

    fn waiting(&self, names: &[String]) -> String {
        let Self { name, unit, .. } = self;
        match self.start {
            Condition::AtOnce => format!("`{name}` was not executed"),
            Condition::At(time) => format!("`{name}` was not executed: it waits for {time} s"),
            Condition::After { call, output, .. } => {
                let other = names.get(call).map_or("another call", String::as_str);
                format!("`{name}` was not executed: `{other}.{}` did not become TRUE", output.name())
            }
            Condition::Above(x) => format!("`{name}` was not executed: the axis did not pass {x} {unit} upwards"),
            Condition::Below(x) => format!("`{name}` was not executed: the axis did not pass {x} {unit} downwards"),
        }
    }
}
