//! What the caller knows and a recording does not.
use servobench_base::Coordinate;
use servobench_metrics::Name;
use servobench_plant::pmsm;

/// What to show beside the recorded channels.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewOptions {
    /// What came of each run, in their order; runs beyond the last have none.
    pub verdicts: Vec<Verdict>,
    /// Channel name and largest magnitude (SI) that motor and drive allow it: drawn as lines at ± the value, or at + the
    /// value only where the channel is never negative.
    pub limits: Vec<(String, f64)>,
    /// Metric and the largest value of it (SI) that passes. Drawn where it bounds a curve: the following errors, torque,
    /// current and voltage as [`ViewOptions::limits`]; vibration, overshoot and settling time in the plot of the residual
    /// vibration. Others are left out.
    pub allowed: Vec<(Name, f64)>,
    /// Settling window, ± (axis unit): drawn around the residual vibration, with the instant from which on the load is in it.
    pub window: Option<f64>,
    /// From when on residual vibration is shown when there is no move (s).
    pub residual_from: Option<f64>,
    /// Largest number of instants per curve. A longer channel is thinned to a minimum/maximum envelope
    /// ([`servobench_trace::envelope`]): every extreme stays, at its own instant.
    pub max_instants: usize,
    /// Factor by which the deflection of the load against the motor is enlarged in the 3D view; `None` chooses one at
    /// which the largest deflection can be seen.
    pub exaggeration: Option<f64>,
    /// The motor and what bounds it, for the page of its operating point; `None` without a synchronous motor.
    pub motor: Option<MotorLimits>,
}

/// A synchronous motor and what bounds it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotorLimits {
    /// The motor.
    pub motor: pmsm::Params,
    /// Largest current that the drive asks for, and voltage that the inverter gives in every direction.
    pub bounds: pmsm::Bounds,
    /// Voltage of the DC link (V).
    pub dc_link: f64,
    /// Largest effort that the drive asks for (N·m or N); may be infinite.
    pub effort: f64,
    /// Axis coordinate per motor coordinate; negative for a motor that is mounted the other way round.
    pub transmission: f64,
    /// Whether the motor turns or moves along a line.
    pub motion: Coordinate,
}

/// What came of a run, in words: the head of every page.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Verdict {
    /// Whether it passed.
    pub outcome: Outcome,
    /// What fails, a sentence each.
    pub reasons: Vec<String>,
    /// What fails nothing and should be known, a sentence each.
    pub warnings: Vec<String>,
}

/// Whether a run passed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Outcome {
    /// It kept all its limits.
    Passed,
    /// It did not.
    Failed,
    /// There was nothing to judge it by.
    #[default]
    Unjudged,
}

impl Default for ViewOptions {
    fn default() -> Self {
        Self {
            verdicts: Vec::new(),
            limits: Vec::new(),
            allowed: Vec::new(),
            window: None,
            residual_from: None,
            max_instants: 20_000,
            exaggeration: None,
            motor: None,
        }
    }
}
