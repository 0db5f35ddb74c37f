//! Observer of position, velocity and disturbance: a rigid motor under the commanded effort, corrected by the measured position.
//!
//! ```text
//! dθ/dt = ω      J·dω/dt = τ + d      dd/dt = 0                    τ: commanded effort, held over a cycle
//! r  = θ(k) − [θ̂ + T·ω̂ + T²/(2J)·(τ + d̂)]                         exact for constant τ and d
//! θ̂ += l_1·r past its prediction      ω̂ likewise += l_2·r      d̂ += l_3·r
//! l_1 = 1 − z³      l_2 = 3/2·(1 − z)²·(1 + z)/T      l_3 = (1 − z)³·J/T²      z = exp(−ω_o·T)
//! ```
//! All three poles of the error are z, those of (s + ω_o)³ in continuous time: the fading-memory filter of second degree, with the factor z
//! per cycle. White noise of the position of variance σ² appears in ω̂ with
//!
//! ```text
//! var ω̂ = (1 − z)³·(13 + 50·z + 49·z²)/(2·(1 + z)⁵)·σ²/T²          for a difference: 2·σ²/T²
//! ```
//! With the right inertia, ω̂ has no error at constant acceleration. Otherwise the equivalent disturbance, D = (Ĵ − J)·dω/dt, causes an
//! error of s·(s + 3ω_o)/(s + ω_o)³·D/Ĵ (continuous time): at a constant jerk j 3·(1 − J/Ĵ)·j/ω_o². The state holds the error of the
//! position, not the position: its rounding does not grow with the travel.
//! Sources: Luenberger, *An introduction to observers*, IEEE Transactions on Automatic Control 16(6), 1971; Lorenz & Van Patten,
//! *High-resolution velocity estimation for all-digital, AC servo drives*, IEEE Transactions on Industry Applications 27(4), 1991 (driven
//! by the effort); Brookner, *Tracking and Kalman Filtering Made Easy*, 1998, ch. 1 (gains of the fading memory; the variance there is that
//! of the prediction, here by hand that of the corrected value).
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use servobench_base::Stateful;
use servobench_config::Kind::Plain;
use servobench_config::quantities::{BANDWIDTH, RATIO};
use servobench_config::{Bound, Measure, ParameterError, positive};

servobench_config::parameters! {
    /// A parameter of the observer.
    pub enum Parameter {
        /// Bandwidth ω_o: all three poles of the error
        OBSERVER_BANDWIDTH "bandwidth of the observer" = positive(Plain(&BANDWIDTH), "200 Hz");
        /// Share of the observed disturbance that is subtracted from the effort
        COMPENSATION "compensation of the disturbance" = Measure { kind: Plain(&RATIO), bound: Bound::Within(0.0, 1.0), example: "0.8" };
    }
}

/// Parameters; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Period T (s).
    pub period: f64,
    /// Total inertia Ĵ at the motor (kg·m² or kg), as assumed by the drive.
    pub inertia: f64,
    /// Corrections per position: of the position (1), of the velocity (1/s), of the disturbance (N·m/rad or N/m).
    pub gains: [f64; 3],
    /// Share of the observed disturbance that is subtracted from the effort.
    pub compensation: f64,
}

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct State {
    /// Measured position minus the observed one (rad or m).
    pub behind: f64,
    /// Observed velocity (rad/s or m/s).
    pub velocity: f64,
    /// Observed disturbance (N·m or N).
    pub disturbance: f64,
}

impl Params {
    /// Parameters with all poles at the bandwidth `omega` (rad/s), in cycles of `period` (s), for a motor of this `inertia`.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter out of its bound.
    pub fn new(omega: f64, period: f64, inertia: f64, compensation: f64) -> Result<Self, ParameterError> {
        Parameter::OBSERVER_BANDWIDTH.check(omega)?;
        let z = libm::exp(-omega * period);
        // 1 − z, without cancellation in a slow observer.
        let left = -libm::expm1(-omega * period);
        let gains = [
            left * (1.0 + z + z * z),
            1.5 * left * left * (1.0 + z) / period,
            left * left * left * inertia / (period * period),
        ];
        let params = Self { period, inertia, gains, compensation };
        params.check().map(|()| params)
    }

    /// # Errors
    /// [`ParameterError`] names the first parameter out of its bound.
    pub fn check(&self) -> Result<(), ParameterError> {
        let Self { period, inertia, gains, compensation } = *self;
        let is_positive = |value: f64| value > 0.0 && value.is_finite();
        if ![period, inertia].into_iter().chain(gains).all(is_positive) {
            let name = Parameter::OBSERVER_BANDWIDTH;
            return Err(ParameterError { name, value: gains[1], bound: "of a motor whose inertia is known" });
        }
        Parameter::COMPENSATION.check(compensation).map(|_| ())
    }
}

/// Observed velocity in a cycle: `travelled` since the last one, with the commanded `effort`.
#[inline(always)]
pub fn step(p: &Params, x: &mut State, travelled: f64, effort: f64) -> f64 {
    let h = p.period;
    let acceleration = (effort + x.disturbance) / p.inertia;
    let residual = x.behind + travelled - h * (x.velocity + h / 2.0 * acceleration);
    let [of_position, of_velocity, of_disturbance] = p.gains;
    x.behind = (1.0 - of_position) * residual;
    x.velocity += h * acceleration + of_velocity * residual;
    x.disturbance += of_disturbance * residual;
    x.velocity
}

#[cfg(test)]
mod tests;
