//! A call of a function block: when it is executed, and what it says.
use super::block::Block;
use super::made::Made;
use crate::network::signals::{Watched, word};
use servobench_base::Setpoint;
use servobench_plcopen::Axis;
use servobench_scenario as scenario;
use servobench_scenario::{Condition, Output};
use servobench_trace::{self as trace, CallFate, Ending, Event, Move, Recorder, SignalId};

/// The outputs that say that a block came to what it is for; of a block that has several, the first of these.
const AIMS: [&str; 8] =
    ["Done", "InVelocity", "InEndVelocity", "InTorque", "ProfileCompleted", "Status", "Enabled", "Valid"];

/// What became of `calls` by the end of the run.
pub(super) fn fates(calls: &[Call], known: &Known) -> Vec<trace::Call> {
    let mut idle: Vec<bool> = vec![false; calls.len()];
    // A call that waits on an idle one is idle too, and may stand before it: there are at most as many links as calls.
    for _ in 0..calls.len() {
        idle = calls.iter().map(|call| call.started.is_none() && call.may_be_left_out(&idle)).collect();
    }
    let of = |(own, call): (usize, &Call)| trace::Call {
        name: call.name.clone(),
        block: call.block.name().to_owned(),
        // What waits in vain may; what is executed has to end well unless it is marked.
        is_optional: call.is_optional || (call.started.is_none() && call.may_be_left_out(&idle)),
        fate: call.fate(own, known),
    };
    calls.iter().enumerate().map(of).collect()
}

/// How far after its time a cycle may be by rounding (s).
const ROUNDING: f64 = 1e-9;

/// A call under way.
#[expect(clippy::struct_excessive_bools, reason = "each is a state that a cycle asks for, and they are independent")]
#[derive(Debug, Clone)]
pub(super) struct Call {
    name: String,
    block: Box<dyn Block>,
    start: Condition,
    stop: Option<Condition>,
    timeout: f64,
    updates: Vec<scenario::Update>,
    /// When Execute or Enable became TRUE.
    started: Option<f64>,
    is_optional: bool,
    /// When it ended in Error (s), ErrorID, and the error in words.
    error: Option<(f64, u32, String)>,
    /// Whether it became FALSE again.
    is_over: bool,
    execute: bool,
    has_ended: bool,
    /// Signals of Execute or Enable and of the outputs, with the values noted last.
    signals: Vec<(SignalId, f64)>,
    trigger: Watched<bool>,
    values: Vec<f64>,
    made: Option<Made>,
}

impl Call {
    pub(super) fn new(call: &scenario::Call, block: Box<dyn Block>, recorder: &mut Recorder) -> Self {
        let names = block.outputs();
        let trigger = if block.is_enabled() { "Enable" } else { "Execute" };
        let trigger = Watched::new(&call.name, trigger, recorder);
        let signals = names.iter().map(|name| (recorder.add_signal(&call.name, name), f64::NAN)).collect();
        Self {
            name: call.name.clone(),
            start: call.start,
            stop: call.stop,
            timeout: call.timeout,
            updates: call.updates.clone(),
            started: None,
            is_optional: call.is_optional,
            error: None,
            is_over: false,
            execute: false,
            has_ended: false,
            values: vec![0.0; names.len()],
            signals,
            trigger,
            block,
            made: None,
        }
    }

    /// One cycle; `own` is where the call stands in `known`.
    ///
    /// # Errors
    /// Says that `start` was waited for for too long.
    pub(super) fn cycle(
        &mut self,
        own: usize,
        known: &mut Known,
        axis: &mut Axis,
        recorder: &mut Recorder,
    ) -> Result<(), String> {
        let t = known.t;
        self.decide(known);
        if self.started.is_none() && t > self.timeout {
            return Err(format!("{} within {} s", self.waiting(known), self.timeout));
        }
        self.trigger.note(t, self.execute, recorder, word);
        self.block.step(axis, self.execute, &mut self.values);
        for (index, name) in self.block.outputs().iter().enumerate() {
            self.note(own, index, name, known, recorder);
        }
        Ok(())
    }

    /// Execute or Enable in this cycle.
    fn decide(&mut self, known: &Known) {
        let t = known.t;
        match self.started {
            None => {
                if known.holds(self.start, 0.0) {
                    (self.started, self.execute) = (Some(t), true);
                }
            }
            Some(_) if self.is_over => {}
            Some(started) => {
                let stops = match self.stop {
                    Some(stop) => known.holds(stop, started),
                    None => !self.block.is_enabled() && self.has_ended,
                };
                if stops {
                    (self.execute, self.is_over) = (false, true);
                    return;
                }
                while let Some(update) = self.updates.first() {
                    if !known.holds(update.when, started) {
                        break;
                    }
                    let update = self.updates.remove(0);
                    self.block.load(&update.block);
                }
            }
        }
    }

    /// Notes an output where it changed.
    fn note(&mut self, own: usize, index: usize, name: &str, known: &mut Known, recorder: &mut Recorder) {
        let t = known.t;
        let value = self.values[index];
        if value > 0.0 {
            known.rises[own].1[index].1.get_or_insert(t);
        }
        let (signal, last) = &mut self.signals[index];
        if last.to_bits() == value.to_bits() {
            return;
        }
        *last = value;
        match name {
            "ErrorID" | "AxisErrorID" => {
                let message = self.block.error();
                recorder.note_value(*signal, t, &format!("{value}"));
                if let Some(message) = message {
                    if name == "ErrorID" && self.error.is_none() {
                        #[expect(
                            clippy::cast_possible_truncation,
                            clippy::cast_sign_loss,
                            reason = "a number of 16 bits"
                        )]
                        let id = value as u32;
                        self.error = Some((t, id, message.clone()));
                    }
                    let source = self.name.clone();
                    recorder.note_event(Event { start: t, end: t, source, message });
                }
            }
            _ => recorder.note_value(*signal, t, &word(value > 0.0)),
        }
        self.has_ended |= value > 0.0 && matches!(name, "Done" | "CommandAborted" | "Error");
    }

    /// Follows the motion that the block has the axis make.
    pub(super) fn follow_motion(&mut self, t: f64, commanded: Setpoint, made: &mut Vec<Move>) {
        let is_active =
            self.block.outputs().iter().zip(&self.values).any(|(name, value)| *name == "Active" && *value > 0.0);
        match (&mut self.made, is_active) {
            (Some(making), true) => making.follow(commanded),
            (None, true) if self.block.moves() => self.made = Some(Made::begin(t, commanded)),
            (Some(_), false) => self.end_motion(t, commanded, made),
            (None, _) => {}
        }
    }

    pub(super) fn end_motion(&mut self, t: f64, commanded: Setpoint, made: &mut Vec<Move>) {
        if let Some(making) = self.made.take() {
            // A motion that ends as commanded ends in Done, and at rest: any other one is broken off, or goes on.
            let is = |output| {
                self.block.outputs().iter().zip(&self.values).any(|(name, value)| *name == output && *value > 0.0)
            };
            let ending = match (is("CommandAborted") || is("Error"), commanded.v == 0.0) {
                (true, _) => Ending::Aborted,
                (false, true) => Ending::AtRest,
                (false, false) => Ending::InMotion,
            };
            made.extend(making.end(t, commanded, format!("{}: {}", self.name, self.block.name()), ending));
        }
    }

    /// What to say of a call that was never executed.
    pub(super) fn never_executed(&self, known: &Known) -> Option<String> {
        self.started.is_none().then(|| self.waiting(known))
    }

    /// Whether the run may do without it, beside what its file says: it waits on the failure of another call, or on one of
    /// `idle` ones, which are optional and were never executed.
    fn may_be_left_out(&self, idle: &[bool]) -> bool {
        let waits_in_vain = match self.start {
            Condition::After { output: Output::Error | Output::CommandAborted, .. } => true,
            Condition::After { call, .. } => idle.get(call).is_some_and(|is_idle| *is_idle),
            Condition::AtOnce | Condition::At(_) | Condition::Above(_) | Condition::Below(_) => false,
        };
        self.is_optional || waits_in_vain
    }

    /// What became of it by the end of the run.
    fn fate(&self, own: usize, known: &Known) -> CallFate {
        if let Some((time, id, message)) = self.error.clone() {
            return CallFate::Failed { time, id, message };
        }
        if let Some(why) = self.never_executed(known) {
            return CallFate::NeverExecuted(why);
        }
        let risen = |name: &str| known.rises[own].1.iter().any(|(output, when)| *output == name && when.is_some());
        let aim = self.block.outputs().iter().find(|name| AIMS.contains(name));
        match aim {
            Some(aim) if !risen(aim) && !risen("CommandAborted") => {
                CallFate::Unfinished(format!("its `{aim}` did not become TRUE"))
            }
            _ => CallFate::Executed,
        }
    }

    /// Its name, and when its outputs have become TRUE: never yet.
    pub(super) fn rises(&self) -> Rises {
        (self.name.clone(), self.block.outputs().iter().map(|name| (*name, None)).collect())
    }

    fn waiting(&self, known: &Known) -> String {
        let name = &self.name;
        let of = |call: usize| known.rises.get(call).map_or("another call", |(name, _)| name.as_str());
        match self.start {
            Condition::AtOnce => format!("`{name}` was not executed"),
            Condition::At(time) => format!("`{name}` was not executed: it waits for {time} s"),
            Condition::After { call, output, .. } => {
                format!("`{name}` was not executed: `{}.{}` did not become TRUE", of(call), output.name())
            }
            Condition::Above(x) => format!("`{name}` was not executed: the axis did not pass {x} upwards"),
            Condition::Below(x) => format!("`{name}` was not executed: the axis did not pass {x} downwards"),
        }
    }
}

/// Name of a call, and of each output when it first became TRUE (s).
pub(super) type Rises = (String, Vec<(&'static str, Option<f64>)>);

/// What conditions are about, in a cycle.
#[derive(Debug, Clone)]
pub(super) struct Known {
    /// Time (s).
    pub(super) t: f64,
    /// Actual position.
    pub(super) position: f64,
    /// Of each call.
    pub(super) rises: Vec<Rises>,
}

impl Known {
    /// Whether a condition holds; `begun` is when the execution began that an update or a stop belongs to.
    fn holds(&self, condition: Condition, begun: f64) -> bool {
        match condition {
            Condition::AtOnce => self.t >= begun,
            Condition::At(time) => self.t >= time - ROUNDING,
            Condition::After { call, output, delay } => {
                let risen = self.risen(call, output);
                risen.is_some_and(|risen| self.t >= risen + delay - ROUNDING)
            }
            Condition::Above(x) => self.position >= x,
            Condition::Below(x) => self.position <= x,
        }
    }

    fn risen(&self, call: usize, output: Output) -> Option<f64> {
        let (_, rises) = self.rises.get(call)?;
        rises.iter().find(|(name, _)| *name == output.name())?.1
    }
}
