//! Which view stands where.
use crate::catalogue::Page;
use crate::happenings::Happenings;
use crate::layout::{Layout, Node, View};
use crate::legend;
use crate::planned::PlannedPlot;
use crate::reached::Reached;
use crate::scene::Scene;
use crate::signals::Lanes;
use crate::verdict::Head;
use rerun::blueprint::components::{ContainerKind, LinkAxis};
use rerun::datatypes::{TimeInt, TimeRange, TimeRangeBoundary};
use rerun::external::re_sdk_types::blueprint::archetypes::{
    EyeControls3D, LineGrid3D, PlotLegend, ScalarAxis, TextLogColumns, TimeAxis,
};
use rerun::external::re_sdk_types::blueprint::datatypes::{TextLogColumn, TextLogColumnKind};
use servobench_metrics::round_below;

/// Height of what stands below the tabs in a window of 1400 × 900 points.
const PAGE: f32 = 790.0;
/// Height of the title and the frame of a text, and of a line of it (points).
const FRAME: f32 = 38.0;
const LINE: f32 = 22.0;
/// Most lines of the head on the first page, and on the others; more can be scrolled to.
const LINES: (usize, usize) = (8, 1);
/// More plots than this on a page stand in two columns.
const COLUMN: usize = 3;

/// What is to be arranged.
pub(crate) struct Parts<'p, 'a> {
    /// The plots.
    pub(crate) plots: &'p [PlannedPlot<'a>],
    /// The 3D view.
    pub(crate) scene: Option<&'p Scene>,
    /// Moves, events and log.
    pub(crate) happenings: Happenings,
    /// Lanes of signals.
    pub(crate) signals: Lanes,
    /// Lanes of limits.
    pub(crate) reached: Option<Reached>,
    /// What came of it.
    pub(crate) head: &'p Head,
    /// Length of the longest run (s).
    pub(crate) duration: f64,
}

/// The layout of `parts`.
pub(crate) fn layout(parts: Parts<'_, '_>) -> Layout {
    let Parts { plots, scene, happenings, signals, reached, head, duration } = parts;
    let on = |page: Page| plots.iter().filter(move |plot| plot.page == page).map(|plot| (share(plot), plot_view(plot)));
    let mut left: Vec<(f32, Node)> = Vec::new();
    left.extend(scene.map(|scene| (if scene.roots.len() > 1 { 2.0 } else { 1.5 }, scene_view(scene))));
    left.extend(on(Page::Motion));
    left.extend(lanes_view(&happenings));
    let right = on(Page::Errors).collect();
    let columns = [(0.45, left), (0.55, right)]
        .into_iter()
        .filter_map(|(share, parts)| Some((share, Node::of(ContainerKind::Vertical, None, parts)?)));
    let mut blocks: Vec<(f32, Node)> = Vec::new();
    if !signals.paths.is_empty() || !signals.fates.is_empty() {
        blocks.extend(on(Page::Motion).map(|(_, plot)| (0.85, plot)));
        // A lane takes 40 points, its view the height of title and time axis.
        let height = 0.45 + 0.3 * signals.fates.len().min(5) as f32;
        let fates = (height, "Calls that were never executed, or failed", signals.fates);
        for (height, title, paths) in [fates, (2.0, "Blocks, axis and drive", signals.paths)] {
            blocks.extend((!paths.is_empty()).then(|| (height, Node::View(View::new("StateTimeline", title, paths)))));
        }
    }
    let mut first = [
        ("Axis", Node::of(ContainerKind::Horizontal, None, columns.collect())),
        ("Program", Node::of(ContainerKind::Vertical, None, blocks)),
    ];
    if signals.has_program {
        first.reverse();
    }
    let [one, two] = first;
    let lanes = reached.as_ref().map_or(0, |reached| reached.paths.len().min(6));
    let height = 0.14 + 0.07 * lanes as f32;
    let drive = [(1.0, in_columns(on(Page::Electrical).collect())), (height, reached.map(reached_view))];
    let drive = drive.into_iter().filter_map(|(share, part)| Some((share, part?))).collect();
    let pages = [
        one,
        two,
        ("Set-point", Node::of(ContainerKind::Grid, None, on(Page::SetPoint).collect())),
        ("Drive", Node::of(ContainerKind::Vertical, None, drive)),
        ("Other", in_columns(on(Page::Other).collect())),
        ("Log", log_view(&happenings)),
    ];
    let pages = pages.into_iter().filter_map(|(name, page)| Some((name, page?)));
    let pages = pages.enumerate().map(|(index, (name, page))| (1.0, with_head(name, page, head, index == 0)));
    let root = Node::of(ContainerKind::Tabs, None, pages.collect());
    let root = root.unwrap_or_else(|| Node::View(View::new("TextLog", "Nothing was recorded", Vec::new())));
    Layout { root, playback_speed: playback_speed(duration) }
}

/// The tab `name`: the head above `page`, whole as far as there is room on the first.
fn with_head(name: &'static str, page: Node, head: &Head, is_first: bool) -> Node {
    let most = if is_first { LINES.0 } else { LINES.1 };
    let height = FRAME + LINE * head.lines().clamp(1, most) as f32;
    let mut parts = vec![(PAGE - height, page)];
    if let Some(path) = head.path() {
        parts.insert(0, (height, Node::View(View::new("TextDocument", head.subject.clone(), vec![path]))));
    }
    Node::tab(name, parts)
}

/// `plots` below each other, or in two columns when there are many.
fn in_columns(plots: Vec<(f32, Node)>) -> Option<Node> {
    let kind = if plots.len() > COLUMN { ContainerKind::Grid } else { ContainerKind::Vertical };
    Node::of(kind, None, plots)
}

/// Slow motion in which a run of `duration` (s) lasts six to fifteen seconds, so that the eye can follow a vibration;
/// longer runs play in real time.
fn playback_speed(duration: f64) -> f64 {
    if duration > 0.0 { round_below(duration / 6.0).min(1.0) } else { 1.0 }
}

/// Share of a column that a plot takes: a disturbance has little to show.
fn share(plot: &PlannedPlot<'_>) -> f32 {
    if plot.path.ends_with("_disturbance") { 0.6 } else { 1.0 }
}

/// Moves and events, as high as it has lanes.
fn lanes_view(happenings: &Happenings) -> Option<(f32, Node)> {
    let lanes = happenings.lanes.clone();
    let height = 0.4 + 0.25 * lanes.len().min(4) as f32;
    (!lanes.is_empty()).then(|| (height, Node::View(View::new("StateTimeline", "Moves and events", lanes))))
}

fn reached_view(reached: Reached) -> Node {
    Node::View(View::new("StateTimeline", reached.title, reached.paths))
}

fn log_view(happenings: &Happenings) -> Option<Node> {
    let columns = [TextLogColumnKind::LogLevel, TextLogColumnKind::Body];
    let columns = columns.map(|kind| TextLogColumn { kind, visible: true.into() });
    let columns = TextLogColumns::new().with_text_log_columns(columns);
    let logs = happenings.logs.clone();
    (!logs.is_empty()).then(|| Node::View(View::new("TextLog", "Log", logs).with("TextLogColumns", &columns)))
}

fn plot_view(plot: &PlannedPlot<'_>) -> Node {
    let shown = plot.shown().map(|series| series.path.clone());
    let axis = match plot.own_time {
        None => TimeAxis::new().with_link(LinkAxis::LinkToGlobal),
        Some((from, to)) => {
            TimeAxis::new().with_link(LinkAxis::Independent).with_view_range(TimeRange { start: at(from), end: at(to) })
        }
    };
    let (low, high) = plot.range;
    let values = ScalarAxis::new().with_range([low * plot.scale.factor, high * plot.scale.factor]);
    // The title says what a single curve is.
    let legend = PlotLegend::new().with_corner(legend::corner(plot)).with_visible(plot.shown().count() > 1);
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
