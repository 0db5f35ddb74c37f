//! How the velocity loop has the velocity of the motor: by differences, by the M/T method, or by an observer.
//!
//! | method | equation | age |
//! |---|---|---|
//! | difference | (θ(k) − θ(k−1))/T | T/2 |
//! | M/T ([`mt`]) | travel between the last edges of two cycles over the time between them | about T/2 |
//! | observer ([`observer`]) | a model of the motor that the measured position corrects | 0 |
//!
//! Without one of them the loop takes the velocity of an encoder that gives it, and differences of any other. The motor's coordinate.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use servobench_base::Stateful;
use servobench_config::ParameterError;

pub mod mt;
pub mod observer;

servobench_config::choices! {
    /// How the motor's velocity is measured.
    pub enum Method {
        /// the difference of two positions over the period of the velocity loop
        Difference = "difference",
        /// M/T method: the increments between the last edges of two cycles over the time between these edges
        Mt = "mt",
        /// an observer of position, velocity and disturbance
        Observer = "observer",
    }
}

/// The last edge of an incremental encoder: where it passed from one increment to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// How long ago (s).
    pub age: f64,
    /// Where, from the position that is read on (motor coordinate): half an increment in one direction or the other.
    pub offset: f64,
}

/// A method with its parameters; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Params {
    /// Differences, whatever the encoder gives.
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

/// What a cycle of the velocity loop knows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Input {
    /// Measured position (rad or m).
    pub position: f64,
    /// By how much that is more than a cycle ago (rad or m).
    pub travelled: f64,
    /// The encoder's last edge, where it tells.
    pub edge: Option<Edge>,
    /// Effort that was asked for in the last cycle (N·m or N).
    pub effort: f64,
    /// Velocity that the encoder gives (rad/s or m/s), where it gives one.
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

    /// A method that is linear in what it sees: the M/T method gives differences of positions, as finely as one likes.
    #[must_use]
    pub const fn linearised(self) -> Self {
        match self {
            Self::Difference | Self::Mt(_) => Self::Difference,
            Self::Observer(observer) => Self::Observer(observer),
        }
    }

    /// Age (s) of a velocity that is measured in cycles of `h` (s), with many edges in each.
    #[must_use]
    pub fn age(&self, h: f64) -> f64 {
        match self {
            Self::Difference | Self::Mt(_) => h / 2.0,
            Self::Observer(_) => 0.0,
        }
    }
}

impl State {
    /// Effort that is to be added so that the disturbance is met (N·m or N): none without an observer.
    #[inline(always)]
    #[must_use]
    pub fn compensation(&self, p: &Params) -> f64 {
        match p {
            Params::Difference | Params::Mt(_) => 0.0,
            Params::Observer(observer) => -observer.compensation * self.observer.disturbance,
        }
    }
}

/// The velocity that is measured at a cycle of the velocity loop, `h` (s) after the last one.
#[inline(always)]
pub fn step(p: &Params, x: &mut State, u: Input, h: f64) -> f64 {
    match p {
        Params::Difference => u.travelled / h,
        Params::Mt(mt) => mt::step(mt, &mut x.mt, u.position, u.edge, h),
        Params::Observer(observer) => observer::step(observer, &mut x.observer, u.travelled, u.effort),
    }
}
