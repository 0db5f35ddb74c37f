//! Why scenarios cannot be compared.
use servobench_sim::BuildError;
use thiserror::Error;

/// Why scenarios cannot be compared.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CompareError {
    /// Nothing that is measured of one has a meaning for the other.
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
        /// Why not.
        error: BuildError,
    },
    /// The gentlest run has nothing of what is to be equal.
    #[error(
        "the {what} of `{scenario}` is {value}: no other run can be slowed to nothing; name a value, as in --equal {example}"
    )]
    Nothing {
        /// Name of the run.
        scenario: String,
        /// What is to be equal, in words.
        what: &'static str,
        /// What it has, with its unit.
        value: String,
        /// What may be written instead.
        example: &'static str,
    },
    /// There is no run to make others equal to.
    #[error(
        "the {what} cannot be made equal: every run breaks a requirement at its own limits; `servobench run` reports which"
    )]
    NoneSound {
        /// What is to be equal, in words.
        what: &'static str,
    },
    /// What is to be equal was not measured of a run.
    #[error("the {what} of `{scenario}` cannot be made equal: {metric} could not be measured, {why}{remedy}")]
    NotMeasured {
        /// Name of the run.
        scenario: String,
        /// What is to be equal, in words.
        what: &'static str,
        /// Name of the metric.
        metric: &'static str,
        /// Why it was not measured.
        why: String,
        /// What helps, after a semicolon; empty where nothing is known.
        remedy: &'static str,
    },
    /// Its moves have no duration of their own.
    #[error("`{scenario}` cannot be slowed: {why}")]
    NotSlowable {
        /// Name of the run.
        scenario: String,
        /// Why not.
        why: String,
    },
    /// It is slower than it may be.
    #[error(
        "`{scenario}` takes {shortest} at its own limits, longer than the {wanted} that are wanted: moves are slowed and not \
         sped up; name at least {shortest}, or raise its limits"
    )]
    TooSlow {
        /// Name of the run.
        scenario: String,
        /// How long its longest move lasts.
        shortest: String,
        /// What is wanted.
        wanted: String,
    },
    /// However slow it is, it does not come down to what is wanted.
    #[error(transparent)]
    NotReached(Box<NotReached>),
}

/// However slow a run is, it does not come down to what is wanted.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "`{scenario}` does not come down to {what} {target}: at its own limits it has {own}, and with moves up to {factor} × as \
     long {least} at the least; name a value that all can reach, as in --equal {example}"
)]
pub struct NotReached {
    /// Name of the run.
    pub scenario: String,
    /// What is to be equal, in words.
    pub what: &'static str,
    /// What is wanted, with its unit.
    pub target: String,
    /// What it has at its own limits.
    pub own: String,
    /// How much longer its moves were made at most.
    pub factor: String,
    /// The least of what was measured of it.
    pub least: String,
    /// What may be written instead.
    pub example: &'static str,
}
