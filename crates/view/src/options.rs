//! What the caller knows and a recording does not.

/// What to show beside the recorded channels.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewOptions {
    /// Channel name and largest allowed magnitude (SI): drawn as lines at ± the value, or at + the value only where the
    /// channel is never negative.
    pub limits: Vec<(String, f64)>,
    /// Settling window, ± (axis unit): drawn around the residual vibration.
    pub window: Option<f64>,
    /// From when on residual vibration is shown when there is no move (s).
    pub residual_from: Option<f64>,
    /// Largest number of instants per curve. A longer channel is thinned to a minimum/maximum envelope
    /// ([`servobench_trace::envelope`]): every extreme stays, at its own instant.
    pub max_instants: usize,
    /// Factor by which the deflection of the load against the motor is enlarged in the 3D view; `None` chooses one at
    /// which the largest deflection can be seen.
    pub exaggeration: Option<f64>,
}

impl Default for ViewOptions {
    fn default() -> Self {
        Self { limits: Vec::new(), window: None, residual_from: None, max_instants: 20_000, exaggeration: None }
    }
}
