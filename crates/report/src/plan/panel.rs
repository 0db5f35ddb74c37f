//! One quantity of a plan over time.
use super::axis::{Axis, unit_at};
use super::curve::Curve;
use super::drawing::escaped;
use super::ticks::ticks;
use servobench_metrics::{Quantity, round_above, round_below};

/// Height of a panel.
pub(super) const HEIGHT: f64 = 118.0;
/// A limit more than this many times the peak would flatten the curve: it is named, not drawn.
const IN_SIGHT: f64 = 2.5;

/// One quantity over time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Panel<'a> {
    /// `velocity`.
    pub(super) name: &'a str,
    /// Unit of the values: `m/s`.
    pub(super) unit: &'a str,
    /// Its values (SI).
    pub(super) curve: Curve<'a>,
    /// Largest magnitude allowed (SI); drawn dashed.
    pub(super) limit: Option<f64>,
}

impl Panel<'_> {
    /// Ticks of the values, zero line, limits.
    pub(super) fn draw_scale(&self, svg: &mut Vec<String>, time: &Axis, value: &Axis) {
        let (_, scale) = self.shown_unit();
        let (left, right) = (time.from, time.to);
        for (tick, label) in marks(value.low / scale, value.high / scale) {
            let (y, class) = (value.at(tick * scale), if tick == 0.0 { "z" } else { "g" });
            svg.push(format!(
                "<line class=\"{class}\" x1=\"{left}\" x2=\"{right}\" y1=\"{y:.2}\" y2=\"{y:.2}\"/>\n\
                 <text class=\"k\" x=\"{:.2}\" y=\"{:.2}\" text-anchor=\"end\">{label}</text>",
                left - 8.0,
                y + 4.0
            ));
        }
        for limit in self.drawn_limit().iter().flat_map(|limit| [*limit, -*limit]) {
            if (value.low..=value.high).contains(&limit) {
                let y = value.at(limit);
                svg.push(format!("<line class=\"l\" x1=\"{left}\" x2=\"{right}\" y1=\"{y:.2}\" y2=\"{y:.2}\"/>"));
            }
        }
    }

    /// The curve over the area under it.
    pub(super) fn draw_curve(&self, svg: &mut Vec<String>, time: &Axis, value: &Axis, colour: &str) {
        let Some((line, area)) = self.curve.paths(time, value) else { return };
        svg.push(format!(
            "<path class=\"f\" fill=\"{colour}\" d=\"{area}\"/>\n<path class=\"c\" stroke=\"{colour}\" d=\"{line}\"/>"
        ));
    }

    /// Name, unit, peak and limit at the right of the panel.
    pub(super) fn draw_legend(&self, svg: &mut Vec<String>, x: f64, top: f64, colour: &str) {
        let (unit, _) = self.shown_unit();
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
            if self.drawn_limit().is_none() {
                line("lt", 86.0, "", "(off the scale)");
            }
        }
    }

    /// Unit of the scale, and how much of the plain unit it is.
    fn shown_unit(&self) -> (String, f64) {
        unit_at(self.peak().max(self.drawn_limit().unwrap_or(0.0)), self.unit)
    }

    fn peak(&self) -> f64 {
        self.curve.values.iter().fold(0.0, |peak: f64, value| peak.max(value.abs()))
    }

    /// The limit, where it does not flatten the curve.
    fn drawn_limit(&self) -> Option<f64> {
        let peak = self.peak();
        self.limit.filter(|limit| peak == 0.0 || *limit <= IN_SIGHT * peak)
    }

    /// Room for the values, zero, and the limit on each side that the values go to.
    pub(super) fn axis(&self, top: f64) -> Axis {
        let (mut low, mut high) =
            self.curve.values.iter().fold((0.0, 0.0), |(l, h): (f64, f64), value| (l.min(*value), h.max(*value)));
        if let Some(limit) = self.drawn_limit() {
            let (below, above) = (low < -1e-9 * limit, high > 1e-9 * limit);
            low = if below { low.min(-limit) } else { low };
            high = if above || !below { high.max(limit) } else { high };
        }
        let span = if high > low { high - low } else { 1.0 };
        let room = |side: f64| if side == 0.0 { 0.02 } else { 0.08 } * span;
        Axis { low: low - room(low), high: high + room(high), from: top + HEIGHT, to: top }
    }
}

/// About four ticks from `low` to `high`. Where their round step leaves a single one, a finer step leaves three at least.
fn marks(low: f64, high: f64) -> Vec<(f64, String)> {
    let span = high - low;
    let few = ticks(low, high, round_above(span / 4.0));
    if few.len() > 1 { few } else { ticks(low, high, round_below(span / 3.0)) }
}

#[cfg(test)]
mod tests {
    use super::super::curve::Shape;
    use super::*;

    const TIME: Axis = Axis { low: 0.0, high: 2.0, from: 84.0, to: 728.0 };

    fn panel(values: &[f64], limit: f64) -> Panel<'_> {
        let curve = Curve { times: &[0.0, 1.0, 2.0], values, shape: Shape::Straight };
        Panel { name: "velocity", unit: "m/s", curve, limit: Some(limit) }
    }

    /// The scale and the legend of `panel`.
    fn drawn(panel: &Panel<'_>) -> String {
        let mut svg = Vec::new();
        panel.draw_scale(&mut svg, &TIME, &panel.axis(0.0));
        panel.draw_legend(&mut svg, 740.0, 0.0, "#000000");
        svg.join("\n")
    }

    #[test]
    fn a_limit_is_drawn_on_the_sides_that_are_used() {
        let lines = |values: [f64; 3]| drawn(&panel(&values, 2.0)).matches("class=\"l\"").count();
        assert_eq!((lines([0.0, 1.0, 0.0]), lines([0.0, 1.0, -1.0]), lines([0.0, -1.0, 0.0])), (1, 2, 1));
    }

    /// The curve takes its panel but for a room of 2 and 8 % of the span; the limit is named.
    #[test]
    fn a_far_limit_does_not_flatten_the_curve() {
        let far = panel(&[0.0, 1.0, 0.0], 10.0);
        let (svg, axis) = (drawn(&far), far.axis(0.0));
        assert!((axis.at(1.0) - 0.08 / 1.1 * HEIGHT).abs() < 1e-9, "{axis:?}");
        assert!(
            !svg.contains("class=\"l\"") && svg.contains("limit 10.0 m/s") && svg.contains("(off the scale)"),
            "{svg}"
        );
        assert!(!drawn(&panel(&[0.0, 1.0, 0.0], 2.0)).contains("off the scale"));
    }

    /// ±349 takes a scale of ±405: 500, the step above a quarter of it, would leave 0 alone.
    #[test]
    fn every_panel_has_a_scale() {
        let labels = |peak: f64| {
            let svg = drawn(&panel(&[0.0, peak, -peak], peak));
            svg.matches("text-anchor=\"end\">").count()
        };
        assert_eq!(labels(349.0), 5);
        assert!((100..1000).all(|peak| (2..=9).contains(&labels(f64::from(peak)))));
    }

    /// There is room for eight characters left of a panel.
    #[test]
    fn labels_of_large_numbers_are_short() {
        let svg = drawn(&panel(&[1e9, -1e9, 0.0], 1e9));
        let labels = svg.split("text-anchor=\"end\">").skip(1).map(|rest| rest.split('<').next().unwrap());
        assert_eq!(labels.collect::<Vec<_>>(), ["-1", "0", "1"]);
        assert!(svg.contains("×10⁹ m/s"), "{svg}");
    }
}
