//! A call of a function block: when it is executed, and what it says.
use super::block::Block;
use super::made::Made;
use crate::network::signals::{Watched, word};
use servobench_base::Setpoint;
use servobench_plcopen::Axis;
use servobench_scenario as scenario;
use servobench_scenario::{Condition, Output};
use servobench_trace::{Event, Move, Recorder, SignalId};

/// How far after its time a cycle may be by rounding (s).
const ROUNDING: f64 = 1e-9;

/// A call under way.
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
            made.extend(making.end(t, commanded, format!("{}: {}", self.name, self.block.name())));
        }
    }

    /// What to say of a call that was never executed.
    pub(super) fn never_executed(&self, known: &Known) -> Option<String> {
        self.started.is_none().then(|| self.waiting(known))
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
