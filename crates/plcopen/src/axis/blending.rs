//! The velocity with which the end of a command is passed when the next one is blended with it.
//!
//! The wanted velocity is that of the buffer mode, zero where the two lead in different directions. The highest up to it is taken
//! to which the first command can bring the axis without turning back, and from which the next one can follow: that is the one
//! to which the next one, run backwards, would bring it.
//!
//! Where that is above the velocity of the first command, the axis goes at the latter until only the distance is left that the
//! rise takes; where there is not so much, it rises at once.
use super::bounds::Bounds;
use super::calming::planned;
use super::run::Run;
use servobench_base::Setpoint;
use servobench_motion::PlanError;
use servobench_motion::online::{Target, passing_velocity};

/// What follows a passage, in the same direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Next {
    /// A position, passed at a velocity of which the sign is that of the direction, or at rest.
    Position { x: f64, end_velocity: f64, bounds: Bounds },
    /// A velocity, reached anywhere.
    Velocity,
}

/// The way from `from` to `x` within `bounds` on an axis with the bounds `axis`, begun `lead` seconds ago, which is passed at a speed of at most `wanted` on the way to `next`.
pub(crate) fn blended(
    from: &Setpoint,
    x: f64,
    [bounds, axis]: [&Bounds; 2],
    next: &Next,
    wanted: f64,
    lead: f64,
) -> Result<Run, PlanError> {
    let direction = if x < from.x { -1.0 } else { 1.0 };
    let fast = bounds.faster(wanted);
    let followed = match next {
        Next::Velocity => wanted,
        Next::Position { x: end, end_velocity, bounds } => {
            let start = Setpoint { v: *end_velocity, ..Setpoint::default() };
            speed_at(&start, end - x, &bounds.faster(wanted).backwards(), wanted)?
        }
    };
    let speed = speed_at(from, x, &fast, followed)?;
    let target = Target::Position { x, v: direction * speed };
    if speed <= bounds.velocity {
        return planned(from, &target, bounds, axis, lead);
    }
    let cruise = Setpoint { v: direction * bounds.velocity, ..Setpoint::default() };
    let rise = x - fast.covered(&cruise, direction * speed)?;
    if direction * bounds.covered(from, cruise.v)? <= direction * (rise - from.x) {
        let way = bounds.plan(from, &Target::Position { x: rise, v: cruise.v })?;
        return Ok(Run::new(way, lead, Some((target, fast))));
    }
    planned(from, &target, &fast, axis, lead)
}

/// The highest speed up to `most` with which `x` can be passed; zero where there is none.
fn speed_at(from: &Setpoint, x: f64, bounds: &Bounds, most: f64) -> Result<f64, PlanError> {
    let limits = bounds.limits().towards(x - from.x);
    Ok(passing_velocity(bounds.order(), from, x, &limits, most)?.unwrap_or(0.0))
}
