//! Set-points that may be chosen.

/// A kind of set-point.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Family {
    /// Order of the profile, 2 to 4.
    pub order: u32,
    /// Further keys as on the command line: `setpoint.shaper.kind=zvd`.
    pub settings: Vec<String>,
    /// What it is called: `order 3, zvd`.
    pub name: String,
}

/// The largest limits that a set-point may have (SI).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ceiling {
    /// Velocity.
    pub velocity: f64,
    /// Acceleration.
    pub acceleration: f64,
    /// Jerk; infinite where none is given.
    pub jerk: f64,
    /// Snap; infinite where none is given.
    pub snap: f64,
}

/// A set-point: its family, and its limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SetPoint {
    /// Index of its family.
    pub family: usize,
    /// Velocity, acceleration, jerk and snap (SI); infinite above the order.
    pub limits: [f64; 4],
}

/// Levels of velocity and acceleration, and their ratio from one to the next.
const VELOCITIES: (usize, f64) = (3, 0.8);
const ACCELERATIONS: (usize, f64) = (9, 0.86);
/// Levels of the times in which acceleration and jerk rise, and their ratio; the longest is this part of the shortest move of second order.
const RISES: (usize, f64) = (15, 1.4);
const LONGEST_RISE: f64 = 0.5;

impl SetPoint {
    /// By velocity (SI), acceleration (SI), and the times (s) in which acceleration and jerk rise; of those the first `order − 2` count.
    #[must_use]
    pub fn by_times(family: usize, order: u32, [velocity, acceleration, rise, rise_of_jerk]: [f64; 4]) -> Self {
        let jerk = if order > 2 { acceleration / rise } else { f64::INFINITY };
        let snap = if order > 3 { jerk / rise_of_jerk } else { f64::INFINITY };
        Self { family, limits: [velocity, acceleration, jerk, snap] }
    }

    /// Velocity (SI), acceleration (SI), and the times (s) in which acceleration and jerk rise; 0 where they jump.
    #[must_use]
    pub fn times(&self) -> [f64; 4] {
        let [velocity, acceleration, jerk, snap] = self.limits;
        [velocity, acceleration, acceleration / jerk, if jerk.is_finite() { jerk / snap } else { 0.0 }]
    }

    /// Whether no limit is above the ceiling.
    pub(crate) fn is_below(&self, ceiling: &Ceiling) -> bool {
        let Ceiling { velocity, acceleration, jerk, snap } = *ceiling;
        let most = [velocity, acceleration, jerk, snap];
        // An order below three has no jerk to bound.
        self.limits.iter().zip(most).all(|(limit, most)| limit.is_infinite() || *limit <= most * (1.0 + 1e-12))
    }

    /// Bits by which it is told from others.
    pub(crate) fn key(&self) -> (usize, [u64; 4]) {
        (self.family, self.limits.map(f64::to_bits))
    }
}

/// All set-points of a family on a coarse grid; `shortest` is the duration of the move of second order at the ceiling (s).
pub(crate) fn grid(index: usize, family: &Family, ceiling: &Ceiling, shortest: f64) -> Vec<SetPoint> {
    let levels = |top: f64, (count, ratio): (usize, f64)| (0..count).map(move |k| top * ratio.powi(k as i32));
    let rises = || levels(LONGEST_RISE * shortest, (RISES.0, 1.0 / RISES.1));
    let mut all = Vec::new();
    for velocity in levels(ceiling.velocity, VELOCITIES) {
        for acceleration in levels(ceiling.acceleration, ACCELERATIONS) {
            let add = |all: &mut Vec<SetPoint>, rise, rise_of_jerk| {
                let point = SetPoint::by_times(index, family.order, [velocity, acceleration, rise, rise_of_jerk]);
                all.extend(point.is_below(ceiling).then_some(point));
            };
            match family.order {
                2 => add(&mut all, 0.0, 0.0),
                3 => rises().for_each(|rise| add(&mut all, rise, 0.0)),
                _ => rises().for_each(|rise| {
                    rises().filter(|other| *other <= rise).for_each(|other| add(&mut all, rise, other));
                }),
            }
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_and_times_say_the_same() {
        let point = SetPoint::by_times(0, 4, [0.5, 4.0, 0.08, 0.05]);
        assert_eq!(point.limits.map(|limit| (limit * 1e9).round() / 1e9), [0.5, 4.0, 50.0, 1000.0]);
        let back = point.times();
        assert!(back.iter().zip([0.5, 4.0, 0.08, 0.05]).all(|(one, other)| (one - other).abs() < 1e-12), "{back:?}");
        let third = SetPoint::by_times(0, 3, [0.5, 4.0, 0.08, 0.05]);
        assert!(third.limits[3].is_infinite() && third.times()[3] == 0.0);
        assert_eq!(SetPoint::by_times(0, 2, [0.5, 4.0, 0.0, 0.0]).times()[2..], [0.0, 0.0]);
    }

    #[test]
    fn a_grid_stays_below_the_ceiling() {
        let ceiling = Ceiling { velocity: 0.5, acceleration: 4.0, jerk: 100.0, snap: f64::INFINITY };
        let family = |order| Family { order, settings: vec![], name: String::new() };
        assert_eq!(grid(0, &family(2), &ceiling, 0.6).len(), 27);
        for order in [3, 4] {
            let all = grid(0, &family(order), &ceiling, 0.6);
            assert!(all.len() > 100 && all.iter().all(|point| point.limits[2] <= 100.0 * (1.0 + 1e-12)), "{order}");
        }
    }
}
