//! Other lobes: set-points that no refinement leads to.
use crate::best::Question;
use crate::set_point::{Room, SetPoint};

/// Parts of the period of the mode by which a box becomes longer or shorter: zeros of a box are a period from each other.
const HALF: f64 = 0.5;
const SIXTH: f64 = 1.0 / 6.0;

/// `point` with one box longer or shorter, with half a period moved from one box to another, and with the same boxes in other families; nothing where
/// no mode is known.
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
