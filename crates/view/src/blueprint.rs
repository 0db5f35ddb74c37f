//! Arrangement of the views.
use crate::catalogue::Page;
use crate::curves::TIMELINE;
use crate::layout::{Layout, Node, View};
use crate::legend;
use crate::plane::Plane;
use crate::planned::PlannedPlot;
use crate::reached::Reached;
use crate::rerun::EntityPath;
use crate::rerun::blueprint::archetypes::{
    EyeControls3D, LineGrid3D, PlotLegend, ScalarAxis, TextLogColumns, TimeAxis,
};
use crate::rerun::blueprint::components::{ContainerKind, LinkAxis};
use crate::rerun::blueprint::datatypes::{TextLogColumn, TextLogColumnKind, TimelineColumn};
use crate::rerun::{TimeInt, TimeRange, TimeRangeBoundary};
use crate::scene::Scene;
use crate::signals::Lanes;
use crate::timeline_events::Happenings;
use crate::verdict::Head;
use servobench_metrics::round_below;

/// Height below the tabs in a window of 1400 × 900 points.
const PAGE: f64 = 815.0;
/// Largest height of the head on the first page; the rest can be scrolled to (points).
const HEAD: f64 = 200.0;
/// Height of title and time axis of a plot (points).
const AROUND: f64 = 40.0;
/// Least height of a plot in which curve and legend can be read, where lanes stand beside it (points).
const LEAST: f64 = 165.0;
/// Height of title and time axis of lanes, and of a lane (points).
const LANES: f64 = 54.0;
const LANE: f64 = 40.0;
/// Largest share of a column for lanes, when there are plots too.
const MOST: f64 = 0.6;
/// Largest number of plots on a page in a single column; for the set-point, the second number.
const COLUMN: (usize, usize) = (3, 2);

/// Parts to be arranged.
pub(crate) struct Parts<'p, 'a> {
    /// The plots.
    pub(crate) plots: &'p [PlannedPlot<'a>],
    /// The 3D view.
    pub(crate) scene: Option<&'p Scene>,
    /// Moves, events and log.
    pub(crate) timeline_events: Happenings,
    /// Lanes of signals.
    pub(crate) signals: Lanes,
    /// Lanes of limits.
    pub(crate) reached: Option<Reached>,
    /// Planes of the motor's operating points.
    pub(crate) planes: &'p [Plane],
    /// Verdict, above every page.
    pub(crate) head: &'p Head,
    /// Length of the longest run (s).
    pub(crate) duration: f64,
}

/// Height of a part of a column.
#[derive(Debug, Clone, Copy)]
enum Room {
    /// Share of the remaining height.
    Share(f64),
    /// Points.
    Points(f64),
}

/// A part of a column.
enum Part<'p, 'a> {
    /// A plot, whose axis depends on its height.
    Plot(&'p PlannedPlot<'a>),
    /// Anything else.
    View(Node),
}

/// The parts of a column, from above.
type Column<'p, 'a> = Vec<(Room, Part<'p, 'a>)>;

/// The layout of `parts`.
pub(crate) fn layout(parts: Parts<'_, '_>) -> Layout {
    let Parts { plots, scene, timeline_events, signals, reached, planes, head, duration } = parts;
    let is_first = |name: &str| (name == "Program") == signals.has_program;
    let height = |name: &str| PAGE - head_height(head, ["Axis", "Program"].contains(&name) && is_first(name));
    let on =
        |page: Page| plots.iter().filter(move |plot| plot.page == page).map(|plot| (share(plot), Part::Plot(plot)));
    let program = program(on(Page::Motion).collect(), &signals, height("Program"));
    let mut drive: Column<'_, '_> = Vec::new();
    let lanes = reached.map(|reached| (lanes_height(reached.paths.len().min(6)), reached_view(reached)));
    let rest = height("Drive") - lanes.as_ref().map_or(0.0, |(points, _)| *points);
    let electrical = in_columns(on(Page::Electrical).collect(), COLUMN.0, rest);
    drive.extend(electrical.map(|node| (Room::Share(1.0), Part::View(node))));
    drive.extend(lanes.map(|(points, node)| (Room::Points(points), Part::View(node))));
    let mut pages = [
        ("Axis", axis(on(Page::Motion).collect(), on(Page::Errors).collect(), scene, &timeline_events, height("Axis"))),
        ("Program", program),
        ("Set-point", in_columns(on(Page::SetPoint).collect(), COLUMN.1, height("Set-point"))),
        ("Drive", stack(drive, height("Drive"))),
        ("Motor", operating(planes)),
        ("Other", in_columns(on(Page::Other).collect(), COLUMN.0, height("Other"))),
        ("Log", log_view(&timeline_events)),
    ];
    if signals.has_program {
        pages.swap(0, 1);
    }
    let pages = pages.into_iter().filter_map(|(name, page)| Some((name, page?)));
    let pages = pages.enumerate().map(|(index, (name, page))| (1.0, with_head(name, page, head, index == 0)));
    let root = Node::of(ContainerKind::Tabs, None, pages.collect());
    let root = root.unwrap_or_else(|| Node::View(View::new("TextLog", "Nothing was recorded", Vec::new())));
    Layout { root, playback_speed: playback_speed(duration) }
}

/// The page of the axis: bodies and motion at the left, errors at the right.
fn axis<'p, 'a>(
    motion: Column<'p, 'a>,
    mut right: Column<'p, 'a>,
    scene: Option<&Scene>,
    timeline_events: &Happenings,
    height: f64,
) -> Option<Node> {
    let is_comparison = scene.is_some_and(|scene| scene.roots.len() > 1);
    let share = if is_comparison { 2.0 } else { 1.5 };
    let mut left: Column<'p, 'a> = Vec::new();
    left.extend(scene.map(|scene| (Room::Share(share), Part::View(scene_view(scene)))));
    left.extend(motion);
    // The lanes of several runs would leave the 3D view no room.
    if is_comparison { &mut right } else { &mut left }.extend(lanes_view(timeline_events));
    let columns = [(0.45, left), (0.55, right)];
    let columns = columns.into_iter().filter_map(|(share, parts)| Some((share, stack(parts, height)?)));
    Node::of(ContainerKind::Horizontal, None, columns.collect())
}

/// The page of the motor: two planes beside each other.
fn operating(planes: &[Plane]) -> Option<Node> {
    let rows = planes.chunks(2).filter_map(|row| {
        let columns = row.iter().map(|plane| (0.5, plane.view())).collect();
        Some((0.5, Node::of(ContainerKind::Horizontal, None, columns)?))
    });
    Node::of(ContainerKind::Vertical, None, rows.collect())
}

/// The page of signals: the motion, calls that never completed, and a lane for each signal.
fn program(motion: Column<'_, '_>, signals: &Lanes, height: f64) -> Option<Node> {
    if signals.paths.is_empty() && signals.fates.is_empty() {
        return None;
    }
    let lanes = |title: &str, paths: &[EntityPath], most: f64| {
        let points = lanes_height(paths.len()).min(most);
        let view = || Part::View(Node::View(View::new("StateTimeline", title, paths.to_vec())));
        (!paths.is_empty()).then(|| (Room::Points(points), view()))
    };
    let fates = lanes("Calls that were never executed, or failed", &signals.fates, lanes_height(4));
    let taken =
        LEAST * motion.len() as f64 + lanes_height(signals.fates.len().min(4)) * f64::from(u8::from(fates.is_some()));
    let all = lanes("Blocks, axis and drive", &signals.paths, (height - taken).max(lanes_height(2)));
    stack(motion.into_iter().chain(fates).chain(all).collect(), height)
}

/// `parts` below each other in `height` points.
fn stack(parts: Column<'_, '_>, height: f64) -> Option<Node> {
    let points = |room: &Room| if let Room::Points(points) = room { *points } else { 0.0 };
    let shares = |room: &Room| if let Room::Share(share) = room { *share } else { 0.0 };
    let fixed: f64 = parts.iter().map(|(room, _)| points(room)).sum();
    let all: f64 = parts.iter().map(|(room, _)| shares(room)).sum();
    // Plots keep some of the height, however many lanes there are.
    let squeezed = if all > 0.0 && fixed > 0.0 { (MOST * height / fixed).min(1.0) } else { 1.0 };
    let rest = (height - squeezed * fixed).max(0.0);
    let nodes = parts.into_iter().map(|(room, part)| {
        let own = squeezed * points(&room) + if all > 0.0 { rest * shares(&room) / all } else { 0.0 };
        let node = match part {
            Part::Plot(plot) => plot_view(plot, own - AROUND),
            Part::View(node) => node,
        };
        #[expect(clippy::cast_possible_truncation, reason = "rounds, to far less than a pixel")]
        let own = own as f32;
        (own, node)
    });
    Node::of(ContainerKind::Vertical, None, nodes.collect())
}

/// `plots` below each other, or in two columns when there are more than `most`.
fn in_columns(mut plots: Column<'_, '_>, most: usize, height: f64) -> Option<Node> {
    if plots.len() <= most {
        return stack(plots, height);
    }
    let right = plots.split_off(plots.len().div_ceil(2));
    let columns = [plots, right].into_iter().filter_map(|column| Some((0.5, stack(column, height)?)));
    Node::of(ContainerKind::Horizontal, None, columns.collect())
}

/// The tab `name`: the head above `page`, on the first tab in full as far as there is room.
fn with_head(name: &'static str, page: Node, head: &Head, is_first: bool) -> Node {
    let height = head_height(head, is_first);
    #[expect(clippy::cast_possible_truncation, reason = "rounds, to far less than a pixel")]
    let [page_share, head_share] = [PAGE - height, height].map(|points| points as f32);
    let mut parts = vec![(page_share, page)];
    if let Some(path) = head.path() {
        parts.insert(0, (head_share, Node::View(View::new("TextDocument", head.subject.clone(), vec![path]))));
    }
    Node::tab(name, parts)
}

/// Height of the head (points).
fn head_height(head: &Head, is_first: bool) -> f64 {
    head.path().map_or(0.0, |_| head.height(is_first).min(HEAD))
}

/// Height of a view of `count` lanes (points).
fn lanes_height(count: usize) -> f64 {
    LANES + LANE * count as f64
}

/// Slow motion in which a run of `duration` (s) lasts six to fifteen seconds, so that the eye can follow a vibration;
/// longer runs play in real time.
fn playback_speed(duration: f64) -> f64 {
    if duration > 0.0 { round_below(duration / 6.0).min(1.0) } else { 1.0 }
}

/// Share of a column for a plot: a disturbance needs less.
fn share(plot: &PlannedPlot<'_>) -> Room {
    Room::Share(if plot.path.ends_with("_disturbance") { 0.6 } else { 1.0 })
}

/// Moves and events, with a height for their lanes.
fn lanes_view<'p, 'a>(timeline_events: &Happenings) -> Option<(Room, Part<'p, 'a>)> {
    let lanes = timeline_events.lanes.clone();
    let height = Room::Points(lanes_height(lanes.len().min(4)));
    (!lanes.is_empty()).then(|| (height, Part::View(Node::View(View::new("StateTimeline", "Moves and events", lanes)))))
}

fn reached_view(reached: Reached) -> Node {
    Node::View(View::new("StateTimeline", reached.title, reached.paths))
}

fn log_view(timeline_events: &Happenings) -> Option<Node> {
    let columns = [TextLogColumnKind::LogLevel, TextLogColumnKind::Body];
    let columns = columns.map(|kind| TextLogColumn { kind, visible: true.into() });
    // Rerun's own column of times is too narrow for them: each line begins with its time.
    let time = TimelineColumn { visible: false.into(), timeline: TIMELINE.into() };
    let columns = TextLogColumns::new().with_text_log_columns(columns).with_timeline_columns([time]);
    let logs = timeline_events.logs.clone();
    (!logs.is_empty()).then(|| Node::View(View::new("TextLog", "Log", logs).with("TextLogColumns", &columns)))
}

/// A plot of `height` points.
fn plot_view(plot: &PlannedPlot<'_>, height: f64) -> Node {
    let shown = plot.shown().map(|series| series.path.clone());
    let axis = match plot.own_time {
        None => TimeAxis::new().with_link(LinkAxis::LinkToGlobal),
        Some((from, to)) => {
            TimeAxis::new().with_link(LinkAxis::Independent).with_view_range(TimeRange { start: at(from), end: at(to) })
        }
    };
    let (low, high) = plot.range(height);
    let values = ScalarAxis::new().with_range([low * plot.scale.factor, high * plot.scale.factor]);
    // The title names a single curve.
    let legend =
        PlotLegend::new().with_corner(legend::corner(plot, (low, high))).with_visible(plot.shown().count() > 1);
    let view = View::new("TimeSeries", plot.title.clone(), shown.collect());
    Node::View(view.with("TimeAxis", &axis).with("ScalarAxis", &values).with("PlotLegend", &legend))
}

/// A boundary at `seconds`.
fn at(seconds: f64) -> TimeRangeBoundary {
    #[expect(clippy::cast_possible_truncation, reason = "saturates, 292 years from the start of the run")]
    let nanoseconds = (seconds * 1e9).round() as i64;
    TimeRangeBoundary::Absolute(TimeInt(nanoseconds))
}

fn scene_view(scene: &Scene) -> Node {
    let eye = EyeControls3D::new().with_position(scene.eye).with_look_target(scene.target).with_eye_up([0.0, 0.0, 1.0]);
    let mut view = View::new("3D", scene.title.clone(), scene.roots.clone());
    view.recursive = true;
    Node::View(view.with("EyeControls3D", &eye).with("LineGrid3D", &LineGrid3D::new().with_visible(false)))
}
