//! Candidate set-points.
use crate::best::Question;
use servobench_motion::Limits;

/// A kind of set-point.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Family {
    /// Order of the profile, 2 to 4.
    pub order: u32,
    /// The input shaper after it: `zvd`.
    pub shaper: Option<String>,
    /// Further keys as on the command line: `setpoint.shaper.kind=zvd`, `drive.position.bandwidth=20 Hz`.
    pub settings: Vec<String>,
    /// Its name: `order 3, zvd`.
    pub name: String,
}

/// A set-point: its family and its limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SetPoint {
    /// Index of its family.
    pub family: usize,
    /// Velocity, acceleration, jerk and snap (SI); infinite above the order.
    pub limits: [f64; 4],
}

/// Significant digits of a limit.
const DIGITS: usize = 5;

/// The number with [`DIGITS`] significant digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value)
}

impl SetPoint {
    /// The set-point for the lengths (s) of the moving averages whose convolution is a move over `distance`, the longest first: d through
    /// T₀, T₁, T₂, T₃ has v = d/T₀, a = v/T₁, j = a/T₂, s = j/T₃. The first `order` count. Limits are rounded to five significant digits,
    /// so that the reported values are those of the runs.
    #[must_use]
    pub fn by_boxes(family: usize, order: u32, distance: f64, [cruise, ramp, rise, rise_of_jerk]: [f64; 4]) -> Self {
        let velocity = distance / cruise;
        let acceleration = velocity / ramp;
        let jerk = if order > 2 { acceleration / rise } else { f64::INFINITY };
        let snap = if order > 3 { jerk / rise_of_jerk } else { f64::INFINITY };
        Self { family, limits: [velocity, acceleration, jerk, snap].map(rounded) }
    }

    /// The lengths (s) of the moving averages of a move over `distance`; 0 above the order.
    #[must_use]
    pub fn boxes(&self, distance: f64) -> [f64; 4] {
        let [velocity, acceleration, jerk, snap] = self.limits;
        let above = |lower: f64, upper: f64| if upper.is_finite() { lower / upper } else { 0.0 };
        [distance / velocity, velocity / acceleration, above(acceleration, jerk), above(jerk, snap)]
    }

    /// Bits that identify it.
    pub(crate) fn key(&self) -> (usize, [u64; 4]) {
        (self.family, self.limits.map(f64::to_bits))
    }
}

/// Distance and ceiling of the moves of a question.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Room<'a> {
    /// Distance of the longest move (m or rad).
    pub(crate) distance: f64,
    /// The largest limits.
    pub(crate) ceiling: &'a Limits,
}

/// Smallest length of an average, relative to the longest: a shorter one has no effect.
const SHORTEST: f64 = 1e-3;

/// Bisections for the length of an average that contains others, which grow as it shrinks: to a millionth.
const HALVINGS: u32 = 20;

/// Extends `boxes` as required: `reached` (d, v, a or j) divided by them must stay below `most`, and each must contain all after it.
fn fit(fitted: &mut [f64], boxes: &[f64], most: &[f64], reached: f64, shortest: f64) {
    let (Some(length), Some(most_of_it)) = (boxes.first(), most.first()) else { return };
    let mut inside = |length: f64| {
        fit(&mut fitted[1..], &boxes[1..], &most[1..], reached / length, shortest);
        fitted[1..].iter().sum::<f64>()
    };
    let mut low = length.max(reached / most_of_it).max(shortest);
    let mut high = inside(low);
    if high <= low {
        fitted[0] = low;
        return;
    }
    // A longer average needs shorter ones inside it.
    if inside(high) < high {
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(low, high);
            if inside(middle) > middle { low = middle } else { high = middle }
        }
        inside(high);
    }
    fitted[0] = high;
}

impl<'q> Room<'q> {
    pub(crate) const fn of(question: &'q Question) -> Self {
        Self { distance: question.distance, ceiling: &question.ceiling }
    }

    /// Shortest duration of all averages together (s).
    pub(crate) fn shortest(&self, order: u32) -> f64 {
        self.fitted(order, [0.0; 4]).iter().sum()
    }

    /// `boxes`, of which the first `order` count, extended as required: to respect the ceiling, and to reach all limits (T₀ ≥ T₁ + T₂ + T₃,
    /// T₁ ≥ T₂ + T₃, T₂ ≥ T₃).
    pub(crate) fn fitted(&self, order: u32, boxes: [f64; 4]) -> [f64; 4] {
        let Limits { velocity, acceleration, jerk, snap } = *self.ceiling;
        let most = [velocity, acceleration, jerk, snap];
        let mut fitted = [0.0; 4];
        let shortest = SHORTEST * boxes[0].max(self.distance / velocity);
        let count = order as usize;
        fit(&mut fitted[..count], &boxes[..count], &most[..count], self.distance, shortest);
        fitted
    }

    /// The set-point with these averages, extended as required.
    pub(crate) fn point(&self, index: usize, order: u32, boxes: [f64; 4]) -> SetPoint {
        let Limits { velocity, acceleration, jerk, snap } = *self.ceiling;
        let most = [velocity, acceleration, jerk, snap];
        let SetPoint { family, limits } = SetPoint::by_boxes(index, order, self.distance, self.fitted(order, boxes));
        // Rounding may carry a limit beyond the ceiling; infinite limits belong to a higher order.
        SetPoint {
            family,
            limits: std::array::from_fn(|k| if limits[k].is_finite() { limits[k].min(most[k]) } else { limits[k] }),
        }
    }

    /// Total length of the averages of a set-point (s): the duration of its profile.
    pub(crate) fn length(&self, point: &SetPoint) -> f64 {
        point.boxes(self.distance).iter().sum()
    }

    /// True if both are of one family and no average differs between them by more than the share `part`.
    pub(crate) fn are_near(&self, one: &SetPoint, other: &SetPoint, part: f64) -> bool {
        let boxes = one.boxes(self.distance).into_iter().zip(other.boxes(self.distance));
        one.family == other.family && boxes.into_iter().all(|(one, other)| (one - other).abs() <= part * one.max(other))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_same(found: &[f64], expected: &[f64]) -> bool {
        found.len() == expected.len() && found.iter().zip(expected).all(|(one, other)| (one - other).abs() < 1e-12)
    }

    #[test]
    fn limits_and_boxes_agree() {
        let boxes = [0.5, 0.125, 0.08, 0.04];
        let point = SetPoint::by_boxes(0, 4, 0.25, boxes);
        assert!(is_same(&point.limits, &[0.5, 4.0, 50.0, 1250.0]), "{point:?}");
        assert!(is_same(&point.boxes(0.25), &boxes), "{point:?}");
        let third = SetPoint::by_boxes(0, 3, 0.25, boxes);
        assert!(third.limits[3].is_infinite() && is_same(&third.boxes(0.25), &[0.5, 0.125, 0.08, 0.0]));
        let second = SetPoint::by_boxes(0, 2, 0.25, boxes);
        assert!(second.limits[2].is_infinite() && is_same(&second.boxes(0.25), &[0.5, 0.125, 0.0, 0.0]));
    }

    /// A short distance: limits that no move would reach are lowered to reachable ones. None is above its ceiling.
    #[test]
    fn boxes_are_as_long_as_their_limits_need() {
        let free = Limits { velocity: 9.0, acceleration: 900.0, jerk: f64::INFINITY, snap: f64::INFINITY };
        let fitted = Room { distance: 0.02, ceiling: &free }.fitted(4, [0.01, 0.1, 0.02, 0.1]);
        assert!(is_same(&fitted, &[0.4, 0.2, 0.1, 0.1]), "{fitted:?}");
        let ceiling = Limits { velocity: 1.0 / 3.0, acceleration: 2.0 / 3.0, jerk: 10.0, snap: 1e3 };
        let room = Room { distance: 1.0, ceiling: &ceiling };
        assert!(is_same(&room.fitted(3, [0.0; 4]), &[3.0, 0.5, 2.0 / 30.0, 0.0]));
        // A move that does not reach its velocity: two ramps of √(d/a) each.
        let ceiling = Limits { velocity: 2.0, acceleration: 20.0, jerk: f64::INFINITY, snap: f64::INFINITY };
        let triangle = Room { distance: 0.02, ceiling: &ceiling }.fitted(2, [0.0; 4]);
        let ramp = 0.001_f64.sqrt();
        assert!((triangle[0] - ramp).abs() < 1e-5 * ramp && (triangle[1] - ramp).abs() < 1e-5 * ramp, "{triangle:?}");
        // Five digits, and at the ceiling where they would carry it beyond: 0.66667 is above 2/3.
        assert!(is_same(&room.point(0, 2, [0.0; 4]).limits[..2], &[0.33333, 2.0 / 3.0]));
    }
}
