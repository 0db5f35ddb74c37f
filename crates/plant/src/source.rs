//! An ideal source of force or torque: effort = gain · output, |output| ≤ limit.

/// An ideal source; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IdealSource {
    /// Effort per unit of output (N/V or N·m/V); 1 if the output is the effort itself.
    pub gain: f64,
    /// Quantity of the output.
    pub output: SourceOutput,
    /// Largest |output| (V, N or N·m); infinite without a limit.
    pub limit: f64,
}

/// Quantity of the output of an ideal source.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SourceOutput {
    /// A voltage (V).
    Voltage,
    /// The effort itself (N or N·m).
    Effort,
}
