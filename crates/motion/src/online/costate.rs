//! Sensitivity of the distance of a path to the highest derivative at its start.
//!
//! A path of order 3 leads the chain (p, v, a) to p₁ with zero v and a; ∫p is the distance of a chain of order 4 on it. A change du
//! of the rate of a for a time dt, s before the end, changes a, v, p and ∫p there by du·dt times 1, s, s²/2 and s³/6. The
//! switching times adapt so that a, v and p arrive as before. So ∫(p − p₁) changes by
//!
//! ```text
//! λ(s)·du·dt,    λ(s) = s³/6 + c₂s² + c₁s + c₀,    zero at every switching time and at the end,
//! ```
//!
//! since a moved switch may only change what others compensate: the costate of optimal control (Pontryagin). A hold
//! brings a to its limit from any value, so that λ on either side of it differs by a constant; a cruise does so
//! with v and a: a constant and a multiple of s. A change da at the start changes ∫(p − p₁) by λ(start)·da.
//!
//! The duration T changes in the same way by a κ(s) = s² + k₁s + k₀ that is zero at every switching time but not at the end: that
//! moves by dT = −κ(start)·da/(κ(0)·u), where u is the last rate. Together d∫p = λ(start)·da + p₁·dT.
use super::second;

/// Durations of the stretches up to the hold of v, or to the turn without one: up, hold of a, down.
type Away = [f64; 3];

/// d∫p/da at the start of a path: `away`, for `cruise` at the highest v if that is reached, and `home` from there to `p`.
pub(crate) fn by_a(away: Away, cruise: Option<f64>, home: &second::Fastest, p: f64) -> f64 {
    let [up, hold, down] = away;
    // Times before the end: switches on the path home, and on the path to it.
    let (home_down, home_hold, home_up) = (home.down, home.down + home.hold, home.duration());
    let third = home_up + cruise.unwrap_or(0.0);
    let second = third + down;
    let first = second + hold;
    let start = first + up;
    // Zeros of λ and κ in the time between the holds of a, except for a constant.
    let before = if cruise.is_some() { home_up } else { second };
    let (lambda_home, kappa_home) = (other_zero(home_down, home_hold, before), home_hold + before - home_down);
    let (lambda, kappa) = match cruise {
        None => ([0.0, home_down, lambda_home], [home_down, kappa_home]),
        // Zero at both ends of the path down to the cruise; the coefficient of s² is that of λ after it.
        Some(_) => ([second, third, home_down + lambda_home - second - third], [second, third]),
    };
    let lambda = |s: f64| (s - lambda[0]) * (s - lambda[1]) * (s - lambda[2]) / 6.0;
    let covered = lambda(start) - lambda(first);
    if p == 0.0 {
        return covered;
    }
    let kappa = |s: f64| (s - kappa[0]) * (s - kappa[1]);
    covered + p * (kappa(start) - kappa(first)) / (home_down * kappa_home * home.rate)
}

/// The z for which s·(s − y)·(s − z) has the same value at s = `one` and s = `other`.
fn other_zero(y: f64, one: f64, other: f64) -> f64 {
    let sum = one + other;
    (one * one + one * other + other * other - y * sum) / (sum - y)
}

#[cfg(test)]
mod tests {
    use super::super::first::State;
    use super::super::fourth::State4;
    use super::super::newton::Near;
    use super::super::second::Sides;
    use super::super::third::{self, Limits3, State3};

    /// Oracle: the difference of two paths. Its error is the third derivative times 1e-10, and 1e-16/1e-5 by rounding.
    #[test]
    fn what_a_way_covers_changes_by_that_much() {
        let free = Limits3 { v: Sides::both(1e3), a: Sides::both(1e3), j: 1.0 };
        let held = Limits3 { a: Sides { below: 0.7, above: 0.5 }, ..free };
        let cruising = Limits3 { v: Sides { below: 0.6, above: 0.8 }, ..free };
        let both = Limits3 { v: cruising.v, ..held };
        for (name, limits) in [("free", free), ("held", held), ("cruising", cruising), ("both", both)] {
            for from in [
                State3 { p: 0.0, v: 0.1, a: 0.2 },
                State3 { p: 0.4, v: -0.3, a: 0.1 },
                State3 { p: -1.0, v: 0.5, a: -0.3 },
            ] {
                for to in [State3 { p: 4.0, v: 0.0, a: 0.0 }, State3 { p: -3.0, v: 0.0, a: 0.0 }] {
                    let way = |da: f64| third::way(State3 { a: from.a + da, ..from }, to, &limits, &Near::nothing());
                    let covered =
                        |da: f64| State4 { x: 0.0, v: from.p, a: from.v, j: from.a + da }.along(&way(da).path).x;
                    let (exact, step) = (way(0.0).by_a, 1e-5);
                    let measured = (covered(step) - covered(-step)) / (2.0 * step);
                    assert!(
                        (exact - measured).abs() < 1e-8 * (1.0 + measured.abs()),
                        "{name} {from:?} {to:?}: {exact} {measured}"
                    );
                }
            }
        }
    }
}
