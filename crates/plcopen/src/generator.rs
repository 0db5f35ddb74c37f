//! The generator of order 4 as a function block for a PLC, and by the same procedure those of order 3 and 2.
//!
//! Pietrusewicz, Waszczuk & Kubicki, *`MC_MoveAbsolute()` 4th Order Real-Time Trajectory Generation Function Algorithm and
//! Implementation*, Applied Sciences 9 (2019), sections 4.1–4.4 and the interface `Profile4thFB` of figure 8. The plan, (1)–(49),
//! is [`Profile::plan_sampled`]; the execution, (72)–(75), is [`Cascade`]. Here is what starts and times them, sample by sample:
//!
//! ```text
//! ENstart_k  = enable AND ready                                     "readiness is passed to ENstart"
//! GenStart_k = ENstart_k AND NOT ENstart_(k−1)                      (69)
//! start_k    = GenStart_(k−1)                                       (70)   then dd9 and t16 are planned, (55)–(56), (50)–(54)
//! t_exec     = −Ts/2 at start, Ts more at each sample after it      (71)
//! p_i        = dd9_5 where t_exec > t16_i, else 0                   (57)–(62)
//! snap       = dir·(p_1 − p_2 − p_3 + p_4 − p_5 + p_6 + p_7 − p_8 − p_9 + p_10 + p_11 − p_12 + p_13 − p_14 − p_15 + p_16)   (63)
//! ready      = t_exec > t_final + T_set                             (65)
//! ```
//!
//! | sample | enable | `GenStart` | start | `t_exec` | snap |
//! |---|---|---|---|---|---|
//! | k | rises | 1 | 0 | – | 0 |
//! | k + 1 | | 0 | 1 | −Ts/2 | 0 |
//! | k + 2 | | 0 | 0 | Ts/2 | the first pulse |
//!
//! So the snap follows the edge of enable by two samples, and as times are whole numbers of samples and `t_exec` lies between
//! them, no comparison is one of equals. Switching times are counted in samples here, with the same result.
//!
//! An enable that stays TRUE starts again as soon as the block is ready, as it does there: to the position that `pref` has then.
//!
//! # What is corrected
//!
//! - (49) gives the snap the sign of the move, and (63) gives it once more: it is given once, here.
//! - (66)–(68) make the variable *dir* out of itself. What is meant is the sign of the move times that of the
//!   [mounting](Mounting), which is taken over with the start: a motor does not change its mounting on the way.
//! - (72)–(75) add up their rounding, and leave some velocity behind that goes on for ever: the values of a run are those of
//!   its start in closed form, and the last one is the target.
//!
//! # What the paper only names
//!
//! Figure 8 declares these without a word on them: `ssMethodType`, which Simulink PLC Coder adds to each block that has a state
//! ([`Method`]); `ActRefPos` and `pref_add`, which are taken for the two ends of "increment from an actual position to the new one"
//! (section 3): the move goes from `ActRefPos`, as it is at the start, by `pref_add = ±(pref − ActRefPos)`; and `CmdDone`, taken for
//! the end of what (65) waits for. Its flags are of type LREAL, and BOOL here.
//!
//! # Lower orders
//!
//! "The algorithm itself is scalable" (section 6): with [`Input::order`] 3 the jerk is what is switched, with 2 the acceleration, over 7
//! and 3 segments in place of 15, and what is switched is added up by the rows of (72)–(75) below it.
//!
//! [`Profile4th`](crate::Profile4th) has an axis follow it. The crate `structured-text` has the block as code for a PLC, which computes
//! the same to the last bit: a change here is one there.
use servobench_base::{ParamError, Setpoint, Stateful, non_negative, positive};
use servobench_motion::sampled::{Cascade, Run};
use servobench_motion::{Limits, Order, PlanError, Profile};

/// What does not change while the PLC runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    sample_time: f64,
    /// `T_set` in samples.
    settling: f64,
}

impl Params {
    /// With the sample time Ts (s), the settling time `T_set` (s). Moves are executed as in the paper, by the forward-Euler cascade.
    ///
    /// # Errors
    /// [`ParamError`] when the sample time is not positive, or the settling time not positive or zero.
    pub fn new(sample_time: f64, settling_time: f64) -> Result<Self, ParamError> {
        let sample_time = positive("sample_time", sample_time)?;
        let settling = non_negative("settling_time", settling_time)? / sample_time;
        Ok(Self { sample_time, settling })
    }
}

/// `ssMethodType`: what a call is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// `SS_INITIALIZE`, 0: sets the block back.
    Initialize,
    /// `SS_STEP`, 1: one sample.
    #[default]
    Step,
}

/// Whether the motor turns as the axis moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Mounting {
    /// It does.
    #[default]
    Same,
    /// It turns the opposite way: every reference has the opposite sign.
    Opposite,
}

impl Mounting {
    const fn sign(self) -> f64 {
        match self {
            Self::Same => 1.0,
            Self::Opposite => -1.0,
        }
    }
}

/// Inputs, in the axis unit (m or rad).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Input {
    /// `ssMethodType`.
    pub method: Method,
    /// Which derivative is switched; taken over with the start.
    pub order: Order,
    /// `pref`: where to.
    pub reference: f64,
    /// `vel_bnd`, `acc_bnd`, `jerk_bnd` and `djerk_bnd`, of which those up to the order count.
    pub limits: Limits,
    /// `TriggerEnable`.
    pub enable: bool,
    /// `ActRefPos`: where the reference is when a move starts, as the last [`Output::set_point`] says.
    pub actual_reference: f64,
    /// The mounting direction, taken over with the start.
    pub mounting: Mounting,
}

/// Outputs, in the axis unit (m or rad).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Output {
    /// `Position`, `Velocity`, `Acceleration`, `Jerk` and `dJerk` (the snap).
    pub set_point: Setpoint,
    /// `pref_add`: what the move adds to the position.
    pub added: f64,
    /// `CmdDone`: the last move is over, and its settling time too.
    pub done: bool,
    /// A rise of enable starts a move, (65).
    pub ready: bool,
    /// Why there is no move, if the last start failed.
    pub error: Option<PlanError>,
}

/// What the block keeps from sample to sample.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct State {
    /// `ENstart` and `GenStart` of the sample before.
    is_enabled: bool,
    is_starting: bool,
    /// Where the reference stands; `None` before the first call.
    position: Option<f64>,
    /// Samples since the start: `t_exec` is that less a half.
    count: u64,
    /// Samples of the last move; `None` before the first one.
    total: Option<u64>,
    added: f64,
    course: Option<Course>,
    error: Option<PlanError>,
}

/// One call: the outputs of this sample.
pub fn step(params: &Params, state: &mut State, input: &Input) -> Output {
    let is_initial = input.method == Method::Initialize;
    if is_initial {
        *state = State::default();
    }
    let position = *state.position.get_or_insert(input.actual_reference);
    if core::mem::take(&mut state.is_starting) {
        state.start(params, input);
    } else {
        state.count = state.count.saturating_add(1);
    }
    let ready = state.is_ready(params);
    let is_enabled = input.enable && ready && !is_initial;
    state.is_starting = is_enabled && !state.is_enabled;
    state.is_enabled = is_enabled;
    let set_point = match &mut state.course {
        None => Setpoint::at_rest(position),
        // t_exec = −Ts/2.
        Some(course) if state.count == 0 => Setpoint::at_rest(course.base),
        Some(course) => {
            let set_point = course.next(state.count - 1);
            if state.total.is_some_and(|total| state.count > total) {
                (state.position, state.course) = (Some(set_point.x), None);
            }
            set_point
        }
    };
    Output { set_point, added: state.added, done: ready && state.total.is_some(), ready, error: state.error }
}

impl State {
    /// (55)–(56): plans anew.
    fn start(&mut self, params: &Params, input: &Input) {
        let distance = input.mounting.sign() * (input.reference - input.actual_reference);
        (self.count, self.error) = (0, None);
        match Course::new(params, input, distance) {
            Ok(course) => (self.total, self.added, self.course) = (Some(course.total), distance, Some(course)),
            Err(error) => (self.total, self.added, self.error) = (None, 0.0, Some(error)),
        }
    }

    /// Whether a move has been asked for in this sample, or is under way.
    pub(crate) const fn is_moving(&self) -> bool {
        self.is_starting || self.course.is_some()
    }

    /// (65); `t_final` is (54) in samples.
    fn is_ready(&self, params: &Params) -> bool {
        self.total.is_none_or(|total| self.count as f64 - 0.5 > total as f64 + params.settling)
    }
}

/// A move on its way.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
struct Course {
    profile: Profile,
    base: f64,
    total: u64,
    /// At the start of `run`, from the base.
    cascade: Cascade,
    run: Run,
    /// Sample at which `run` starts, and the number of the next one.
    began: u64,
    next: usize,
}

impl Course {
    fn new(params: &Params, input: &Input, distance: f64) -> Result<Self, PlanError> {
        let &Input { order, limits, actual_reference: base, .. } = input;
        let profile = Profile::plan_sampled(order, distance, &limits, params.sample_time)?;
        let total = profile.samples().map_or(0, |samples| samples.total());
        let cascade = Cascade::at_rest(order, 0.0, params.sample_time)?;
        Ok(Self { profile, base, total, cascade, run: Run { value: 0.0, count: 0 }, began: 0, next: 0 })
    }

    /// The set-point of `sample`; asked in the order of the samples.
    fn next(&mut self, sample: u64) -> Setpoint {
        if sample >= self.total {
            return Setpoint::at_rest(self.base + self.profile.distance());
        }
        let from_base = self.cascaded(sample);
        Setpoint { x: self.base + from_base.x, ..from_base }
    }

    /// (72)–(75), from the start of the run.
    fn cascaded(&mut self, sample: u64) -> Setpoint {
        while sample >= self.began + self.run.count {
            let Some(run) = self.profile.runs().nth(self.next) else { break };
            self.cascade.skip(self.run);
            self.began += self.run.count;
            self.next += 1;
            self.run = run;
        }
        self.cascade.ahead(self.run.value, sample - self.began)
    }
}
