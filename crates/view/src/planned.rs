//! A plot that has its curves: its unit, its title, the range of its axis.
use crate::catalogue::{BOUND, Headline, Page};
use crate::scale::{Scale, shown_unit};
use crate::series::{Role, Series, Values};
use crate::style;
use crate::ticks::range_with_labels;
use rerun::{EntityPath, EntityPathPart};

/// A limit is drawn as a line when it is at most this many times the largest value: beyond, it would flatten the curves,
/// and the title names it instead.
const IN_SIGHT: f64 = 3.0;
/// Part of the peak below which a negative value is rounding.
const ROUNDING: f64 = 1e-9;
/// More runs than this are not listed one by one in a title.
const LISTED: usize = 3;

/// A plot with the curves that it can have.
#[derive(Debug)]
pub(crate) struct PlannedPlot<'a> {
    /// What it shows, the unit, the peak, and limits that are out of sight.
    pub(crate) title: String,
    /// First part of the entity paths of its curves, the second in a comparison.
    pub(crate) path: &'static str,
    /// Where it stands.
    pub(crate) page: Page,
    /// Unit in which they are shown.
    pub(crate) scale: Scale,
    /// Curves and limit lines.
    pub(crate) series: Vec<Series<'a>>,
    /// Whether a value holds until the next one.
    pub(crate) held: bool,
    /// Range of the value axis (SI).
    pub(crate) range: (f64, f64),
    /// First and last instant that it shows (s), when it does not share the time axis of the others.
    pub(crate) own_time: Option<(f64, f64)>,
}

/// What a plot is told beside its curves.
pub(crate) struct Frame<'t> {
    /// What it shows.
    pub(crate) title: &'t str,
    /// Part of the entity paths.
    pub(crate) path: &'static str,
    /// Where it stands.
    pub(crate) page: Page,
    /// SI unit of all its curves.
    pub(crate) unit: &'t str,
    /// Whether its currents and voltages are amplitudes.
    pub(crate) amplitude: bool,
    /// What the title says of the curves.
    pub(crate) headline: Headline,
    /// Values that are always in sight (SI).
    pub(crate) includes: &'t [f64],
    /// Whether a value holds until the next one.
    pub(crate) held: bool,
    /// A bound, if there is one.
    pub(crate) bound: Option<Bound>,
}

/// What curves should not exceed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bound {
    /// `limit` or `window`.
    pub(crate) word: &'static str,
    /// Largest magnitude (SI).
    pub(crate) value: f64,
    /// Whether it counts below zero where the curves are never negative.
    pub(crate) both_sides: bool,
}

impl<'a> PlannedPlot<'a> {
    /// The plot of `series`, with the lines of its bound.
    pub(crate) fn new(frame: &Frame<'_>, series: Vec<Series<'a>>) -> Self {
        let curves = || series.iter().filter(|series| series.role != Role::Bound);
        let ranges = curves().filter_map(Series::range);
        let (low, high) = ranges.reduce(|one, two| (one.0.min(two.0), one.1.max(two.1))).unwrap_or_default();
        let peak = high.max(-low);
        let unit = shown_unit(frame.unit, frame.amplitude);
        let scale = Scale::for_peak(&unit, peak);
        let is_near_zero = low.max(-high) <= high - low;
        let anchors = frame.includes.iter().chain(is_near_zero.then_some(&0.0));
        let range = anchors.fold((low, high), |(low, high), value| (low.min(*value), high.max(*value)));
        let span = curves().map(Series::time).reduce(|one, two| (one.0.min(two.0), one.1.max(two.1)));
        let title = scale.title(frame.title);
        let Frame { path, page, held, .. } = *frame;
        let span = span.unwrap_or_default();
        let mut plot = Self { title, path, page, scale, series, held, range, own_time: None };
        plot.add_headline(frame.headline);
        plot.place_recorded_bounds(peak, &unit);
        if let Some(bound) = frame.bound.filter(|bound| bound.value.is_finite() && bound.value > 0.0) {
            let signs = if bound.both_sides || low < -ROUNDING * peak { "±" } else { "" };
            let name = format!("{} {signs}{}", bound.word, Scale::for_peak(&unit, bound.value).show(bound.value, 4));
            if bound.value > IN_SIGHT * peak {
                plot.title = format!("{}, {name}", plot.title);
            } else {
                let lines = [("upper", bound.value), ("lower", -bound.value)];
                for (part, value) in lines.into_iter().take(if signs.is_empty() { 1 } else { 2 }) {
                    let entity = EntityPath::new([bound.word, path, part].map(EntityPathPart::new).to_vec());
                    plot.series.push(bound_line(entity, name.clone(), value, span));
                }
            }
        }
        let shown = plot.shown().filter_map(Series::range).chain([plot.range]);
        let (low, high) = shown.reduce(|one, two| (one.0.min(two.0), one.1.max(two.1))).unwrap_or_default();
        plot.range = range_with_labels(low, high, page.plot_height());
        plot
    }

    /// The lines that the plot shows.
    pub(crate) fn shown(&self) -> impl Iterator<Item = &Series<'a>> {
        self.series.iter().filter(|series| series.shown)
    }

    /// First and last instant that it shows (s).
    pub(crate) fn time(&self) -> (f64, f64) {
        let all = self.shown().map(Series::time).reduce(|one, two| (one.0.min(two.0), one.1.max(two.1)));
        self.own_time.or(all).unwrap_or_default()
    }

    /// Appends to the title what a reader would otherwise have to read off.
    fn add_headline(&mut self, headline: Headline) {
        let word = match headline {
            Headline::None => return,
            Headline::Peak => "peak",
            Headline::PeakToPeak => "p-p",
        };
        let leads = self.series.iter().filter(|series| series.role == Role::Lead);
        let ranges = leads.filter_map(|lead| Some((lead.name.as_str(), lead.range()?)));
        let values: Vec<(&str, f64)> = ranges.map(|(name, range)| (name, headline.of(range))).collect();
        let show = |value: f64| self.scale.show(value, 3);
        let said = match &values[..] {
            [] => return,
            [(_, value)] => show(*value),
            few if few.len() <= LISTED => {
                few.iter().map(|(run, value)| format!("{} ({run})", show(*value))).collect::<Vec<_>>().join(", ")
            }
            many => format!("up to {}", show(many.iter().map(|(_, value)| *value).fold(0.0, f64::max))),
        };
        self.title = format!("{}, {word} {said}", self.title);
    }

    /// Takes recorded bounds out of the plot into the title when they are out of sight.
    fn place_recorded_bounds(&mut self, peak: f64, unit: &str) {
        let bounds = self.series.iter().filter(|series| series.role == Role::Bound);
        let nearest = bounds.filter_map(Series::range).map(|(low, _)| low).reduce(f64::min);
        let Some(nearest) = nearest.filter(|nearest| *nearest > IN_SIGHT * peak) else { return };
        self.title = format!("{}, {BOUND} {}", self.title, Scale::for_peak(unit, nearest).show(nearest, 4));
        self.series.iter_mut().filter(|series| series.role == Role::Bound).for_each(|series| series.shown = false);
    }
}

fn bound_line<'a>(path: EntityPath, name: String, value: f64, span: (f64, f64)) -> Series<'a> {
    let values = Values::Level { value, span };
    Series { path, name, colour: style::LIMIT, width: 1.0, shown: true, role: Role::Bound, values }
}
