//! A plan as a drawing: position and its derivatives over time, one panel each, with their limits.
use super::axis::{Axis, unit_at};
use super::curve::{Curve, Shape};
use super::panel::{HEIGHT, Panel};
use super::ticks::ticks;
use super::{NAMES, PlannedMove};
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
.k{font-size:11px;fill:#5b6472}.e{font-size:11px;font-weight:600}.g{stroke:#e4e8ee;stroke-width:1}.b{stroke:#aab3c0;stroke-width:1;stroke-dasharray:1.5 3}\
.z{stroke:#9aa3b0;stroke-width:1}\
.l{stroke:#c2303a;stroke-width:1.2;stroke-dasharray:6 4}.lt{font-size:11px;fill:#c2303a}.c{fill:none;\
stroke-width:2;stroke-linejoin:round}.f{stroke:none;opacity:.09}";

/// Parts into which a segment is cut, so that position, of the fourth degree, is drawn within 1e-8 of the move.
const PARTS: u32 = 4;
/// Labels of the time axis keep this far from that of the end.
const LABEL: f64 = 34.0;
/// Marks closer than this are one.
const APART: f64 = 1.5;

impl PlannedMove {
    /// The move as SVG, complete in itself.
    ///
    /// Between two switching instants everything is a polynomial and drawn as such: a sampled plan too, which is continuous
    /// between its samples.
    #[must_use]
    pub fn svg(&self) -> String {
        let n = self.profile.order().derivative();
        let (mut switches, mut parts) = (Vec::new(), Vec::new());
        for segment in self.profile.segments() {
            switches.push(segment.start);
            parts.extend((0..PARTS).map(|k| segment.start + segment.length * f64::from(k) / f64::from(PARTS)));
        }
        if !switches.is_empty() {
            switches.push(self.profile.duration());
            parts.push(self.profile.duration());
        }
        let (of_switches, of_parts) = (self.columns(&switches), self.columns(&parts));
        let units: Vec<String> = (0..=n).map(|i| self.unit_of(i)).collect();
        let limits = std::iter::once(None).chain(self.limits().map(|limit| limit.is_finite().then_some(limit)));
        let curve = |i: usize| match n - i {
            0 => Curve { times: &switches, values: &of_switches[i], shape: Shape::Held },
            1 => Curve { times: &switches, values: &of_switches[i], shape: Shape::Straight },
            _ => Curve { times: &parts, values: &of_parts[i], shape: Shape::Smooth(&of_parts[i + 1]) },
        };
        let panels: Vec<Panel<'_>> = limits
            .enumerate()
            .map(|(i, limit)| Panel { name: NAMES[i], unit: &units[i], curve: curve(i), limit })
            .collect();
        let distance = Quantity::new(self.profile.distance(), self.unit);
        // In the unit of the time axis; to the nanosecond they are in the table.
        let (unit, scale) = unit_at(self.profile.duration(), "s");
        let shown = |time: f64| format!("{} {unit}", four_digits(time / scale));
        let title = format!("{distance} in {}, order {n}", shown(self.profile.duration()));
        let subtitle: Vec<_> = self.dwells().map(|(name, _, value)| format!("{name} = {}", shown(value))).collect();
        Drawing { title: &title, subtitle: &subtitle.join(",  "), switches: &switches, panels: &panels }.to_svg()
    }

    /// Position and its derivatives at `times`.
    fn columns(&self, times: &[f64]) -> [Vec<f64>; 5] {
        let setpoints: Vec<Setpoint> = times.iter().map(|t| self.profile.at(*t)).collect();
        let column = |value: fn(&Setpoint) -> f64| setpoints.iter().map(value).collect::<Vec<_>>();
        [column(|at| at.x), column(|at| at.v), column(|at| at.a), column(|at| at.j), column(|at| at.s)]
    }
}

/// Panels below each other.
struct Drawing<'a> {
    /// Headline: `1 m in 1.35 s, order 4`.
    title: &'a str,
    /// What a reader wants to know besides: segment times.
    subtitle: &'a str,
    /// Switching instants from the start to the end (s), ascending.
    switches: &'a [f64],
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
        let end = self.switches.last().copied();
        let time = Axis { low: 0.0, high: end.unwrap_or(1.0), from: LEFT, to: WIDTH - RIGHT };
        let (unit, scale) = unit_at(time.high, "s");
        let marks = ticks(0.0, time.high / scale, round_above(time.high / scale / 8.0));
        for (k, panel) in self.panels.iter().enumerate() {
            let top = TOP + k as f64 * (HEIGHT + GAP);
            let bottom = top + HEIGHT;
            let upright = |class: &str, x: f64| {
                format!("<line class=\"{class}\" x1=\"{x:.2}\" x2=\"{x:.2}\" y1=\"{top}\" y2=\"{bottom}\"/>")
            };
            svg.extend(marks.iter().map(|(value, _)| upright("g", time.at(value * scale))));
            svg.extend(self.boundaries(&time).into_iter().map(|x| upright("b", x)));
            let (value, colour) = (panel.axis(top), COLOURS[k % COLOURS.len()]);
            panel.draw_scale(&mut svg, &time, &value);
            panel.draw_curve(&mut svg, &time, &value, colour);
            panel.draw_legend(&mut svg, time.to + 12.0, top, colour);
        }
        let base = height - BOTTOM + 18.0;
        let centred = |class: &str, x: f64, y: f64, text: &str| {
            format!("<text class=\"{class}\" x=\"{x:.2}\" y=\"{y:.2}\" text-anchor=\"middle\">{text}</text>")
        };
        let free = marks.iter().map(|(value, label)| (time.at(value * scale), label));
        let free = free.filter(|(x, _)| end.is_none() || time.to - x >= LABEL);
        svg.extend(free.map(|(x, label)| centred("k", x, base, label)));
        if let Some(end) = end {
            svg.push(centred("e", time.to, base, &four_digits(end / scale)));
        }
        svg.push(centred("k", f64::midpoint(time.from, time.to), base + 18.0, &format!("time ({unit})")));
        svg.push("</svg>\n".to_owned());
        svg.join("\n")
    }

    /// Where a segment ends (pixels); segments too short to be seen end where the next one does.
    fn boundaries(&self, time: &Axis) -> Vec<f64> {
        let mut boundaries: Vec<f64> = Vec::new();
        for x in self.switches.iter().skip(1).map(|t| time.at(*t)) {
            if boundaries.last().is_none_or(|before| x - before >= APART) {
                boundaries.push(x);
            }
        }
        boundaries
    }
}

/// A positive number with four significant digits at most.
fn four_digits(value: f64) -> String {
    let rounded = format!("{value:.3e}").parse().unwrap_or(value);
    format!("{rounded}")
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

    /// The path of the line of panel `k`.
    fn path(svg: &str, k: usize) -> &str {
        let rest = svg.split("<path class=\"c\"").nth(k + 1).unwrap();
        rest.split(" d=\"").nth(1).unwrap().split('"').next().unwrap()
    }

    /// All numbers in `path`.
    fn numbers(path: &str) -> Vec<f64> {
        let is_number = |c: char| c.is_ascii_digit() || c == '.' || c == '-';
        path.split(|c| !is_number(c)).filter(|text| !text.is_empty()).map(|text| text.parse().unwrap()).collect()
    }

    /// The points and control points of a path of cubic curves.
    fn cubics(path: &str) -> Vec<(f64, f64)> {
        assert!(path.chars().all(|c| !c.is_ascii_alphabetic() || "MC".contains(c)), "{path}");
        numbers(path).chunks(2).map(|pair| (pair[0], pair[1])).collect()
    }

    /// Pixels of the time and of the value `value` in panel `k`, whose values go from `low` to `high`. Room is 2 % at zero
    /// and 8 % elsewhere.
    fn pixel(duration: f64, k: u8, (low, high): (f64, f64), t: f64, value: f64) -> (f64, f64) {
        let span = high - low;
        let room = |side: f64| if side == 0.0 { 0.02 * span } else { 0.08 * span };
        let (bottom, top) = (low - room(low), high + room(high));
        let y = TOP + f64::from(k) * (HEIGHT + GAP) + (top - value) / (top - bottom) * HEIGHT;
        (LEFT + t / duration * (WIDTH - RIGHT - LEFT), y)
    }

    /// Oracle: the profile itself, at a hundred instants of every part. Coordinates are written to a hundredth of a pixel,
    /// and three of them err in the curve.
    #[test]
    fn curves_are_those_of_the_profile() {
        let plan = moves::lambrechts(Order::Fourth);
        let (profile, svg) = (&plan.profile, plan.svg());
        let values: [fn(Setpoint) -> f64; 3] = [|at| at.x, |at| at.v, |at| at.a];
        for (k, (value, range)) in (0..).zip(values.into_iter().zip([(0.0, 1.0), (0.0, 1.0), (-5.0, 5.0)])) {
            let points = cubics(path(&svg, usize::from(k)));
            assert_eq!(points.len(), 1 + 3 * 4 * 15, "15 segments in four parts");
            for part in points.windows(4).step_by(3) {
                for step in 0..=100 {
                    let u = f64::from(step) / 100.0;
                    let weights = [(1.0 - u).powi(3), 3.0 * u * (1.0 - u).powi(2), 3.0 * u * u * (1.0 - u), u.powi(3)];
                    let at =
                        |pick: fn(&(f64, f64)) -> f64| part.iter().zip(weights).map(|(p, w)| w * pick(p)).sum::<f64>();
                    let (x, y) = (at(|p| p.0), at(|p| p.1));
                    let t = (x - LEFT) / (WIDTH - RIGHT - LEFT) * profile.duration();
                    let expected = pixel(profile.duration(), k, range, t, value(profile.at(t)));
                    assert!((y - expected.1).abs() < 0.03, "panel {k} at {t} s: {y} instead of {}", expected.1);
                }
            }
        }
    }

    /// Corners would show as a tangent that differs left and right of a point. A hundredth of a pixel of the control points
    /// turns a tangent of ten pixels by a thousandth.
    #[test]
    fn curves_have_no_corners() {
        let svg = moves::lambrechts(Order::Fourth).svg();
        for k in 0..3 {
            let points = cubics(path(&svg, k));
            for k in (3..points.len() - 3).step_by(3) {
                let slope = |from: (f64, f64), to: (f64, f64)| (to.1 - from.1) / (to.0 - from.0);
                let (before, after) = (slope(points[k - 1], points[k]), slope(points[k], points[k + 1]));
                assert!((before - after).abs() < 0.02, "{before} and {after} at {:?}", points[k]);
            }
        }
    }

    /// Jerk is straight from switch to switch, snap goes level and upright and ends on both sides at zero.
    #[test]
    fn the_highest_derivatives_are_drawn_without_slant() {
        let svg = moves::lambrechts(Order::Fourth).svg();
        let (jerk, snap) = (path(&svg, 3), path(&svg, 4));
        assert!(jerk.chars().all(|c| !c.is_ascii_alphabetic() || "ML".contains(c)), "{jerk}");
        assert!(snap.chars().all(|c| !c.is_ascii_alphabetic() || "MHV".contains(c)), "{snap}");
        let zero = pixel(1.35, 4, (-1000.0, 1000.0), 0.0, 0.0).1;
        let numbers = numbers(snap);
        assert!((numbers[1] - zero).abs() < 0.02 && (numbers.last().unwrap() - zero).abs() < 0.02, "{snap}");
    }

    /// A move of 1.35 thousand million samples takes no more room than the continuous one, and looks the same.
    #[test]
    fn the_size_of_a_drawing_does_not_depend_on_the_number_of_samples() {
        let (fine, continuous) = (moves::sampled(1e-9).svg(), moves::lambrechts(Order::Fourth).svg());
        assert!(fine.len() < 40_000, "{} bytes", fine.len());
        for panel in 0..5 {
            let (one, two) = (numbers(path(&fine, panel)), numbers(path(&continuous, panel)));
            assert!(
                one.len() == two.len() && one.iter().zip(two).all(|(one, two)| (one - two).abs() < 0.02),
                "{panel}"
            );
        }
    }

    /// Pulses of jerk that last 1e-9 of the move reach their limit in the drawing.
    #[test]
    fn the_shortest_pulse_is_drawn_to_its_peak() {
        let limits = Limits { velocity: 1.0, acceleration: 1e-3, jerk: 1e6, snap: 1e16 };
        let profile = Profile::plan(Order::Fourth, 1.0, &limits).unwrap();
        let peak = profile.peaks().jerk;
        let svg = PlannedMove::new(profile, Limits { jerk: peak, ..limits }, "m").svg();
        let top = pixel(1.0, 3, (-peak, peak), 0.0, peak).1;
        let highest = numbers(path(&svg, 3)).into_iter().skip(1).step_by(2).fold(f64::INFINITY, f64::min);
        assert!((highest - top).abs() < 0.02, "{highest} {top}");
    }

    #[test]
    fn the_ends_of_the_segments_and_of_the_move_are_marked() {
        let svg = moves::lambrechts(Order::Fourth).svg();
        assert_eq!(svg.matches("class=\"b\"").count(), 5 * 15, "15 segments in five panels");
        assert_eq!(svg.matches("class=\"e\"").count(), 1);
        assert!(svg.contains(">1.35</text>"), "the end of the move");
        // 1.35 s cuts the distance to the label of 1.4 s, which there is none of, not to that of 1.2 s.
        assert!(svg.contains(">1.2</text>"));
    }

    #[test]
    fn times_are_written_in_the_unit_of_the_axis() {
        let limits = Limits { velocity: 1.0, acceleration: 3.0, jerk: 100.0, snap: 1e4 };
        let svg = PlannedMove::new(Profile::plan(Order::Second, 1e-3, &limits).unwrap(), limits, "m").svg();
        // Two halves of √(1 mm/3 m/s²) = 18.257 ms each.
        assert!(svg.contains(">1.00 mm in 36.51 ms, order 2<") && svg.contains("t_a = 18.26 ms"), "{svg}");
        assert!(svg.contains(">36.51</text>") && svg.contains(">time (ms)</text>"));
    }

    #[test]
    fn a_move_of_no_distance_is_still_a_drawing() {
        let limits = Limits { velocity: 1.0, acceleration: 1.0, jerk: 1.0, snap: 1.0 };
        let svg = PlannedMove::new(Profile::plan(Order::Third, 0.0, &limits).unwrap(), limits, "m").svg();
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>") && !svg.contains("NaN"), "{svg}");
    }

    #[test]
    fn words_are_escaped() {
        assert_eq!(escaped("a < b & \"c\" > d"), "a &lt; b &amp; &quot;c&quot; &gt; d");
    }
}
