//! Weighted sums of set-points.
use crate::PlanError;
use servobench_base::Setpoint;

/// Largest magnitude that a filter accepts (SI): far above any set-point, and as far below an overflow of sums.
const HIGHEST: f64 = 1e150;

/// The set-point with this number in its stream, if all its values are finite and at most 1e150 in magnitude.
pub(super) fn checked(index: u64, setpoint: Setpoint) -> Result<Setpoint, PlanError> {
    let Setpoint { x, v, a, j, s } = setpoint;
    for (name, value) in [("x", x), ("v", v), ("a", a), ("j", j), ("s", s)] {
        if !(-HIGHEST..=HIGHEST).contains(&value) {
            return Err(PlanError::Sample { index, name, value, highest: HIGHEST });
        }
    }
    Ok(setpoint)
}

pub(super) fn plus(one: Setpoint, two: Setpoint) -> Setpoint {
    Setpoint { x: one.x + two.x, v: one.v + two.v, a: one.a + two.a, j: one.j + two.j, s: one.s + two.s }
}

pub(super) fn minus(one: Setpoint, two: Setpoint) -> Setpoint {
    Setpoint { x: one.x - two.x, v: one.v - two.v, a: one.a - two.a, j: one.j - two.j, s: one.s - two.s }
}

/// `newest` + Σ weight·(set-point − `newest`): the sum with the given weights, and the rest of one for `newest`. If
/// all set-points are the same, the result is exactly that one.
pub(super) fn blend(newest: Setpoint, others: impl Iterator<Item = (f64, Setpoint)>) -> Setpoint {
    others.fold(newest, |sum, (weight, other)| plus(sum, minus(other, newest).scaled(weight)))
}
