//! A body between two exchanges with its FMU.
//!
//! ```text
//! x(t) = x0 + v·t + a·t²/2      v(t) = v + a·t                          t after the last exchange, H between two
//!
//!            with a velocity       by positions only
//! hold       v = v0 (x = x0)       v = (x0 − x1)/H (x = x0)
//! linear     v = v0                v = (x0 − x1)/H
//! quadratic  a = (v0 − v1)/H       v = (3·x0 − 4·x1 + x2)/2H,  a = (x0 − 2·x1 + x2)/H²
//! ```
//! x1 and x2 are one and two exchanges before x0. Until there are as many, the order is lower. The positions' formulas are those
//! of the parabola through the points (backward differences; Abramowitz & Stegun, *Handbook of Mathematical Functions*, 25.3).
use servobench_plant::{BodyState, Extrapolation};

/// What is known of a body's motion.
#[derive(Debug, Clone)]
pub(crate) struct Motion {
    order: Extrapolation,
    /// Time between two exchanges (s).
    period: f64,
    /// The last positions, the latest first.
    positions: [f64; 3],
    /// Exchanges up to now.
    count: u32,
    /// What it goes on with.
    velocity: f64,
    acceleration: f64,
}

impl Motion {
    pub(crate) fn new(order: Extrapolation, period: f64) -> Self {
        Self { order, period, positions: [0.0; 3], count: 0, velocity: 0.0, acceleration: 0.0 }
    }

    /// Takes what was exchanged.
    pub(crate) fn exchange(&mut self, position: f64, velocity: Option<f64>) {
        let [x1, x2, _] = self.positions;
        let (x0, h, before) = (position, self.period, self.velocity);
        self.positions = [x0, x1, x2];
        self.count = self.count.saturating_add(1);
        let quadratic = self.order == Extrapolation::Quadratic;
        (self.velocity, self.acceleration) = match (velocity, self.count) {
            (Some(v0), 2..) if quadratic => (v0, (v0 - before) / h),
            (Some(v0), _) => (v0, 0.0),
            (None, 1) => (0.0, 0.0),
            (None, 3..) if quadratic => ((3.0 * x0 - 4.0 * x1 + x2) / (2.0 * h), (x0 - 2.0 * x1 + x2) / (h * h)),
            (None, _) => ((x0 - x1) / h, 0.0),
        };
    }

    /// Where it is `t` (s) after the last exchange.
    pub(crate) fn after(&self, t: f64) -> BodyState {
        let (x, v, a) = (self.positions[0], self.velocity, self.acceleration);
        match self.order {
            Extrapolation::Hold => BodyState { position: x, velocity: v },
            _ => BodyState { position: x + t * (v + 0.5 * a * t), velocity: v + a * t },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Extrapolation::{Hold, Linear, Quadratic};

    /// Greatest errors of position and velocity of sin(t) within one exchange of `h` after t = 1, exchanged from t ≤ 1 on.
    fn errors(order: Extrapolation, with_velocity: bool, h: f64) -> (f64, f64) {
        let mut motion = Motion::new(order, h);
        for k in -5..=0 {
            let t = 1.0 + f64::from(k) * h;
            motion.exchange(t.sin(), with_velocity.then(|| t.cos()));
        }
        (1..10).map(|j| f64::from(j) * 0.1 * h).fold((0.0, 0.0), |(x, v), t| {
            let (state, at) = (motion.after(t), 1.0 + t);
            (f64::max(x, (state.position - at.sin()).abs()), f64::max(v, (state.velocity - at.cos()).abs()))
        })
    }

    /// Oracle: Taylor's theorem. What is left out of the motion is of order p in H, and half the step makes 2^p less of it.
    /// Tolerance: the next order's share, a few H of a hundredth.
    #[test]
    fn errors_fall_with_the_order_that_is_promised() {
        for (order, with_velocity, position, velocity) in [
            (Hold, true, 1.0, 1.0),
            (Hold, false, 1.0, 1.0),
            (Linear, true, 2.0, 1.0),
            (Linear, false, 2.0, 1.0),
            (Quadratic, true, 3.0, 2.0),
            (Quadratic, false, 3.0, 2.0),
        ] {
            let (coarse, fine) = (errors(order, with_velocity, 0.02), errors(order, with_velocity, 0.01));
            let observed = ((coarse.0 / fine.0).log2(), (coarse.1 / fine.1).log2());
            assert!((observed.0 - position).abs() < 0.05, "{order:?} {with_velocity}: {observed:?}");
            assert!((observed.1 - velocity).abs() < 0.05, "{order:?} {with_velocity}: {observed:?}");
        }
    }

    /// What was exchanged is passed on to the bit.
    #[test]
    fn at_an_exchange_the_state_is_what_was_exchanged() {
        for order in [Hold, Linear, Quadratic] {
            let mut motion = Motion::new(order, 0.1);
            for (x, v) in [(0.1, 0.3), (0.2, -0.7), (0.7, 1e-9)] {
                motion.exchange(x, Some(v));
                assert_eq!(motion.after(0.0), BodyState { position: x, velocity: v }, "{order:?}");
            }
        }
    }

    /// Oracle: what is known of a single point is that it is there.
    #[test]
    fn before_there_are_enough_points_the_order_is_lower() {
        let mut motion = Motion::new(Quadratic, 0.5);
        motion.exchange(1.0, None);
        assert_eq!(motion.after(0.3), BodyState { position: 1.0, velocity: 0.0 });
        motion.exchange(2.0, None);
        assert_eq!(motion.after(0.25), BodyState { position: 2.5, velocity: 2.0 });
        // x = 1, 2, 4: the parabola has a = 4, and v = 5 at the last.
        motion.exchange(4.0, None);
        assert_eq!(motion.after(0.5), BodyState { position: 4.0 + 2.5 + 0.5, velocity: 7.0 });
    }
}
