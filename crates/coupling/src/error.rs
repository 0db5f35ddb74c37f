//! Errors of a coupled simulation.
use crate::network::NetworkError;
use thiserror::Error;

/// Reasons why a coupled simulation could not begin or continue; `E` is the error of its blocks.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CouplingError<E> {
    /// The network cannot be run as requested.
    #[error(transparent)]
    Network(#[from] NetworkError),
    /// A block could not continue.
    #[error("`{block}` failed at {time} s: {source}")]
    Block {
        /// Name of the block.
        block: String,
        /// Time (s).
        time: f64,
        /// Error of the block.
        source: E,
    },
    /// An output is not a finite number.
    #[error("`{output}` is {value} at {time} s, after communication step {step}")]
    NotFinite {
        /// Name of the output.
        output: String,
        /// Its value.
        value: f64,
        /// Time (s).
        time: f64,
        /// Number of the communication step.
        step: u64,
    },
    /// A block returned from a step at an impossible time.
    #[error(
        "`{block}` was requested to step from {from} s to {to} s and reports {at} s, after {parts} parts of the step"
    )]
    Astray {
        /// Name of the block.
        block: String,
        /// Start of the step (s).
        from: f64,
        /// End of the step (s).
        to: f64,
        /// Time reported by the block (s).
        at: f64,
        /// Number of early returns in this step.
        parts: u32,
    },
    /// An iteration did not converge.
    #[error(
        "the loop {cycle} did not converge in communication step {step} ({time} s): `{output}` still changed by {change} after \
         {iterations} iterations, allowed is {allowed}; raise `iterations` or `tolerance`, or take a smaller step than {length} s"
    )]
    NotConverged {
        /// Blocks or outputs of the loop.
        cycle: String,
        /// The output farthest from its tolerance.
        output: String,
        /// Its last change (its own unit).
        change: f64,
        /// Its tolerance (its own unit).
        allowed: f64,
        /// Number of evaluations.
        iterations: u32,
        /// Number of the communication step.
        step: u64,
        /// Time (s).
        time: f64,
        /// The communication step (s).
        length: f64,
    },
    /// A signal of a loop grows, and faster than its exchange can follow.
    #[error(
        "the coupling `{connection}` is unstable in communication step {step} ({time} s): the error of the extrapolated exchange grew {growth:.0}-fold in {exchanges} exchanges, to more than half of the signal; take a smaller step than {length} s, {help}"
    )]
    Unstable {
        /// The connection, as `a.x -> b.u`.
        connection: String,
        /// Number of the communication step.
        step: u64,
        /// Time (s).
        time: f64,
        /// Factor by which its defect has grown.
        growth: f64,
        /// Number of exchanges in which it has grown.
        exchanges: u32,
        /// The communication step (s).
        length: f64,
        /// Further remedy with this method.
        help: &'static str,
    },
}
