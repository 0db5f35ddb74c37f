//! What will be plotted: the catalogue, met with what was recorded.
use crate::catalogue::{BOUND, Curve, Headline, PLOTS, Page, Plot};
use crate::options::ViewOptions;
use crate::planned::{Bound, Frame, PlannedPlot};
use crate::run::Run;
use crate::scale::Scale;
use crate::series::{Role, Series, Values};
use crate::style;

/// All plots that have at least one curve, in the order of the catalogue; the residual vibration after the errors.
pub(crate) fn plots<'a>(runs: &[Run<'a>], options: &ViewOptions) -> Vec<PlannedPlot<'a>> {
    let mut planned = Vec::new();
    for plot in PLOTS {
        planned.extend(plan(plot, runs, options));
        if plot.path == "following_error" {
            planned.extend(residual(runs, options));
        }
    }
    planned
}

/// The first derivative of the position (0: velocity) that moves of some order do not limit.
const JERK: usize = 2;

fn plan<'a>(plot: &Plot, runs: &[Run<'a>], options: &ViewOptions) -> Option<PlannedPlot<'a>> {
    // In a comparison, all runs show the same curve: the first one that one of them has.
    let recorded = |curve: &&Curve| runs.iter().any(|run| run.first_of(curve.channels).is_some());
    let lead = plot.curves.iter().find(recorded)?;
    let (mut unit, mut series) = ("", Vec::new());
    for curve in plot.curves {
        for (index, run) in runs.iter().enumerate() {
            let Some(channel) = run.first_of(curve.channels) else { continue };
            let leads = std::ptr::eq(curve, lead);
            let name = match run.label {
                None => curve.name.to_owned(),
                Some(label) if leads => label.to_owned(),
                Some(label) => format!("{label} {}", curve.name),
            };
            // A motor that is one body with its load would only draw the same curve twice.
            let twin = run.is_rigid() && lead.name == "load" && curve.name == "motor";
            unit = &channel.spec.unit;
            series.push(Series {
                path: run.path(&[plot.path, &curve.name.replace(' ', "_")]),
                name,
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
    if plot.derivative.is_some_and(|derivative| derivative >= JERK)
        && series.iter().all(|one| one.range() == Some((0.0, 0.0)))
    {
        // An impulse wherever it is not: the order of the moves does not limit it.
        return None;
    }
    let ours = |channel: &str| plot.curves.iter().any(|curve| curve.channels.contains(&channel));
    let limits = options.limits.iter().filter(|(channel, _)| ours(channel)).map(|(_, limit)| *limit);
    let limit = limits.chain(plot.derivative.and_then(|derivative| planned_limit(runs, derivative))).reduce(f64::min);
    let frame = Frame {
        title: if unit == "N" { plot.linear_title.unwrap_or(plot.title) } else { plot.title },
        path: plot.path,
        page: plot.page,
        unit,
        amplitude: plot.amplitude,
        headline: plot.headline,
        includes: plot.includes,
        held: plot.held,
        bound: limit.map(|value| Bound { word: BOUND, value, both_sides: false }),
    };
    Some(PlannedPlot::new(&frame, series))
}

/// The limit of a derivative of the position (0: velocity) that all moves of all runs were planned with.
fn planned_limit(runs: &[Run<'_>], derivative: usize) -> Option<f64> {
    let mut limits = runs.iter().flat_map(|run| &run.recording.moves).map(|made| made.limits[derivative]);
    let first = limits.next()??;
    limits.all(|limit| limit.is_some_and(|limit| limit.to_bits() == first.to_bits())).then_some(first)
}

/// The load minus its target after the last profile, as the metric has it.
fn residual<'a>(runs: &[Run<'a>], options: &ViewOptions) -> Option<PlannedPlot<'a>> {
    let (mut unit, mut series) = ("", Vec::new());
    for (index, run) in runs.iter().enumerate() {
        let Some(channel) = run.first_of(&["load.position"]) else { continue };
        let Some((from, target)) = run.after_the_last_move().or_else(|| {
            // Without a target, where the load is in the end.
            Some((options.residual_from?, *channel.values.last()?))
        }) else {
            continue;
        };
        let first = run.recording.index_at(from);
        if first + 1 >= channel.values.len() {
            continue;
        }
        unit = &channel.spec.unit;
        series.push(Series {
            path: run.path(&["residual_vibration", "load"]),
            name: run.label.unwrap_or("load").to_owned(),
            colour: run.label.map_or(style::LOAD, |_| style::of_run(index)),
            width: 2.0,
            shown: true,
            role: Role::Lead,
            values: Values::Channel { run: *run, values: &channel.values, first, origin: target },
        });
    }
    if series.is_empty() {
        return None;
    }
    let moved = runs.iter().any(|run| !run.recording.moves.is_empty());
    let frame = Frame {
        title: if moved { "Residual vibration after the last move" } else { "Residual vibration" },
        path: "residual_vibration",
        page: Page::Errors,
        unit,
        amplitude: false,
        headline: Headline::PeakToPeak,
        includes: &[0.0],
        held: false,
        bound: options.window.map(|value| Bound { word: "window", value, both_sides: true }),
    };
    let mut planned = PlannedPlot::new(&frame, series);
    let (start, end) = planned.time();
    planned.own_time = Some((start, end));
    if start > 0.0 {
        // Rerun leaves the seconds out at most ticks of a time axis.
        planned.title = format!("{}, from {}", planned.title, Scale::for_peak("s", start).show(start, 3));
    }
    Some(planned)
}
