//! Curves as SVG paths, exact in every part.
use super::axis::Axis;
use std::fmt::Write;

/// A quantity at instants between which it is one polynomial.
#[derive(Debug, Clone, Copy)]
pub(super) struct Curve<'a> {
    /// Instants (s), ascending.
    pub(super) times: &'a [f64],
    /// Value from each instant on.
    pub(super) values: &'a [f64],
    /// What it does between two of them.
    pub(super) shape: Shape<'a>,
}

/// What a quantity does between two instants.
#[derive(Debug, Clone, Copy)]
pub(super) enum Shape<'a> {
    /// It has these derivatives at the instants. Of a polynomial up to the third degree the curve is exact, and it has no
    /// corners.
    Smooth(&'a [f64]),
    /// It goes straight on.
    Straight,
    /// It holds its value, before and after the move zero.
    Held,
}

impl Curve<'_> {
    /// The path of the line, and of the area between it and zero; `None` without a value.
    pub(super) fn paths(&self, time: &Axis, value: &Axis) -> Option<(String, String)> {
        let (first, last) = (time.at(*self.times.first()?), time.at(*self.times.last()?));
        let (start, zero) = (value.at(*self.values.first()?), value.at(0.0));
        let mut line = match self.shape {
            Shape::Held => format!("M{first:.2},{zero:.2}V{start:.2}"),
            Shape::Smooth(_) | Shape::Straight => format!("M{first:.2},{start:.2}"),
        };
        for k in 1..self.times.len() {
            let (x, y) = (time.at(self.times[k]), value.at(self.values[k]));
            let written = match self.shape {
                Shape::Held => write!(line, "H{x:.2}V{y:.2}"),
                Shape::Straight => write!(line, "L{x:.2},{y:.2}"),
                Shape::Smooth(slopes) => {
                    let third = (self.times[k] - self.times[k - 1]) / 3.0;
                    let (t1, t2) = (time.at(self.times[k - 1] + third), time.at(self.times[k] - third));
                    let after = value.at(self.values[k - 1] + third * slopes[k - 1]);
                    let before = value.at(self.values[k] - third * slopes[k]);
                    write!(line, "C{t1:.2},{after:.2} {t2:.2},{before:.2} {x:.2},{y:.2}")
                }
            };
            debug_assert!(written.is_ok(), "a string takes everything");
        }
        let area = format!("{line}L{last:.2},{zero:.2}H{first:.2}Z");
        Some((line, area))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIME: Axis = Axis { low: 0.0, high: 2.0, from: 0.0, to: 200.0 };
    const VALUE: Axis = Axis { low: 0.0, high: 1.0, from: 100.0, to: 0.0 };

    fn line(values: &[f64], shape: Shape<'_>) -> String {
        Curve { times: &[0.0, 1.0, 2.0], values, shape }.paths(&TIME, &VALUE).unwrap().0
    }

    #[test]
    fn a_held_value_rises_from_zero_and_falls_to_it_upright() {
        let path = line(&[1.0, 0.5, 0.0], Shape::Held);
        assert_eq!(path, "M0.00,100.00V0.00H100.00V50.00H200.00V100.00");
    }

    #[test]
    fn a_straight_line_is_straight() {
        assert_eq!(line(&[0.0, 1.0, 0.0], Shape::Straight), "M0.00,100.00L100.00,0.00L200.00,100.00");
    }

    /// Oracle: t²/4 as a quadratic Bézier curve has its control point where the tangents meet, and a cubic one its two on
    /// two thirds of the way there: (1/3, 0) and (2/3, 1/12) from 0 to 1.
    #[test]
    fn a_parabola_is_a_parabola() {
        let path = line(&[0.0, 0.25, 1.0], Shape::Smooth(&[0.0, 0.5, 1.0]));
        assert!(path.starts_with("M0.00,100.00C33.33,100.00 66.67,91.67 100.00,75.00C"), "{path}");
    }

    #[test]
    fn nothing_is_no_path() {
        assert!(Curve { times: &[], values: &[], shape: Shape::Held }.paths(&TIME, &VALUE).is_none());
    }
}
