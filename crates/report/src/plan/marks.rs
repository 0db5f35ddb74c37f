//! Marks where a bound binds.
use crate::drawing::Axis;
use servobench_motion::online::Sides;
use servobench_planner::Binding;
use std::fmt::Write;

/// A shorter interval is a dot, and marks closer together than this are one (pixels).
const DOT: f64 = 1.5;

/// Marks on the limits of one panel.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Marks {
    /// Intervals along the limit, as a path.
    pub(super) stretches: String,
    /// Dots, as a path of lines of zero length.
    pub(super) dots: String,
}

impl Marks {
    /// Marks of `bindings`, all of one derivative, along its `limit`, also where it is exceeded.
    pub(super) fn of<'a>(bindings: impl Iterator<Item = &'a Binding>, limit: Sides, time: &Axis, value: &Axis) -> Self {
        // Above zero and below, each from left to right: start, end, height.
        let mut merged: [Vec<(f64, f64, f64)>; 2] = [vec![], vec![]];
        for binding in bindings {
            let (from, to) = (time.at(binding.start), time.at(binding.start + binding.length));
            let is_below = binding.value < 0.0;
            let side = &mut merged[usize::from(is_below)];
            let limit = if is_below { -limit.below } else { limit.above };
            match side.last_mut() {
                Some(last) if from - last.1 < DOT => last.1 = last.1.max(to),
                _ => side.push((from, to, value.at(limit))),
            }
        }
        let mut marks = Self::default();
        for (from, to, y) in merged.into_iter().flatten() {
            let written = if to - from < DOT {
                write!(marks.dots, "M{:.1},{y:.1}h0", f64::midpoint(from, to))
            } else {
                write!(marks.stretches, "M{from:.1},{y:.1}H{to:.1}")
            };
            debug_assert!(written.is_ok(), "a string takes everything");
        }
        marks
    }

    pub(super) fn draw(&self, svg: &mut Vec<String>) {
        for (class, path) in [("m", &self.stretches), ("d", &self.dots)] {
            if !path.is_empty() {
                svg.push(format!("<path class=\"{class}\" d=\"{path}\"/>"));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_are_lines_and_instants_are_dots() {
        let time = Axis { low: 0.0, high: 1.0, from: 0.0, to: 100.0 };
        let value = Axis { low: -2.0, high: 2.0, from: 100.0, to: 0.0 };
        let binding = |start, length, value| Binding { derivative: 1, start, length, value };
        // The second begins where the first ends, except for a pixel; the last exceeds the limit.
        let all = [binding(0.1, 0.2, 2.0), binding(0.31, 0.1, 2.0), binding(0.5, 0.0, -2.0), binding(0.9, 0.001, 2.5)];
        let marks = Marks::of(all.iter(), Sides::both(2.0), &time, &value);
        assert_eq!(marks.stretches, "M10.0,0.0H41.0");
        assert_eq!(marks.dots, "M90.1,0.0h0M50.0,100.0h0");
    }
}
