//! Corner in which the legend of a plot covers least.
use crate::planned::PlannedPlot;
use crate::rerun::blueprint::components::Corner2D;
use crate::series::Role;

/// Share of a plot's width for a legend.
const WIDTH: f64 = 0.18;
/// Shares of a plot's height for one line of a legend, and for its frame.
const LINE: f64 = 0.12;
const FRAME: f64 = 0.06;
/// Number of instants at which a curve is checked in a corner.
const LOOKS: usize = 400;

/// Corners in order of preference: each with true if at the right, true if at the top, and the weight of the covered points. Most events
/// are at the left.
const CORNERS: [(Corner2D, bool, bool, usize); 4] = [
    (Corner2D::RightTop, true, true, 1),
    (Corner2D::RightBottom, true, false, 1),
    (Corner2D::LeftTop, false, true, 2),
    (Corner2D::LeftBottom, false, false, 2),
];

/// The corner in which the fewest points of the curves lie, on an axis from `low` to `high`.
pub(crate) fn corner(plot: &PlannedPlot<'_>, (low, high): (f64, f64)) -> Corner2D {
    let lines = plot.shown().count();
    let height = (FRAME + LINE * lines as f64).min(1.0);
    let (start, end) = plot.time();
    let covered = |right: bool, top: bool| -> usize {
        let (from, to) =
            if right { (end - WIDTH * (end - start), end) } else { (start, start + WIDTH * (end - start)) };
        let (bottom, ceiling) =
            if top { (high - height * (high - low), high) } else { (low, low + height * (high - low)) };
        // The visible rest of a bound's line suffices.
        let curves = plot.shown().filter(|series| series.role != Role::Bound);
        curves.map(|series| series.hits((from, to), (bottom, ceiling), LOOKS)).sum()
    };
    let emptiest = CORNERS.into_iter().min_by_key(|(_, right, top, weight)| weight * covered(*right, *top));
    emptiest.map_or(Corner2D::RightTop, |(corner, ..)| corner)
}
