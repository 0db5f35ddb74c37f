//! Errors of the analysis of a loop.
use servobench_base::ParamError;
use thiserror::Error;

/// Reasons why a loop could not be analysed.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StabilityError {
    /// A parameter is out of its bound.
    #[error(transparent)]
    Parameter(#[from] ParamError),
    /// A parameter of the drive is out of its bound.
    #[error(transparent)]
    Drive(#[from] servobench_drive::ParameterError),
    /// The running loop has no matrices.
    #[error(transparent)]
    Linear(#[from] servobench_linear::LinearError),
    /// The source of effort does not suit the drive's output.
    #[error("a current loop is for a synchronous motor, a direct output for an ideal source")]
    SourceDoesNotFit,
    /// The numbers of one period of the loop overflow.
    #[error(
        "the poles of the loop cannot be computed: over the common period of its loops ({ticks} base ticks) it grows beyond 1e150"
    )]
    Overflow {
        /// Length of the period (base ticks).
        ticks: usize,
    },
    /// The QR iteration gave up.
    #[error(
        "the poles of the loop cannot be computed: the QR iteration did not converge after {iterations} iterations for one of them"
    )]
    NotConverged {
        /// Allowed number of iterations.
        iterations: u32,
    },
}
