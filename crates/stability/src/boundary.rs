//! Gains at which a loop changes from stable to unstable or back.
//!
//! The gain moves away from the factor 1 on a logarithmic grid, and the first change of the verdict is bisected. So that no island
//! is stepped over, the grid follows the poles: a step is half of the distance of a pole to the unit circle (for a stable loop
//! the pole that arrives first, for an unstable loop the one outside that arrives last) at its current speed d|λ|/d ln k (or a twentieth of
//! |dλ/d ln k|, if it moves along the circle), but at least 0.5 % and at most 10 % of the gain. A range of gains that is missed is narrower
//! than 0.5 %, or a pole comes to the circle and back within a step, in which it would have gone half of the distance.
use crate::analyse::Poles;
use crate::equations::{Closed, Equations};
use crate::error::StabilityError;
use crate::report::GainName;

/// Gains are scanned to this factor and its reciprocal.
pub(crate) const REACH: f64 = 1_000.0;
const SHORTEST_STEP: f64 = 0.005;
const LONGEST_STEP: f64 = 0.1;
/// Largest share of the distance to the circle in one step.
const SHARE: f64 = 0.5;
/// Share of the motion along the circle that counts as motion towards it: poles along it may turn.
const ALONG: f64 = 0.05;
/// Relative difference of gains that gives the speed of the poles.
const DIFFERENCE: f64 = 1e-4;
/// Relative accuracy of the boundary.
const ACCURACY: f64 = 1e-6;
/// A pole closer to the origin is a delay: it needs more than a step to the circle, and its speed is that of a multiple
/// root, infinite.
const DELAY: f64 = 0.3;

/// The nearest factors on the gain `name` at which the verdict on the loops `closed` changes from `is_unstable`: downwards and
/// upwards.
pub(crate) fn nearest(
    equations: &mut Equations,
    closed: Closed,
    name: GainName,
    is_unstable: bool,
) -> Result<[Option<f64>; 2], StabilityError> {
    let mut scan = Scan { equations, closed, name, is_unstable };
    let (below, above) = (scan.nearest(-1.0)?, scan.nearest(1.0)?);
    Ok([below, above].map(|factor| factor.map(f64::exp)))
}

struct Scan<'a, 'b> {
    equations: &'a mut Equations<'b>,
    closed: Closed,
    name: GainName,
    is_unstable: bool,
}

impl Scan<'_, '_> {
    /// Logarithm of the nearest factor in the direction `sign`.
    fn nearest(&mut self, sign: f64) -> Result<Option<f64>, StabilityError> {
        let mut here = 0.0_f64;
        let mut poles = self.poles(here)?;
        while here.abs() < REACH.ln() {
            let next = here + sign * self.step(poles.as_ref(), here + sign * DIFFERENCE)?;
            poles = self.poles(next)?;
            if self.is_other(poles.as_ref()) {
                return self.bisect(here, next).map(Some);
            }
            here = next;
        }
        Ok(None)
    }

    /// The poles with the gain scaled by e to the power of `exponent`; `None` if the loop overflows within a period.
    fn poles(&mut self, exponent: f64) -> Result<Option<Poles>, StabilityError> {
        self.equations.with(self.closed, self.name.factors(exponent.exp()));
        match Poles::new(self.equations) {
            Err(StabilityError::Overflow { .. }) => Ok(None),
            poles => poles.map(Some),
        }
    }

    /// True if the verdict has changed.
    fn is_other(&self, poles: Option<&Poles>) -> bool {
        let is_unstable = poles.is_none_or(|poles| poles.outside().is_some());
        is_unstable != self.is_unstable
    }

    fn bisect(&mut self, mut same: f64, mut other: f64) -> Result<f64, StabilityError> {
        while (other - same).abs() > ACCURACY {
            let middle = f64::midpoint(same, other);
            let poles = self.poles(middle)?;
            *(if self.is_other(poles.as_ref()) { &mut other } else { &mut same }) = middle;
        }
        Ok(f64::midpoint(same, other))
    }

    /// Step of the gain in which the decisive pole could move half-way to the circle, from `poles` and their values at `beside`: a
    /// stable loop changes with the first pole that leaves the circle, an unstable one with the last that comes in.
    fn step(&mut self, poles: Option<&Poles>, beside: f64) -> Result<f64, StabilityError> {
        let (Some(poles), Some(moved)) = (poles, self.poles(beside)?) else { return Ok(LONGEST_STEP) };
        let mut steps = (LONGEST_STEP, SHORTEST_STEP);
        for (block, pole) in poles.values.iter().filter(|(_, pole)| pole.norm_sqr() > DELAY * DELAY) {
            let of_block = moved.values.iter().filter(|(other, _)| other == block).map(|(_, moved)| moved);
            let Some(moved) = of_block.min_by(|a, b| (*a - pole).norm_sqr().total_cmp(&(*b - pole).norm_sqr())) else {
                continue;
            };
            let way = (moved.norm() - pole.norm()).abs().max(ALONG * (moved - pole).norm());
            let distance = (pole.norm() - 1.0).abs();
            let step = if way > 0.0 { SHARE * DIFFERENCE * distance / way } else { LONGEST_STEP };
            steps.0 = steps.0.min(step);
            if pole.norm() > 1.0 {
                steps.1 = steps.1.max(step);
            }
        }
        Ok((if self.is_unstable { steps.1 } else { steps.0 }).clamp(SHORTEST_STEP, LONGEST_STEP))
    }
}
