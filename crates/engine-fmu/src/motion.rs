//! A body between two exchanges with its FMU: it continues at constant velocity.
//!
//! ```text
//! x(t) = x0 + v·t       v(t) = v       t after the last exchange
//! ```
//! v is the exchanged velocity, or (x0 − x1)/H from the last two positions, H apart; 0 until there are two.
use servobench_base::Stateful;
use servobench_plant::BodyState;

/// Motion of a body as exchanged.
#[derive(Debug, Clone, Stateful)]
pub(crate) struct Motion {
    /// Time between two exchanges (s).
    #[state(constant)]
    period: f64,
    /// The last position; `None` before the first exchange.
    position: Option<f64>,
    velocity: f64,
}

impl Motion {
    pub(crate) fn new(period: f64) -> Self {
        Self { period, position: None, velocity: 0.0 }
    }

    /// Stores the exchanged position and velocity.
    pub(crate) fn exchange(&mut self, position: f64, velocity: Option<f64>) {
        let by_positions = || self.position.map_or(0.0, |before| (position - before) / self.period);
        // A negative zero becomes zero.
        self.velocity = velocity.unwrap_or_else(by_positions) + 0.0;
        self.position = Some(position);
    }

    /// State `t` (s) after the last exchange.
    pub(crate) fn after(&self, t: f64) -> BodyState {
        BodyState { position: self.position.unwrap_or_default() + t * self.velocity, velocity: self.velocity }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Greatest errors of position and velocity of sin(t) within one exchange of `h` after t = 1, exchanged from t ≤ 1 on.
    fn errors(with_velocity: bool, h: f64) -> (f64, f64) {
        let mut motion = Motion::new(h);
        for k in -5..=0 {
            let t = 1.0 + f64::from(k) * h;
            motion.exchange(t.sin(), with_velocity.then(|| t.cos()));
        }
        (1..10).map(|j| f64::from(j) * 0.1 * h).fold((0.0, 0.0), |(x, v), t| {
            let (state, at) = (motion.after(t), 1.0 + t);
            (f64::max(x, (state.position - at.sin()).abs()), f64::max(v, (state.velocity - at.cos()).abs()))
        })
    }

    /// Oracle: Taylor's theorem. The neglected part of the motion is of order p in H, and half the step divides it by 2^p.
    /// Tolerance: the next order's share, a few H of a hundredth.
    #[test]
    fn errors_fall_with_the_order_that_is_promised() {
        for with_velocity in [true, false] {
            let (coarse, fine) = (errors(with_velocity, 0.02), errors(with_velocity, 0.01));
            let observed = ((coarse.0 / fine.0).log2(), (coarse.1 / fine.1).log2());
            assert!((observed.0 - 2.0).abs() < 0.05, "{with_velocity}: {observed:?}");
            assert!((observed.1 - 1.0).abs() < 0.05, "{with_velocity}: {observed:?}");
        }
    }

    /// Exchanged values are passed on bit for bit.
    #[test]
    fn at_an_exchange_the_state_is_what_was_exchanged() {
        let mut motion = Motion::new(0.1);
        for (x, v) in [(0.1, 0.3), (0.2, -0.7), (0.7, 1e-9)] {
            motion.exchange(x, Some(v));
            assert_eq!(motion.after(0.0), BodyState { position: x, velocity: v });
        }
    }

    /// Oracle: a single point determines only a position.
    #[test]
    fn before_there_are_two_points_it_stands_still() {
        let mut motion = Motion::new(0.5);
        motion.exchange(1.0, None);
        assert_eq!(motion.after(0.3), BodyState { position: 1.0, velocity: 0.0 });
        motion.exchange(2.0, None);
        assert_eq!(motion.after(0.25), BodyState { position: 2.5, velocity: 2.0 });
    }
}
