//! Latency of a digital encoder: its readings are delayed by its protocol.
//!
//! Between two ticks the position is the cubic of Hermite through both positions and velocities: of fourth order in the tick, and
//! exact under constant acceleration and constant jerk. Before the first tick the body is taken to have moved with its initial velocity.
use crate::mechanics::BodyState;
use servobench_base::state::{Damaged, Reader, Stateful, Value as _, Writer};

/// The last states of a body.
#[derive(Debug, Clone)]
pub(super) struct Past {
    /// From the oldest on, in a ring.
    states: Vec<BodyState>,
    newest: usize,
    is_begun: bool,
    /// Whole ticks of the latency; `share` is the rest, in ticks.
    ticks: usize,
    share: f64,
    h: f64,
}

/// Saved from the newest on: each number of the state then has the same age at every tick.
impl Stateful for Past {
    fn save(&self, to: &mut dyn Writer) {
        let Self { states, newest, is_begun, ticks: _, share: _, h: _ } = self;
        is_begun.save(to);
        let count = states.len();
        for age in 0..count {
            states[(newest + count - age) % count].save(to);
        }
    }

    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
        (self.is_begun, self.newest) = (bool::restored(from)?, 0);
        let count = self.states.len();
        (0..count).try_for_each(|age| self.states[(count - age) % count].restore(from))
    }
}

impl Past {
    /// A memory for `latency` (s) in ticks of `h` (s).
    pub(super) fn new(latency: f64, h: f64) -> Self {
        let ticks = libm::floor(latency / h);
        let share = latency / h - ticks;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a whole number that is not negative"
        )]
        let ticks = ticks as usize;
        Self { states: vec![BodyState::default(); ticks + 2], newest: 0, is_begun: false, ticks, share, h }
    }

    /// Takes the state of this tick and returns the position `latency` earlier.
    pub(super) fn position(&mut self, now: BodyState) -> f64 {
        let count = self.states.len();
        if self.is_begun {
            self.newest = if self.newest + 1 == count { 0 } else { self.newest + 1 };
            self.states[self.newest] = now;
        } else {
            self.is_begun = true;
            for back in 0..count {
                let position = now.position - now.velocity * back as f64 * self.h;
                self.states[(count - back) % count] = BodyState { position, ..now };
            }
        }
        let back = |ticks: usize| {
            let at = self.newest + count - ticks;
            self.states[if at < count { at } else { at - count }]
        };
        self.between(back(self.ticks + 1), back(self.ticks))
    }

    /// Position before `after` by the share of a tick, and after `before` by the rest of it.
    fn between(&self, before: BodyState, after: BodyState) -> f64 {
        if self.share == 0.0 {
            return after.position;
        }
        let (s, h) = (1.0 - self.share, self.h);
        let travel = after.position - before.position;
        let [first, last] = [before, after].map(|state| h * state.velocity - travel);
        before.position + s * travel + s * (1.0 - s) * ((1.0 - s) * first - s * last)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the position at that time; exact for cubics, and the line before the beginning.
    #[test]
    fn it_is_the_position_of_then() {
        let h = 1e-3;
        let at = |t: f64| BodyState {
            position: 0.3 + 2.0 * t - 40.0 * t * t + 900.0 * t * t * t,
            velocity: 2.0 - 80.0 * t + 2700.0 * t * t,
        };
        for latency in [0.0, 0.31e-3, 1e-3, 2.77e-3, 9e-3] {
            let mut past = Past::new(latency, h);
            for k in 0..60 {
                let t = f64::from(k) * h;
                let found = past.position(at(t));
                let then = t - latency;
                let expected = if then < -1e-12 { 0.3 + 2.0 * then } else { at(then).position };
                // Between the last tick before the beginning and the first one the cubic is the line, too.
                assert!((found - expected).abs() < 1e-14, "{latency} {k}: {found} {expected}");
            }
        }
    }

    /// Fourth order: half the tick leaves a sixteenth of the error.
    #[test]
    fn it_is_of_fourth_order() {
        let error = |ticks: u32| {
            let h = 0.2 / f64::from(ticks);
            let mut past = Past::new(0.4 * h, h);
            let at = |t: f64| BodyState { position: (50.0 * t).sin(), velocity: 50.0 * (50.0 * t).cos() };
            let errors = (0..ticks).map(|k| {
                let t = f64::from(k) * h;
                let found = past.position(at(t));
                if k == 0 { 0.0 } else { (found - at(t - 0.4 * h).position).abs() }
            });
            errors.fold(0.0, f64::max)
        };
        let ratio = error(100) / error(200);
        assert!((15.0..17.0).contains(&ratio), "{ratio}");
    }
}
