//! Reasons why scenarios cannot be compared.
use servobench_sim::BuildError;
use thiserror::Error;

/// Reasons why scenarios cannot be compared.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CompareError {
    /// No measurement of one has a meaning for the other.
    #[error(
        "`{one}` is {motion} and `{other}` {other_motion}: a length and an angle cannot be compared; compare axes of one kind"
    )]
    Axes {
        /// Name of the first scenario.
        one: String,
        /// `linear`, `rotary`.
        motion: &'static str,
        /// Name of the other.
        other: String,
        /// Its kind.
        other_motion: &'static str,
    },
    /// Moves without a counterpart cannot have its limits or its duration.
    #[error(
        "`{one}` makes {moves} moves and `{other}` {other_moves}; what is to be equal needs the same moves in each"
    )]
    Moves {
        /// Name of the first scenario.
        one: String,
        /// Its moves.
        moves: usize,
        /// Name of the other.
        other: String,
        /// Its moves.
        other_moves: usize,
    },
    /// A limit that both moves have differs.
    #[error(
        "move {number} of `{one}` is limited to {value} in {derivative} (SI), that of `{other}` to {other_value}; without \
         equal limits each runs at its own"
    )]
    Limits {
        /// Number of the move, from 1.
        number: usize,
        /// `velocity`, `acceleration`, `jerk`, `snap`.
        derivative: &'static str,
        /// Name of the first scenario.
        one: String,
        /// Its limit (SI).
        value: f64,
        /// Name of the other.
        other: String,
        /// Its limit (SI).
        other_value: f64,
    },
    /// A move cannot be planned.
    #[error("`{scenario}`: {error}")]
    Plan {
        /// Name of the scenario.
        scenario: String,
        /// The reason.
        error: BuildError,
    },
    /// The gentlest run has a value of zero in the compared quantity.
    #[error(
        "the {what} of `{scenario}` is {value}: no other run can be slowed to nothing; name a value, as in --equal {example}"
    )]
    Nothing {
        /// Name of the run.
        scenario: String,
        /// The compared quantity, in words.
        what: &'static str,
        /// Its value, with its unit.
        value: String,
        /// Option that may be written instead.
        example: &'static str,
    },
    /// Every run breaks a requirement: there is none to equal.
    #[error(
        "the {what} cannot be made equal: every run breaks a requirement at its own limits; `servobench run` reports which"
    )]
    NoneSound {
        /// The compared quantity, in words.
        what: &'static str,
    },
    /// The compared quantity was not measured in a run.
    #[error("the {what} of `{scenario}` cannot be made equal: {metric} could not be measured, {why}{remedy}")]
    NotMeasured {
        /// Name of the run.
        scenario: String,
        /// The compared quantity, in words.
        what: &'static str,
        /// Name of the metric.
        metric: &'static str,
        /// Reason why it was not measured.
        why: String,
        /// Remedy, after a semicolon; empty where none is known.
        remedy: &'static str,
    },
    /// Its moves have no duration that could be changed.
    #[error("`{scenario}` cannot be slowed: {why}")]
    NotSlowable {
        /// Name of the run.
        scenario: String,
        /// The reason.
        why: String,
    },
    /// The requested duration is shorter than that of the run at its own limits.
    #[error(
        "`{scenario}` takes {shortest} at its own limits, longer than the {wanted} that are wanted: moves are slowed and not \
         sped up; name at least {shortest}, or raise its limits"
    )]
    TooSlow {
        /// Name of the run.
        scenario: String,
        /// Duration of its longest move.
        shortest: String,
        /// The requested duration.
        wanted: String,
    },
    /// No permitted slowdown brings its value down to the target.
    #[error(transparent)]
    NotReached(Box<NotReached>),
}

/// No permitted slowdown brings a run's value down to the target.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "`{scenario}` does not come down to {what} {target}: at its own limits it has {own}, and with moves up to {factor} × as \
     long {least} at the least; name a value that all can reach, as in --equal {example}"
)]
pub struct NotReached {
    /// Name of the run.
    pub scenario: String,
    /// The compared quantity, in words.
    pub what: &'static str,
    /// The target, with its unit.
    pub target: String,
    /// Its value at its own limits.
    pub own: String,
    /// Largest factor of the duration of its moves that was tried.
    pub factor: String,
    /// Its least measured value.
    pub least: String,
    /// Option that may be written instead.
    pub example: &'static str,
}
