//! Other lobes: set-points that refinement does not reach.
use crate::best::Question;
use crate::set_point::{Room, SetPoint};

/// Shares of the mode's period by which an average is changed: the zeros of an average are one period apart.
const HALF: f64 = 0.5;
const SIXTH: f64 = 1.0 / 6.0;

/// `point` with one average longer or shorter, with half a period moved from one average to another, and with the same averages in other
/// families; empty without a known mode.
pub(crate) fn hops(question: &Question, room: &Room<'_>, point: &SetPoint) -> Vec<SetPoint> {
    let period = 1.0 / question.frequency;
    if !period.is_finite() {
        return Vec::new();
    }
    let own = point.boxes(room.distance);
    let order = question.families[point.family].order;
    let count = order as usize;
    let moved = |moves: &[(usize, f64)]| {
        let mut boxes = own;
        for (k, parts) in moves {
            boxes[*k] = (boxes[*k] + parts * period).max(0.0);
        }
        room.point(point.family, order, boxes)
    };
    let single = (0..count).flat_map(|k| [-HALF, HALF, -SIXTH, SIXTH].map(|part| moved(&[(k, part)])));
    let pairs = (0..count).flat_map(|from| (0..count).filter(move |to| *to != from).map(move |to| (from, to)));
    let pairs = pairs.map(|(from, to)| moved(&[(from, -HALF), (to, HALF)]));
    let families = question.families.iter().enumerate().filter(|(index, _)| *index != point.family);
    let others = families.map(|(index, family)| room.point(index, family.order, own));
    single.chain(pairs).chain(others).collect()
}
