//! Velocity with which the end of a command is passed when the next one is blended with it.
//!
//! The desired velocity is that of the buffer mode, zero where the two commands lead in different directions. The result is the highest
//! velocity up to it that the first command can reach without turning back and from which the waiting commands can follow. The latter
//! bound is the velocity that the next command, run backwards from its own end, would reach. The waiting commands are therefore visited
//! from the last to the first.
//!
//! Above the velocity of the first command, the axis travels at the latter until only the distance of the rise is left; if the
//! distance is shorter than that, it rises at once.
use super::Axis;
use super::bounds::Bounds;
use super::brake_pre_trajectory::{is_fit_for, planned};
use super::queue::Queue;
use super::run::Run;
use crate::command::Goal;
use crate::error::BlockError;
use servobench_base::Setpoint;
use servobench_motion::PlanError;
use servobench_motion::online::{Target, passing_velocity};

/// Trajectory from `from` to `x` within `bounds` on an axis with the bounds `axis`, begun `lead` seconds ago, which passes `x` at a
/// speed of at most `wanted`.
pub(super) fn blended(
    from: &Setpoint,
    x: f64,
    [bounds, axis]: [&Bounds; 2],
    wanted: f64,
    lead: f64,
) -> Result<Run, PlanError> {
    let direction = if x < from.x { -1.0 } else { 1.0 };
    let fast = bounds.faster(wanted);
    let speed = speed_at(from, x, &fast, wanted)?;
    let target = Target::Position { x, v: direction * speed };
    if speed <= bounds.velocity {
        return planned(from, &target, bounds, axis, lead);
    }
    let cruise = Setpoint { v: direction * bounds.velocity, ..Setpoint::default() };
    let rise = x - fast.covered(&cruise, direction * speed)?;
    if direction * bounds.covered(from, cruise.v)? <= direction * (rise - from.x) {
        let way = bounds.plan(from, &Target::Position { x: rise, v: cruise.v })?;
        if is_fit_for(&way, axis) {
            return Ok(Run::new(way, lead, Some((target, fast)), axis));
        }
    }
    planned(from, &target, &fast, axis, lead)
}

/// Highest speed up to `most` with which `x` can be passed; zero if there is none.
fn speed_at(from: &Setpoint, x: f64, bounds: &Bounds, most: f64) -> Result<f64, PlanError> {
    let limits = bounds.limits().towards(x - from.x);
    Ok(passing_velocity(bounds.order(), from, x, &limits, most)?.unwrap_or(0.0))
}

impl Axis {
    /// Highest final speed of a command with the velocity `velocity` that leads to `x` in `direction` from which the commands waiting
    /// from this `place` in the queue on can follow within their own limits.
    pub(super) fn exit_speed(
        &self,
        x: f64,
        direction: f64,
        velocity: f64,
        queue: &Queue,
        place: usize,
    ) -> Result<f64, BlockError> {
        let Some(command) = queue.get(place) else { return Ok(0.0) };
        let bounds = Bounds::of(&command.dynamics, &self.params.limits, &self.factors);
        let blending = |speed: f64| command.buffer_mode.blending_velocity(velocity, speed).unwrap_or(0.0);
        let (end, end_velocity) = match (command.goal, self.target(command, &Setpoint::at_rest(x), x)?) {
            (Goal::Rest | Goal::Reference(_) | Goal::Effort { .. } | Goal::Led(_), _) => return Ok(0.0),
            (_, Target::Velocity(v)) => {
                let speed = direction * v * self.factors.velocity;
                return Ok(if speed > 0.0 { blending(speed) } else { 0.0 });
            }
            (_, Target::Position { x, v }) => (x, direction * v * self.factors.velocity),
        };
        let (wanted, length) = (blending(bounds.velocity), direction * (end - x));
        if length <= 0.0 || wanted == 0.0 {
            return Ok(0.0);
        }
        // A command that turns round behind the end comes to rest there.
        let exit = if command.is_endless() {
            end_velocity.max(0.0)
        } else {
            self.exit_speed(end, direction, bounds.velocity, queue, place + 1)?
        };
        let start = Setpoint { v: exit, ..Setpoint::default() };
        let backwards = bounds.faster(wanted.max(exit)).backwards();
        speed_at(&start, length, &backwards, wanted).map_err(|error| BlockError::Plan { block: command.block, error })
    }
}
