//! A planned move as a drawing: position and its derivatives over time, one panel each, with their limits.
use crate::ticks::{step, ticks};
use servobench_metrics::Quantity;

/// One quantity over time.
#[derive(Debug, Clone, Copy)]
pub struct Panel<'a> {
    /// `velocity`.
    pub name: &'a str,
    /// Unit of the values: `m/s`.
    pub unit: &'a str,
    /// One value for each time (SI).
    pub values: &'a [f64],
    /// Largest magnitude allowed (SI); drawn dashed.
    pub limit: Option<f64>,
    /// Whether a value holds until the next time: a staircase rather than a polygon.
    pub held: bool,
}

/// A planned move. The values are samples; nothing is known here of how they were planned.
#[derive(Debug, Clone)]
pub struct PlanDrawing<'a> {
    /// Headline: `1 m in 1.35 s, order 4`.
    pub title: &'a str,
    /// What a reader wants to know besides: segment times, sample time.
    pub subtitle: &'a str,
    /// Times of the values (s), ascending.
    pub times: &'a [f64],
    /// Panels from top to bottom.
    pub panels: &'a [Panel<'a>],
}

const WIDTH: f64 = 860.0;
const LEFT: f64 = 84.0;
const RIGHT: f64 = 132.0;
const TOP: f64 = 78.0;
const BOTTOM: f64 = 46.0;
const PANEL: f64 = 118.0;
const GAP: f64 = 22.0;
/// One colour for each panel, distinguishable without colour vision by position anyway.
const COLOURS: [&str; 5] = ["#1f5fa8", "#0f7f72", "#9a5b00", "#8a2f78", "#4a4fb0"];
const STYLE: &str = "text{font-family:'DejaVu Sans','Segoe UI',Helvetica,Arial,sans-serif;fill:#1c2330}\
.t{font-size:17px;font-weight:600}.s{font-size:12.5px;fill:#5b6472}.n{font-size:13px;font-weight:600}\
.k{font-size:11px;fill:#5b6472}.g{stroke:#e4e8ee;stroke-width:1}.z{stroke:#9aa3b0;stroke-width:1}\
.l{stroke:#c2303a;stroke-width:1.2;stroke-dasharray:6 4}.lt{font-size:11px;fill:#c2303a}.c{fill:none;\
stroke-width:2;stroke-linejoin:round}.f{stroke:none;opacity:.09}";

impl PlanDrawing<'_> {
    /// The drawing as SVG, complete in itself.
    #[must_use]
    pub fn to_svg(&self) -> String {
        let count = self.panels.len() as f64;
        let height = TOP + count * PANEL + (count - 1.0).max(0.0) * GAP + BOTTOM;
        let (title, subtitle) = (escaped(self.title), escaped(self.subtitle));
        let mut svg = vec![
            format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" width=\"{WIDTH}\" \
                 height=\"{height}\" role=\"img\">"
            ),
            format!("<title>{title}</title>\n<style>{STYLE}</style>"),
            format!("<rect width=\"{WIDTH}\" height=\"{height}\" fill=\"#ffffff\"/>"),
            format!("<text class=\"t\" x=\"{LEFT}\" y=\"34\">{title}</text>"),
            format!("<text class=\"s\" x=\"{LEFT}\" y=\"55\">{subtitle}</text>"),
        ];
        let (first, last) = (self.times.first().copied().unwrap_or(0.0), self.times.last().copied().unwrap_or(0.0));
        let time =
            Axis { low: first, high: if last > first { last } else { first + 1.0 }, from: LEFT, to: WIDTH - RIGHT };
        let (unit, scale) = Quantity::axis_unit(time.high - time.low, "s");
        let marks = ticks(time.low / scale, time.high / scale, step((time.high - time.low) / scale, 8.0));
        for (k, panel) in self.panels.iter().enumerate() {
            let top = TOP + k as f64 * (PANEL + GAP);
            svg.extend(marks.iter().map(|(value, _)| {
                let (x, bottom) = (time.at(value * scale), top + PANEL);
                format!("<line class=\"g\" x1=\"{x:.2}\" x2=\"{x:.2}\" y1=\"{top}\" y2=\"{bottom}\"/>")
            }));
            let value = panel.axis(top);
            panel.draw_scale(&mut svg, &time, &value);
            panel.draw_curve(&mut svg, self.times, &time, &value, COLOURS[k % COLOURS.len()]);
            panel.draw_legend(&mut svg, time.to + 12.0, top, COLOURS[k % COLOURS.len()]);
        }
        let base = height - BOTTOM + 18.0;
        let centred = |x: f64, y: f64, text: &str| {
            format!("<text class=\"k\" x=\"{x:.2}\" y=\"{y:.2}\" text-anchor=\"middle\">{text}</text>")
        };
        svg.extend(marks.iter().map(|(value, label)| centred(time.at(value * scale), base, label)));
        svg.push(centred(f64::midpoint(time.from, time.to), base + 18.0, &format!("time ({unit})")));
        svg.push("</svg>\n".to_owned());
        svg.join("\n")
    }
}

/// A linear scale from values to pixels.
struct Axis {
    low: f64,
    high: f64,
    /// Pixel of `low`.
    from: f64,
    /// Pixel of `high`.
    to: f64,
}

impl Axis {
    fn at(&self, value: f64) -> f64 {
        self.from + (value - self.low) / (self.high - self.low) * (self.to - self.from)
    }
}

impl Panel<'_> {
    /// Ticks of the values, zero line, limits.
    fn draw_scale(&self, svg: &mut Vec<String>, time: &Axis, value: &Axis) {
        let (_, scale) = self.shown_unit(value);
        let (left, right) = (time.from, time.to);
        for (tick, label) in ticks(value.low / scale, value.high / scale, step((value.high - value.low) / scale, 4.0)) {
            let (y, class) = (value.at(tick * scale), if tick == 0.0 { "z" } else { "g" });
            svg.push(format!(
                "<line class=\"{class}\" x1=\"{left}\" x2=\"{right}\" y1=\"{y:.2}\" y2=\"{y:.2}\"/>\n\
                 <text class=\"k\" x=\"{:.2}\" y=\"{:.2}\" text-anchor=\"end\">{label}</text>",
                left - 8.0,
                y + 4.0
            ));
        }
        for limit in self.limit.iter().flat_map(|limit| [*limit, -*limit]) {
            if (value.low..=value.high).contains(&limit) {
                let y = value.at(limit);
                svg.push(format!("<line class=\"l\" x1=\"{left}\" x2=\"{right}\" y1=\"{y:.2}\" y2=\"{y:.2}\"/>"));
            }
        }
    }

    fn draw_curve(&self, svg: &mut Vec<String>, times: &[f64], time: &Axis, value: &Axis, colour: &str) {
        let points = self.points(times, time, value);
        let (Some(first), Some(last)) = (points.first(), points.last()) else { return };
        let zero = value.at(0.0);
        let path = points.iter().map(|(x, y)| format!("{x:.2},{y:.2}")).collect::<Vec<_>>().join(" ");
        svg.push(format!(
            "<polygon class=\"f\" fill=\"{colour}\" points=\"{:.2},{zero:.2} {path} {:.2},{zero:.2}\"/>\n\
             <polyline class=\"c\" stroke=\"{colour}\" points=\"{path}\"/>",
            first.0, last.0
        ));
    }

    /// Name, unit, peak and limit at the right of the panel.
    fn draw_legend(&self, svg: &mut Vec<String>, x: f64, top: f64, colour: &str) {
        let (unit, _) = self.shown_unit(&self.axis(top));
        let peak = Quantity::new(self.peak(), self.unit);
        let mut line = |class: &str, y: f64, attributes: &str, text: &str| {
            let (y, text) = (top + y, escaped(text));
            svg.push(format!("<text class=\"{class}\" x=\"{x:.2}\" y=\"{y:.2}\"{attributes}>{text}</text>"));
        };
        line("n", 16.0, &format!(" style=\"fill:{colour}\""), self.name);
        line("k", 33.0, "", &unit);
        line("k", 54.0, "", &format!("peak {peak}"));
        if let Some(limit) = self.limit {
            line("lt", 71.0, "", &format!("limit {}", Quantity::new(limit, self.unit)));
        }
    }

    /// Unit of the scale, and how much of the plain unit it is.
    fn shown_unit(&self, value: &Axis) -> (String, f64) {
        // The room around the curve must not decide the prefix.
        let largest = self.limit.unwrap_or(0.0).min(value.high.max(-value.low)).max(self.peak());
        Quantity::axis_unit(largest, self.unit)
    }

    fn peak(&self) -> f64 {
        self.values.iter().fold(0.0, |peak: f64, value| peak.max(value.abs()))
    }

    /// Room for the values, zero, and the limit on each side that the values go to.
    fn axis(&self, top: f64) -> Axis {
        let (mut low, mut high) =
            self.values.iter().fold((0.0, 0.0), |(l, h): (f64, f64), value| (l.min(*value), h.max(*value)));
        if let Some(limit) = self.limit {
            let (below, above) = (low < -1e-9 * limit, high > 1e-9 * limit);
            low = if below { low.min(-limit) } else { low };
            high = if above || !below { high.max(limit) } else { high };
        }
        let span = if high > low { high - low } else { 1.0 };
        let room = |side: f64| if side == 0.0 { 0.02 } else { 0.08 } * span;
        Axis { low: low - room(low), high: high + room(high), from: top + PANEL, to: top }
    }

    /// The curve in pixels. Of many samples in one column of pixels, the extremes and the last are kept.
    fn points(&self, times: &[f64], time: &Axis, value: &Axis) -> Vec<(f64, f64)> {
        let mut points: Vec<(f64, f64)> = Vec::new();
        let mut column: Option<Column> = None;
        let mut before: Option<f64> = None;
        for (t, y) in times.iter().zip(self.values) {
            let (x, y) = (time.at(*t), value.at(*y));
            for (x, y) in [before.filter(|_| self.held).map(|y| (x, y)), Some((x, y))].into_iter().flatten() {
                if !column.as_mut().is_some_and(|column| column.take(x, y)) {
                    points.extend(column.replace(Column::new(x, y)).into_iter().flat_map(Column::points));
                }
            }
            before = Some(y);
        }
        points.extend(column.into_iter().flat_map(Column::points));
        straightened(&points)
    }
}

/// Samples that fall on one column of half a pixel.
#[derive(Clone, Copy)]
struct Column {
    first: (f64, f64),
    low: (f64, f64),
    high: (f64, f64),
    last: (f64, f64),
}

impl Column {
    fn new(x: f64, y: f64) -> Self {
        Self { first: (x, y), low: (x, y), high: (x, y), last: (x, y) }
    }

    /// Takes a sample that belongs to this column; says whether it does.
    fn take(&mut self, x: f64, y: f64) -> bool {
        let belongs = x - self.first.0 < 0.5;
        if belongs {
            self.last = (x, y);
            if y < self.low.1 {
                self.low = (x, y);
            }
            if y > self.high.1 {
                self.high = (x, y);
            }
        }
        belongs
    }

    /// What is drawn of it, in order of time, each point once.
    fn points(self) -> Vec<(f64, f64)> {
        let (one, two) = if self.low.0 <= self.high.0 { (self.low, self.high) } else { (self.high, self.low) };
        let mut points = vec![self.first, one, two, self.last];
        points.dedup();
        points
    }
}

/// The polyline without the points that lie within a twentieth of a pixel of a straight line.
fn straightened(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    const INVISIBLE: f64 = 0.05;
    let mut kept: Vec<(f64, f64)> = points.first().copied().into_iter().collect();
    let mut start = 0;
    for end in 2..points.len() {
        let skipped = &points[start + 1..end];
        if skipped.iter().any(|point| distance(*point, points[start], points[end]) > INVISIBLE) {
            start = end - 1;
            kept.push(points[start]);
        }
    }
    if points.len() > 1 {
        kept.extend(points.last());
    }
    kept
}

/// Distance of `point` from the straight line through `from` and `to`; from `from` when these are one point.
fn distance(point: (f64, f64), from: (f64, f64), to: (f64, f64)) -> f64 {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let (px, py) = (point.0 - from.0, point.1 - from.1);
    let length = (dx * dx + dy * dy).sqrt();
    // A curve that turns back on itself within a column must not lose its turning point.
    let along = if length > 0.0 { (px * dx + py * dy) / length } else { 0.0 };
    if length == 0.0 || along < 0.0 || along > length {
        return (px * px + py * py).sqrt();
    }
    (px * dy - py * dx).abs() / length
}

/// `text` fit for XML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of the attribute `points` of the first polyline.
    fn polyline(svg: &str) -> Vec<(f64, f64)> {
        let rest = &svg[svg.find("<polyline").unwrap()..];
        let points = rest.split("points=\"").nth(1).unwrap().split('"').next().unwrap();
        let pair = |pair: &str| pair.split_once(',').map(|(x, y)| (x.parse().unwrap(), y.parse().unwrap())).unwrap();
        points.split(' ').map(pair).collect()
    }

    fn drawing(times: &[f64], panel: Panel<'_>) -> String {
        PlanDrawing { title: "a < b & c", subtitle: "", times, panels: &[panel] }.to_svg()
    }

    fn close(one: (f64, f64), two: (f64, f64)) -> bool {
        (one.0 - two.0).abs() < 0.02 && (one.1 - two.1).abs() < 0.02
    }

    /// A triangle of 10 001 samples is three points, at the corners of the panel less its room of 2 and 8 %.
    #[test]
    fn straight_lines_are_two_points_each() {
        let times: Vec<f64> = (0..=10_000).map(|k| f64::from(k) * 1e-4).collect();
        let values: Vec<f64> = times.iter().map(|t| 1.0 - (2.0 * t - 1.0).abs()).collect();
        let panel = Panel { name: "velocity", unit: "m/s", values: &values, limit: None, held: false };
        let points = polyline(&drawing(&times, panel));
        let (left, right, bottom, top) = (LEFT, WIDTH - RIGHT, TOP + PANEL, TOP);
        let per_unit = PANEL / 1.1;
        let expected = [
            (left, bottom - 0.02 * per_unit),
            (f64::midpoint(left, right), top + 0.08 * per_unit),
            (right, bottom - 0.02 * per_unit),
        ];
        assert_eq!(points.len(), 3, "{points:?}");
        assert!(points.iter().zip(expected).all(|(one, two)| close(*one, two)), "{points:?} {expected:?}");
    }

    #[test]
    fn a_held_value_is_a_staircase() {
        let (times, values) = ([0.0, 0.5, 1.0], [1.0, -1.0, -1.0]);
        let panel = Panel { name: "snap", unit: "m/s⁴", values: &values, limit: Some(1.0), held: true };
        let points = polyline(&drawing(&times, panel));
        let middle = f64::midpoint(LEFT, WIDTH - RIGHT);
        assert_eq!(points.len(), 4, "{points:?}");
        assert!((points[1].0 - middle).abs() < 0.02 && (points[2].0 - middle).abs() < 0.02, "{points:?}");
        assert!((points[1].1 - points[0].1).abs() < 0.02 && (points[2].1 - points[3].1).abs() < 0.02);
    }

    /// One sample of 100 000 that exceeds the others is not lost.
    #[test]
    fn thinning_keeps_the_peak() {
        let times: Vec<f64> = (0..100_000).map(f64::from).collect();
        let mut values = vec![0.0; times.len()];
        values[54_321] = 1.0;
        let panel = Panel { name: "jerk", unit: "m/s³", values: &values, limit: Some(1.0), held: false };
        let svg = drawing(&times, panel);
        let points = polyline(&svg);
        let highest = points.iter().map(|(_, y)| *y).fold(f64::INFINITY, f64::min);
        assert!((highest - (TOP + 0.08 / 1.1 * PANEL)).abs() < 0.02, "{highest}");
        assert!(points.len() < 10 && svg.len() < 10_000, "{} points, {} bytes", points.len(), svg.len());
    }

    #[test]
    fn a_limit_is_drawn_on_the_sides_that_are_used() {
        let times = [0.0, 1.0, 2.0];
        let lines = |values: [f64; 3]| {
            let panel = Panel { name: "velocity", unit: "m/s", values: &values, limit: Some(2.0), held: false };
            drawing(&times, panel).matches("class=\"l\"").count()
        };
        assert_eq!((lines([0.0, 1.0, 0.0]), lines([0.0, 1.0, -1.0]), lines([0.0, -1.0, 0.0])), (1, 2, 1));
    }

    #[test]
    fn nothing_to_draw_is_still_a_drawing() {
        let panel = Panel { name: "velocity", unit: "m/s", values: &[], limit: None, held: false };
        let svg = drawing(&[], panel);
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
        assert!(!svg.contains("NaN") && svg.contains("a &lt; b &amp; c"), "{svg}");
    }
}
