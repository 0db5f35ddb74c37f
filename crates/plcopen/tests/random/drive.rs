//! A drive that follows with a lag and fails now and then.
use super::chance::Chance;
use super::{CYCLE_TIME, Follower};
use servobench_fieldbus::{AxisCommand, AxisFeedback, Fault, Homing, Power, Task};

/// Time by which the axis lags behind its set-point (s).
const LAG: f64 = 7e-3;

/// A drive that gets its set-points without a bus.
#[derive(Debug, Default)]
pub(crate) struct Drive(AxisFeedback);

impl Follower for Drive {
    fn feedback(&self) -> AxisFeedback {
        self.0
    }

    fn follow(&mut self, command: &AxisCommand, chance: &mut Chance, _: &str) {
        let Self(feedback) = self;
        if feedback.fault.is_none() {
            feedback.fault = chance.once_in(3000).then_some(Fault::Drive(0x2310));
        } else if command.reset || chance.once_in(50) {
            feedback.fault = None;
        }
        let is_on = command.power && (feedback.fault.is_none() || chance.once_in(2)) && !chance.once_in(3000);
        feedback.power = match feedback.power {
            Power::On | Power::Switching if is_on => Power::On,
            Power::Off if is_on => Power::Switching,
            _ => Power::Off,
        };
        feedback.homing = Homing::Idle;
        match command.task {
            Task::Follow(sample) if feedback.power == Power::On => {
                (feedback.position, feedback.velocity) = (sample.x - LAG * sample.v, sample.v);
            }
            Task::Follow(_) => feedback.velocity = 0.0,
            Task::Effort(effort) => {
                feedback.effort = effort;
                feedback.velocity = (feedback.velocity + 0.01 * effort).clamp(-1.2, 1.2);
                feedback.position += feedback.velocity * CYCLE_TIME;
            }
            Task::Home { .. } => {
                feedback.velocity = 0.0;
                feedback.homing = chance.one_of(&[Homing::Busy, Homing::Busy, Homing::Attained]);
                if chance.once_in(20) {
                    feedback.homing = Homing::Failed;
                }
            }
            Task::Drive(way) => panic!("no block leaves its way to the drive: {way:?}"),
        }
    }
}
