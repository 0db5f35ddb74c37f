//! The residual vibration: the load minus its target after the last profile, as the metric defines it, with its window, the instant of
//! settling in it, and the allowed values.
use crate::catalogue::{Headline, Page};
use crate::planned::{ALLOWED, Bound, Frame, Mark, PlannedPlot, Sides, WINDOW};
use crate::run::Run;
use crate::scale::{Scale, shown_unit};
use crate::series::{Role, Series, Values};
use crate::settling::{Settling, settling};
use crate::style;
use servobench_metrics::Name;
use servobench_signals::Signal;
use servobench_view_request::ViewOptions;

/// First part of its entity paths.
pub(crate) const PATH: &str = "residual_vibration";

/// The plot; `None` where nothing was recorded after a profile.
pub(crate) fn plan<'a>(runs: &[Run<'a>], options: &ViewOptions) -> Option<PlannedPlot<'a>> {
    let (mut unit, mut series) = ("", Vec::new());
    let (mut marks, mut remarks) = (Vec::new(), Vec::new());
    for (index, run) in runs.iter().enumerate() {
        let Some(channel) = run.first_of(&[Signal::LoadPosition.name()]) else { continue };
        let Some((from, target)) = run.after_the_last_move().or_else(|| {
            // Without a target, relative to the final position of the load.
            Some((options.residual_from?, *channel.values.last()?))
        }) else {
            continue;
        };
        let first = run.recording.index_at(from);
        if first + 1 >= channel.values.len() {
            continue;
        }
        unit = &channel.spec.unit;
        let colour = run.label.map_or(style::LOAD, |_| style::of_run(index));
        series.push(Series {
            path: run.path(&[PATH, "load"]),
            name: run.label.unwrap_or("load").to_owned(),
            colour,
            width: 2.0,
            shown: true,
            role: Role::Lead,
            values: Values::Channel { run: *run, values: &channel.values, first, origin: target },
        });
        let mark = |part: &str, name: String, after: f64, colour| Mark {
            path: run.path(&[PATH, part]),
            name: run.labelled(&name),
            time: from + after,
            colour,
        };
        match options.window.and_then(|window| settling(run, window)) {
            Some(Settling::After(time)) => {
                let said = format!("settled after {}", shown(time, "s"));
                // Dark for a single run, so that the line is not taken for the curve.
                marks.push(mark("settled", said.clone(), time, run.label.map_or(style::MARK, |_| colour)));
                if run.label.is_none() {
                    remarks.push(said);
                }
            }
            Some(Settling::Never) => remarks.push(run.labelled("not settled")),
            None => {}
        }
        // In a comparison every run ends at another time, and the lines would hide the curves.
        if let Some(most) = allowed(options, Name::SettlingTime).filter(|_| run.label.is_none()) {
            let name = format!("{ALLOWED} settling time {}", shown(most, "s"));
            marks.push(mark("allowed_settling", name, most, style::ALLOWED));
        }
    }
    if series.is_empty() {
        return None;
    }
    let is_alone = runs.iter().all(|run| run.label.is_none());
    let moved = runs.iter().any(|run| !run.recording.moves.is_empty());
    if let Some(most) = allowed(options, Name::ResidualVibrationPp) {
        remarks.push(format!("{ALLOWED} p-p {}", shown(most, unit)));
    }
    let frame = Frame {
        // The title of a comparison has the numbers of all runs.
        title: if moved && is_alone { "Residual vibration after the last move" } else { "Residual vibration" },
        lead: (series.len() == 1).then_some("load"),
        path: PATH,
        page: Page::Errors,
        unit,
        amplitude: false,
        headline: Headline::PeakToPeak,
        includes: &[0.0],
        held: false,
        bounds: bounds(runs, options),
        marks,
        remarks,
    };
    let mut planned = PlannedPlot::new(&frame, series);
    let (start, end) = planned.time();
    planned.own_time = Some((start, end));
    if start > 0.0 {
        // Rerun leaves the seconds out at most ticks of a time axis.
        planned.title = format!("{}, from {}", planned.title, shown(start, "s"));
    }
    Some(planned)
}

/// The window, and the allowed overshoot beyond the target.
fn bounds(runs: &[Run<'_>], options: &ViewOptions) -> Vec<Bound> {
    let window = options.window.map(|value| Bound {
        root: WINDOW,
        name: WINDOW.into(),
        value,
        sides: Sides::Both,
        colour: style::LIMIT,
    });
    let amplitude = allowed(options, Name::ResidualVibrationAmplitude)
        .map(|value| Bound::allowed(format!("{ALLOWED} amplitude"), value, Sides::Both));
    // Beyond the target is above or below it; all runs must agree.
    let last = |run: &Run<'_>| run.recording.moves.iter().max_by(|one, two| one.end.total_cmp(&two.end)).cloned();
    let mut upwards = runs.iter().filter_map(last).map(|made| made.to >= made.from);
    let first = upwards.next();
    let side = first.filter(|first| upwards.all(|next| next == *first));
    let side = side.map(|is_up| if is_up { Sides::Above } else { Sides::Below });
    let overshoot = allowed(options, Name::Overshoot)
        .zip(side)
        .map(|(value, side)| Bound::allowed(format!("{ALLOWED} overshoot"), value, side));
    [window, amplitude, overshoot].into_iter().flatten().collect()
}

/// The largest value of `metric` that passes.
fn allowed(options: &ViewOptions, metric: Name) -> Option<f64> {
    let of_it = options.allowed.iter().filter(|(name, _)| *name == metric).map(|(_, most)| *most);
    of_it.reduce(f64::min)
}

/// A value with its unit, in three digits.
fn shown(value: f64, unit: &str) -> String {
    let unit = shown_unit(unit, false);
    Scale::for_peak(&unit, value).show(value, 3)
}
