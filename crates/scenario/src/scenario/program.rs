//! The program: moves of every family, and pauses.
use servobench_metrics::Limit;
use servobench_motion::interpolate::Mode;
use servobench_planner::{Positioning, Request};

/// A step of the program.
#[derive(Debug, Clone, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "a program has some dozen steps, most of them moves")]
pub enum Step {
    /// A move.
    Move(MoveStep),
    /// A pause (s).
    Wait(f64),
}

/// A move.
#[derive(Debug, Clone, PartialEq)]
pub struct MoveStep {
    /// The move as if from rest at position 0; its initial state is known once the previous move is planned.
    pub request: Request,
    /// Origin of its positions.
    pub positioning: Positioning,
    /// Time for which its final velocity is held (s).
    pub hold: f64,
    /// Time after the start of the previous move at which this one takes over (s); `None`: at its end.
    pub aborts_after: Option<f64>,
    /// Limits of the metrics of this move.
    pub metric_limits: Vec<Limit>,
}

/// Interpolation between a slow commanding task and the drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interpolation {
    /// Method by which values between two commands are found.
    pub mode: Mode,
    /// Time between two commands (s), a whole number of base ticks.
    pub period: f64,
}
