//! A point of a table in SI.
use crate::PlanError;
use crate::limits::RANGE;
use servobench_base::Stateful;

/// Time, position and velocity of a point.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct Knot {
    /// Time (s), later than that of the point before by at least 1e-30 s.
    pub t: f64,
    /// Position (m or rad), absolute.
    pub x: f64,
    /// Velocity (m/s or rad/s); without it the path to this point is linear.
    pub v: Option<f64>,
}

impl Knot {
    /// Position `x` (m or rad) at time `t` (s), with a velocity to be chosen or a linear approach.
    #[must_use]
    pub const fn new(t: f64, x: f64) -> Self {
        Self { t, x, v: None }
    }

    /// Position `x` (m or rad) at time `t` (s), passed with the velocity `v` (m/s or rad/s).
    #[must_use]
    pub const fn moving(t: f64, x: f64, v: f64) -> Self {
        Self { t, x, v: Some(v) }
    }
}

/// `knots` if they are a table: two at least, finite, in the order of time.
///
/// # Errors
/// [`PlanError`] names the first point that is not.
pub(crate) fn checked(knots: &[Knot]) -> Result<(), PlanError> {
    if knots.len() < 2 {
        return Err(PlanError::TooFewPoints { points: knots.len() });
    }
    let mut last = f64::NEG_INFINITY;
    for (point, knot) in knots.iter().enumerate() {
        for (name, value) in [("t", knot.t), ("x", knot.x), ("v", knot.v.unwrap_or(0.0))] {
            within(point, name, value)?;
        }
        // The difference, not only the order: two times may be next to each other in `f64`.
        if knot.t - last < RANGE.0 {
            return Err(PlanError::Point {
                point,
                name: "t",
                value: knot.t,
                bound: "at least 1e-30 s later than at the point before",
                remedy: "sort the points by time and give each a different time",
            });
        }
        last = knot.t;
    }
    Ok(())
}

/// `value` if it is a number within ±1e30.
pub(crate) fn within(point: usize, name: &'static str, value: f64) -> Result<f64, PlanError> {
    if value.abs() <= RANGE.1 {
        Ok(value)
    } else {
        Err(PlanError::Point { point, name, value, bound: "a number within ±1e30", remedy: "correct it or its unit" })
    }
}

/// As much of `scratch` as `points` points need.
///
/// # Errors
/// [`PlanError::ShortSlice`] if it is shorter.
pub(crate) fn scratch_for(scratch: &mut [f64], points: usize) -> Result<&mut [f64], PlanError> {
    let length = scratch.len();
    scratch.get_mut(..points).ok_or(PlanError::ShortSlice { name: "scratch", length, points })
}
