//! The shortest slowdown from which on a target value is met.
//!
//! Factors are tried in steps, several at a time, until the value is not above the target; between the last two of them the factor is
//! refined by regula falsi (Illinois; Dowell and Jarratt 1971) and bisection. A residual vibration has zeros, around which it comes down in
//! dips that are narrower than a step: each dip is searched before the steps continue. The factors tried do not depend on how many are
//! tried at the same time, so that the result does not either.

/// Sequence of the factors that are tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Steps {
    /// Each longer than the one before by this share.
    Ratio(f64),
    /// Each longer by this difference, with a search of every dip.
    Difference(f64),
}

/// Factors that are tried at a time.
const AT_A_TIME: usize = 8;
/// Longest factor that is tried.
pub(super) const LONGEST: f64 = 10.0;
/// Steps at most.
const MOST_STEPS: usize = 3000;
/// Relative tolerance of equal values.
pub(super) const EQUAL: f64 = 1e-6;
/// Resolution of a factor.
const RESOLUTION: f64 = 1e-10;
/// Share of a step at which the search of a dip ends.
const DIP: f64 = 1e-3;
/// Number of refinements that did not halve the interval, after which it is bisected.
const PATIENCE: u32 = 2;

/// A factor and its measured value; infinite where nothing was measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Point {
    pub(super) factor: f64,
    pub(super) value: f64,
}

/// State of the search.
#[derive(Debug, Clone, PartialEq)]
enum Phase {
    /// Steps.
    Stepping,
    /// Searching a dip between the factors of the outer points, of which a point between them is lower.
    Dipping { low: f64, high: f64, best: Point },
    /// Refining: the value is above the target at the one, and not at the other.
    Closing { above: Point, below: Point, weights: [f64; 2], last: Option<bool>, slow: u32 },
    /// The target is met.
    Found(Point),
    /// The target is not met.
    NotFound,
}

/// The search for one factor.
#[derive(Debug, Clone)]
pub(super) struct Search {
    target: f64,
    steps: Steps,
    /// Points of the steps, in their order, the first at factor 1.
    tried: Vec<Point>,
    /// Number of tried steps that were evaluated.
    seen: usize,
    /// True if the part before the first step was searched.
    has_begun: bool,
    phase: Phase,
    /// The least value that was measured.
    least: f64,
}

impl Search {
    /// Searches the first factor at which the value is not above `target`; it is `own` at the factor 1.
    pub(super) fn new(target: f64, own: f64, steps: Steps) -> Self {
        let first = Point { factor: 1.0, value: own };
        let is_met = own <= target * (1.0 + EQUAL);
        let phase = if is_met { Phase::Found(first) } else { Phase::Stepping };
        Self { target, steps, tried: vec![first], seen: 1, has_begun: false, phase, least: own }
    }

    /// The factor, when it is found.
    pub(super) const fn found(&self) -> Option<Point> {
        match self.phase {
            Phase::Found(point) => Some(point),
            _ => None,
        }
    }

    /// The largest factor of the steps.
    pub(super) fn reached(&self) -> f64 {
        self.tried.last().map_or(1.0, |point| point.factor)
    }

    /// The least value that was measured.
    pub(super) const fn least(&self) -> f64 {
        self.least
    }

    /// The factors to be tried now; none when the search has ended.
    pub(super) fn wanted(&self) -> Vec<f64> {
        match &self.phase {
            Phase::Stepping => {
                let steps = self.tried.len()..(self.tried.len() + AT_A_TIME).min(MOST_STEPS);
                steps.map(|k| self.factor(k)).take_while(|factor| *factor <= LONGEST).collect()
            }
            Phase::Dipping { low, high, .. } => {
                let part = (high - low) / (AT_A_TIME + 1) as f64;
                (1..=AT_A_TIME).map(|k| low + part * k as f64).collect()
            }
            Phase::Closing { above, below, weights, slow, .. } => {
                let middle = 0.5 * (above.factor + below.factor);
                let [a, b] = [weights[0] * (above.value - self.target), weights[1] * (self.target - below.value)];
                let share = a / (a + b);
                let is_usable = share.is_finite() && share > 0.0 && share < 1.0 && *slow < PATIENCE;
                vec![if is_usable { above.factor + share * (below.factor - above.factor) } else { middle }]
            }
            Phase::Found(_) | Phase::NotFound => Vec::new(),
        }
    }

    fn factor(&self, k: usize) -> f64 {
        match self.steps {
            Steps::Ratio(part) => (1.0 + part).powf(k as f64),
            Steps::Difference(step) => 1.0 + step * k as f64,
        }
    }

    /// Takes the values measured at the factors that [`wanted`](Self::wanted) returned; `None` where nothing was measured.
    pub(super) fn learn(&mut self, factors: &[f64], values: &[Option<f64>]) {
        let points = factors.iter().zip(values).map(|(factor, value)| {
            let value = value.filter(|value| value.is_finite()).map_or(f64::INFINITY, f64::abs);
            Point { factor: *factor, value }
        });
        let points: Vec<Point> = points.collect();
        self.least = points.iter().map(|point| point.value).fold(self.least, f64::min);
        match self.phase.clone() {
            Phase::Stepping => {
                let is_over = points.is_empty();
                self.tried.extend(points);
                self.look(is_over);
            }
            Phase::Dipping { low, high, best } => self.dip(low, high, best, &points),
            Phase::Closing { above, below, weights, last, slow } => {
                if let Some(point) = points.first() {
                    self.close(above, below, weights, last, slow, *point);
                }
            }
            Phase::Found(_) | Phase::NotFound => {}
        }
    }

    /// Evaluates the tried steps, one after the other.
    fn look(&mut self, is_over: bool) {
        self.phase = Phase::Stepping;
        if let [first, second, ..] = self.tried[..]
            && matches!(self.steps, Steps::Difference(_))
            && !std::mem::replace(&mut self.has_begun, true)
            && first.value <= second.value
        {
            // It may come down and rise again before the first step.
            self.phase = Phase::Dipping { low: first.factor, high: second.factor, best: first };
            return;
        }
        while let Some(point) = self.tried.get(self.seen).copied() {
            let before = self.tried[self.seen - 1];
            if point.value <= self.target {
                self.between(before, point);
                return;
            }
            let after = self.tried.get(self.seen + 1);
            let looks_into_dips = matches!(self.steps, Steps::Difference(_));
            match after {
                // The next step decides if it is a dip.
                None if looks_into_dips && !is_over => return,
                Some(after)
                    if looks_into_dips
                        && after.value > self.target
                        && point.value < before.value
                        && point.value <= after.value =>
                {
                    self.phase = Phase::Dipping { low: before.factor, high: after.factor, best: point };
                    self.seen += 1;
                    return;
                }
                _ => self.seen += 1,
            }
        }
        if is_over {
            self.phase = Phase::NotFound;
        }
    }

    /// Searches a dip, of which the lowest point so far is `best`.
    fn dip(&mut self, low: f64, high: f64, best: Point, points: &[Point]) {
        let end = |factor| Point { factor, value: f64::INFINITY };
        let mut all = if best.factor > low { vec![end(low), best] } else { vec![best] };
        all.extend(points);
        all.push(end(high));
        all.sort_by(|one, two| one.factor.total_cmp(&two.factor));
        if let Some(k) = all.iter().position(|point| point.value <= self.target) {
            self.between(all[k - 1], all[k]);
            return;
        }
        let lowest = all.iter().enumerate().min_by(|(_, one), (_, two)| one.value.total_cmp(&two.value));
        let Some((k, lowest)) = lowest.filter(|(k, _)| *k + 1 < all.len()) else {
            self.look(false);
            return;
        };
        let (low, high) = (all[k.saturating_sub(1)].factor, all[k + 1].factor);
        let Steps::Difference(step) = self.steps else { return };
        if high - low < DIP * step {
            self.look(false);
        } else {
            self.phase = Phase::Dipping { low, high, best: *lowest };
        }
    }

    /// Refines between a point above the target and one that is not.
    fn between(&mut self, above: Point, below: Point) {
        self.phase = if self.is_met(below, above) {
            Phase::Found(below)
        } else {
            Phase::Closing { above, below, weights: [1.0; 2], last: None, slow: 0 }
        };
    }

    fn is_met(&self, below: Point, above: Point) -> bool {
        (self.target - below.value).abs() <= EQUAL * self.target
            || below.factor - above.factor <= RESOLUTION * below.factor
    }

    fn close(
        &mut self,
        above: Point,
        below: Point,
        mut weights: [f64; 2],
        last: Option<bool>,
        slow: u32,
        point: Point,
    ) {
        let is_above = point.value > self.target;
        let width = below.factor - above.factor;
        let (above, below) = if is_above { (point, below) } else { (above, point) };
        if (point.value - self.target).abs() <= EQUAL * self.target {
            self.phase = Phase::Found(point);
            return;
        }
        if self.is_met(below, above) {
            self.phase = Phase::Found(below);
            return;
        }
        // Illinois: an end that stays twice counts half.
        let (kept, moved) = if is_above { (1, 0) } else { (0, 1) };
        weights[moved] = 1.0;
        if last == Some(is_above) {
            weights[kept] *= 0.5;
        }
        let has_halved = below.factor - above.factor <= 0.5 * width;
        let slow = if has_halved { 0 } else { slow + 1 };
        // After a bisection its ends count whole again.
        let slow = if slow > PATIENCE { 0 } else { slow };
        self.phase = Phase::Closing { above, below, weights, last: Some(is_above), slow };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// The factor, and how many were tried.
    fn searched(target: f64, steps: Steps, value: impl Fn(f64) -> Option<f64>) -> (Option<Point>, usize) {
        let mut search = Search::new(target, value(1.0).unwrap(), steps);
        let mut count = 0;
        while search.found().is_none() {
            let factors = search.wanted();
            let values: Vec<_> = factors.iter().map(|factor| value(*factor)).collect();
            count += values.len();
            let is_over = factors.is_empty();
            search.learn(&factors, &values);
            if is_over {
                break;
            }
        }
        (search.found(), count)
    }

    /// Oracle: the square root.
    #[test]
    fn a_value_that_falls_with_the_square_is_met_at_the_root() {
        for target in [0.9, 0.5, 0.02] {
            let (found, count) = searched(target, Steps::Ratio(0.05), |s| Some(1.0 / (s * s)));
            let found = found.unwrap();
            assert!((found.factor * target.sqrt() - 1.0).abs() < EQUAL, "{target}: {found:?}");
            assert!(count < 80, "{count} for {target}");
        }
        assert_eq!(searched(1.0, Steps::Ratio(0.05), |_| Some(1.0)).1, 0, "it is met already");
        assert_eq!(searched(0.009, Steps::Ratio(0.05), |s| Some(1.0 / (s * s))).0, None, "at 10.5");
    }

    /// A dip of |sin| is narrower than a step where little is left: oracle is the arc sine beside the first zero.
    #[test]
    fn the_first_dip_counts_however_narrow_it_is() {
        // One lobe is 0.1 long, a step a tenth of it; the first zero lies at 1.05.
        let value = |s: f64| Some((PI * (s - 1.05) / 0.1).sin().abs());
        for target in [0.5, 0.05, 0.002] {
            let (found, count) = searched(target, Steps::Difference(0.0098), value);
            let found = found.unwrap();
            let expected = 1.05 - 0.1 * f64::asin(target) / PI;
            assert!((found.factor - expected).abs() < 1e-7, "{target}: {found:?} {expected}");
            assert!(count < 90, "{count} for {target}");
        }
    }

    /// The zero lies before the first step, behind which it is higher than at the beginning.
    #[test]
    fn a_dip_right_at_the_beginning_counts() {
        let value = |s: f64| Some((PI * (s - 1.001) / 0.1).sin().abs());
        let (found, _) = searched(0.01, Steps::Difference(0.0098), value);
        let expected = 1.001 - 0.1 * f64::asin(0.01) / PI;
        assert!((found.unwrap().factor - expected).abs() < 1e-7, "{found:?} {expected}");
        let (found, count) = searched(0.5, Steps::Difference(0.0098), |s| Some(s.min(2.2 - s)));
        assert!((found.unwrap().factor - 1.7).abs() < 1e-6 && count < 150, "{found:?} {count}");
    }

    #[test]
    fn what_does_not_come_down_far_enough_in_one_dip_goes_on_to_the_next() {
        // Dips down to 0.3/s: 0.25 is met in the one at 1.25.
        let value = |s: f64| Some(((PI * (s - 1.05) / 0.1).sin().abs() + 0.3) / s);
        let (found, _) = searched(0.25, Steps::Difference(0.0098), value);
        let found = found.unwrap();
        assert!((1.24..1.25).contains(&found.factor) && (found.value - 0.25).abs() < 1e-6, "{found:?}");
    }

    /// A value that jumps meets the target at the jump, on the side that is not above.
    #[test]
    fn a_jump_is_found_to_the_last_digits() {
        let (found, count) = searched(0.5, Steps::Ratio(0.05), |s| Some(if s < 1.234_567 { 1.0 } else { 0.2 }));
        let found = found.unwrap();
        assert!((found.factor - 1.234_567).abs() < 1e-9 && (found.value - 0.2).abs() < 1e-15, "{found:?}");
        assert!(count < 70, "{count}");
    }

    #[test]
    fn where_nothing_is_measured_it_is_not_met() {
        let value = |s: f64| if (1.2..1.4).contains(&s) { None } else { Some(2.0 - s) };
        let (found, _) = searched(0.7, Steps::Ratio(0.05), value);
        let found = found.unwrap();
        assert!((found.factor - 1.4).abs() < 1e-6, "{found:?}");
    }
}
