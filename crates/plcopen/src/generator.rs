//! The generator of order 4 as a function block for a PLC, and those of orders 3 and 2 by the same procedure.
//!
//! Pietrusewicz, Waszczuk & Kubicki, *`MC_MoveAbsolute()` 4th Order Real-Time Trajectory Generation Function Algorithm and Implementation*,
//! Applied Sciences 9 (2019), sections 4.1–4.4 and the interface `Profile4thFB` of figure 8. The plan, (1)–(49), is
//! [`Profile::plan_sampled`]; the execution, (72)–(75), is [`Cascade`]. This module starts and times them, sample by sample:
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
//! The snap follows the edge of enable by two samples. Times are whole numbers of samples and `t_exec` lies between them, so that no
//! comparison is between equals. Switching times are counted in samples here, with the same result.
//!
//! As in the paper, an enable that stays TRUE starts again as soon as the block is ready: to the present position `pref`.
//!
//! # Corrections to the paper
//!
//! - (49) gives the snap the sign of the move, and (63) applies it again: here it is applied once.
//! - (66)–(68) define the variable *dir* by itself. The sign of the move times that of the [mounting](Mounting) is meant; the mounting is
//!   taken over with the start, since a motor keeps it during a move.
//! - (72)–(75) accumulate rounding, and leave a residual velocity forever: here the values of a run follow from its start in closed form,
//!   and the last one is the target.
//!
//! # Interpretation of undescribed signals
//!
//! Figure 8 declares these without a description: `ssMethodType`, which Simulink PLC Coder adds to each block that has a state
//! ([`Method`]); `ActRefPos` and `pref_add`, taken for the two parts of "increment from an actual position to the new one" (section 3): the
//! move goes from `ActRefPos`, as it is at the start, by `pref_add = ±(pref − ActRefPos)`; and `CmdDone`, taken for the end of the wait in
//! (65). Its flags are of type LREAL, and BOOL here.
//!
//! # Lower orders
//!
//! "The algorithm itself is scalable" (section 6): with [`Input::order`] 3 the jerk is switched, with 2 the acceleration, over 7 and 3
//! segments in place of 15, and the rows of (72)–(75) below the switched quantity add it up.
//!
//! [`Profile4th`](crate::Profile4th) makes an axis follow the generator. The crate `structured-text` has the block as code for a PLC, which
//! computes bit-identical results: change both together.
use servobench_base::{ParamError, Setpoint, Stateful, non_negative, positive};
use servobench_motion::sampled::{Cascade, Run};
use servobench_motion::{Limits, Order, PlanError, Profile};

/// Parameters, constant while the PLC runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    sample_time: f64,
    /// `T_set` in samples.
    settling: f64,
}

impl Params {
    /// Parameters with the sample time Ts (s) and the settling time `T_set` (s); moves are executed by the forward-Euler cascade, as in the
    /// paper.
    ///
    /// # Errors
    /// [`ParamError`] when the sample time is not positive, or the settling time not positive or zero.
    pub fn new(sample_time: f64, settling_time: f64) -> Result<Self, ParamError> {
        let sample_time = positive("sample_time", sample_time)?;
        let settling = non_negative("settling_time", settling_time)? / sample_time;
        Ok(Self { sample_time, settling })
    }
}

/// `ssMethodType`: purpose of a call.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// `SS_INITIALIZE`, 0: resets the block.
    Initialize,
    /// `SS_STEP`, 1: one sample.
    #[default]
    Step,
}

/// Mounting of the motor, relative to the motion of the axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Mounting {
    /// The motor turns as the axis moves.
    #[default]
    Same,
    /// The motor turns the opposite way: every reference has the opposite sign.
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
    /// Order of the switched derivative; taken over with the start.
    pub order: Order,
    /// `pref`: target.
    pub reference: f64,
    /// `vel_bnd`, `acc_bnd`, `jerk_bnd` and `djerk_bnd`, of which those up to the order apply.
    pub limits: Limits,
    /// `TriggerEnable`.
    pub enable: bool,
    /// `ActRefPos`: reference at the start of a move, equal to the last [`Output::set_point`].
    pub actual_reference: f64,
    /// Mounting of the motor, taken over with the start.
    pub mounting: Mounting,
}

/// Outputs, in the axis unit (m or rad).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Output {
    /// `Position`, `Velocity`, `Acceleration`, `Jerk` and `dJerk` (the snap).
    pub set_point: Setpoint,
    /// `pref_add`: position that the move adds.
    pub added: f64,
    /// `CmdDone`: the last move is over, and its settling time too.
    pub done: bool,
    /// A rising edge of enable starts a move, (65).
    pub ready: bool,
    /// Cause, if the last start failed.
    pub error: Option<PlanError>,
}

/// State of the block from sample to sample.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct State {
    /// `ENstart` and `GenStart` of the sample before.
    is_enabled: bool,
    is_starting: bool,
    /// Present reference; `None` before the first call.
    position: Option<f64>,
    /// Samples since the start: `t_exec` is half a sample less.
    count: u64,
    /// Samples of the last move; `None` before the first one.
    total: Option<u64>,
    added: f64,
    course: Option<Course>,
    error: Option<PlanError>,
}

/// Handles one call: returns the outputs of this sample.
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
    /// (55)–(56): plans a new move.
    fn start(&mut self, params: &Params, input: &Input) {
        let distance = input.mounting.sign() * (input.reference - input.actual_reference);
        (self.count, self.error) = (0, None);
        match Course::new(params, input, distance) {
            Ok(course) => (self.total, self.added, self.course) = (Some(course.total), distance, Some(course)),
            Err(error) => (self.total, self.added, self.error) = (None, 0.0, Some(error)),
        }
    }

    /// True if a move has been requested in this sample, or is active.
    pub(crate) const fn is_moving(&self) -> bool {
        self.is_starting || self.course.is_some()
    }

    /// (65); `t_final` is (54) in samples.
    fn is_ready(&self, params: &Params) -> bool {
        self.total.is_none_or(|total| self.count as f64 - 0.5 > total as f64 + params.settling)
    }
}

/// A move being executed.
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

    /// Set-point of `sample`; called in the order of the samples.
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
