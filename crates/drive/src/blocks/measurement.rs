//! Velocity measurement for the velocity loop: by differences, by the M/T method, or by an observer.
//!
//! | method | equation | age |
//! |---|---|---|
//! | difference | (θ(k) − θ(k−1))/T | T/2 |
//! | M/T ([`mt`]) | travel between the last edges of two cycles over the time between them | about T/2 |
//! | observer ([`observer`]) | a model of the motor, corrected by the measured position | 0 |
//!
//! By default the loop takes the velocity of an encoder that provides it, and differences otherwise. All in the motor's coordinate.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use servobench_base::Stateful;
use servobench_config::ParameterError;

pub mod mt;
pub mod observer;

servobench_config::choices! {
    /// Method of measuring the motor's velocity.
    pub enum Method {
        /// the difference of two positions over the period of the velocity loop
        Difference = "difference",
        /// M/T method: the increments between the last edges of two cycles over the time between these edges
        Mt = "mt",
        /// an observer of position, velocity and disturbance
        Observer = "observer",
    }
}

/// Last edge of an incremental encoder: the transition from one increment to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// Age (s).
    pub age: f64,
    /// Offset of the edge from the present reading (motor coordinate): half an increment in one direction or the other.
    pub offset: f64,
}

/// A method with its parameters; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Params {
    /// Differences, with every encoder.
    Difference,
    /// M/T method.
    Mt(mt::Params),
    /// Observer.
    Observer(observer::Params),
}

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct State {
    mt: mt::State,
    observer: observer::State,
}

/// Input of a cycle of the velocity loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Input {
    /// Measured position (rad or m).
    pub position: f64,
    /// Travel since the last cycle (rad or m).
    pub travelled: f64,
    /// Last edge of the encoder, if it reports edges.
    pub edge: Option<Edge>,
    /// Effort commanded in the last cycle (N·m or N).
    pub effort: f64,
    /// Velocity from the encoder (rad/s or m/s), if it provides one.
    pub of_encoder: Option<f64>,
}

impl Params {
    /// # Errors
    /// [`ParameterError`] names the first parameter out of its bound.
    pub fn check(&self) -> Result<(), ParameterError> {
        match self {
            Self::Difference => Ok(()),
            Self::Mt(mt) => mt.check(),
            Self::Observer(observer) => observer.check(),
        }
    }

    /// Linear counterpart of the method: the M/T method becomes differences of positions, without quantisation.
    #[must_use]
    pub const fn linearised(self) -> Self {
        match self {
            Self::Difference | Self::Mt(_) => Self::Difference,
            Self::Observer(observer) => Self::Observer(observer),
        }
    }

    /// Age (s) of a velocity measured in cycles of `h` (s), with many edges in each.
    #[must_use]
    pub fn age(&self, h: f64) -> f64 {
        match self {
            Self::Difference | Self::Mt(_) => h / 2.0,
            Self::Observer(_) => 0.0,
        }
    }
}

impl State {
    /// Effort to be added to cancel the disturbance (N·m or N): zero without an observer.
    #[inline(always)]
    #[must_use]
    pub fn compensation(&self, p: &Params) -> f64 {
        match p {
            Params::Difference | Params::Mt(_) => 0.0,
            Params::Observer(observer) => -observer.compensation * self.observer.disturbance,
        }
    }
}

/// Measured velocity in a cycle of the velocity loop, `h` (s) after the last one.
#[inline(always)]
pub fn step(p: &Params, x: &mut State, u: Input, h: f64) -> f64 {
    match p {
        Params::Difference => u.travelled / h,
        Params::Mt(mt) => mt::step(mt, &mut x.mt, u.position, u.edge, h),
        Params::Observer(observer) => observer::step(observer, &mut x.observer, u.travelled, u.effort),
    }
}
