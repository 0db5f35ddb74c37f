//! The neighbours of a set-point, nearer and nearer.
use crate::search::{Allowance, Found, Search};
use crate::set_point::{Family, SetPoint};
use servobench_motion::Limits;

/// The first step to a neighbour, and the last, as parts of a value.
const STEPS: (f64, f64) = (0.08, 0.0008);

/// The best near `start`: neighbours in every direction of velocity, acceleration and the times of their rise, until there is none that is
/// faster at the smallest step.
pub(crate) fn refined(
    search: &mut Search<'_>,
    families: &[Family],
    ceiling: &Limits,
    allowed: &Allowance,
    start: Found,
) -> Found {
    let (mut best, (mut step, last)) = (start, STEPS);
    while step >= last {
        let around = neighbours(&best.planned.point, families, ceiling, step);
        let planned = search.planned(&around);
        match search.fastest_below(&planned, allowed, 1.0, best.worst.time).into_iter().next() {
            Some(better) => best = better,
            None => step *= 0.5,
        }
    }
    best
}

/// Set-points whose velocity, acceleration and times are each a step less, the same, or a step more.
fn neighbours(point: &SetPoint, families: &[Family], ceiling: &Limits, step: f64) -> Vec<SetPoint> {
    let Some(family) = families.get(point.family) else { return Vec::new() };
    let dimensions = family.order as usize;
    let own = point.times();
    let mut all = Vec::new();
    for code in 0..3_usize.pow(family.order) {
        let mut times = own;
        let mut rest = code;
        for time in times.iter_mut().take(dimensions) {
            *time *= [1.0 / (1.0 + step), 1.0, 1.0 + step][rest % 3];
            rest /= 3;
        }
        let near = SetPoint::by_times(point.family, family.order, times).below(ceiling);
        if near.is_below(ceiling) && near.key() != point.key() {
            all.push(near);
        }
    }
    all.sort_by_key(SetPoint::key);
    all.dedup_by_key(|point| point.key());
    all
}
