//! What the axis is measured against: the set-points of the motion task, as much later as the way to the loops takes.
//!
//! The link, the bus and the drive each hold a set-point for a time that is known beforehand. An axis that follows what it is
//! sent without an error is where the motion task wanted it that much earlier; an error against the undelayed set-point would
//! be velocity × delay, and one against what arrived would not show a frame that was lost.
use servobench_base::Setpoint;
use servobench_motion::interpolate::{Interval, Mode, Sample};
use std::collections::VecDeque;

/// The set-points of the motion task and the way between them.
#[derive(Debug, Clone)]
pub(super) struct DelayedReference {
    /// Time from one set-point to the next (s).
    period: f64,
    /// How much later the loops follow (s).
    delay: f64,
    /// Set-points, the oldest first; its time is `first` (s).
    kept: VecDeque<Setpoint>,
    first: f64,
    /// Between the first two of them.
    interval: Option<Interval>,
}

impl DelayedReference {
    /// A motion task that gives a set-point every `period` (s), followed `delay` (s) later.
    pub(super) fn new(period: f64, delay: f64) -> Self {
        // One interval is read, those of the delay wait, and one is being filled.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few cycles")]
        let room = (delay / period) as usize + 4;
        Self { period, delay, kept: VecDeque::with_capacity(room), first: 0.0, interval: None }
    }

    /// Takes the set-point of the time `t` (s), a period after the last one.
    pub(super) fn push(&mut self, t: f64, setpoint: Setpoint) {
        if self.kept.is_empty() {
            self.first = t;
        }
        self.kept.push_back(setpoint);
    }

    /// Forgets what was asked: nothing is followed until there are set-points again.
    pub(super) fn restart(&mut self) {
        self.kept.clear();
        self.interval = None;
    }

    /// What is followed at `t` (s), which does not go back; `None` before the first set-point has arrived.
    pub(super) fn at(&mut self, t: f64) -> Option<Setpoint> {
        let wanted = t - self.delay;
        // Half a nanosecond for the rounding of the difference.
        while self.kept.len() > 2 && wanted - self.first >= self.period - 5e-10 {
            self.kept.pop_front();
            self.first += self.period;
            self.interval = None;
        }
        let (from, to) = (self.kept.front()?, self.kept.get(1)?);
        if wanted < self.first - 5e-10 {
            return None;
        }
        let interval = match &self.interval {
            Some(interval) => interval,
            None => self.interval.insert(between(self.period, from, to)?),
        };
        let fraction = ((wanted - self.first) / self.period).clamp(0.0, 1.0);
        interval.at(fraction).ok().map(|command| command.setpoint)
    }
}

/// The quintic polynomial by the positions, velocities and accelerations at both ends.
fn between(period: f64, from: &Setpoint, to: &Setpoint) -> Option<Interval> {
    let sample = |Setpoint { x, v, a, .. }: Setpoint| Sample { x, v, a, torque: 0.0 };
    Interval::new(Mode::Quintic, period, &[sample(*from), sample(*to)]).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a quintic itself, which the interpolation meets, at the delayed time.
    #[test]
    fn the_reference_is_the_set_point_of_the_delayed_time() {
        let at = |t: f64| Setpoint { x: t.powi(5), v: 5.0 * t.powi(4), a: 20.0 * t.powi(3), ..Setpoint::default() };
        let (period, delay) = (4e-3, 5.125e-3);
        let mut reference = DelayedReference::new(period, delay);
        assert_eq!(reference.at(0.0), None);
        for tick in 0..10_000_u32 {
            let t = f64::from(tick) / 16e3;
            if tick % 64 == 0 {
                reference.push(t, at(t));
            }
            match reference.at(t) {
                Some(setpoint) => assert!((setpoint.x - at(t - delay).x).abs() < 1e-14, "{t}: {setpoint:?}"),
                None => assert!(t < delay, "{t}"),
            }
            assert!(reference.kept.capacity() == reference.kept.capacity().min(8), "does not grow");
        }
    }
}
