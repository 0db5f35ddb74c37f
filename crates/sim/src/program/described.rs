//! Descriptions of the moves of a program for a recording.
use super::{Planned, Program};
use servobench_metrics::DisplayUnit;
use servobench_motion::online::Effort;
use servobench_motion::rockwell::Shape;
use servobench_planner::{Follow, Generator, Method};
use servobench_trace::{Ending, Move};

impl Program {
    /// The label of a move between two positions (m or rad), made by a profile of this `order`.
    pub(crate) fn label(&self, ends: [f64; 2], order: &str) -> String {
        label(&self.unit, ends, order)
    }
}

impl Planned {
    /// Description of the move for a recording, with its end `delay` (s) later than planned.
    pub(super) fn describe(&self, unit: &DisplayUnit, delay: f64) -> Move {
        let (plan, order) = (&self.plan, self.plan.order());
        let length = self.end - self.start;
        // The difference of start and end is rounded: it alone proves nothing.
        let is_aborted = self.is_aborted && length < plan.duration();
        let (from, to) = (self.from, self.from + plan.at(length.max(plan.duration())).x);
        let (cruise_start, cruise) = match plan.end().v {
            // A held velocity.
            v if v != 0.0 && length > plan.duration() => (plan.duration(), length - plan.duration()),
            _ => plan.cruise(),
        };
        let cruise = (cruise_start.min(length), cruise.min(length - cruise_start).max(0.0));
        let (mut peaks, mut limits) = (plan.largest(), [None; 4]);
        for (k, (sides, both)) in plan.limits().iter().zip(plan.peaks()).enumerate() {
            let uses_more_below = -both.lowest * sides.above > both.highest * sides.below;
            let limit = if uses_more_below { sides.below } else { sides.above };
            limits[k] = limit.is_finite().then_some(limit);
            if sides.below.to_bits() != sides.above.to_bits() {
                peaks[k] = if uses_more_below { -both.lowest } else { both.highest };
            }
        }
        let (kind, aborted) = (self.kind, if is_aborted { ", aborted" } else { "" });
        Move {
            label: label(unit, [from, to], &format!("{order}{kind}{aborted}")),
            start: self.start,
            end: self.end + delay,
            from,
            to,
            peaks,
            limits,
            cruise: (self.start + cruise.0 + delay, cruise.1),
            ending: match is_aborted {
                true => Ending::Aborted,
                false if self.ends_at_rest => Ending::AtRest,
                false => Ending::InMotion,
            },
        }
    }
}

fn label(unit: &DisplayUnit, ends: [f64; 2], order: &str) -> String {
    let [from, to] = ends.map(|position| unit.text(without_rounding(position)));
    format!("move from {from} to {to}, order {order}")
}

/// Kind of the move for a label, in words, besides its order.
pub(super) const fn kind(generator: &Generator) -> &'static str {
    match generator {
        Generator::PointToPoint(asked) => match asked.method {
            Method::Published => "",
            Method::Optimal => " optimal",
        },
        Generator::Replanning(asked) => match asked.effort {
            Effort::Fast => " online",
            Effort::Refined => " online, refined",
        },
        Generator::Rockwell(asked) => match asked.operands.shape {
            Shape::Trapezoid => " Rockwell trapezoid",
            Shape::SCurve { .. } => " Rockwell S-curve",
        },
        Generator::Table(asked) => match asked.follow {
            Follow::Segments => " table",
            Follow::Plateaus { .. } => " position profile, plateaus",
            Follow::Steps { .. } => " position profile, spline",
        },
    }
}

/// A position (m or rad) rounded to a picounit: a sum of targets would show its rounding error.
fn without_rounding(position: f64) -> f64 {
    libm::round(position * 1e12) / 1e12
}
