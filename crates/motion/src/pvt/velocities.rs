//! Velocities for given positions and times.
use super::{Knot, checked, knot::within, scratch_for};
use crate::PlanError;

/// Coefficients of the row of a point: λ·V0 + 2·V1 + μ·V2 = r.
struct Row {
    lambda: f64,
    mu: f64,
    r: f64,
}

/// Row of the point in the middle of three.
fn row(before: &Knot, here: &Knot, behind: &Knot) -> Row {
    let (h0, h1) = (here.t - before.t, behind.t - here.t);
    let (lambda, mu) = (h1 / (h0 + h1), h0 / (h0 + h1));
    Row { lambda, mu, r: 3.0 * (lambda * ((here.x - before.x) / h0) + mu * ((behind.x - here.x) / h1)) }
}

fn velocity(knots: &[Knot], point: usize) -> Result<f64, PlanError> {
    knots[point].v.ok_or(PlanError::Point {
        point,
        name: "v",
        value: f64::NAN,
        bound: "given",
        remedy: "choose a first velocity for each point, by the average rule if nothing better is known",
    })
}

/// Checks `knots` and gives the first and the last one its velocity.
pub(crate) fn set_ends(knots: &mut [Knot], start: f64, end: f64) -> Result<(), PlanError> {
    checked(knots)?;
    let last = knots.len() - 1;
    knots[0].v = Some(within(0, "v", start)?);
    knots[last].v = Some(within(last, "v", end)?);
    Ok(())
}

/// Sets the velocity of each point to the mean of the segments before and behind it, that of the first and the last one to `start`
/// and `end` (m/s or rad/s).
///
/// # Errors
/// [`PlanError`] for fewer than two points, and names the first one that is not finite or not later than the one
/// before.
pub fn average(knots: &mut [Knot], start: f64, end: f64) -> Result<(), PlanError> {
    set_ends(knots, start, end)?;
    for i in 1..knots.len() - 1 {
        let (before, behind) = (knots[i - 1], knots[i + 1]);
        knots[i].v = Some((behind.x - before.x) / (behind.t - before.t));
    }
    Ok(())
}

/// Reduces the jumps of acceleration at the points, in `passes` passes of the formulas F2 and F1 over the velocities
/// of the points; those of the first and the last point stay. See [the module](super) for the
/// convergence.
///
/// # Errors
/// [`PlanError`] names the first point without a velocity; otherwise as [`average`].
pub fn smooth(knots: &mut [Knot], passes: usize) -> Result<(), PlanError> {
    checked(knots)?;
    for i in 0..knots.len() {
        velocity(knots, i)?;
    }
    let last = knots.len() - 1;
    for _ in 0..passes {
        let mut before = velocity(knots, 0)?;
        for i in 1..last {
            let here = row(&knots[i - 1], &knots[i], &knots[i + 1]);
            before = if i + 1 < last {
                let next = row(&knots[i], &knots[i + 1], &knots[i + 2]);
                let behind = here.mu * (next.mu * velocity(knots, i + 2)? - next.r);
                (2.0 * (here.r - here.lambda * before) + behind) / (4.0 - here.mu * next.lambda)
            } else {
                (here.r - here.lambda * before - here.mu * velocity(knots, last)?) / 2.0
            };
            knots[i].v = Some(before);
        }
    }
    Ok(())
}

/// Sets the velocities of the points so that the acceleration is continuous at all of them, those of the first and the last one to
/// `start` and `end` (m/s or rad/s): the cubic spline through the points. `scratch` holds a value for each point.
///
/// # Errors
/// [`PlanError::ShortSlice`]; otherwise as [`average`].
pub fn continuous(knots: &mut [Knot], start: f64, end: f64, scratch: &mut [f64]) -> Result<(), PlanError> {
    let scratch = scratch_for(scratch, knots.len())?;
    set_ends(knots, start, end)?;
    let last = knots.len() - 1;
    // Elimination: V(i) + scratch(i)·V(i+1) = V(i) as stored. The pivot is at least 3/2, as λ < 1 and the factor before
    // is at most 1/2.
    let (mut above, mut known) = (0.0, start);
    for i in 1..last {
        let Row { lambda, mu, r } = row(&knots[i - 1], &knots[i], &knots[i + 1]);
        let pivot = 2.0 - lambda * above;
        (above, known) = (mu / pivot, (r - lambda * known) / pivot);
        (scratch[i], knots[i].v) = (above, Some(known));
    }
    let mut behind = end;
    for i in (1..last).rev() {
        behind = velocity(knots, i)? - scratch[i] * behind;
        knots[i].v = Some(behind);
    }
    Ok(())
}
