//! Commands that are gentler than the state from which they start.
//!
//! An axis that is about to reach its limit of velocity or acceleration, as a brisk command leads it, would pass that limit if a
//! command with less jerk or snap took over at once. Where that is so, acceleration and jerk are brought to zero with what the
//! axis allows, and the command starts from there.
use super::bounds::Bounds;
use super::run::Run;
use servobench_base::Setpoint;
use servobench_motion::PlanError;
use servobench_motion::online::{Target, Transition};

/// What rounding may add to a limit, as a part of it.
const ROUNDING: f64 = 1e-9;

/// The way from `from` to `target` within `bounds`, begun `lead` seconds ago, on an axis with the bounds `axis`.
pub(super) fn planned(
    from: &Setpoint,
    target: &Target,
    bounds: &Bounds,
    axis: &Bounds,
    lead: f64,
) -> Result<Run, PlanError> {
    let way = bounds.plan(from, target)?;
    if is_fit_for(&way, axis) {
        return Ok(Run::new(way, lead, None, axis).planned_for(*target, *bounds));
    }
    // What is left of the velocity when the acceleration goes to zero at the jerk of the axis.
    let rest = from.v + from.a * from.a.abs() / (2.0 * axis.jerk);
    let calmed = axis.plan(from, &Target::Velocity(rest.clamp(-axis.velocity, axis.velocity)))?;
    Ok(Run::new(calmed, lead, Some((*target, *bounds)), axis).planned_for(*target, *bounds))
}

/// `from` with no more jerk and acceleration than the velocity that is left on an axis with the bounds `axis` takes up: a table
/// whose velocity has corners leads to states that no way within the limits of the axis does, and from which none leads on. The
/// acceleration then falls in a step, as it does at each of the corners.
pub(super) fn settled(from: &Setpoint, axis: &Bounds) -> Setpoint {
    let keeps_limits = axis.plan(from, &Target::Velocity(0.0)).is_ok_and(|way| keeps(&way, axis));
    if keeps_limits || axis.jerk == f64::INFINITY {
        return *from;
    }
    let room = (axis.velocity - from.v.copysign(from.v * from.a)).max(0.0);
    let steepest = steepest_before(room, axis).min(axis.acceleration);
    Setpoint { a: from.a.clamp(-steepest, steepest), j: 0.0, s: 0.0, ..*from }
}

/// The acceleration that is brought to zero while the velocity rises by `room`.
fn steepest_before(room: f64, axis: &Bounds) -> f64 {
    let Bounds { jerk, snap, .. } = *axis;
    if snap == f64::INFINITY {
        return libm::sqrt(2.0 * jerk * room);
    }
    // The jerk is a trapezoid, in a/j + j/s; or a triangle, in 2·√(a/s).
    let least = jerk * jerk / snap;
    let trapezoid = 0.5 * (libm::sqrt(least * least + 8.0 * jerk * room) - least);
    if trapezoid >= least { trapezoid } else { libm::cbrt(snap * room * room) }
}

/// Whether an axis with the bounds `axis` can go the way.
pub(super) fn is_fit_for(way: &Transition, axis: &Bounds) -> bool {
    way.excess() == 0.0 || keeps(way, axis)
}

/// Whether velocity and acceleration stay within those of the axis, as far as `way` is not on its way back into them.
fn keeps(way: &Transition, axis: &Bounds) -> bool {
    let (mut velocity, mut acceleration) = (way.at(0.0).v.abs(), way.at(0.0).a.abs());
    for segment in way.segments() {
        let start = way.at(segment.start);
        let mut see = |t: f64| {
            if t >= 0.0 && t <= segment.length {
                let there = start.after(t);
                velocity = velocity.max(there.v.abs());
                acceleration = acceleration.max(there.a.abs());
            }
        };
        see(0.0);
        see(segment.length);
        // j + s·t = 0, and a + j·t + s·t²/2 = 0.
        see(-start.j / start.s);
        let root = libm::sqrt((start.j * start.j - 2.0 * start.s * start.a).max(0.0));
        see(-2.0 * start.a / (start.j + root));
        see(-2.0 * start.a / (start.j - root));
    }
    let within = |value: f64, limit: f64| value <= limit * (1.0 + ROUNDING);
    within(velocity, axis.velocity.max(way.at(0.0).v.abs()))
        && within(acceleration, axis.acceleration.max(way.at(0.0).a.abs()))
}
