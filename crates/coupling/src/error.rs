//! Why a coupled simulation ended.
use crate::network::NetworkError;
use thiserror::Error;

/// Why a coupled simulation could not begin or go on; `E` is the error of its blocks.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CouplingError<E> {
    /// The network cannot be run as it was asked for.
    #[error(transparent)]
    Network(#[from] NetworkError),
    /// A block could not go on.
    #[error("`{block}` failed at {time} s: {source}")]
    Block {
        /// Name of the block.
        block: String,
        /// When (s).
        time: f64,
        /// Its own reason.
        source: E,
    },
    /// An output is not a finite number.
    #[error("`{output}` is {value} at {time} s, after communication step {step}")]
    NotFinite {
        /// The output.
        output: String,
        /// What it is.
        value: f64,
        /// When (s).
        time: f64,
        /// Number of the communication step.
        step: u64,
    },
    /// A block came back from a step at a time where it cannot be.
    #[error(
        "`{block}` was asked to go from {from} s to {to} s and says that it is at {at} s, after {parts} parts of the step"
    )]
    Astray {
        /// Name of the block.
        block: String,
        /// Where it was (s).
        from: f64,
        /// Where it should have gone (s).
        to: f64,
        /// Where it says that it is (s).
        at: f64,
        /// How often it came back early in this step.
        parts: u32,
    },
    /// An iteration did not come to its end.
    #[error(
        "the loop {cycle} did not agree in communication step {step} ({time} s): `{output}` still changed by {change} after {iterations} iterations, allowed is {allowed}; let them be more (`iterations`), let the loop agree less well (`tolerance`), or take a smaller step than {length} s"
    )]
    NotConverged {
        /// Blocks or outputs of the loop.
        cycle: String,
        /// The output farthest from its tolerance.
        output: String,
        /// Its last change (its own unit).
        change: f64,
        /// What it may change (its own unit).
        allowed: f64,
        /// How many evaluations there were.
        iterations: u32,
        /// Number of the communication step.
        step: u64,
        /// When (s).
        time: f64,
        /// The communication step (s).
        length: f64,
    },
    /// A signal of a loop grows, and faster than its exchange can follow.
    #[error(
        "the coupling `{connection}` is unstable in communication step {step} ({time} s): what the exchange did not expect grew {growth:.0}-fold in {exchanges} exchanges, to more than half of the signal; take a smaller step than {length} s, {help}"
    )]
    Unstable {
        /// The connection, as `a.x -> b.u`.
        connection: String,
        /// Number of the communication step.
        step: u64,
        /// When (s).
        time: f64,
        /// How much its defect has grown.
        growth: f64,
        /// In how many exchanges.
        exchanges: u32,
        /// The communication step (s).
        length: f64,
        /// What else may help with this method.
        help: &'static str,
    },
}
