//! Set-points that may be chosen.
use servobench_motion::Limits;

/// A kind of set-point.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Family {
    /// Order of the profile, 2 to 4.
    pub order: u32,
    /// The input shaper behind it: `zvd`.
    pub shaper: Option<String>,
    /// Further keys as on the command line: `setpoint.shaper.kind=zvd`, `drive.position.bandwidth=20 Hz`.
    pub settings: Vec<String>,
    /// What it is called: `order 3, zvd`.
    pub name: String,
}

/// A set-point: its family, and its limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SetPoint {
    /// Index of its family.
    pub family: usize,
    /// Velocity, acceleration, jerk and snap (SI); infinite above the order.
    pub limits: [f64; 4],
}

/// Significant digits of a limit.
const DIGITS: usize = 4;
/// What rounding or a step may carry a limit beyond its ceiling by: it then stands at it.
const BEYOND: f64 = 1.1;

/// The number with [`DIGITS`] significant digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value)
}

/// Levels of a limit from its largest value down: how many, and their ratio.
type Levels = (i32, f64);

/// The levels of a coarse grid.
struct Grid {
    velocities: Levels,
    accelerations: Levels,
    /// Times in which acceleration and jerk rise, from the longest down.
    rises: Levels,
}

/// Of second and third order the lengths of all boxes are near to those with which a mode is met at a zero; the fourth order has neighbours
/// enough to be refined from, and a shaper meets the mode by itself.
const FINE: Grid = Grid { velocities: (10, 0.975), accelerations: (20, 0.97), rises: (50, 1.1) };
const OF_FOURTH_ORDER: Grid = Grid { velocities: (6, 0.96), accelerations: (14, 0.95), rises: (26, 1.2) };
const WITH_SHAPER: Grid = Grid { velocities: (3, 0.95), accelerations: (6, 0.92), rises: (12, 1.4) };
/// Accelerations far below the largest, as parts of it: what a weak axis follows.
const SLOW: [f64; 4] = [0.4, 0.25, 0.15, 0.08];
/// The longest rise, as part of the shortest move of second order.
const LONGEST_RISE: f64 = 0.5;

impl SetPoint {
    /// By velocity (SI), acceleration (SI), and the times (s) in which acceleration and jerk rise; of those the first `order − 2` count. Limits
    /// are rounded to four significant digits, so that what was run is what is told.
    #[must_use]
    pub fn by_times(family: usize, order: u32, [velocity, acceleration, rise, rise_of_jerk]: [f64; 4]) -> Self {
        let jerk = if order > 2 { acceleration / rise } else { f64::INFINITY };
        let snap = if order > 3 { jerk / rise_of_jerk } else { f64::INFINITY };
        Self { family, limits: [velocity, acceleration, jerk, snap].map(rounded) }
    }

    /// Velocity (SI), acceleration (SI), and the times (s) in which acceleration and jerk rise; 0 where they jump.
    #[must_use]
    pub fn times(&self) -> [f64; 4] {
        let [velocity, acceleration, jerk, snap] = self.limits;
        [velocity, acceleration, acceleration / jerk, if jerk.is_finite() { jerk / snap } else { 0.0 }]
    }

    /// The same with what rounding or a step has carried beyond the ceiling at it.
    pub(crate) fn below(self, ceiling: &Limits) -> Self {
        let Limits { velocity, acceleration, jerk, snap } = *ceiling;
        let most = [velocity, acceleration, jerk, snap];
        let limits = std::array::from_fn(|k| {
            let limit = self.limits[k];
            // What is infinite belongs to a higher order.
            if limit.is_finite() && limit <= BEYOND * most[k] { limit.min(most[k]) } else { limit }
        });
        Self { limits, ..self }
    }

    /// Whether no limit is above the ceiling.
    pub(crate) fn is_below(&self, ceiling: &Limits) -> bool {
        let Limits { velocity, acceleration, jerk, snap } = *ceiling;
        let most = [velocity, acceleration, jerk, snap];
        // An order below three has no jerk to bound.
        self.limits.iter().zip(most).all(|(limit, most)| limit.is_infinite() || *limit <= most)
    }

    /// Bits by which it is told from others.
    pub(crate) fn key(&self) -> (usize, [u64; 4]) {
        (self.family, self.limits.map(f64::to_bits))
    }
}

/// All set-points of a family on a coarse grid; `shortest` is the duration of the move of second order at the ceiling (s).
pub(crate) fn grid(index: usize, family: &Family, ceiling: &Limits, shortest: f64) -> Vec<SetPoint> {
    let Grid { velocities, accelerations, rises } = match family.order {
        _ if family.shaper.is_some() => WITH_SHAPER,
        4 => OF_FOURTH_ORDER,
        _ => FINE,
    };
    let levels = |top: f64, (count, ratio): Levels| (0..count).map(move |k| top * ratio.powi(k));
    let rises = || levels(LONGEST_RISE * shortest, (rises.0, 1.0 / rises.1));
    let mut all = Vec::new();
    for velocity in levels(ceiling.velocity, velocities) {
        let slow = SLOW.map(|part| part * ceiling.acceleration);
        for acceleration in levels(ceiling.acceleration, accelerations).chain(slow) {
            let add = |all: &mut Vec<SetPoint>, rise, rise_of_jerk| {
                let times = [velocity, acceleration, rise, rise_of_jerk];
                let point = SetPoint::by_times(index, family.order, times).below(ceiling);
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

    fn is_same(found: &[f64], expected: &[f64]) -> bool {
        found.len() == expected.len() && found.iter().zip(expected).all(|(one, other)| (one - other).abs() < 1e-12)
    }

    #[test]
    fn limits_and_times_say_the_same() {
        let times = [0.5, 4.0, 0.08, 0.05];
        let point = SetPoint::by_times(0, 4, times);
        assert!(is_same(&point.limits, &[0.5, 4.0, 50.0, 1000.0]), "{point:?}");
        assert!(is_same(&point.times(), &times), "{point:?}");
        let third = SetPoint::by_times(0, 3, times);
        assert!(third.limits[3].is_infinite() && is_same(&third.times(), &[0.5, 4.0, 0.08, 0.0]));
        assert!(is_same(&SetPoint::by_times(0, 2, times).times(), &[0.5, 4.0, 0.0, 0.0]));
    }

    /// Four digits, and at the ceiling where they would carry it beyond.
    #[test]
    fn limits_are_rounded_and_stay_below_the_ceiling() {
        let ceiling = Limits { velocity: 1.0 / 3.0, acceleration: 2.0 / 3.0, jerk: 1.0, snap: 1.0 };
        let rounded = SetPoint::by_times(0, 2, [1.0 / 3.0, 2.0 / 3.0, 0.0, 0.0]);
        assert!(is_same(&rounded.limits[..2], &[0.3333, 0.6667]) && !rounded.is_below(&ceiling));
        let below = rounded.below(&ceiling);
        assert!(is_same(&below.limits[..2], &[0.3333, 2.0 / 3.0]) && below.is_below(&ceiling), "{below:?}");
    }

    #[test]
    fn a_grid_stays_below_the_ceiling() {
        let ceiling = Limits { velocity: 0.5, acceleration: 4.0, jerk: 100.0, snap: f64::INFINITY };
        let family = |order| Family { order, shaper: None, settings: vec![], name: String::new() };
        assert_eq!(grid(0, &family(2), &ceiling, 0.6).len(), 240);
        for order in [3, 4] {
            let all = grid(0, &family(order), &ceiling, 0.6);
            assert!(all.len() > 100 && all.iter().all(|point| point.limits[2] <= 100.0), "{order}");
        }
    }
}
