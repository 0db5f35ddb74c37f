//! A target that is passed at a velocity is met, however near the straight way to that velocity comes to it.
//!
//! Where the straight way from a state to the target's velocity v is all but long enough, the rest is made up for by pulses
//! so short that there are no numbers for them beside the times of the way: what it covers grows with the root of the turning
//! time (order 3), or its third root (order 4), and is met to √ε or ∛ε. Who aims a little nearer and goes on at v for what is
//! left to the target meets it to rounding, and takes no longer: next to the straight way another metre costs 1/v seconds
//! either way.
use super::first::State;
use super::path::Path;
use super::second::Sides;

/// What a target may be missed by, as a part of what is covered.
pub(crate) const ROUNDING: f64 = 1e-13;

/// What the straight way may end away from the target, as a part of what is covered, and is still taken.
pub(crate) const NEGLIGIBLE: f64 = 1e-12;

/// The largest part of a value that may be its rounding: where limits are much larger than what a way uses, they are no measure of it.
const LARGEST: f64 = 1e-6;

/// What positions are rounded by where a distance is their difference.
#[inline]
pub(crate) fn rounding_of(from: f64, to: f64) -> f64 {
    4.0 * f64::EPSILON * (from.abs() + to.abs())
}

/// What a derivative near its end is rounded by: it was up to its limits before, on the same polynomial. `size` is its size now.
#[inline]
pub(crate) fn rounding_within(limits: Sides, size: f64) -> f64 {
    (4.0 * f64::EPSILON * limits.above.max(limits.below)).min(LARGEST * size)
}

/// How often it is aimed nearer, each time by four times as much.
const AIMS: u32 = 8;

/// Whether `path`, which ends at `end`, meets `to`, or comes to rest there, where the pulses cover nothing.
#[inline]
pub(crate) fn is_met<S: State, const N: usize>(from: S, to: S, end: S, path: &Path<N>) -> bool {
    let (missed, v) = (to.position() - end.position(), to.velocity());
    let way = (to.position() - from.position()).abs();
    // The time is asked for where the way alone does not tell.
    v == 0.0 || missed.abs() <= ROUNDING * way || missed.abs() <= ROUNDING * (way + v.abs() * path.duration())
}

/// The way from `from` to `to` by `plan`, which has one to any position, instead of `path`, which misses it; `straight` is the
/// straight way to the velocity at which it is passed.
#[cold]
pub(crate) fn meet<S: State, const N: usize>(
    [from, to]: [S; 2],
    path: Path<N>,
    plan: impl Fn(f64) -> Option<Path<N>>,
    straight: &Path<N>,
) -> Option<Path<N>> {
    let (goal, v) = (to.position(), to.velocity());
    // Time at v that is left to the target.
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
