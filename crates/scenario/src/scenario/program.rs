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
    /// The move as it would be from rest at position 0; the state in which it begins is known when the move before is planned.
    pub request: Request,
    /// What its positions count from.
    pub positioning: Positioning,
    /// How long the velocity that it ends with is held (s).
    pub hold: f64,
    /// Takes over from the move before, so long after the start of that (s); at its end without.
    pub aborts_after: Option<f64>,
    /// Limits of what is measured on this move.
    pub metric_limits: Vec<Limit>,
}

/// Between a slow task that commands and the drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interpolation {
    /// How values between two commands are found.
    pub mode: Mode,
    /// Time between two commands (s), a whole number of base ticks.
    pub period: f64,
}
