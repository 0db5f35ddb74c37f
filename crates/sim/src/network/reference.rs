//! Reference for the following error: the set-points of the motion task, delayed by the path to the loops.
//!
//! The link, the bus and the drive each delay a set-point by a time that is known beforehand. An axis that follows the set-points sent
//! to it without an error is where the motion task wanted it that much earlier. An error against the undelayed set-point would
//! be velocity × delay, and one against the received set-points would hide a lost frame.
use crate::program::Program;
use servobench_base::{Setpoint, Stateful};
use servobench_motion::interpolate::{Interval, Mode, Sample};
use std::collections::VecDeque;

/// Cycles of the motion task for which the link continues without a set-point.
const PREDICTED: f64 = 2.0;
/// Rounding of differences of times (s).
const ROUNDING: f64 = 5e-10;

/// Future set-points of the motion task, if they are known beforehand.
#[derive(Debug, Stateful)]
#[state(fixed)]
struct Known {
    program: Program,
    /// Start of the program (s).
    begun: Option<f64>,
}

/// The set-points of the motion task, interpolated.
#[derive(Debug, Stateful)]
pub(super) struct DelayedReference {
    /// Time from one set-point to the next in normal operation (s).
    #[state(constant)]
    period: f64,
    /// Delay of the loops (s).
    #[state(constant)]
    delay: f64,
    /// Set-points and their times (s), the oldest first.
    kept: VecDeque<(f64, Setpoint)>,
    /// Interval between the first two set-points.
    interval: Option<Interval>,
    /// For a delay below the period, with which the next set-point is followed before it is there.
    #[state(fixed)]
    known: Option<Box<Known>>,
}

impl DelayedReference {
    /// Reference for a motion task that gives a set-point every `period` (s), followed `delay` (s) later.
    pub(super) fn new(period: f64, delay: f64) -> Self {
        // One interval is read, those of the delay wait, and one is being filled.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few cycles")]
        let room = (delay / period) as usize + 4;
        Self { period, delay, kept: VecDeque::with_capacity(room), interval: None, known: None }
    }

    /// Reference for a motion task that runs `program`. It is only needed for a delay below the period.
    pub(super) fn of_program(period: f64, delay: f64, program: &Program) -> Self {
        let known = (delay < period).then(|| Box::new(Known { program: program.clone(), begun: None }));
        Self { known, ..Self::new(period, delay) }
    }

    /// Sets the start of the program to `t` (s).
    pub(super) fn begin(&mut self, t: f64) {
        if let Some(known) = &mut self.known {
            known.begun = Some(t);
        }
    }

    /// Adds the set-point of time `t` (s), later than the last one. Starts anew after a gap that is longer than the link
    /// bridges.
    pub(super) fn push(&mut self, t: f64, setpoint: Setpoint) {
        let most = (PREDICTED + 1.0) * self.period + ROUNDING;
        if self.kept.back().is_some_and(|(last, _)| t - last > most) {
            self.restart();
        }
        self.kept.push_back((t, setpoint));
    }

    /// Discards all set-points: nothing is followed until there are new ones.
    pub(super) fn restart(&mut self) {
        self.kept.clear();
        self.interval = None;
    }

    /// Set-point followed at `t` (s), which must not decrease; `None` before the first set-point has arrived, and after a gap so
    /// long that the link has stopped the axis. Set-points that are late, or followed ahead of the motion task, are taken from
    /// its program, or predicted as the link does without one.
    pub(super) fn at(&mut self, t: f64) -> Option<Setpoint> {
        let wanted = t - self.delay;
        while self.kept.len() > 2 && self.kept.get(1).is_some_and(|(end, _)| wanted - end >= -ROUNDING) {
            self.kept.pop_front();
            self.interval = None;
        }
        let ((begin, from), (end, to)) = (self.kept.front()?, self.kept.get(1)?);
        if wanted < begin - ROUNDING {
            return None;
        }
        let beyond = wanted - end;
        if beyond > ROUNDING {
            if let Some(Known { program, begun: Some(begun) }) = self.known.as_deref_mut() {
                let is_followed = beyond <= PREDICTED * self.period;
                return is_followed.then(|| program.at((wanted - *begun).max(0.0)));
            }
            let parabola = Setpoint { x: to.x, v: to.v, a: to.a, ..Setpoint::default() };
            return (beyond <= PREDICTED * self.period).then(|| parabola.after(beyond));
        }
        let length = end - begin;
        let interval = match &self.interval {
            Some(interval) => interval,
            None => self.interval.insert(between(length, from, to)?),
        };
        let fraction = ((wanted - begin) / length).clamp(0.0, 1.0);
        interval.at(fraction).ok().map(|command| command.setpoint)
    }
}

/// The quintic polynomial with the positions, velocities and accelerations at both ends.
pub(super) fn between(period: f64, from: &Setpoint, to: &Setpoint) -> Option<Interval> {
    let sample = |Setpoint { x, v, a, .. }: Setpoint| Sample { x, v, a, torque: 0.0 };
    Interval::new(Mode::Quintic, period, &[sample(*from), sample(*to)]).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a quintic itself, which the interpolation reproduces, at the delayed time.
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

    /// Oracle: a constant acceleration, which a parabola predicts.
    #[test]
    fn what_is_late_is_predicted_and_what_stays_away_is_not_followed() {
        let at = |t: f64| Setpoint { x: t * t, v: 2.0 * t, a: 2.0, ..Setpoint::default() };
        let (period, delay) = (4e-3, 4e-3);
        let mut reference = DelayedReference::new(period, delay);
        for k in 0..4 {
            reference.push(f64::from(k) * period, at(f64::from(k) * period));
        }
        // The last one is that of 12 ms, followed until 16 ms.
        for (t, is_followed) in [(15e-3, true), (18e-3, true), (24e-3, true), (24.1e-3, false)] {
            let found = reference.at(t);
            assert_eq!(found.is_some(), is_followed, "{t}");
            assert!(found.is_none_or(|found| (found.x - at(t - delay).x).abs() < 1e-15), "{t}: {found:?}");
        }
        reference.push(28e-3, at(28e-3));
        assert_eq!(reference.at(28e-3), None);
        reference.push(32e-3, at(32e-3));
        assert!(reference.at(34e-3).is_some_and(|found| (found.x - at(30e-3).x).abs() < 1e-15));
    }
}
