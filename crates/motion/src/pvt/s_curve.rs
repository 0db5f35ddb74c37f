//! The simplest move with continuous acceleration as a table.
use super::{Knot, checked};
use crate::PlanError;
use crate::limits::in_range;
use servobench_base::{finite, positive};

/// The move by `distance` (m or rad) from rest at `start` (m or rad) to rest in four segments of `segment_time` (s),
/// through which the jerk is J, −J, −J and J:
///
/// ```text
/// x = [0, J·T³/6, J·T³, 11/6·J·T³, 2·J·T³]     v = [0, J·T²/2, J·T², J·T²/2, 0]     J = distance/(2·T³)
/// ```
///
/// # Errors
/// [`PlanError`] names the argument that is not finite, not positive or out of range.
pub fn s_curve(start: f64, distance: f64, segment_time: f64) -> Result<[Knot; 5], PlanError> {
    let time = in_range("segment_time", positive("segment_time", segment_time)?, "correct its unit")?;
    let (start, distance) = (finite("start", start)?, finite("distance", distance)?);
    let knot = |k: f64, x: f64, v: f64| Knot::moving(k * time, start + x * distance, v * (distance / time));
    let knots = [
        knot(0.0, 0.0, 0.0),
        knot(1.0, 1.0 / 12.0, 0.25),
        knot(2.0, 0.5, 0.5),
        knot(3.0, 11.0 / 12.0, 0.25),
        knot(4.0, 1.0, 0.0),
    ];
    checked(&knots)?;
    Ok(knots)
}

/// The segment time T (s) with which [`s_curve`] covers `distance` (m or rad) with the jerk `jerk` (m/s³ or rad/s³):
/// T = ∛(|distance|/(2·jerk)).
///
/// # Errors
/// [`PlanError`] names the argument that is zero, not finite or out of range.
pub fn s_curve_segment_time(distance: f64, jerk: f64) -> Result<f64, PlanError> {
    let distance = in_range("distance", positive("distance", distance.abs())?, "correct its unit")?;
    let jerk = in_range("jerk", positive("jerk", jerk)?, "correct its unit")?;
    Ok(libm::cbrt(distance / (2.0 * jerk)))
}
