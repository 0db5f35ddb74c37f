//! The search for the best set-points of all families: seeds, refinement, hops.
use crate::best::{AdviseError, Question};
use crate::hops::hops;
use crate::merit::Merit;
use crate::refine::{Steps, refined};
use crate::search::{Allowance, Found, Planned, Search};
use crate::seeds::seeds;
use crate::set_point::{Room, SetPoint};

/// Largest duration, relative to the best within the limits, at which the moves of seeds are run.
const WITHIN: f64 = 1.12;
/// Number of seeds that determine the hardest machine.
const PROBES: usize = 12;
/// Largest distance between machines of the search, in lobes of the shortest move.
const OF_A_LOBE: f64 = 0.15;
/// Relative difference of averages below which two set-points are the same start.
const APART: f64 = 0.04;
/// A family is not refined if its shortest time exceeds the best by this factor; it is exhausted within this factor of its shortest time.
const HOPELESS: f64 = 1.03;
const REACHED: f64 = 1.001;
/// Ratio to the best time above which a first refinement is abandoned.
const NEAR: f64 = 1.04;
/// Largest and smallest step of a first refinement, of the last one, and of one for a price.
const ROUGH: Steps = (0.12, 0.015);
const FINE: Steps = (0.03, 0.0008);
const FOR_A_PRICE: Steps = (0.03, 0.004);
/// Hops: speed-up from which on they restart, their largest number, and the largest time, relative to the best, of their moves.
const FASTER: f64 = 0.998;
const HOPS: usize = 4;
const LONGER: f64 = 1.1;

/// Effort of a search.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Effort {
    /// Largest numbers of set-points that are run on all machines, and of those that are refined: in total, and per family.
    run: [usize; 2],
    refined: [usize; 2],
    /// Number of set-points that are refined to the end, and the steps.
    to_the_end: usize,
    fine: Steps,
    /// True if it hops from the best to other lobes.
    has_hops: bool,
}

impl Effort {
    /// For the first advice among this number of families.
    pub(crate) fn of_first(families: usize) -> Self {
        let of_each = |all: usize| all / families.max(1);
        Self {
            run: [300, of_each(120).clamp(6, 40)],
            refined: [50, of_each(24).clamp(2, 8)],
            to_the_end: 3,
            fine: FINE,
            has_hops: true,
        }
    }

    /// After machines have joined the search.
    pub(crate) const AGAIN: Self = Self { run: [16, 8], refined: [5, 3], to_the_end: 1, fine: FINE, has_hops: false };
    /// For a price.
    pub(crate) const PRICE: Self =
        Self { run: [12, 4], refined: [2, 2], to_the_end: 1, fine: FOR_A_PRICE, has_hops: false };
}

/// The seeds of all families run on the hardest machine, and the total number of seeds. Machines between the corners join the search: zeros
/// and maxima of residual vibration lie there.
///
/// # Errors
/// [`AdviseError::NoPlan`], [`AdviseError::TooWide`]
pub(crate) fn sown(
    question: &Question,
    search: &mut Search<'_>,
    allowed: &Allowance,
) -> Result<(Vec<Planned>, usize), AdviseError> {
    let room = Room::of(question);
    let mut points = Vec::new();
    for (index, family) in question.families.iter().enumerate() {
        let of_family = seeds(index, family, &room, question.frequency);
        let Some(first) = of_family.first().and_then(|first| search.planned(&[*first]).pop()) else { continue };
        // A shaper adds the same time to any profile.
        let shaper = first.duration - room.length(&first.point);
        points.extend(of_family.into_iter().map(|point| (room.length(&point) + shaper, point)));
    }
    points.sort_by(|one, other| one.0.total_cmp(&other.0));
    let shortest = points.first().ok_or(AdviseError::NoPlan)?.0;
    let probes: Vec<SetPoint> = (0..PROBES).map(|k| points[(2 * k + 1) * points.len() / (2 * PROBES)].1).collect();
    let hardest = search.hardest(&probes, allowed);
    let own = search.machine(hardest).to_vec();
    let is_beside = |machine: &Vec<f64>| {
        let differ = machine.iter().zip(&own).filter(|(one, own)| one.to_bits() != own.to_bits());
        differ.count() <= 1
    };
    let between = question.machines.along(question.frequency, OF_A_LOBE / shortest)?;
    search.add(between.into_iter().filter(is_beside).chain([question.machines.middle()]));
    let run = search.sifted(&points, allowed, hardest, WITHIN);
    Ok((run, points.len()))
}

/// The best set-points within all limits that refinement finds from those in `from`, the fastest first.
pub(crate) fn best(
    question: &Question,
    search: &mut Search<'_>,
    from: &[Planned],
    allowed: &Allowance,
    effort: Effort,
) -> Vec<Found> {
    let room = Room::of(question);
    let refine = |search: &mut Search<'_>, start: Found, steps, bound| {
        let order = question.families[start.planned.point.family].order;
        refined(search, &room, order, allowed, start, steps, bound)
    };
    let fastest = search.fastest_known(allowed, None);
    let candidates = first(question, search, from, allowed, effort.run);
    search.on_all(&candidates, allowed, f64::INFINITY, |_| 0.0);
    let mut starts = first(question, search, &candidates, allowed, effort.refined);
    starts.extend(fastest.filter(|one| !starts.contains(one)));

    let (mut all, mut least) = (Vec::<Found>::new(), f64::INFINITY);
    let mut is_done = vec![false; question.families.len()];
    for start in starts {
        let family = start.point.family;
        let shortest = start.duration - room.length(&start.point) + room.shortest(question.families[family].order);
        if shortest > HOPELESS * least || is_done[family] {
            continue;
        }
        let Some(start) = search.on_all(&[start], allowed, f64::INFINITY, |_| 0.0).pop() else { continue };
        let found = refine(search, start, ROUGH, NEAR * least);
        least = least.min(found.merit.time_kept());
        is_done[family] = found.merit.time_kept() <= REACHED * shortest;
        all.push(found);
    }
    // A set-point slightly over a limit is ranked by its promise.
    all.sort_by(|one, other| one.merit.promise().total_cmp(&other.merit.promise()));
    let near = all.len().min(effort.to_the_end);
    for found in &mut all[..near] {
        *found = refine(search, found.clone(), effort.fine, f64::INFINITY);
    }
    all.retain(|one| one.merit.keeps());
    all.sort_by(by_time);

    for _ in 0..if effort.has_hops { HOPS } else { 0 } {
        let Some(best) = all.first().cloned() else { break };
        let (time, family) = (best.merit.time, best.planned.point.family);
        let better = hops(question, &room, &best.planned.point).into_iter().find_map(|point| {
            let planned = search.planned(&[point]);
            // Another family must promise more.
            let most = if point.family == family { LONGER * time } else { time };
            let start = planned.into_iter().filter(|one| one.duration < most).collect::<Vec<_>>();
            let start = search.on_all(&start, allowed, f64::INFINITY, |_| 0.0).pop()?;
            let found = refine(search, start, ROUGH, time);
            (found.merit.time_kept() < FASTER * time).then_some(found)
        });
        let Some(better) = better else { break };
        all.insert(0, refine(search, better, effort.fine, f64::INFINITY));
    }
    all
}

/// The first of `from`, each with averages that differ from all before it, up to the largest numbers in total and per family: the Pareto
/// front of time and excess over the limits first, then the front of the remaining ones, and so on.
fn first(
    question: &Question,
    search: &Search<'_>,
    from: &[Planned],
    allowed: &Allowance,
    [most, of_each_family]: [usize; 2],
) -> Vec<Planned> {
    let room = Room::of(question);
    let mut left: Vec<(Merit, Planned)> = from.iter().map(|one| (search.known_merit(one, allowed), *one)).collect();
    left.sort_by(|(one, _), (other, _)| one.time.total_cmp(&other.time).then(one.over.total_cmp(&other.over)));
    let mut of_family = vec![0; question.families.len()];
    let mut first: Vec<Planned> = Vec::new();
    while first.len() < most {
        let mut least = f64::INFINITY;
        let (front, behind): (Vec<_>, Vec<_>) = left.into_iter().partition(|(merit, _)| {
            let is_front = merit.over < least;
            least = least.min(merit.over);
            is_front
        });
        left = behind;
        if front.is_empty() {
            break;
        }
        // From those within their limits to the fast ones.
        for (_, one) in front.into_iter().rev() {
            let is_new = first.iter().all(|other| !room.are_near(&one.point, &other.point, APART));
            let count = &mut of_family[one.point.family];
            if is_new && *count < of_each_family && first.len() < most {
                *count += 1;
                first.push(one);
            }
        }
    }
    first
}

/// The fastest first.
fn by_time(one: &Found, other: &Found) -> std::cmp::Ordering {
    one.merit.time.total_cmp(&other.merit.time).then(one.planned.duration.total_cmp(&other.planned.duration))
}
