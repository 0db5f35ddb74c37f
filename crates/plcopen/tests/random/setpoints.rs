//! Checks of the commands from cycle to cycle.
use super::CYCLE_TIME;
use servobench_base::Setpoint;
use servobench_fieldbus::{AxisCommand, AxisFeedback, Power, Task};
use servobench_plcopen::{Axis, AxisState, BlockName};

/// Blocks that follow tables, whose segments meet without regard to jerk and snap.
const TABLES: [BlockName; 3] = [BlockName::PositionProfile, BlockName::VelocityProfile, BlockName::AccelerationProfile];

/// The set-points of an axis.
#[derive(Debug, Default)]
pub(crate) struct Setpoints {
    last: Option<Setpoint>,
    /// True if the last set-point came from a table.
    was_led: bool,
}

impl Setpoints {
    /// Checks that a disabled axis gets no motion, and that nothing jumps but the jerk of tables.
    pub(crate) fn check(&mut self, axis: &Axis, feedback: &AxisFeedback, command: &AxisCommand, place: &str) {
        let is_led = axis.commanded_by().is_some_and(|block| TABLES.contains(&block));
        let (state, limits) = (axis.state(), axis.params().limits);
        let is_disabled = state == AxisState::Disabled;
        assert!(!is_disabled || !command.power || feedback.power != Power::On, "{place}");
        assert!(!matches!(command.task, Task::Home { .. }) || state == AxisState::Homing, "{place}");
        let was_led = std::mem::replace(&mut self.was_led, is_led);
        let Task::Follow(sample) = command.task else {
            assert!(matches!(state, AxisState::Homing | AxisState::ContinuousMotion), "{place}: {state}");
            self.last = None;
            return;
        };
        let is_where_it_is = (sample.x - feedback.demanded()).abs() == 0.0;
        assert!(!is_disabled || is_where_it_is || self.last.is_none(), "{place}: moves a disabled axis");
        let now = Setpoint { x: sample.x, ..axis.commanded() };
        assert!([now.x, now.v, now.a, now.j].iter().all(|value| value.is_finite()), "{place}: {now:?}");
        // Without power, under a fault at rest, and while the drive ends a homing, the set-point is where the axis is.
        let follows = is_disabled
            || state == AxisState::ErrorStop && (feedback.power != Power::On || is_where_it_is)
            || state == AxisState::Stopping && is_where_it_is;
        if let Some(last) = self.last.filter(|_| !follows) {
            // The mean of each derivative over a cycle is within its limit. Two motions on top of each other and limits that were
            // higher before keep those of the axis together; the margin is rounding.
            let step = |name, one: f64, other: f64, limit: f64, rounding: f64| {
                let mean = (other - one).abs() / CYCLE_TIME;
                let most = limit * (1.0 + 1e-6) + rounding;
                assert!(mean <= most, "{place} in {state}: {name} {mean} {limit}\n{last:?}\n{now:?}");
            };
            // A stop begins at the velocity that an effort, or another action of the drive, has left.
            step("x", last.x, now.x, limits.velocity.max(last.v.abs()), 1e-12 / CYCLE_TIME);
            step("v", last.v, now.v, limits.acceleration, 1e-9 / CYCLE_TIME);
            if limits.jerk < f64::INFINITY && !was_led && !is_led {
                step("a", last.a, now.a, limits.jerk, 1e-7 / CYCLE_TIME);
            }
            if limits.snap < f64::INFINITY && !was_led && !is_led {
                step("j", last.j, now.j, limits.snap, 1e-5 / CYCLE_TIME);
            }
        }
        self.last = (!follows).then_some(now);
    }
}
