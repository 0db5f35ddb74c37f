//! A plot that has its curves: its unit, its title, the range of its axis.
use crate::catalogue::{BOUND, Headline, Page};
use crate::rerun::{EntityPath, EntityPathPart};
use crate::scale::{Scale, shown_unit};
use crate::series::{Role, Series, Values};
use crate::style::{self, Rgb};
use crate::ticks::range_with_labels;

/// A limit is drawn as a line when it is at most this many times the largest value: a larger one would flatten the curves, and is named in
/// the title instead.
const IN_SIGHT: f64 = 3.0;
/// Share of the peak below which a negative value is rounding.
const ROUNDING: f64 = 1e-9;
/// Largest number of runs that a title lists one by one.
const LISTED: usize = 3;
/// Height of the lowest plot considered (points).
const LOWEST: f64 = 60.0;

/// A plot with its recorded curves.
#[derive(Debug)]
pub(crate) struct PlannedPlot<'a> {
    /// Its subject, the unit, the peak, and limits that are out of sight.
    pub(crate) title: String,
    /// First part of the entity paths of its curves, the second in a comparison.
    pub(crate) path: String,
    /// Page of the blueprint.
    pub(crate) page: Page,
    /// Unit in which they are shown.
    pub(crate) scale: Scale,
    /// Curves, limit lines and marks.
    pub(crate) series: Vec<Series<'a>>,
    /// True if a value holds until the next one.
    pub(crate) held: bool,
    /// Smallest and largest value that the axis must include (SI).
    pub(crate) reach: (f64, f64),
    /// First and last instant on its time axis (s), when it does not share that of the others.
    pub(crate) own_time: Option<(f64, f64)>,
}

/// Properties of a plot beside its curves.
pub(crate) struct Frame<'t> {
    /// Its subject.
    pub(crate) title: &'t str,
    /// Name of the curve that the title describes, where there are several.
    pub(crate) lead: Option<&'t str>,
    /// Part of the entity paths.
    pub(crate) path: &'t str,
    /// Page of the blueprint.
    pub(crate) page: Page,
    /// SI unit of all its curves.
    pub(crate) unit: &'t str,
    /// True if its currents and voltages are amplitudes.
    pub(crate) amplitude: bool,
    /// Number of the curves in the title.
    pub(crate) headline: Headline,
    /// Values that the axis always includes (SI).
    pub(crate) includes: &'t [f64],
    /// True if a value holds until the next one.
    pub(crate) held: bool,
    /// Bounds, if any.
    pub(crate) bounds: Vec<Bound>,
    /// Instants that are marked.
    pub(crate) marks: Vec<Mark>,
    /// Texts in the title beside the numbers of the curves.
    pub(crate) remarks: Vec<String>,
}

/// Value that curves should not exceed.
#[derive(Debug, Clone)]
pub(crate) struct Bound {
    /// First part of its entity path: `limit`, `allowed` or `window`.
    pub(crate) root: &'static str,
    /// Its name: the root, possibly with its subject.
    pub(crate) name: String,
    /// Largest magnitude (SI).
    pub(crate) value: f64,
    /// Sides of zero on which it applies.
    pub(crate) sides: Sides,
    /// Colour of its lines.
    pub(crate) colour: Rgb,
}

/// Sides of zero on which a bound applies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sides {
    /// The sides that the curves reach.
    Curves,
    /// Both sides.
    Both,
    /// Above.
    Above,
    /// Below.
    Below,
}

/// An instant that is marked.
#[derive(Debug, Clone)]
pub(crate) struct Mark {
    /// Its entity.
    pub(crate) path: EntityPath,
    /// Its name in the legend.
    pub(crate) name: String,
    /// Time (s).
    pub(crate) time: f64,
    /// Colour of its line.
    pub(crate) colour: Rgb,
}

impl<'a> PlannedPlot<'a> {
    /// The plot of `series`, with the lines of its bounds and marks.
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
        let span = span.unwrap_or_default();
        let (path, page, held) = (frame.path.to_owned(), frame.page, frame.held);
        let mut plot = Self { title, path, page, scale, series, held, reach: range, own_time: None };
        plot.add_headline(frame.headline, frame.lead);
        for remark in &frame.remarks {
            plot.title = format!("{}, {remark}", plot.title);
        }
        plot.place_recorded_bounds(peak, &unit);
        let is_negative = low < -ROUNDING * peak;
        for bound in frame.bounds.iter().filter(|bound| bound.value.is_finite() && bound.value > 0.0) {
            plot.add_bound(bound, &unit, peak, is_negative, span);
        }
        let shown = plot.shown().filter_map(Series::range).chain([plot.reach]);
        plot.reach = shown.reduce(|one, two| (one.0.min(two.0), one.1.max(two.1))).unwrap_or_default();
        // From end to end of the axis, which in a low plot spans more than in a high one.
        let upright = plot.range(LOWEST);
        for Mark { path, name, time, colour } in frame.marks.iter().filter(|mark| mark.time <= span.1) {
            let values = Values::Instant { time: *time, range: upright };
            let (path, name) = (path.clone(), name.clone());
            let mark = Series { path, name, colour: *colour, width: 2.0, shown: true, role: Role::Bound, values };
            plot.series.push(mark);
        }
        plot
    }

    /// Range of the value axis (SI) where the plot is `height` points high.
    pub(crate) fn range(&self, height: f64) -> (f64, f64) {
        let (low, high) = self.reach;
        range_with_labels(low, high, height.max(LOWEST))
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

    /// Appends the numbers of the curves to the title, so that they need not be read off the plot.
    fn add_headline(&mut self, headline: Headline, lead: Option<&str>) {
        let is_comparison = self.series.iter().filter(|series| series.role == Role::Lead).count() > 1;
        let word = match headline {
            Headline::None => {
                // The legend names the runs, but not the curve.
                if let Some(lead) = lead.filter(|_| is_comparison) {
                    self.title = format!("{}, {lead}", self.title);
                }
                return;
            }
            Headline::Peak => "peak",
            Headline::PeakToPeak => "p-p",
        };
        let leads = self.series.iter().filter(|series| series.role == Role::Lead && series.shown);
        let ranges = leads.filter_map(|lead| Some((lead.name.as_str(), lead.range()?)));
        let values: Vec<(&str, f64)> = ranges.map(|(name, range)| (name, headline.of(range))).collect();
        let show = |value: f64| self.scale.show(value, 3);
        // The title has the unit already.
        let number = |value: f64| self.scale.number(value, 3);
        let said = match &values[..] {
            [] => return,
            [(_, value)] => show(*value),
            few if few.len() <= LISTED => {
                few.iter().map(|(run, value)| format!("{} ({run})", number(*value))).collect::<Vec<_>>().join(", ")
            }
            many => format!("up to {}", show(many.iter().map(|(_, value)| *value).fold(0.0, f64::max))),
        };
        let lead = lead.map_or(String::new(), |lead| format!("{lead} "));
        self.title = format!("{}, {lead}{word} {said}", self.title);
    }

    /// Takes recorded bounds out of the plot into the title when they are out of sight.
    fn place_recorded_bounds(&mut self, peak: f64, unit: &str) {
        let bounds = self.series.iter().filter(|series| series.role == Role::Bound);
        let nearest = bounds.filter_map(Series::range).map(|(low, _)| low).reduce(f64::min);
        let Some(nearest) = nearest.filter(|nearest| *nearest > IN_SIGHT * peak) else { return };
        self.title = format!("{}, {BOUND} {}", self.title, Scale::for_peak(unit, nearest).show(nearest, 4));
        self.series.iter_mut().filter(|series| series.role == Role::Bound).for_each(|series| series.shown = false);
    }

    /// Draws `bound`, or names it in the title when it is out of sight.
    fn add_bound(&mut self, bound: &Bound, unit: &str, peak: f64, is_negative: bool, span: (f64, f64)) {
        let (above, below) = match bound.sides {
            Sides::Curves => (true, is_negative),
            Sides::Both => (true, true),
            Sides::Above => (true, false),
            Sides::Below => (false, true),
        };
        let signs = match (above, below) {
            (true, true) => "±",
            (false, true) => "−",
            _ => "",
        };
        let name = format!("{} {signs}{}", bound.name, Scale::for_peak(unit, bound.value).show(bound.value, 4));
        if bound.value > IN_SIGHT * peak {
            self.title = format!("{}, {name}", self.title);
            return;
        }
        let lines = [("upper", bound.value, above), ("lower", -bound.value, below)];
        for (part, value, _) in lines.into_iter().filter(|(.., is_there)| *is_there) {
            // The subjects of two bounds of one kind in a plot distinguish them.
            let about = bound.name.strip_prefix(bound.root).unwrap_or(&bound.name).trim().replace(' ', "_");
            let parts = [bound.root, &self.path, &about, part].into_iter().filter(|part| !part.is_empty());
            let path = EntityPath::new(parts.map(EntityPathPart::new).collect());
            let values = Values::Level { value, span };
            let name = name.clone();
            let (colour, width) = (bound.colour, 1.0);
            self.series.push(Series { path, name, colour, width, shown: true, role: Role::Bound, values });
        }
    }
}

impl Bound {
    /// Bound of a curve by motor, drive or plan.
    pub(crate) fn limit(value: f64) -> Self {
        Self { root: BOUND, name: BOUND.into(), value, sides: Sides::Curves, colour: style::LIMIT }
    }

    /// Bound that judges a run: the `name` begins with `allowed`.
    pub(crate) fn allowed(name: String, value: f64, sides: Sides) -> Self {
        Self { root: ALLOWED, name, value, sides, colour: style::ALLOWED }
    }
}

/// First word of a bound by which a run is judged.
pub(crate) const ALLOWED: &str = "allowed";
/// First word of a settling window.
pub(crate) const WINDOW: &str = "window";
