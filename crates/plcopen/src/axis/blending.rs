//! The velocity with which the end of a command is passed when the next one is blended with it.
//!
//! The wanted velocity is that of the buffer mode, zero where the two lead in different directions. Without turning back the
//! end at a distance D can be passed at any velocity up to the one that takes D to reach, and the next command can follow from
//! any up to the one that takes its own distance to brake from; how far it is to a velocity grows with it, so that the highest
//! that both can is found by bisection.
//!
//! Where the wanted velocity is above that of the first command, the axis goes at the latter until the distance is left that it
//! takes to reach the former.
use super::bounds::{Bounds, heading};
use super::run::Run;
use servobench_base::Setpoint;
use servobench_motion::PlanError;
use servobench_motion::online::Target;

/// A way from a known place to a position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Leg {
    pub(crate) x: f64,
    pub(crate) end_velocity: f64,
    pub(crate) bounds: Bounds,
}

/// The way from `from` along `first`, whose end is passed at the wanted velocity or the highest below it from which `next`,
/// to a position or to a velocity, can follow.
pub(crate) fn blended(from: &Setpoint, first: &Leg, next: &Next, wanted: f64, lead: f64) -> Result<Run, PlanError> {
    let direction = heading(from, &Target::Position { x: first.x, v: 0.0 });
    let at_end = |speed: f64| Setpoint { v: direction * speed, ..Setpoint::at_rest(first.x) };
    let bounds = Bounds { velocity: first.bounds.velocity.max(wanted), ..first.bounds };
    let is_reached = |speed: f64| -> Result<bool, PlanError> {
        Ok(direction * bounds.covered(from, direction * speed)? <= direction * (first.x - from.x))
    };
    let can_follow = |speed: f64| -> Result<bool, PlanError> {
        match next {
            Next::Position(leg) => {
                let covered = leg.bounds.faster(speed).covered(&at_end(speed), leg.end_velocity)?;
                Ok(direction * covered <= direction * (leg.x - first.x))
            }
            Next::Velocity => Ok(true),
        }
    };
    let speed = highest(wanted, |speed| Ok(is_reached(speed)? && can_follow(speed)?))?;
    let target = Target::Position { x: first.x, v: direction * speed };
    if speed > first.bounds.velocity {
        let slower = Setpoint { v: direction * first.bounds.velocity, ..Setpoint::default() };
        let x = first.x - bounds.covered(&slower, direction * speed)?;
        if direction * first.bounds.covered(from, slower.v)? <= direction * (x - from.x) {
            let way = first.bounds.plan(from, &Target::Position { x, v: slower.v })?;
            return Ok(Run::new(way, lead, Some((target, bounds))));
        }
    }
    Ok(Run::new(bounds.plan(from, &target)?, lead, None))
}

/// What follows a passage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Next {
    /// A position.
    Position(Leg),
    /// A velocity in the same direction, reached anywhere.
    Velocity,
}

impl Bounds {
    /// The same with room for `speed`.
    fn faster(self, speed: f64) -> Self {
        Self { velocity: self.velocity.max(speed), ..self }
    }
}

/// The highest speed up to `wanted` that is `possible`, zero if none is; up to it all are.
fn highest(wanted: f64, possible: impl Fn(f64) -> Result<bool, PlanError>) -> Result<f64, PlanError> {
    if possible(wanted)? {
        return Ok(wanted);
    }
    let (mut low, mut high) = (0.0, wanted);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if possible(middle)? {
            low = middle;
        } else {
            high = middle;
        }
    }
    Ok(low)
}

/// Leaves a billionth of the wanted velocity.
const HALVINGS: usize = 30;
