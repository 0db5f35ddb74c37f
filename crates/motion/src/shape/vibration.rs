//! The vibration to be avoided.
use crate::PlanError;
use crate::limits::in_range;
use servobench_base::{ParamError, positive};

/// A mode of the axis: a complex pair of poles `−ζω ± jω·√(1 − ζ²)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vibration {
    omega_n: f64,
    zeta: f64,
}

impl Vibration {
    /// A mode of natural frequency `omega_n` (rad/s) and damping ratio `zeta`, 0 for undamped.
    ///
    /// # Errors
    /// [`PlanError`] when the frequency is not between 1e-30 and 1e30 rad/s or the damping ratio is not at least 0 and
    /// below 1, where nothing oscillates.
    pub fn new(omega_n: f64, zeta: f64) -> Result<Self, PlanError> {
        let omega_n = in_range("omega_n", positive("omega_n", omega_n)?, "correct its unit")?;
        if !(0.0..1.0).contains(&zeta) {
            return Err(ParamError { name: "zeta", value: zeta, bound: "at least 0 and below 1" }.into());
        }
        Ok(Self { omega_n, zeta })
    }

    /// Natural frequency ω (rad/s).
    #[must_use]
    pub const fn omega_n(&self) -> f64 {
        self.omega_n
    }

    /// Damping ratio ζ.
    #[must_use]
    pub const fn zeta(&self) -> f64 {
        self.zeta
    }

    /// Frequency at which it rings, `ω_d = ω·√(1 − ζ²)` (rad/s).
    #[must_use]
    pub fn omega_d(&self) -> f64 {
        self.omega_n * libm::sqrt((1.0 - self.zeta) * (1.0 + self.zeta))
    }

    /// Rate at which it decays, `ζω` (1/s).
    #[must_use]
    pub const fn decay(&self) -> f64 {
        self.zeta * self.omega_n
    }

    /// Half a period of the damped vibration, `π/ω_d` (s).
    #[must_use]
    pub fn half_period(&self) -> f64 {
        core::f64::consts::PI / self.omega_d()
    }
}
