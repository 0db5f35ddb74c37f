//! Initial lengths of averages for a search.
use crate::set_point::{Family, Room, SetPoint};

/// The longest cruise as a multiple of the shortest.
const LONGEST: f64 = 4.0;
/// Ratios of neighbouring lengths of each average.
const RATIOS: [f64; 4] = [1.2, 1.4, 1.7, 2.0];
/// Lengths of inner averages in parts of the mode's period, and the number of parts: an average over a whole period cancels the mode.
const OF_A_PERIOD: f64 = 0.25;
const PARTS: u32 = 8;
/// Smallest length of an inner average, relative to the one outside it: refinement finds shorter ones.
const SHORTEST: f64 = 0.04;

/// Lengths from `low` to `high`, each `ratio` times the one before, with both ends and with the parts of the mode's period between them.
fn lengths([low, high]: [f64; 2], ratio: f64, frequency: f64) -> Vec<f64> {
    let levels = std::iter::successors(Some(low), |length| Some(length * ratio)).take_while(|length| *length < high);
    let parts = (1..=PARTS).map(|count| OF_A_PERIOD * f64::from(count) / frequency);
    levels.chain(parts.filter(|length| (low..high).contains(length))).chain([high.max(low)]).collect()
}

/// The initial set-points of a family, the shortest first; `frequency` (Hz) is that of the mode, 0 without a mode.
pub(crate) fn seeds(index: usize, family: &Family, room: &Room<'_>, frequency: f64) -> Vec<SetPoint> {
    let order = family.order;
    let shortest = room.fitted(order, [0.0; 4])[0];
    let mut all: Vec<[f64; 4]> = lengths([shortest, LONGEST * shortest], RATIOS[0], 0.0)
        .into_iter()
        .map(|cruise| [cruise, 0.0, 0.0, 0.0])
        .collect();
    for (k, ratio) in RATIOS.into_iter().enumerate().take(order as usize).skip(1) {
        let longer = |boxes: [f64; 4]| {
            // The ceiling requires a minimum length, and an average is at least as long as all those inside it.
            let least = room.fitted(order, boxes)[k].max(SHORTEST * boxes[k - 1]);
            lengths([least, boxes[k - 1]], ratio, frequency).into_iter().map(move |length| {
                let mut boxes = boxes;
                boxes[k] = length;
                boxes
            })
        };
        all = all.into_iter().flat_map(longer).collect();
    }
    let mut all: Vec<SetPoint> = all.into_iter().map(|boxes| room.point(index, order, boxes)).collect();
    all.sort_by(|one, other| room.length(one).total_cmp(&room.length(other)).then(one.key().cmp(&other.key())));
    all.dedup_by_key(|point| point.key());
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_motion::Limits;

    #[test]
    fn a_search_begins_at_the_ceiling_and_far_below_it() {
        let ceiling = Limits { velocity: 0.5, acceleration: 4.0, jerk: 100.0, snap: f64::INFINITY };
        let room = Room { distance: 0.25, ceiling: &ceiling };
        let family = |order| Family { order, shaper: None, settings: vec![], name: String::new() };
        for order in 2..=4 {
            let all = seeds(0, &family(order), &room, 17.5);
            let below = |point: &SetPoint| order == 2 || point.limits[2] <= 100.0;
            assert!((50..20_000).contains(&all.len()) && all.iter().all(below), "{order}: {}", all.len());
            let velocities = || all.iter().map(|point| point.limits[0]);
            let (slowest, fastest) = (velocities().fold(f64::INFINITY, f64::min), velocities().fold(0.0, f64::max));
            assert!(slowest <= 0.16 && (fastest - 0.5).abs() < 1e-9, "{order}: {slowest} {fastest}");
            assert!(all.is_sorted_by(|one, other| room.length(one) <= room.length(other)));
        }
    }
}
