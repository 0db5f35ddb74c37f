//! What moves the axis.

/// What moves the axis.
#[derive(Debug, Clone, PartialEq)]
pub enum Motor {
    /// A permanent-magnet synchronous motor on an averaged inverter.
    Pmsm(Pmsm),
    /// An ideal source: effort = gain × output, output saturating.
    IdealSource(IdealSource),
    /// The motor side follows the set-point exactly.
    Prescribed,
}

/// PMSM in dq, amplitude-invariant, phase-to-neutral.
#[derive(Debug, Clone, PartialEq)]
pub struct Pmsm {
    /// Pole pairs.
    pub pole_pairs: u32,
    /// Stator resistance, phase to neutral (Ω).
    pub resistance: f64,
    /// d-axis inductance (H).
    pub inductance_d: f64,
    /// q-axis inductance (H).
    pub inductance_q: f64,
    /// Flux linkage of the magnets, peak (V·s).
    pub flux_linkage: f64,
    /// Largest current, peak (A).
    pub max_current: f64,
    /// Encoder on the motor.
    pub encoder: Encoder,
}

/// Ideal effort source.
#[derive(Debug, Clone, PartialEq)]
pub struct IdealSource {
    /// Effort per unit of output (N/V or N·m/V); 1 where the output is the effort itself.
    pub gain: f64,
    /// What the output is.
    pub output: SourceOutput,
    /// Largest |output| (V, N or N·m).
    pub limit: f64,
    /// Encoder on the motor.
    pub encoder: Encoder,
}

/// What the output of an ideal source is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SourceOutput {
    /// A voltage (V).
    Voltage,
    /// The effort itself (N or N·m).
    Effort,
}

/// Position encoder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Encoder {
    /// Smallest step (motor coordinate for the motor's, axis coordinate for the load's); `None` for an ideal encoder.
    pub resolution: Option<f64>,
}
