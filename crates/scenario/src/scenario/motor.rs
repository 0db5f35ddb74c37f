//! Motors: a synchronous one, an ideal source.

/// PMSM in dq, amplitude-invariant, phase-to-neutral; one that turns or a linear one.
#[derive(Debug, Clone, PartialEq)]
pub struct Pmsm {
    /// Electrical angle per motor coordinate: the pole pairs of a motor that turns (rad/rad), π/τ_p of a linear motor
    /// with the pole pitch τ_p (rad/m).
    pub electrical_ratio: f64,
    /// Stator resistance, phase to neutral (Ω).
    pub resistance: f64,
    /// d-axis inductance (H).
    pub inductance_d: f64,
    /// q-axis inductance (H).
    pub inductance_q: f64,
    /// Flux linkage of the magnets, peak (V·s).
    pub flux_linkage: f64,
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

impl Pmsm {
    /// Torque or force per ampere of amplitude at i_d = 0: 1.5·p·ψ (N·m/A), of a linear motor 1.5·(π/τ_p)·ψ (N/A).
    #[must_use]
    pub fn effort_constant(&self) -> f64 {
        self.effort_constant_at(0.0)
    }

    /// The same at the d-axis current `i_d` (A, peak): 1.5·p·(ψ + (L_d − L_q)·i_d).
    #[must_use]
    pub fn effort_constant_at(&self, i_d: f64) -> f64 {
        let reluctance = if i_d == 0.0 { 0.0 } else { (self.inductance_d - self.inductance_q) * i_d };
        1.5 * self.electrical_ratio * (self.flux_linkage + reluctance)
    }
}
