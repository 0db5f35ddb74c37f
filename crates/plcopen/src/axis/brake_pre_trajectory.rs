//! Commands that are gentler than the state from which they start.
//!
//! An axis about to reach its limit of velocity or acceleration under a brisk command would exceed that limit if a command with less
//! jerk or snap took over at once. In that case acceleration and jerk are first brought to zero within the limits of the axis, and the
//! command starts from there.
use super::bounds::Bounds;
use super::run::Run;
use servobench_base::Setpoint;
use servobench_motion::PlanError;
use servobench_motion::online::{Target, Transition};

/// Relative tolerance of a limit for rounding.
const ROUNDING: f64 = 1e-9;

/// Trajectory from `from` to `target` within `bounds`, begun `lead` seconds ago, on an axis with the bounds `axis`.
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
    // Velocity that is left when the acceleration goes to zero at the jerk of the axis.
    let rest = from.v + from.a * from.a.abs() / (2.0 * axis.jerk);
    let calmed = axis.plan(from, &Target::Velocity(rest.clamp(-axis.velocity, axis.velocity)))?;
    Ok(Run::new(calmed, lead, Some((*target, *bounds)), axis).planned_for(*target, *bounds))
}

/// `from` with jerk and acceleration reduced to those that the remaining velocity of an axis with the bounds `axis` absorbs: a table
/// whose velocity has corners leads to states that no trajectory within the limits of the axis reaches, and from which none continues. The
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

/// Highest acceleration that can be brought to zero while the velocity rises by `room`.
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

/// True if an axis with the bounds `axis` can follow the trajectory.
pub(super) fn is_fit_for(way: &Transition, axis: &Bounds) -> bool {
    way.excess() == 0.0 || keeps(way, axis)
}

/// True if velocity and acceleration stay within those of the axis, except while `way` returns into them.
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
