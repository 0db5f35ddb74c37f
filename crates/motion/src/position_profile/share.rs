//! The share of plateaus in which velocity changes, chosen within limits.
//!
//! A small share α needs a high acceleration, a large one a high velocity: for a single segment from rest to rest
//!
//! ```text
//! V = p/(T·(1 − α))       a = V/(α·T)
//! ```
//!
//! The chosen share needs the smallest part of both limits, max(|V|/V_max, |a|/a_max) over the whole table. In a table of several
//! segments that part may have several minima over α: the search covers a grid of 64 shares, and then the neighbourhood of the best.
use super::Command;
use crate::PlanError;
use crate::limits::{RANGE, in_range};
use servobench_base::{ParamError, Stateful, positive};

/// Shares of the grid, up to 1/2.
const GRID: u32 = 64;
/// Steps by the golden ratio beside the best share of the grid: each leaves 0.62 of the interval.
const STEPS: u32 = 40;
const GOLDEN: f64 = 0.618_033_988_749_894_9;
/// Share that is chosen unless another one is better.
const FIRST: f64 = 0.25;

/// The largest velocity (m/s or rad/s) and acceleration (m/s² or rad/s²) of a profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Demand {
    velocity: f64,
    acceleration: f64,
}

impl Demand {
    /// Demand of `commands`, which begin at velocity `start`.
    pub(super) fn of(commands: impl Iterator<Item = Command>, start: f64) -> Self {
        let none = Self { velocity: start.abs(), acceleration: 0.0 };
        commands.fold(none, |most, command| Self {
            velocity: most.velocity.max(command.velocity.abs()),
            acceleration: most.acceleration.max(command.acceleration),
        })
    }
}

/// The share α of a segment at either end in which the velocity of plateaus changes.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub enum PlateauShare {
    /// A given share, above 0 and up to 1/2, which leaves no plateau.
    Given(f64),
    /// The share that needs the smallest part of both limits, which may exceed the whole. The profile is solved about 150 times to
    /// find it.
    SmallestPartOf {
        /// Largest velocity (m/s or rad/s), above 0.
        velocity: f64,
        /// Largest acceleration (m/s² or rad/s²), above 0.
        acceleration: f64,
    },
}

impl From<f64> for PlateauShare {
    fn from(share: f64) -> Self {
        Self::Given(share)
    }
}

impl PlateauShare {
    /// Finds the share; `demand` gives the demand of a profile with one.
    ///
    /// # Errors
    /// [`PlanError`] of `demand`, and for a share or a limit out of its range.
    pub(super) fn found(self, mut demand: impl FnMut(f64) -> Result<Demand, PlanError>) -> Result<f64, PlanError> {
        match self {
            Self::Given(share) => checked(share),
            Self::SmallestPartOf { velocity, acceleration } => {
                for (name, value) in [("velocity", velocity), ("acceleration", acceleration)] {
                    in_range(name, positive(name, value)?, "give a limit of another size")?;
                }
                best(|share| {
                    let taken = demand(share)?;
                    Ok((taken.velocity / velocity).max(taken.acceleration / acceleration))
                })
            }
        }
    }
}

/// `share` if it is a share of a segment that leaves space for the other end.
fn checked(share: f64) -> Result<f64, PlanError> {
    if (RANGE.0..=0.5).contains(&share) {
        return Ok(share);
    }
    Err(ParamError { name: "alpha", value: share, bound: "above 0 (at least 1e-30) and at most 0.5" }.into())
}

/// The share for which `part` is smallest.
fn best(mut part: impl FnMut(f64) -> Result<f64, PlanError>) -> Result<f64, PlanError> {
    let mut best = (FIRST, part(FIRST)?);
    let width = 0.5 / f64::from(GRID);
    for k in 1..=GRID {
        let share = width * f64::from(k);
        let found = part(share)?;
        if found < best.1 {
            best = (share, found);
        }
    }
    let [mut from, mut to] = [(best.0 - width).max(0.1 * width), (best.0 + width).min(0.5)];
    for _ in 0..STEPS {
        let inner = GOLDEN * (to - from);
        let [left, right] = [to - inner, from + inner];
        let [at_left, at_right] = [part(left)?, part(right)?];
        for (share, found) in [(left, at_left), (right, at_right)] {
            if found < best.1 {
                best = (share, found);
            }
        }
        (from, to) = if at_left <= at_right { (from, right) } else { (left, to) };
    }
    Ok(best.0)
}
