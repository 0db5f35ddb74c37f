//! Panels below each other, with the texts above, below and beside them.
use super::marks::Marks;
use super::panel::{HEIGHT, Panel};
use super::window::Window;
use crate::drawing::{Axis, COLOURS, STYLE as SHARED, escaped, ticks, unit_at};
use servobench_metrics::round_above;
use servobench_planner::Binding;

pub(super) const WIDTH: f64 = 860.0;
pub(super) const LEFT: f64 = 84.0;
pub(super) const RIGHT: f64 = 132.0;
/// Height above the first panel, with one line below the title.
pub(super) const TOP: f64 = 96.0;
/// Height of each further line.
const LINE: f64 = 17.0;
const BOTTOM: f64 = 46.0;
pub(super) const GAP: f64 = 22.0;
const STYLE: &str = ".b{stroke:#aab3c0;stroke-width:1;stroke-dasharray:1.5 3}\
.l{stroke:#c2303a;stroke-width:1.2;stroke-dasharray:6 4}.lt{font-size:11px;fill:#c2303a}.c{fill:none;\
stroke-width:2;stroke-linejoin:round}.f{stroke:none;opacity:.09}.v{stroke-width:1.2;stroke-linejoin:round}\
.m{fill:none;stroke:#c2303a;stroke-width:4}.d{fill:none;stroke:#c2303a;stroke-width:7;stroke-linecap:round}.p{fill:#fff;stroke-width:1.4}";
/// Smallest distance of labels of the time axis from that of the end.
const LABEL: f64 = 34.0;
/// Marks closer than this are one.
const APART: f64 = 1.5;
/// More segment ends than this would hide the curves.
const MOST_BOUNDARIES: usize = 80;
/// Most points that can be distinguished: they are 6 pixels from each other on average.
const MOST_POINTS: usize = 107;
/// Radius of a point.
const POINT: f64 = 2.4;

/// Panels below each other.
pub(super) struct Sheet<'a> {
    /// Headline: `1 m in 1.35 s, order 4`.
    pub(super) title: &'a str,
    /// Further lines for the reader: segment times, notes of the planner.
    pub(super) lines: Vec<String>,
    /// The part of the move that is drawn.
    pub(super) window: Window,
    /// Ends of the segments (s), ascending.
    pub(super) boundaries: Vec<f64>,
    /// Intervals in which quantities are at their limits.
    pub(super) bindings: Vec<Binding>,
    /// Points of the move: time, position, velocity if it is known (SI).
    pub(super) points: Vec<(f64, f64, Option<f64>)>,
    /// Panels from top to bottom, position first.
    pub(super) panels: &'a [Panel<'a>],
}

impl Sheet<'_> {
    pub(super) fn to_svg(&self) -> String {
        let count = self.panels.len() as f64;
        let first = TOP + LINE * (self.lines.len() as f64 - 1.0).max(0.0);
        let height = first + count * HEIGHT + (count - 1.0).max(0.0) * GAP + BOTTOM;
        let title = escaped(self.title);
        let mut svg = vec![
            format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" width=\"{WIDTH}\" \
                 height=\"{height}\" role=\"img\">"
            ),
            format!("<title>{title}</title>\n<style>{SHARED}{STYLE}</style>"),
            format!("<rect width=\"{WIDTH}\" height=\"{height}\" fill=\"#ffffff\"/>"),
            format!("<text class=\"t\" x=\"{LEFT}\" y=\"34\">{title}</text>"),
        ];
        svg.extend(self.lines.iter().enumerate().map(|(i, line)| {
            format!("<text class=\"s\" x=\"{LEFT}\" y=\"{}\">{}</text>", 55.0 + LINE * i as f64, escaped(line))
        }));
        let Window { from: low, to: end, .. } = self.window;
        let has_end = end > low;
        let high = if has_end { end } else { 1.0 };
        let time = Axis { low, high, from: LEFT, to: WIDTH - RIGHT };
        let (unit, scale) = unit_at(time.high, "s", true);
        let ticks = ticks(low / scale, high / scale, round_above((high - low) / scale / 8.0));
        let boundaries = self.seen_boundaries(&time);
        let mut marks_seen = (false, false);
        let points = self.seen_points(&time);
        for (k, panel) in self.panels.iter().enumerate() {
            let top = first + k as f64 * (HEIGHT + GAP);
            let bottom = top + HEIGHT;
            let upright = |class: &str, x: f64| {
                format!("<line class=\"{class}\" x1=\"{x:.2}\" x2=\"{x:.2}\" y1=\"{top}\" y2=\"{bottom}\"/>")
            };
            svg.extend(ticks.iter().map(|(value, _)| upright("g", time.at(value * scale))));
            svg.extend(boundaries.iter().map(|x| upright("b", *x)));
            let (value, colour) = (panel.axis(top), COLOURS[k % COLOURS.len()]);
            panel.draw_scale(&mut svg, &time, &value);
            panel.draw_curve(&mut svg, &time, &value, colour);
            let bindings = self.bindings.iter().filter(|binding| binding.derivative == k);
            let marks = Marks::of(bindings, panel.limit, &time, &value);
            marks.draw(&mut svg);
            let scale = panel.unit.scale();
            svg.extend(points.iter().filter_map(|(x, position, velocity)| {
                let y = value.at([Some(*position), *velocity].get(k).copied().flatten()? / scale);
                Some(format!("<circle class=\"p\" stroke=\"{colour}\" cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{POINT}\"/>"))
            }));
            marks_seen = (marks_seen.0 || !marks.stretches.is_empty(), marks_seen.1 || !marks.dots.is_empty());
            panel.draw_legend(&mut svg, time.to + 12.0, top, colour);
        }
        self.draw_key(&mut svg, first - 16.0, marks_seen, !points.is_empty());
        let base = height - BOTTOM + 18.0;
        let centred = |class: &str, x: f64, y: f64, text: &str| {
            format!("<text class=\"{class}\" x=\"{x:.2}\" y=\"{y:.2}\" text-anchor=\"middle\">{text}</text>")
        };
        let free = ticks.iter().map(|(value, label)| (time.at(value * scale), label));
        let free = free.filter(|(x, _)| !has_end || time.to - x >= LABEL);
        svg.extend(free.map(|(x, label)| centred("k", x, base, label)));
        if has_end {
            svg.push(centred("e", time.to, base, &self.end_label(scale)));
        }
        svg.push(centred("k", f64::midpoint(time.from, time.to), base + 18.0, &format!("time ({unit})")));
        svg.push("</svg>\n".to_owned());
        svg.join("\n")
    }

    /// The number at the end of the time axis: in a window to a thousandth of its length.
    fn end_label(&self, scale: f64) -> String {
        let Window { from, to, is_whole } = self.window;
        if is_whole {
            return four_digits(to / scale);
        }
        let length = (to - from) / scale;
        let exponent: i32 = format!("{length:e}").split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
        let decimals = usize::try_from(2 - exponent).unwrap_or(0);
        format!("{:.decimals$}", to / scale)
    }

    /// Key to the points, the lines of limits and the marks on them, as far as there are some.
    fn draw_key(&self, svg: &mut Vec<String>, y: f64, (has_stretches, has_dots): (bool, bool), has_points: bool) {
        let mut x = LEFT;
        if has_points {
            let symbol = format!("<circle class=\"p\" stroke=\"{}\" cx=\"4\" cy=\"0\" r=\"{POINT}\"/>", COLOURS[0]);
            svg.push(format!(
                "<g transform=\"translate({x:.0},{y:.0})\">{symbol}<text class=\"k\" x=\"12\" y=\"4\">point</text></g>"
            ));
            x += 60.0;
        }
        let mut entry = |symbol: &str, text: &str, width: f64| {
            svg.push(format!(
                "<g transform=\"translate({x:.0},{y:.0})\">{symbol}<text class=\"lt\" x=\"28\" y=\"4\">{text}</text></g>"
            ));
            x += width;
        };
        if self.panels.iter().any(Panel::shows_a_limit) {
            entry("<line class=\"l\" x1=\"0\" x2=\"22\" y1=\"0\" y2=\"0\"/>", "limit", 72.0);
        }
        if has_stretches {
            entry("<path class=\"m\" d=\"M0,0H22\"/>", "at its limit", 112.0);
        }
        if has_dots {
            entry("<path class=\"d\" d=\"M11,0h0\"/>", "at its limit for an instant", 0.0);
        }
    }

    /// Ends of the segments (pixels); segments too short to be seen end where the next one does.
    fn seen_boundaries(&self, time: &Axis) -> Vec<f64> {
        let mut boundaries: Vec<f64> = Vec::new();
        for x in self.boundaries.iter().map(|t| time.at(*t)) {
            if boundaries.last().is_none_or(|before| x - before >= APART) {
                boundaries.push(x);
            }
        }
        if boundaries.len() > MOST_BOUNDARIES { Vec::new() } else { boundaries }
    }
}

impl Sheet<'_> {
    /// The visible points by their place (pixels); none if there are too many.
    fn seen_points(&self, time: &Axis) -> Vec<(f64, f64, Option<f64>)> {
        let all = self.points.iter().map(|(t, position, velocity)| (time.at(*t), *position, *velocity));
        let seen: Vec<_> =
            all.filter(|(x, ..)| (time.from - 1.0..=time.to + 1.0).contains(x)).take(MOST_POINTS + 1).collect();
        if seen.len() > MOST_POINTS { Vec::new() } else { seen }
    }
}

/// A positive number with at most four significant digits.
pub(super) fn four_digits(value: f64) -> String {
    let rounded = format!("{value:.3e}").parse().unwrap_or(value);
    format!("{rounded}")
}
