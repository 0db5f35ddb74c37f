//! A PLC program: every cycle its calls of function blocks, in the order of the file.
mod block;
mod call;
mod made;

use super::Step;
use super::signals::{Watched, word};
use crate::error::BuildError;
use block::block;
use call::{Call, Known};
use servobench_base::Setpoint;
use servobench_fieldbus::{AxisFeedback, Task};
use servobench_motion::Limits;
use servobench_motion::interpolate::Sample;
use servobench_plcopen::{Axis, AxisParams, AxisState, MOST_BUFFERED};
use servobench_scenario as scenario;
use servobench_trace::{Event, Move, Recorder};

/// A program of function blocks and the axis that they command.
#[derive(Debug, Clone)]
pub(super) struct Plc {
    axis: Axis,
    calls: Vec<Call>,
    known: Known,
    state: Watched<AxisState>,
    homed: Watched<bool>,
    /// What is followed in this cycle, in the coordinate of the machine.
    followed: Setpoint,
    /// What moved the axis, noted at the end.
    made: Vec<Move>,
}

impl Plc {
    /// The program `plc`, executed every `cycle` (s).
    ///
    /// # Errors
    /// [`BuildError`] when the limits are none that an axis can have.
    pub(super) fn new(
        plc: &scenario::Plc,
        modulo: Option<f64>,
        cycle: f64,
        recorder: &mut Recorder,
    ) -> Result<Self, BuildError> {
        let params = AxisParams {
            needs_homing: plc.homing_required,
            modulo,
            buffered_commands: MOST_BUFFERED,
            ..AxisParams::new(cycle, limits(plc))
        };
        let axis = Axis::new(params)?;
        let state = Watched::new("axis", "state", recorder);
        let homed = Watched::new("axis", "homed", recorder);
        let calls = plc.calls.iter().map(|call| Call::new(call, block(&call.block), recorder));
        let calls: Vec<Call> = calls.collect();
        let known = Known { t: 0.0, position: 0.0, rises: calls.iter().map(Call::rises).collect() };
        Ok(Self { axis, calls, known, state, homed, followed: Setpoint::default(), made: Vec::new() })
    }

    /// The state of the axis.
    pub(super) fn state(&self) -> AxisState {
        self.axis.state()
    }

    /// One cycle at `t` (s). The drive counts from `origin`, a position of the machine.
    ///
    /// # Errors
    /// Says which call has waited for too long, and for what.
    pub(super) fn cycle(
        &mut self,
        t: f64,
        feedback: &AxisFeedback,
        origin: f64,
        recorder: &mut Recorder,
        sample: impl Fn(Setpoint) -> Sample,
    ) -> Result<Step, String> {
        self.axis.begin(feedback);
        (self.known.t, self.known.position) = (t, self.axis.actual().position);
        for (index, call) in self.calls.iter_mut().enumerate() {
            call.cycle(index, &mut self.known, &mut self.axis, recorder)?;
        }
        let mut command = self.axis.end();
        let commanded = self.axis.commanded();
        let mut setpoint = None;
        if let Task::Follow(asked) = &mut command.task {
            // The axis counts from where the drive does; the program may have shifted its own zero.
            let followed = Setpoint { x: asked.x, v: asked.v, a: asked.a, ..commanded };
            *asked = sample(followed);
            setpoint = Some(followed);
        }
        let x = origin + setpoint.map_or(feedback.demanded(), |followed| followed.x);
        self.followed = Setpoint { x, ..commanded };
        for call in &mut self.calls {
            call.follow_motion(t, self.followed, &mut self.made);
        }
        self.note(t, recorder);
        Ok(Step { command, setpoint })
    }

    fn note(&mut self, t: f64, recorder: &mut Recorder) {
        let state = self.axis.state();
        let is_other = self.state.note(t, state, recorder, |state| state.name().into());
        if let (true, AxisState::ErrorStop, Some(error)) = (is_other, state, self.axis.error()) {
            recorder.note_event(Event { start: t, end: t, source: "axis".into(), message: error.to_string() });
        }
        self.homed.note(t, self.axis.is_homed(), recorder, word);
    }

    /// Notes at the end of the run, at `t` (s), what moved the axis and what was never executed; moves reach the axis
    /// `delay` (s) later.
    pub(super) fn finish(&mut self, t: f64, delay: f64, recorder: &mut Recorder) {
        for call in &mut self.calls {
            call.end_motion(t, self.followed, &mut self.made);
        }
        self.made.sort_by(|one, other| one.start.total_cmp(&other.start));
        for made in self.made.drain(..) {
            recorder.note_move(Move { start: made.start + delay, end: made.end + delay, ..made });
        }
        for call in call::fates(&self.calls, &self.known) {
            recorder.note_call(call);
        }
        for call in &self.calls {
            if let Some(message) = call.never_executed(&self.known) {
                recorder.note_event(Event { start: t, end: t, source: "PLC".into(), message });
            }
        }
    }
}

/// What the axis may do: what `[setpoint]` says, or the most that any call asks for.
pub(super) fn limits(plc: &scenario::Plc) -> Limits {
    let blocks = plc
        .calls
        .iter()
        .flat_map(|call| std::iter::once(&call.block).chain(call.updates.iter().map(|update| &update.block)));
    let dynamics: Vec<[f64; 4]> = blocks.filter_map(block::dynamics).collect();
    let most = |k: usize| dynamics.iter().map(|dynamics| dynamics[k]).fold(0.0, f64::max);
    let or = |value: f64, otherwise: f64| if value > 0.0 { value } else { otherwise };
    let velocity = or(most(0), 1.0);
    let acceleration = or(most(1), 10.0 * velocity);
    let most = [velocity, acceleration, or(most(2), f64::INFINITY), or(most(3), f64::INFINITY)];
    let [velocity, acceleration, jerk, snap] =
        core::array::from_fn(|k| if plc.limits[k].is_finite() { plc.limits[k] } else { most[k] });
    Limits { velocity, acceleration, jerk, snap }
}
