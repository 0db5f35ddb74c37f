//! One quantity of a plan over time.
use super::axis::Axis;
use super::curve::straightened;
use super::ticks::ticks;
use servobench_metrics::{Quantity, round_above};

/// Height of a panel.
pub(super) const HEIGHT: f64 = 118.0;

/// One quantity over time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Panel<'a> {
    /// `velocity`.
    pub(super) name: &'a str,
    /// Unit of the values: `m/s`.
    pub(super) unit: &'a str,
    /// One value for each time (SI).
    pub(super) values: &'a [f64],
    /// Largest magnitude allowed (SI); drawn dashed.
    pub(super) limit: Option<f64>,
    /// Whether a value holds until the next time: a staircase rather than a polygon.
    pub(super) is_held: bool,
}

impl Panel<'_> {
    /// Ticks of the values, zero line, limits.
    pub(super) fn draw_scale(&self, svg: &mut Vec<String>, time: &Axis, value: &Axis) {
        let (_, scale) = self.shown_unit(value);
        let (left, right) = (time.from, time.to);
        for (tick, label) in
            ticks(value.low / scale, value.high / scale, round_above((value.high - value.low) / scale / 4.0))
        {
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

    pub(super) fn draw_curve(&self, svg: &mut Vec<String>, times: &[f64], time: &Axis, value: &Axis, colour: &str) {
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
    pub(super) fn draw_legend(&self, svg: &mut Vec<String>, x: f64, top: f64, colour: &str) {
        let (unit, _) = self.shown_unit(&self.axis(top));
        let peak = Quantity::new(self.peak(), self.unit);
        let mut line = |class: &str, y: f64, attributes: &str, text: &str| {
            let (y, text) = (top + y, super::drawing::escaped(text));
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
    pub(super) fn axis(&self, top: f64) -> Axis {
        let (mut low, mut high) =
            self.values.iter().fold((0.0, 0.0), |(l, h): (f64, f64), value| (l.min(*value), h.max(*value)));
        if let Some(limit) = self.limit {
            let (below, above) = (low < -1e-9 * limit, high > 1e-9 * limit);
            low = if below { low.min(-limit) } else { low };
            high = if above || !below { high.max(limit) } else { high };
        }
        let span = if high > low { high - low } else { 1.0 };
        let room = |side: f64| if side == 0.0 { 0.02 } else { 0.08 } * span;
        Axis { low: low - room(low), high: high + room(high), from: top + HEIGHT, to: top }
    }

    /// The curve in pixels.
    fn points(&self, times: &[f64], time: &Axis, value: &Axis) -> Vec<(f64, f64)> {
        let mut points: Vec<(f64, f64)> = Vec::new();
        for (t, y) in times.iter().zip(self.values) {
            let x = time.at(*t);
            if let Some((_, before)) = points.last().copied().filter(|_| self.is_held) {
                points.push((x, before));
            }
            points.push((x, value.at(*y)));
        }
        straightened(&points)
    }
}
