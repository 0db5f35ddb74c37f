//! Chains for which RK4 diverges.
//!
//! A step scales a mode e^(λt) by the factor
//!
//! ```text
//! R(z) = 1 + z + z²/2 + z³/6 + z⁴/24      z = λ·h
//! ```
//! and the chain is stable while |R(λ·h)| ≤ 1 for all its eigenvalues: an undamped mode up to ω·h = 2·√2, a damper alone up
//! to −λ·h = 2.785. Source: Hairer & Wanner, *Solving Ordinary Differential Equations II*, §IV.2.
use crate::NAME;
use servobench_plant::{Chain, Drive, Integrator, MechanicsError, MechanicsSetup};
use std::f64::consts::TAU;

/// Rounding of a factor of one.
const ROUNDING: f64 = 1e-9;

/// Refuses a chain that grows from step to step by itself.
pub(crate) fn check(chain: &Chain, setup: &MechanicsSetup) -> Result<(), MechanicsError> {
    let h = setup.step;
    let eigenvalues = chain.eigenvalues(setup.drive == Drive::Prescribed);
    let grows = |value: &&_| Integrator::rk4_gain(**value, h) > 1.0 + ROUNDING;
    let Some(fastest) = eigenvalues.iter().filter(grows).max_by(|one, other| one.norm().total_cmp(&other.norm()))
    else {
        return Ok(());
    };
    let (rate, tick) = (fastest.norm(), h * 1e6);
    let what = if fastest.im == 0.0 {
        format!("a damper that takes {:.3} µs at a tick of {tick} µs: RK4 blows it up", 1e6 / rate)
    } else {
        format!(
            "a mode of {:.0} Hz at a tick of {tick} µs: its ω·h is {:.2}, and RK4 blows it up",
            rate / TAU,
            rate * h
        )
    };
    let help = "raise the base rate, merge the bodies that the stiff link couples, or choose the engine `exact`";
    Err(MechanicsError::Unsupported { engine: NAME, what, help: help.into() })
}
