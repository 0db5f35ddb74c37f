//! Where a loop changes from stable to unstable or back as one gain grows or falls.
//!
//! The gain goes by a factor from 1 away, on a logarithmic grid, and the first change of the verdict is bisected. So that an island
//! is not stepped over, the grid follows the poles: a step is half of what the pole that is soonest at the unit circle needs to
//! get there at its present speed |dλ/d ln k|, but at least 0.5 % and at most 5 % of the gain. A range of gains that is missed
//! is narrower than that: 0.5 %, or a pole turns back twice in one step.
use crate::error::StabilityError;
use crate::period::Period;
use crate::report::GainName;
use crate::tick::{Closed, Tick};
use crate::{analyse, eigen};
use nalgebra::Complex;

/// Gains are scanned to this factor and its reciprocal.
pub(crate) const REACH: f64 = 1_000.0;
const SHORTEST_STEP: f64 = 0.005;
const LONGEST_STEP: f64 = 0.05;
/// Share of the way to the circle that a step takes at most.
const SHARE: f64 = 0.5;
/// Relative difference of gains that tells the speed of the poles.
const DIFFERENCE: f64 = 1e-4;
/// Relative accuracy of the boundary.
const ACCURACY: f64 = 1e-6;
/// A pole closer to the origin is a delay: it needs more than a step to the circle, and its speed is that of a multiple
/// root, infinite.
const DELAY: f64 = 0.3;

/// The nearest factors on the gain `name` at which the verdict on the loops `closed` changes from `is_unstable`: downwards and
/// upwards.
pub(crate) fn nearest(tick: &mut Tick, closed: Closed, name: GainName, is_unstable: bool) -> [Option<f64>; 2] {
    let mut scan = Scan { tick, closed, name, is_unstable };
    [-1.0, 1.0].map(|sign| scan.nearest(sign).map(f64::exp))
}

struct Scan<'a, 'b> {
    tick: &'a mut Tick<'b>,
    closed: Closed,
    name: GainName,
    is_unstable: bool,
}

impl Scan<'_, '_> {
    /// Logarithm of the nearest factor in the direction `sign`.
    fn nearest(&mut self, sign: f64) -> Option<f64> {
        let mut here = 0.0_f64;
        while here.abs() < REACH.ln() {
            let next = here + sign * self.step(here, sign);
            if self.changes_at(next) {
                return Some(self.bisect(here, next));
            }
            here = next;
        }
        None
    }

    /// Whether the verdict is another one. What grows beyond all numbers within a period is unstable.
    fn changes_at(&mut self, exponent: f64) -> bool {
        self.tick.with(self.closed, self.name.factors(exponent.exp()));
        let is_unstable = analyse::unstable_pole(self.tick).map_or(true, |pole| pole.is_some());
        is_unstable != self.is_unstable
    }

    fn bisect(&mut self, mut same: f64, mut other: f64) -> f64 {
        while (other - same).abs() > ACCURACY {
            let middle = f64::midpoint(same, other);
            *(if self.changes_at(middle) { &mut other } else { &mut same }) = middle;
        }
        f64::midpoint(same, other)
    }

    /// How far the gain can go until the first pole is half-way at the circle.
    fn step(&mut self, here: f64, sign: f64) -> f64 {
        let (Ok(poles), Ok(moved)) = (self.poles(here), self.poles(here + sign * DIFFERENCE)) else {
            return SHORTEST_STEP;
        };
        let mut step = LONGEST_STEP;
        for pole in poles.iter().filter(|pole| pole.norm() > DELAY) {
            let way = moved.iter().map(|moved| (moved - pole).norm()).fold(f64::INFINITY, f64::min);
            let distance = (pole.norm() - 1.0).abs();
            if way > 0.0 {
                step = step.min(SHARE * DIFFERENCE * distance / way);
            }
        }
        step.max(SHORTEST_STEP)
    }

    fn poles(&mut self, exponent: f64) -> Result<Vec<Complex<f64>>, StabilityError> {
        self.tick.with(self.closed, self.name.factors(exponent.exp()));
        let blocks = eigen::blocks(&Period::new(self.tick)?)?;
        Ok(blocks.into_iter().flat_map(|block| block.eigenvalues).collect())
    }
}
