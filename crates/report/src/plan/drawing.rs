//! A plan as a drawing: position and its derivatives over time, one panel each, with their limits.
use super::axis::Axis;
use super::panel::{HEIGHT, Panel};
use super::ticks::ticks;
use super::{NAMES, PlannedMove, seconds};
use servobench_base::Setpoint;
use servobench_metrics::{Quantity, round_above};

const WIDTH: f64 = 860.0;
const LEFT: f64 = 84.0;
const RIGHT: f64 = 132.0;
const TOP: f64 = 78.0;
const BOTTOM: f64 = 46.0;
const GAP: f64 = 22.0;
/// One colour for each panel, distinguishable without colour vision by position anyway.
const COLOURS: [&str; 5] = ["#1f5fa8", "#0f7f72", "#9a5b00", "#8a2f78", "#4a4fb0"];
const STYLE: &str = "text{font-family:'DejaVu Sans','Segoe UI',Helvetica,Arial,sans-serif;fill:#1c2330}\
.t{font-size:17px;font-weight:600}.s{font-size:12.5px;fill:#5b6472}.n{font-size:13px;font-weight:600}\
.k{font-size:11px;fill:#5b6472}.g{stroke:#e4e8ee;stroke-width:1}.z{stroke:#9aa3b0;stroke-width:1}\
.l{stroke:#c2303a;stroke-width:1.2;stroke-dasharray:6 4}.lt{font-size:11px;fill:#c2303a}.c{fill:none;\
stroke-width:2;stroke-linejoin:round}.f{stroke:none;opacity:.09}";

impl PlannedMove {
    /// The move as SVG, complete in itself.
    ///
    /// It is drawn at equal steps finer than a pixel and at every switching instant, where all extremes are: a sampled
    /// plan too, which is continuous between its samples.
    #[must_use]
    pub fn svg(&self) -> String {
        let n = self.profile.order().derivative();
        let mut times: Vec<f64> = self.steps().chain(self.profile.segments().map(|segment| segment.start)).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        let setpoints: Vec<Setpoint> = times.iter().map(|t| self.profile.at(*t)).collect();
        let column = |value: fn(&Setpoint) -> f64| setpoints.iter().map(value).collect::<Vec<_>>();
        let columns = [column(|at| at.x), column(|at| at.v), column(|at| at.a), column(|at| at.j), column(|at| at.s)];
        let units: Vec<String> = (0..=n).map(|i| self.unit_of(i)).collect();
        let limits = std::iter::once(None).chain(self.limits().map(|limit| limit.is_finite().then_some(limit)));
        let panels: Vec<Panel<'_>> = limits
            .enumerate()
            .map(|(i, limit)| Panel { name: NAMES[i], unit: &units[i], values: &columns[i], limit, is_held: i == n })
            .collect();
        let distance = Quantity::new(self.profile.distance(), self.unit);
        let title = format!("{distance} in {}, order {n}", seconds(self.profile.duration()));
        let subtitle: Vec<_> = self.dwells().map(|(name, _, value)| format!("{name} = {}", seconds(value))).collect();
        Drawing { title: &title, subtitle: &subtitle.join(",  "), times: &times, panels: &panels }.to_svg()
    }
}

/// Panels below each other.
struct Drawing<'a> {
    /// Headline: `1 m in 1.35 s, order 4`.
    title: &'a str,
    /// What a reader wants to know besides: segment times.
    subtitle: &'a str,
    /// Times of the values (s), ascending.
    times: &'a [f64],
    /// Panels from top to bottom.
    panels: &'a [Panel<'a>],
}

impl Drawing<'_> {
    fn to_svg(&self) -> String {
        let count = self.panels.len() as f64;
        let height = TOP + count * HEIGHT + (count - 1.0).max(0.0) * GAP + BOTTOM;
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
        let marks = ticks(time.low / scale, time.high / scale, round_above((time.high - time.low) / scale / 8.0));
        for (k, panel) in self.panels.iter().enumerate() {
            let top = TOP + k as f64 * (HEIGHT + GAP);
            svg.extend(marks.iter().map(|(value, _)| {
                let (x, bottom) = (time.at(value * scale), top + HEIGHT);
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

/// `text` fit for XML.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::super::moves;
    use super::*;
    use servobench_motion::{Limits, Order, Profile};

    /// Numbers of the attribute `points` of the polyline of panel `k`.
    fn polyline(svg: &str, k: usize) -> Vec<(f64, f64)> {
        let rest = svg.split("<polyline").nth(k + 1).unwrap();
        let points = rest.split("points=\"").nth(1).unwrap().split('"').next().unwrap();
        let pair = |pair: &str| pair.split_once(',').map(|(x, y)| (x.parse().unwrap(), y.parse().unwrap())).unwrap();
        points.split(' ').map(pair).collect()
    }

    fn drawing(times: &[f64], panel: Panel<'_>) -> String {
        Drawing { title: "a < b & c", subtitle: "", times, panels: &[panel] }.to_svg()
    }

    /// Coordinates are written to a hundredth of a pixel.
    fn close(one: (f64, f64), two: (f64, f64)) -> bool {
        (one.0 - two.0).abs() < 0.02 && (one.1 - two.1).abs() < 0.02
    }

    /// A triangle of 1 001 samples is three points, at the corners of the panel less its room of 2 and 8 %.
    #[test]
    fn straight_lines_are_two_points_each() {
        let times: Vec<f64> = (0..=1_000).map(|k| f64::from(k) * 1e-3).collect();
        let values: Vec<f64> = times.iter().map(|t| 1.0 - (2.0 * t - 1.0).abs()).collect();
        let panel = Panel { name: "velocity", unit: "m/s", values: &values, limit: None, is_held: false };
        let points = polyline(&drawing(&times, panel), 0);
        let (left, right, bottom, top) = (LEFT, WIDTH - RIGHT, TOP + HEIGHT, TOP);
        let per_unit = HEIGHT / 1.1;
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
        let panel = Panel { name: "snap", unit: "m/s⁴", values: &values, limit: Some(1.0), is_held: true };
        let points = polyline(&drawing(&times, panel), 0);
        let middle = f64::midpoint(LEFT, WIDTH - RIGHT);
        assert_eq!(points.len(), 4, "{points:?}");
        assert!((points[1].0 - middle).abs() < 0.02 && (points[2].0 - middle).abs() < 0.02, "{points:?}");
        assert!((points[1].1 - points[0].1).abs() < 0.02 && (points[2].1 - points[3].1).abs() < 0.02);
    }

    /// A move of 1.35 thousand million samples takes no more room than the continuous one, and looks the same.
    #[test]
    fn the_size_of_a_drawing_does_not_depend_on_the_number_of_samples() {
        let (fine, continuous) = (moves::sampled(1e-9).svg(), moves::lambrechts(Order::Fourth).svg());
        assert!(fine.len() < 40_000, "{} bytes", fine.len());
        for panel in 0..5 {
            let (one, two) = (polyline(&fine, panel), polyline(&continuous, panel));
            assert!(one.len() == two.len() && one.iter().zip(two).all(|(one, two)| close(*one, two)), "{panel}");
        }
    }

    /// Pulses of jerk that last 1e-9 of the move reach their limit in the drawing, below a room of 8 % of the span.
    #[test]
    fn the_shortest_pulse_is_drawn_to_its_peak() {
        let limits = Limits { velocity: 1.0, acceleration: 1e-3, jerk: 1e6, snap: 1e16 };
        let profile = Profile::plan(Order::Fourth, 1.0, &limits).unwrap();
        let peak = profile.peaks().jerk;
        let svg = PlannedMove::new(profile, Limits { jerk: peak, ..limits }, "m").svg();
        let top = TOP + 3.0 * (HEIGHT + GAP) + 0.08 / 1.16 * HEIGHT;
        let highest = polyline(&svg, 3).iter().map(|(_, y)| *y).fold(f64::INFINITY, f64::min);
        assert!((highest - top).abs() < 0.02, "{highest} {top}");
    }

    #[test]
    fn a_limit_is_drawn_on_the_sides_that_are_used() {
        let times = [0.0, 1.0, 2.0];
        let lines = |values: [f64; 3]| {
            let panel = Panel { name: "velocity", unit: "m/s", values: &values, limit: Some(2.0), is_held: false };
            drawing(&times, panel).matches("class=\"l\"").count()
        };
        assert_eq!((lines([0.0, 1.0, 0.0]), lines([0.0, 1.0, -1.0]), lines([0.0, -1.0, 0.0])), (1, 2, 1));
    }

    #[test]
    fn nothing_to_draw_is_still_a_drawing() {
        let panel = Panel { name: "velocity", unit: "m/s", values: &[], limit: None, is_held: false };
        let svg = drawing(&[], panel);
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
        assert!(!svg.contains("NaN") && svg.contains("a &lt; b &amp; c"), "{svg}");
    }
}
