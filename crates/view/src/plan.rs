//! Plots to be drawn: those of the catalogue for which channels were recorded.
use crate::catalogue::{BOUND, Headline, PLOTS, Page, Plot};
use crate::planned::{ALLOWED, Bound, Frame, PlannedPlot, Sides};
use crate::residual;
use crate::run::{Run, range};
use crate::series::{Role, Series, Values};
use crate::style::{self, Rgb};
use crate::unlisted::{self, Unlisted};
use servobench_metrics::Name;
use servobench_signals::Signal;
use servobench_view_request::ViewOptions;
use std::borrow::Cow;

/// All plots that have at least one curve, in the order of the catalogue; the residual vibration after the errors, and at
/// the end the channels that the catalogue does not name.
pub(crate) fn plots<'a>(runs: &[Run<'a>], options: &ViewOptions) -> Vec<PlannedPlot<'a>> {
    let mut planned = Vec::new();
    let mut others = Unlisted::of(runs);
    for plot in PLOTS {
        let unit = unit_of(plot, runs);
        let (own, rest) = others.into_iter().partition(|one| one.group == plot.path && unit == Some(one.unit));
        others = rest;
        planned.extend(plan(plot, &own, runs, options));
        if plot.path == "following_error" {
            planned.extend(residual::plan(runs, options));
        }
    }
    while let Some(first) = others.first().copied() {
        let is_of_group = |one: &Unlisted<'_>| one.group == first.group && one.unit == first.unit;
        let (group, rest) = others.into_iter().partition(is_of_group);
        others = rest;
        planned.extend(plan_others(&group, runs));
    }
    planned
}

/// The first derivative of the position (0: velocity) that may be missing although the axis moves: a bus need not carry the acceleration,
/// and the order of a move need not limit the higher derivatives.
const ACCELERATION: usize = 1;

/// Width of a single curve (points).
const ALONE: f32 = 2.0;

/// A curve to be plotted.
struct Wanted<'c> {
    channels: &'c [&'c str],
    name: Cow<'c, str>,
    colour: Rgb,
    width: f32,
}

/// Unit of the channels of `plot`; `None` where none was recorded.
fn unit_of<'a>(plot: &Plot, runs: &[Run<'a>]) -> Option<&'a str> {
    let mut recorded = plot.curves.iter().flat_map(|curve| runs.iter().map(|run| run.first_of(curve.channels)));
    recorded.find_map(|channel| Some(channel?.spec.unit.as_str()))
}

fn plan<'a>(plot: &Plot, others: &[Unlisted<'a>], runs: &[Run<'a>], options: &ViewOptions) -> Option<PlannedPlot<'a>> {
    let unit = unit_of(plot, runs)?;
    let own: Vec<[&str; 1]> = others.iter().map(|other| [other.channel]).collect();
    let wanted: Vec<Wanted<'_>> = plot
        .curves
        .iter()
        .map(|one| Wanted { channels: one.channels, name: one.name.into(), colour: one.colour, width: one.width })
        .chain(wanted(others, &own, plot.curves.len()))
        .collect();
    let (lead, mut series) = series(plot.path, &wanted, runs);
    if plot.needs_a_value && series.iter().all(|one| one.range().is_none_or(|(low, high)| low == 0.0 && high == 0.0)) {
        return None;
    }
    let mut remarks = Vec::new();
    if let Some(derivative) = plot.derivative.filter(|derivative| *derivative >= ACCELERATION) {
        series.retain(|one| {
            let Values::Channel { run, values, .. } = one.values else { return true };
            let (is_curve, what) = match content(&run, values, derivative) {
                Content::Curve => return true,
                Content::CurveAndImpulses => (true, "and impulses"),
                // They would be drawn as a line at zero.
                Content::Impulses => (false, "impulses"),
                Content::Nothing => (false, "none"),
            };
            remarks.extend(match run.label {
                Some(label) => Some(format!("{what} ({label})")),
                None => is_curve.then(|| what.to_owned()),
            });
            is_curve
        });
    }
    if !series.iter().any(|one| one.shown && one.range().is_some()) {
        return None;
    }
    // A curve is thin where it lies on others.
    let mut shown = series.iter_mut().filter(|one| one.shown);
    if let (Some(only), None) = (shown.next(), shown.next()) {
        only.width = ALONE;
    }
    let limits = options.limits.iter().filter(|(channel, _)| shows(plot, channel)).map(|(_, limit)| *limit);
    let limit = limits.chain(plot.derivative.and_then(|derivative| planned_limit(runs, derivative))).reduce(f64::min);
    let title = if unit == "N" { plot.linear_title.unwrap_or(plot.title) } else { plot.title };
    let frame = Frame {
        title,
        lead: (wanted.len() > 1 && !title.to_lowercase().contains(lead)).then_some(lead),
        path: plot.path,
        page: plot.page,
        unit,
        amplitude: plot.amplitude,
        headline: plot.headline,
        includes: plot.includes,
        held: plot.held,
        bounds: limit.map(Bound::limit).into_iter().chain(allowed(plot, &series, options)).collect(),
        marks: Vec::new(),
        remarks,
    };
    Some(PlannedPlot::new(&frame, series))
}

/// The plot of channels of one group that the catalogue does not name.
fn plan_others<'a>(group: &[Unlisted<'a>], runs: &[Run<'a>]) -> Option<PlannedPlot<'a>> {
    let first = group.first()?;
    let own: Vec<[&str; 1]> = group.iter().map(|other| [other.channel]).collect();
    let wanted: Vec<Wanted<'_>> = wanted(group, &own, 0).collect();
    // One name for all runs and plots: any channel name is accepted here.
    let (lead, series) = series(OTHERS, &wanted, runs);
    series.iter().find(|one| one.range().is_some())?;
    let name = first.group.replace('_', " ");
    let capital: String = name.chars().take(1).flat_map(char::to_uppercase).chain(name.chars().skip(1)).collect();
    let title = if group.len() == 1 && first.name() != name { format!("{capital}: {}", first.name()) } else { capital };
    let frame = Frame {
        title: &title,
        lead: (group.len() > 1).then_some(lead),
        path: OTHERS,
        page: Page::Other,
        unit: first.unit,
        amplitude: false,
        headline: Headline::Peak,
        includes: &[],
        held: false,
        bounds: Vec::new(),
        marks: Vec::new(),
        remarks: Vec::new(),
    };
    Some(PlannedPlot::new(&frame, series))
}

/// First part of the entity paths of channels that the catalogue does not name.
const OTHERS: &str = "other";

/// The curves of channels that the catalogue does not name, after `count` others.
fn wanted<'c>(
    others: &'c [Unlisted<'c>],
    channels: &'c [[&'c str; 1]],
    count: usize,
) -> impl Iterator<Item = Wanted<'c>> {
    others.iter().zip(channels).enumerate().map(move |(index, (other, channels))| Wanted {
        channels,
        name: other.name().into(),
        colour: unlisted::colour(count + index),
        width: 2.0,
    })
}

/// The series of `wanted` of all `runs`, and the name of the curve that the title describes: the first that one of them has. In a
/// comparison, all runs show that one.
fn series<'a, 'c>(path: &str, wanted: &'c [Wanted<'_>], runs: &[Run<'a>]) -> (&'c str, Vec<Series<'a>>) {
    let recorded = |curve: &&Wanted<'_>| runs.iter().any(|run| run.first_of(curve.channels).is_some());
    let Some(lead) = wanted.iter().find(recorded) else { return ("", Vec::new()) };
    let mut series = Vec::new();
    for curve in wanted {
        for (index, run) in runs.iter().enumerate() {
            let Some(channel) = run.first_of(curve.channels) else { continue };
            let leads = std::ptr::eq(curve, lead);
            // A motor rigid with its load would only draw the same curve twice.
            let twin = run.is_rigid() && lead.name == "load" && curve.name == "motor";
            let part = if path == OTHERS { channel.spec.name.clone() } else { curve.name.replace(' ', "_") };
            series.push(Series {
                path: run.path(&[path, &part]),
                name: if leads { run.label.unwrap_or(&curve.name).to_owned() } else { run.labelled(&curve.name) },
                colour: run.label.map_or(curve.colour, |_| style::of_run(index)),
                width: if run.label.is_some() { 2.0 } else { curve.width },
                shown: (leads || run.label.is_none()) && !twin,
                role: if leads {
                    Role::Lead
                } else if curve.name == BOUND {
                    Role::Bound
                } else {
                    Role::Companion
                },
                values: Values::Channel { run: *run, values: &channel.values, first: 0, origin: 0.0 },
            });
        }
    }
    (&lead.name, series)
}

/// True if `channel` is one of those of `plot`.
fn shows(plot: &Plot, channel: &str) -> bool {
    plot.curves.iter().any(|curve| curve.channels.contains(&channel))
}

/// Allowed values of the curves of `plot` that are shown.
fn allowed(plot: &Plot, series: &[Series<'_>], options: &ViewOptions) -> Vec<Bound> {
    let bound = |(metric, most): &(Name, f64)| {
        let signal = bounded_signal(*metric)?;
        let curve = plot.curves.iter().find(|curve| curve.channels.contains(&signal.name()))?;
        let part = curve.name.replace(' ', "_");
        let of_it = |one: &&Series<'_>| one.path.last().is_some_and(|last| last.unescaped_str() == part);
        series.iter().filter(of_it).find(|one| one.shown)?;
        // Motor and load can both have a limit; all others are alone in their plot.
        let is_one_of_two = matches!(signal, Signal::FollowingErrorMotor | Signal::FollowingErrorLoad);
        let name = if is_one_of_two { format!("{ALLOWED} {}", curve.name) } else { ALLOWED.to_owned() };
        Some(Bound::allowed(name, *most, Sides::Curves))
    };
    options.allowed.iter().filter_map(bound).collect()
}

/// The signal whose magnitude `metric` limits.
const fn bounded_signal(metric: Name) -> Option<Signal> {
    match metric {
        Name::FollowingErrorPeakLoad => Some(Signal::FollowingErrorLoad),
        Name::FollowingErrorPeakMotor => Some(Signal::FollowingErrorMotor),
        Name::TorquePeak => Some(Signal::EffortMotor),
        Name::CurrentPeak => Some(Signal::CurrentQ),
        Name::VoltagePeak => Some(Signal::VoltageMagnitude),
        _ => None,
    }
}

/// The limit of a derivative of the position (0: velocity) that all moves of all runs were planned with.
fn planned_limit(runs: &[Run<'_>], derivative: usize) -> Option<f64> {
    let mut limits = runs.iter().flat_map(|run| &run.recording.moves).map(|made| made.limits[derivative]);
    let first = limits.next()??;
    limits.all(|limit| limit.is_some_and(|limit| limit.to_bits() == first.to_bits())).then_some(first)
}

/// Content of a channel of a derivative of the position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Content {
    /// The derivative.
    Curve,
    /// The derivative in some moves; others do not bound it.
    CurveAndImpulses,
    /// Unbounded in every move: a row of impulses, which no channel shows.
    Impulses,
    /// Zeros only.
    Nothing,
}

/// Content of `values`, a derivative of the position of `run`.
fn content(run: &Run<'_>, values: &[f64], derivative: usize) -> Content {
    let moves = &run.recording.moves;
    let unbounded = moves.iter().filter(|made| !made.peaks[derivative].is_finite()).count();
    if unbounded > 0 && unbounded == moves.len() {
        Content::Impulses
    } else if range(values).is_none_or(|(low, high)| low == 0.0 && high == 0.0) {
        Content::Nothing
    } else if unbounded > 0 {
        Content::CurveAndImpulses
    } else {
        Content::Curve
    }
}
