//! Which view stands where.
use crate::catalogue::Page;
use crate::happenings::Happenings;
use crate::layout::{Layout, Node, View};
use crate::legend;
use crate::planned::PlannedPlot;
use crate::scene::Scene;
use crate::signals::Lanes;
use rerun::blueprint::components::{BackgroundKind, ContainerKind, LinkAxis};
use rerun::datatypes::{TimeInt, TimeRange, TimeRangeBoundary};
use rerun::external::re_sdk_types::blueprint::archetypes::{
    Background, EyeControls3D, LineGrid3D, PlotLegend, ScalarAxis, TextLogColumns, TimeAxis,
};
use rerun::external::re_sdk_types::blueprint::datatypes::{TextLogColumn, TextLogColumnKind};
use servobench_metrics::round_below;

/// The layout for what was planned.
pub(crate) fn layout(
    plots: &[PlannedPlot<'_>],
    scene: Option<&Scene>,
    happenings: &Happenings,
    signals: Lanes,
    duration: f64,
) -> Layout {
    let on = |page: Page| plots.iter().filter(move |plot| plot.page == page).map(|plot| (share(plot), plot_view(plot)));
    let mut left: Vec<(f32, Node)> = Vec::new();
    left.extend(scene.map(|scene| (1.5, scene_view(scene))));
    left.extend(on(Page::Motion));
    left.extend(lanes_view(happenings));
    let right = on(Page::Errors).collect();
    let columns = [(0.45, left), (0.55, right)]
        .into_iter()
        .filter_map(|(share, parts)| Some((share, Node::of(ContainerKind::Vertical, None, parts)?)));
    let mut blocks: Vec<(f32, Node)> = Vec::new();
    if !signals.paths.is_empty() {
        blocks.extend(on(Page::Motion).map(|(_, plot)| (0.5, plot)));
        blocks.push((2.0, Node::View(View::new("StateTimeline", "Blocks, axis and drive", signals.paths))));
    }
    let mut first = [
        Node::of(ContainerKind::Horizontal, Some("Axis"), columns.collect()),
        Node::of(ContainerKind::Vertical, Some("Program"), blocks),
    ];
    if signals.has_program {
        first.reverse();
    }
    let [one, two] = first;
    let pages = [
        one,
        two,
        Node::of(ContainerKind::Grid, Some("Set-point"), on(Page::SetPoint).collect()),
        Node::of(ContainerKind::Vertical, Some("Drive"), on(Page::Electrical).collect()),
        Node::of(ContainerKind::Vertical, Some("Log"), log_view(happenings).into_iter().collect()),
    ];
    let pages: Vec<_> = pages.into_iter().flatten().map(|page| (1.0, page)).collect();
    let root = Node::of(ContainerKind::Tabs, None, pages);
    let root = root.unwrap_or_else(|| Node::View(View::new("TextLog", "Nothing was recorded", Vec::new())));
    Layout { root, playback_speed: playback_speed(duration) }
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
    let height = 0.35 + 0.2 * lanes.len().min(4) as f32;
    (!lanes.is_empty()).then(|| (height, Node::View(View::new("StateTimeline", "Moves and events", lanes))))
}

fn log_view(happenings: &Happenings) -> Option<(f32, Node)> {
    let columns = [TextLogColumnKind::LogLevel, TextLogColumnKind::Body];
    let columns = columns.map(|kind| TextLogColumn { kind, visible: true.into() });
    let columns = TextLogColumns::new().with_text_log_columns(columns);
    let logs = happenings.logs.clone();
    (!logs.is_empty()).then(|| (1.0, Node::View(View::new("TextLog", "Log", logs).with("TextLogColumns", &columns))))
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
    let background = Background::new(BackgroundKind::SolidColor).with_color([28, 31, 36]);
    let view = view.with("Background", &background);
    Node::View(view.with("EyeControls3D", &eye).with("LineGrid3D", &LineGrid3D::new().with_visible(false)))
}
