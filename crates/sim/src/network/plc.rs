//! A PLC program and its recording.
use super::Step;
use super::signals::{Watched, word};
use crate::error::BuildError;
use servobench_base::{Setpoint, Stateful};
use servobench_fieldbus::{AxisFeedback, Task};
use servobench_motion::Limits;
use servobench_motion::interpolate::Sample;
use servobench_plcopen::program::{self, Executor, Fate, Listener, Motion};
use servobench_plcopen::{AxisParams, AxisState, BlockName, MOST_BUFFERED, OutputType};
use servobench_scenario as scenario;
use servobench_trace::{self as trace, CallFate, Event, Move, Recorder, SignalId};

/// A program of function blocks and the axis commanded by them.
#[derive(Debug, Stateful)]
pub(super) struct Plc {
    executor: Executor,
    #[state(constant)]
    calls: Vec<Call>,
    state: Watched<AxisState>,
    homed: Watched<bool>,
    /// Set-point followed in this cycle, in the coordinate of the machine.
    followed: Setpoint,
}

/// Recording of a call.
#[derive(Debug, Clone)]
struct Call {
    name: String,
    block: BlockName,
    /// Signals of Execute or Enable and of the outputs.
    trigger: SignalId,
    outputs: Vec<SignalId>,
}

impl Call {
    fn new(call: &program::Call, recorder: &mut Recorder) -> Self {
        let mut signal = |name| recorder.add_signal(&call.name, name);
        Self {
            name: call.name.clone(),
            block: call.block,
            trigger: signal(call.block.trigger().name()),
            outputs: call.block.outputs().iter().map(|output| signal(output.name())).collect(),
        }
    }
}

impl Plc {
    /// The program `plc`, executed every `cycle` (s).
    ///
    /// # Errors
    /// [`BuildError`] if no axis can have these limits.
    pub(super) fn new(
        plc: &scenario::Plc,
        axis: &scenario::Axis,
        cycle: f64,
        recorder: &mut Recorder,
    ) -> Result<Self, BuildError> {
        let params = AxisParams {
            needs_homing: plc.homing_required,
            modulo: axis.modulo,
            velocity_ramps: plc.velocity_ramps,
            buffered_commands: MOST_BUFFERED,
            ..AxisParams::new(cycle, limits(plc))
        };
        let executor = Executor::new(params, axis.motion, &plc.calls)?;
        let state = Watched::new("axis", "state", recorder);
        let homed = Watched::new("axis", "homed", recorder);
        let calls = plc.calls.iter().map(|call| Call::new(call, recorder)).collect();
        Ok(Self { executor, calls, state, homed, followed: Setpoint::default() })
    }

    /// The state of the axis.
    pub(super) const fn state(&self) -> AxisState {
        self.executor.axis().state()
    }

    /// One cycle at `t` (s). The drive counts from `origin`, a position of the machine.
    ///
    /// # Errors
    /// States the call that has waited too long, and the event it waited for.
    pub(super) fn cycle(
        &mut self,
        t: f64,
        feedback: &AxisFeedback,
        origin: f64,
        recorder: &mut Recorder,
        sample: impl Fn(Setpoint) -> Sample,
    ) -> Result<Step, String> {
        let mut notes = Notes { calls: &self.calls, recorder };
        let mut command = self.executor.cycle(t, feedback, &mut notes).map_err(|overdue| overdue.to_string())?;
        let axis = self.executor.axis();
        // The axis counts from the zero of the drive; the program may have shifted its own zero.
        let (commanded, sent) = (axis.commanded(), axis.sent());
        let setpoint = match &mut command.task {
            Task::Follow(asked) => {
                *asked = sample(sent);
                Some(sent)
            }
            Task::Drive(_) => Some(sent),
            Task::Effort(_) | Task::Home { .. } => None,
        };
        let x = origin + setpoint.map_or(feedback.demanded(), |followed| followed.x);
        self.followed = Setpoint { x, ..commanded };
        self.executor.follow_motions(t, self.followed);
        self.note(t, recorder);
        Ok(Step { command, setpoint, request: self.executor.axis().request() })
    }

    fn note(&mut self, t: f64, recorder: &mut Recorder) {
        let axis = self.executor.axis();
        let state = axis.state();
        let is_other = self.state.note(t, state, recorder, |state| state.name().into());
        if let (true, AxisState::ErrorStop, Some(error)) = (is_other, state, axis.error()) {
            recorder.note_event(Event::new(t, t, "axis", error.to_string()));
        }
        self.homed.note(t, axis.is_homed(), recorder, word);
    }

    /// Records at the end of the run, at `t` (s), the motions of the axis and the calls that were never executed; moves reach the axis
    /// `delay` (s) later.
    pub(super) fn finish(&mut self, t: f64, delay: f64, recorder: &mut Recorder) {
        for motion in self.executor.end_motions(t, self.followed) {
            recorder.note_move(made(&motion, &self.calls[motion.call], delay));
        }
        let fates = self.executor.fates();
        for ((fate, is_optional), call) in fates.iter().zip(&self.calls) {
            let (name, block) = (call.name.clone(), call.block.name().to_owned());
            recorder.note_call(trace::Call { name, block, is_optional: *is_optional, fate: as_recorded(fate) });
        }
        for (fate, _) in fates {
            if let Fate::NeverExecuted(message) = fate {
                recorder.note_event(Event::new(t, t, "PLC", message));
            }
        }
    }
}

/// Recorder of the events in a program.
struct Notes<'a> {
    calls: &'a [Call],
    recorder: &'a mut Recorder,
}

impl Listener for Notes<'_> {
    fn on_trigger(&mut self, t: f64, call: usize, trigger: bool) {
        self.recorder.note_value(self.calls[call].trigger, t, &word(trigger));
    }

    fn on_output(&mut self, t: f64, call: usize, output: usize, value: f64) {
        let call = &self.calls[call];
        let text = match call.block.outputs()[output].value_type() {
            OutputType::Number => value.to_string(),
            OutputType::Flag | OutputType::Never => word(value > 0.0),
        };
        self.recorder.note_value(call.outputs[output], t, &text);
    }

    fn on_error(&mut self, t: f64, call: usize, message: &str) {
        self.recorder.note_event(Event::new(t, t, self.calls[call].name.clone(), message));
    }
}

/// A motion of `call` that reaches the axis `delay` (s) later.
fn made(motion: &Motion, call: &Call, delay: f64) -> Move {
    let &Motion { start, end, from, to, peaks, ending, .. } = motion;
    Move {
        label: format!("{}: {}", call.name, call.block),
        start: start + delay,
        end: end + delay,
        from,
        to,
        peaks,
        limits: [None; 4],
        cruise: (end, 0.0),
        ending,
    }
}

fn as_recorded(fate: &Fate) -> CallFate {
    match fate {
        Fate::Executed => CallFate::Executed,
        Fate::Failed { time, id, message } => {
            CallFate::Failed { time: *time, id: u32::from(*id), message: message.clone() }
        }
        Fate::NeverExecuted(why) => CallFate::NeverExecuted(why.clone()),
        Fate::Unfinished(output) => CallFate::Unfinished(format!("its `{}` did not become TRUE", output.name())),
    }
}

/// Limits of the axis: those of `[setpoint]`, or the largest that any call requests.
pub(super) fn limits(plc: &scenario::Plc) -> Limits {
    program::limits(&plc.limits, &plc.calls)
}
