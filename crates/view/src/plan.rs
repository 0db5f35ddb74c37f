//! What will be plotted: the catalogue, met with what was recorded.
use crate::catalogue::{BOUND, Curve, PLOTS, Page, Plot};
use crate::options::ViewOptions;
use crate::run::{Run, range};
use crate::scale::Scale;
use crate::style::{self, Rgb};
use rerun::{EntityPath, EntityPathPart};

/// A limit is drawn as a line when it is at most this many times the largest value: beyond, it would flatten the curves,
/// and the title names it instead.
const IN_SIGHT: f64 = 3.0;

/// A plot with the curves that it can have.
#[derive(Debug)]
pub(crate) struct PlannedPlot<'a> {
    /// Title with the unit, and limits that are out of sight.
    pub(crate) title: String,
    /// Where it stands.
    pub(crate) page: Page,
    /// SI unit of all its curves.
    unit: &'a str,
    /// Unit in which they are shown.
    pub(crate) scale: Scale,
    /// Curves and limit lines.
    pub(crate) series: Vec<Series<'a>>,
    /// Whether the curves end in the upper half, where the legend would cover them.
    pub(crate) ends_high: bool,
    /// First and last instant that it shows (s), when it does not share the time axis of the others.
    pub(crate) own_time: Option<(f64, f64)>,
}

/// One line in a plot.
#[derive(Debug)]
pub(crate) struct Series<'a> {
    /// Its entity.
    pub(crate) path: EntityPath,
    /// Name in the legend.
    pub(crate) name: String,
    /// Colour.
    pub(crate) colour: Rgb,
    /// Width (points).
    pub(crate) width: f32,
    /// Whether the plot shows it; otherwise it is logged for the user to add.
    pub(crate) shown: bool,
    /// Whether it bounds the others.
    bounds: bool,
    /// Its values (SI).
    pub(crate) values: Values<'a>,
}

/// Values of a line, in SI.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Values<'a> {
    /// A channel from the instant `first` on.
    Channel {
        /// Run that recorded it.
        run: Run<'a>,
        /// All its values.
        values: &'a [f64],
        /// First instant that is shown.
        first: usize,
    },
    /// A constant.
    Level {
        /// Value.
        value: f64,
        /// From when to when (s).
        span: (f64, f64),
    },
}

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

fn plan<'a>(plot: &Plot, runs: &[Run<'a>], options: &ViewOptions) -> Option<PlannedPlot<'a>> {
    // In a comparison, all runs show the same curve: the first one that one of them has.
    let recorded = |curve: &&Curve| runs.iter().any(|run| run.first_of(curve.channels).is_some());
    let lead = plot.curves.iter().find(recorded)?;
    let mut planned = PlannedPlot::new(plot.page);
    for curve in plot.curves {
        for (index, run) in runs.iter().enumerate() {
            let Some(channel) = run.first_of(curve.channels) else { continue };
            let leads = std::ptr::eq(curve, lead);
            let name = match run.label {
                None => curve.name.to_owned(),
                Some(label) if leads => label.to_owned(),
                Some(label) => format!("{label} {}", curve.name),
            };
            planned.unit = &channel.spec.unit;
            planned.series.push(Series {
                path: run.path(&[plot.path, curve.name]),
                name,
                colour: run.label.map_or(curve.colour, |_| style::of_run(index)),
                width: if run.label.is_some() { 2.0 } else { curve.width },
                shown: leads || run.label.is_none(),
                bounds: curve.name == BOUND,
                values: Values::Channel { run: *run, values: &channel.values, first: 0 },
            });
        }
    }
    let ours = |channel: &str| plot.curves.iter().any(|curve| curve.channels.contains(&channel));
    let limits = options.limits.iter().filter(|(channel, _)| ours(channel));
    let limit = limits.map(|(_, limit)| *limit).reduce(f64::min);
    let span = (0.0, runs.iter().map(Run::end).fold(0.0, f64::max));
    planned.finish(plot.title, plot.path, limit.map(|limit| ("limit", limit)), span);
    Some(planned)
}

/// The error of the load (or of the motor, when it is all there is) after the last profile.
fn residual<'a>(runs: &[Run<'a>], options: &ViewOptions) -> Option<PlannedPlot<'a>> {
    let mut planned = PlannedPlot::new(Page::Errors);
    let (mut start, mut end) = (f64::INFINITY, 0.0_f64);
    for (index, run) in runs.iter().enumerate() {
        let Some(from) = run.residual_start(options.residual_from) else { continue };
        let sides = [("load", style::LOAD, "following_error.load"), ("motor", style::MOTOR, "following_error.motor")];
        let errors = sides.map(|(side, colour, name)| run.first_of(&[name]).map(|channel| (side, colour, channel)));
        let Some((side, colour, channel)) = errors.into_iter().flatten().next() else { continue };
        let first = run.recording.index_at(from);
        if first + 1 >= channel.values.len() {
            continue;
        }
        (start, end) = (start.min(from), end.max(run.end()));
        planned.unit = &channel.spec.unit;
        planned.series.push(Series {
            path: run.path(&["residual_vibration", side]),
            name: run.label.unwrap_or(side).to_owned(),
            colour: run.label.map_or(colour, |_| style::of_run(index)),
            width: 2.0,
            shown: true,
            bounds: false,
            values: Values::Channel { run: *run, values: &channel.values, first },
        });
    }
    if planned.series.is_empty() {
        return None;
    }
    let window = options.window.map(|window| ("window", window));
    let moved = runs.iter().any(|run| !run.recording.moves.is_empty());
    let title = if moved { "Residual vibration after the last move" } else { "Residual vibration" };
    planned.finish(title, "residual_vibration", window, (start, end));
    planned.own_time = Some((start, end));
    Some(planned)
}

impl Series<'_> {
    /// Last value (SI).
    fn last(&self) -> Option<f64> {
        match self.values {
            Values::Channel { values, .. } => values.last().copied(),
            Values::Level { value, .. } => Some(value),
        }
    }

    /// Smallest and largest value that it shows (SI).
    fn range(&self) -> Option<(f64, f64)> {
        match self.values {
            Values::Channel { values, first, .. } => range(&values[first..]),
            Values::Level { value, .. } => Some((value, value)),
        }
    }
}

impl PlannedPlot<'_> {
    fn new(page: Page) -> Self {
        let scale = Scale::for_peak("", 0.0);
        Self { title: String::new(), page, unit: "", scale, series: Vec::new(), ends_high: false, own_time: None }
    }

    /// Chooses the unit, now that all curves are known; titles the plot; adds the lines of `bound`, a word and a value.
    fn finish(&mut self, title: &str, path: &str, bound: Option<(&str, f64)>, span: (f64, f64)) {
        let (bounds, curves): (Vec<_>, Vec<_>) = self.series.iter().partition(|series| series.bounds);
        let ranges = curves.iter().filter_map(|series| series.range());
        let (low, high) = ranges.fold((0.0_f64, 0.0_f64), |(low, high), (l, h)| (low.min(l), high.max(h)));
        self.ends_high = curves.iter().filter_map(|series| series.last()).any(|last| last > f64::midpoint(low, high));
        let peak = high.max(-low);
        self.scale = Scale::for_peak(self.unit, peak);
        self.title = self.scale.title(title);
        let recorded = bounds.iter().filter_map(|series| series.range()).map(|(low, _)| low).reduce(f64::min);
        if let Some(nearest) = recorded.filter(|nearest| *nearest > IN_SIGHT * peak) {
            self.title = format!("{}, {BOUND} {}", self.title, self.scale.show(nearest));
            self.series.iter_mut().filter(|series| series.bounds).for_each(|series| series.shown = false);
        }
        let Some((word, value)) = bound.filter(|(_, value)| value.is_finite() && *value > 0.0) else { return };
        let signs = if low < 0.0 { "±" } else { "" };
        let name = format!("{word} {signs}{}", self.scale.show(value));
        if value > IN_SIGHT * peak {
            self.title = format!("{}, {name}", self.title);
            return;
        }
        let lines = [("upper", value), ("lower", -value)];
        for (part, value) in lines.into_iter().take(if low < 0.0 { 2 } else { 1 }) {
            self.series.push(Series {
                path: EntityPath::new([word, path, part].map(EntityPathPart::new).to_vec()),
                name: name.clone(),
                colour: style::LIMIT,
                width: 1.0,
                shown: true,
                bounds: true,
                values: Values::Level { value, span },
            });
        }
    }
}
