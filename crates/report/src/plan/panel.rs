//! One quantity of a plan over time.
use super::curve::Curve;
use super::envelope::Envelope;
use crate::drawing::{Axis, about_four, escaped, unit_at, with_zero};
use servobench_metrics::DisplayUnit;
use servobench_motion::online::Sides;

/// Height of a panel.
pub(super) const HEIGHT: f64 = 118.0;
/// A limit more than this many times the peak would flatten the curve: it is named instead of drawn.
const IN_SIGHT: f64 = 2.5;

/// One quantity over time.
#[derive(Debug, Clone)]
pub(super) struct Panel<'a> {
    /// `velocity`.
    pub(super) name: &'a str,
    /// Unit in which its values are drawn.
    pub(super) unit: DisplayUnit,
    /// Its lowest and highest value, in that unit.
    pub(super) range: (f64, f64),
    /// Largest magnitudes allowed, in that unit; infinite where there is no limit. Drawn dashed.
    pub(super) limit: Sides,
    /// Curve of the quantity.
    pub(super) line: Line<'a>,
}

/// Curve of a quantity.
#[derive(Debug, Clone, Copy)]
pub(super) enum Line<'a> {
    /// Its exact polynomials.
    Exact(Curve<'a>),
    /// Envelope, and the number of the derivative of position.
    Seen(&'a Envelope, usize),
}

impl Panel<'_> {
    /// Ticks of the values, zero line, limits.
    pub(super) fn draw_scale(&self, svg: &mut Vec<String>, time: &Axis, value: &Axis) {
        let (_, scale) = self.shown_unit();
        let (left, right) = (time.from, time.to);
        for (tick, label) in about_four(value.low / scale, value.high / scale) {
            let (y, class) = (value.at(tick * scale), if tick == 0.0 { "z" } else { "g" });
            svg.push(format!(
                "<line class=\"{class}\" x1=\"{left}\" x2=\"{right}\" y1=\"{y:.2}\" y2=\"{y:.2}\"/>\n\
                 <text class=\"k\" x=\"{:.2}\" y=\"{:.2}\" text-anchor=\"end\">{label}</text>",
                left - 8.0,
                y + 4.0
            ));
        }
        for limit in self.drawn_limits(value) {
            let y = value.at(limit);
            svg.push(format!("<line class=\"l\" x1=\"{left}\" x2=\"{right}\" y1=\"{y:.2}\" y2=\"{y:.2}\"/>"));
        }
    }

    /// The curve over the area under it.
    pub(super) fn draw_curve(&self, svg: &mut Vec<String>, time: &Axis, value: &Axis, colour: &str) {
        match &self.line {
            Line::Exact(curve) => {
                let Some((line, area)) = curve.paths(time, value) else { return };
                svg.push(format!(
                    "<path class=\"f\" fill=\"{colour}\" d=\"{area}\"/>\n\
                     <path class=\"c\" stroke=\"{colour}\" d=\"{line}\"/>"
                ));
            }
            Line::Seen(envelope, k) => {
                let path = envelope.path(*k, self.unit.scale(), time, value);
                svg.push(format!("<path class=\"v\" fill=\"{colour}\" stroke=\"{colour}\" d=\"{path}\"/>"));
            }
        }
    }

    /// Name, unit, peak and limit at the right of the panel.
    pub(super) fn draw_legend(&self, svg: &mut Vec<String>, x: f64, top: f64, colour: &str) {
        let (unit, _) = self.shown_unit();
        let shown = |value: f64| self.unit.short(value * self.unit.scale());
        let mut y = top;
        let mut line = |class: &str, down: f64, attributes: &str, text: &str| {
            y += down;
            let text = escaped(text);
            svg.push(format!("<text class=\"{class}\" x=\"{x:.2}\" y=\"{y:.2}\"{attributes}>{text}</text>"));
        };
        line("n", 16.0, &format!(" style=\"fill:{colour}\""), self.name);
        line("k", 17.0, "", &unit);
        line("k", 21.0, "", &format!("peak {}", shown(self.peak())));
        let Sides { below, above } = self.limit;
        let limits = match (below.is_finite(), above.is_finite()) {
            (true, true) if below.to_bits() == above.to_bits() => vec![format!("limit {}", shown(above))],
            (is_below, is_above) => [(is_above, above), (is_below, -below)]
                .into_iter()
                .filter(|(is_limited, _)| *is_limited)
                .map(|(_, limit)| format!("limit {}", shown(limit)))
                .collect(),
        };
        for (i, limit) in limits.iter().enumerate() {
            line("lt", if i == 0 { 17.0 } else { 15.0 }, "", limit);
        }
        if !limits.is_empty() && [below, above].iter().all(|limit| self.in_sight(*limit).is_none()) {
            line("lt", 15.0, "", "(off the scale)");
        }
    }

    /// Unit of the scale, and its size in plain units.
    fn shown_unit(&self) -> (String, f64) {
        let Sides { below, above } = self.limit;
        let largest = [below, above].into_iter().filter_map(|limit| self.in_sight(limit)).fold(self.peak(), f64::max);
        unit_at(largest, self.unit.symbol(), self.unit.takes_prefix())
    }

    const fn peak(&self) -> f64 {
        self.range.1.abs().max(self.range.0.abs())
    }

    /// The limit, if it does not flatten the curve.
    fn in_sight(&self, limit: f64) -> Option<f64> {
        let peak = self.peak();
        (limit.is_finite() && (peak == 0.0 || limit <= IN_SIGHT * peak)).then_some(limit)
    }

    /// The limits that are drawn on an axis.
    fn drawn_limits(&self, value: &Axis) -> impl Iterator<Item = f64> {
        let Sides { below, above } = self.limit;
        let limits = [self.in_sight(above), self.in_sight(below).map(|limit| -limit)];
        let range = value.low..=value.high;
        limits.into_iter().flatten().filter(move |limit| range.contains(limit))
    }

    /// True if a limit is drawn.
    pub(super) fn shows_a_limit(&self) -> bool {
        self.drawn_limits(&self.axis(0.0)).next().is_some()
    }

    /// Axis that holds the values, zero unless they are far from it, and the limit on each side that the values reach.
    pub(super) fn axis(&self, top: f64) -> Axis {
        let (mut low, mut high) = with_zero(self.range);
        let tiny = 1e-9 * self.peak();
        let (below, above) = (low < -tiny, high > tiny);
        if let Some(limit) = self.in_sight(self.limit.below).filter(|_| below) {
            low = low.min(-limit);
        }
        if let Some(limit) = self.in_sight(self.limit.above).filter(|_| above || !below) {
            high = high.max(limit);
        }
        Axis::upright((low, high), top, HEIGHT)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_base::Setpoint;

    const TIME: Axis = Axis { low: 0.0, high: 2.0, from: 84.0, to: 728.0 };

    /// A velocity from `low` to `high`.
    fn panel((low, high): (f64, f64), limit: f64) -> Panel<'static> {
        let curve = Curve { spans: &[], end: Setpoint::default(), k: 1, from_zero: false, to_zero: false, scale: 1.0 };
        let (unit, limit) = (DisplayUnit::si("m", 1), Sides::both(limit));
        Panel { name: "velocity", unit, range: (low, high), limit, line: Line::Exact(curve) }
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
        let lines = |range| drawn(&panel(range, 2.0)).matches("class=\"l\"").count();
        assert_eq!((lines((0.0, 1.0)), lines((-1.0, 1.0)), lines((-1.0, 0.0))), (1, 2, 1));
    }

    #[test]
    fn limits_that_differ_by_direction_are_both_named() {
        let svg = drawn(&Panel { limit: Sides { below: 1.5, above: 2.0 }, ..panel((-1.0, 1.0), 2.0) });
        assert_eq!(svg.matches("class=\"l\"").count(), 2);
        assert!(svg.contains(">limit 2.00 m/s<") && svg.contains(">limit -1.50 m/s<"), "{svg}");
    }

    /// 1 mm of travel at a position of 5 m.
    #[test]
    fn what_is_far_from_zero_takes_its_panel() {
        let axis = panel((5.0, 5.001), f64::INFINITY).axis(0.0);
        assert!(axis.low > 4.99 && axis.high < 5.01, "{axis:?}");
    }

    /// The curve fills its panel except for margins of 2 and 8 % of the span; the limit is named.
    #[test]
    fn a_far_limit_does_not_flatten_the_curve() {
        let far = panel((0.0, 1.0), 10.0);
        let (svg, axis) = (drawn(&far), far.axis(0.0));
        assert!((axis.at(1.0) - 0.08 / 1.1 * HEIGHT).abs() < 1e-9, "{axis:?}");
        assert!(
            !svg.contains("class=\"l\"") && svg.contains("limit 10.0 m/s") && svg.contains("(off the scale)"),
            "{svg}"
        );
        assert!(!drawn(&panel((0.0, 1.0), 2.0)).contains("off the scale"));
    }

    /// ±349 takes a scale of ±405: 500, the step above a quarter of it, would leave 0 alone.
    #[test]
    fn every_panel_has_a_scale() {
        let labels = |peak: f64| {
            let svg = drawn(&panel((-peak, peak), peak));
            svg.matches("text-anchor=\"end\">").count()
        };
        assert_eq!(labels(349.0), 5);
        assert!((100..1000).all(|peak| (2..=9).contains(&labels(f64::from(peak)))));
    }

    /// There is room for eight characters left of a panel.
    #[test]
    fn labels_of_large_numbers_are_short() {
        let svg = drawn(&panel((-1e9, 1e9), 1e9));
        let labels = svg.split("text-anchor=\"end\">").skip(1).map(|rest| rest.split('<').next().unwrap());
        assert_eq!(labels.collect::<Vec<_>>(), ["-1", "0", "1"]);
        assert!(svg.contains("×10⁹ m/s"), "{svg}");
    }
}
