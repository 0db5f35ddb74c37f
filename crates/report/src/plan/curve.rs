//! Curves as SVG paths, exact in every part.
use super::derivatives;
use crate::drawing::Axis;
use servobench_base::Setpoint;
use servobench_planner::Span;
use std::fmt::Write;

/// Parts into which a polynomial of the fourth degree is cut, so that it is drawn within 1e-8 of the move.
const PARTS: u32 = 4;
/// Deviation that does not show in paths written to a hundredth of a pixel (pixels).
const UNSEEN: f64 = 0.005;

/// A derivative of position over the polynomials of a plan.
#[derive(Debug, Clone, Copy)]
pub(super) struct Curve<'a> {
    pub(super) spans: &'a [Span],
    /// The set-point from the end on.
    pub(super) end: Setpoint,
    /// Derivative drawn, 0 for position.
    pub(super) k: usize,
    /// True if it begins at zero, as the highest derivative does at the beginning of the move.
    pub(super) from_zero: bool,
    /// True if it ends at zero, as the highest derivative does at the end of the move.
    pub(super) to_zero: bool,
    /// Size of its unit in SI.
    pub(super) scale: f64,
}

/// A path that is drawn from left to right.
struct Pen {
    path: String,
    x: f64,
    y: f64,
}

impl Pen {
    fn at(x: f64, y: f64) -> Self {
        Self { path: format!("M{x:.2},{y:.2}"), x, y }
    }

    fn add(&mut self, text: std::fmt::Arguments<'_>, x: f64, y: f64) {
        let written = self.path.write_fmt(text);
        debug_assert!(written.is_ok(), "a string takes everything");
        (self.x, self.y) = (x, y);
    }

    fn upright_to(&mut self, y: f64) {
        if (y - self.y).abs() > UNSEEN {
            self.add(format_args!("V{y:.2}"), self.x, y);
        }
    }
}

impl Curve<'_> {
    /// Paths of the line, and of the area between it and zero; `None` without a span.
    pub(super) fn paths(&self, time: &Axis, value: &Axis) -> Option<(String, String)> {
        let first = self.spans.first()?;
        let zero = value.at(0.0).clamp(value.to, value.from);
        let of = |setpoint: &Setpoint| value.at(derivatives(setpoint)[self.k] / self.scale);
        let start = time.at(first.start);
        let mut pen = Pen::at(start, if self.from_zero { zero } else { of(&first.state) });
        for span in self.spans {
            pen.upright_to(of(&span.state));
            self.draw(&mut pen, span, time, value);
        }
        pen.upright_to(if self.to_zero { zero } else { of(&self.end) });
        let area = format!("{}L{:.2},{zero:.2}H{start:.2}Z", pen.path, pen.x);
        Some((pen.path, area))
    }

    /// Draws one polynomial from the position of the pen.
    fn draw(&self, pen: &mut Pen, span: &Span, time: &Axis, value: &Axis) {
        let x = time.at(span.start + span.length);
        let higher = &derivatives(&span.state)[self.k + 1..];
        let degree = if span.is_held { 0 } else { higher.iter().rposition(|part| *part != 0.0).map_or(0, |i| i + 1) };
        let at = |t: f64| derivatives(&span.after(t));
        let parts = match degree {
            0 => return pen.add(format_args!("H{x:.2}"), x, pen.y),
            1 => {
                let y = value.at(at(span.length)[self.k] / self.scale);
                return pen.add(format_args!("L{x:.2},{y:.2}"), x, y);
            }
            2 | 3 => 1,
            _ => PARTS,
        };
        let length = span.length / f64::from(parts);
        for part in 0..parts {
            let (from, to) = (f64::from(part) * length, f64::from(part + 1) * length);
            let (begin, end) = (at(from), at(to));
            let pixel = |value_there: f64| value.at(value_there / self.scale);
            let x = [from + length / 3.0, to - length / 3.0, to].map(|t| time.at(span.start + t));
            let y = [
                pixel(begin[self.k] + begin[self.k + 1] * length / 3.0),
                pixel(end[self.k] - end[self.k + 1] * length / 3.0),
                pixel(end[self.k]),
            ];
            let path = format_args!("C{:.2},{:.2} {:.2},{:.2} {:.2},{:.2}", x[0], y[0], x[1], y[1], x[2], y[2]);
            pen.add(path, x[2], y[2]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIME: Axis = Axis { low: 0.0, high: 2.0, from: 0.0, to: 200.0 };
    const VALUE: Axis = Axis { low: 0.0, high: 1.0, from: 100.0, to: 0.0 };

    /// The line of derivative `k` of two spans of a second each.
    fn line(states: [Setpoint; 2], k: usize, is_highest: bool, is_held: bool) -> String {
        let [one, two] = states.map(|state| Span { start: 0.0, length: 1.0, state, is_held });
        let spans = [one, Span { start: 1.0, ..two }];
        let end = spans[1].after(1.0);
        Curve { spans: &spans, end, k, from_zero: is_highest, to_zero: is_highest, scale: 1.0 }
            .paths(&TIME, &VALUE)
            .unwrap()
            .0
    }

    const ZERO: Setpoint = Setpoint { x: 0.0, v: 0.0, a: 0.0, j: 0.0, s: 0.0 };

    #[test]
    fn the_highest_derivative_rises_from_zero_and_falls_to_it_upright() {
        let path = line([Setpoint { a: 1.0, ..ZERO }, Setpoint { a: 0.5, ..ZERO }], 2, true, false);
        assert_eq!(path, "M0.00,100.00V0.00H100.00V50.00H200.00V100.00");
    }

    #[test]
    fn a_straight_line_is_straight() {
        let path = line([Setpoint { a: 1.0, ..ZERO }, Setpoint { v: 1.0, a: -1.0, ..ZERO }], 1, false, false);
        assert_eq!(path, "M0.00,100.00L100.00,0.00L200.00,100.00");
    }

    #[test]
    fn what_is_held_goes_in_steps() {
        let path = line([Setpoint { v: 1.0, ..ZERO }, Setpoint { x: 1.0, ..ZERO }], 0, false, true);
        assert_eq!(path, "M0.00,100.00H100.00V0.00H200.00");
    }

    /// Oracle: t²/4 as a quadratic Bézier curve has its control point where the tangents meet, and a cubic one its two on
    /// two thirds of the way there: (1/3, 0) and (2/3, 1/12) from 0 to 1.
    #[test]
    fn a_parabola_is_a_parabola() {
        let path = line([Setpoint { a: 0.5, ..ZERO }, Setpoint { x: 0.25, v: 0.5, a: 0.5, ..ZERO }], 0, false, false);
        assert!(path.starts_with("M0.00,100.00C33.33,100.00 66.67,91.67 100.00,75.00C"), "{path}");
    }

    #[test]
    fn nothing_is_no_path() {
        let curve = Curve { spans: &[], end: ZERO, k: 0, from_zero: false, to_zero: false, scale: 1.0 };
        assert!(curve.paths(&TIME, &VALUE).is_none());
    }
}
