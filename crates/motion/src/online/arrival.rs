//! Exact arrival at a target that is passed at a velocity, however near the direct path to that velocity comes to it.
//!
//! If the direct path from a state to the target's velocity v is almost long enough, the rest is made up for by pulses
//! so short that they have no digits beside the times of the path: their distance grows with the root of the turning
//! time (order 3), or its third root (order 4), and is met to √ε or ∛ε. A path that aims a little nearer and continues at v for the
//! rest meets the target to rounding, and takes no longer: next to the direct path another metre costs 1/v seconds
//! either way.
use super::first::State;
use super::path::Path;
use super::second::Sides;

/// Largest miss of a target, relative to the distance covered.
pub(crate) const ROUNDING: f64 = 1e-13;

/// Largest miss of the direct path that is accepted, relative to the distance covered.
pub(crate) const NEGLIGIBLE: f64 = 1e-12;

/// Largest share of a value that may be its rounding: limits much larger than the values of a path are no measure of it.
const LARGEST: f64 = 1e-6;

/// Rounding of a distance that is the difference of two positions.
#[inline]
pub(crate) fn rounding_of(from: f64, to: f64) -> f64 {
    4.0 * f64::EPSILON * (from.abs() + to.abs())
}

/// Rounding of a derivative near its end: it was up to its limits before, on the same polynomial. `size` is its size now.
#[inline]
pub(crate) fn rounding_within(limits: Sides, size: f64) -> f64 {
    (4.0 * f64::EPSILON * limits.above.max(limits.below)).min(LARGEST * size)
}

/// Number of times that the aim is moved nearer, each time by four times as much.
const AIMS: u32 = 8;

/// True if `path`, which ends at `end`, meets `to`, or comes to rest there, where the pulses cover nothing.
#[inline]
pub(crate) fn is_met<S: State, const N: usize>(from: S, to: S, end: S, path: &Path<N>) -> bool {
    let (missed, v) = (to.position() - end.position(), to.velocity());
    let way = (to.position() - from.position()).abs();
    // The time is computed only if the distance alone does not decide.
    v == 0.0 || missed.abs() <= ROUNDING * way || missed.abs() <= ROUNDING * (way + v.abs() * path.duration())
}

/// The path from `from` to `to` by `plan`, which has one to any position, instead of `path`, which misses it; `straight` is the
/// direct path to the velocity at which it is passed.
#[cold]
pub(crate) fn meet<S: State, const N: usize>(
    [from, to]: [S; 2],
    path: Path<N>,
    plan: impl Fn(f64) -> Option<Path<N>>,
    straight: &Path<N>,
) -> Option<Path<N>> {
    let (goal, v) = (to.position(), to.velocity());
    // Remaining time at v up to the target.
    let left = |path: &Path<N>| (goal - from.along(path).position()) / v;
    let waiting = |mut path: Path<N>, time: f64| {
        path.hold(S::CRUISE, v, time);
        path
    };
    let missed = left(&path);
    if missed >= 0.0 {
        return Some(waiting(path, missed));
    }
    let whole = left(straight);
    let mut nearer = missed;
    for _ in 0..AIMS {
        if whole > 0.0 && -nearer >= whole {
            return Some(waiting(*straight, whole));
        }
        let path = plan(goal + nearer * v)?;
        let time = left(&path);
        if time >= 0.0 || is_met(from, to, from.along(&path), &path) {
            return Some(waiting(path, time));
        }
        nearer *= 4.0;
    }
    Some(path)
}
