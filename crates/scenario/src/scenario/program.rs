//! What happens: moves, disturbances, where the axis starts.
use super::Limit;

/// A step of the program.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// A rest-to-rest move.
    Move(MoveStep),
    /// A pause (s).
    Wait(f64),
}

/// A rest-to-rest move.
#[derive(Debug, Clone, PartialEq)]
pub struct MoveStep {
    /// Target: absolute, or relative to the last target (axis coordinate).
    pub target: Target,
    /// Order of the profile: 2, 3 or 4.
    pub order: u8,
    /// Limits of |velocity|, |acceleration|, |jerk|, |snap|; infinite where the order has none.
    pub limits: [f64; 4],
    /// Sampled plan with this sample time (s); `None` for the continuous one.
    pub sample_time: Option<f64>,
    /// Slowed to last this long (s), every derivative in proportion; `None`: as fast as the limits allow.
    pub duration: Option<f64>,
    /// Limits of what is measured on this move.
    pub metric_limits: Vec<Limit>,
}

/// Where a move goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// To a position.
    Absolute(f64),
    /// By a distance.
    Relative(f64),
}

/// An external effort.
#[derive(Debug, Clone, PartialEq)]
pub struct Disturbance {
    /// Body it acts on.
    pub on: DisturbedBody,
    /// First instant (s).
    pub start: f64,
    /// How long (s); infinite: to the end.
    pub duration: f64,
    /// Amplitude (N or N·m, in the body's coordinate).
    pub effort: f64,
    /// Frequency of a sine (Hz); `None` for a step.
    pub frequency: Option<f64>,
}

/// Body a disturbance acts on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DisturbedBody {
    /// The motor (motor coordinate).
    Motor,
    /// The load (axis coordinate).
    Load,
}

/// Initial deviation of the load from rest at zero (axis coordinate).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Initial {
    /// Load position (m or rad).
    pub load_position: f64,
    /// Load velocity (m/s or rad/s).
    pub load_velocity: f64,
}
