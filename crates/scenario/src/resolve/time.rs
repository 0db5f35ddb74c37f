//! Checks that the program and the measures fit into the length of the run.
//!
//! The duration of a move is known after planning, which is not done here. Its lower bound is known:
//!
//! ```text
//! T ≥ x/v + v/a   (v²/a ≤ x)     T ≥ 2·√(x/a)   (otherwise)
//! ```
//! the rest-to-rest move of second order, which every limit of jerk and snap only lengthens.
use crate::diagnostic::Report;
use crate::file::File;
use crate::scenario::Step;
use servobench_motion::Limits;
use servobench_planner::{Generator, Positioning};

/// Relative tolerance for rounding.
const ROUNDING: f64 = 1e-9;

/// Warns of a program that does not fit, and reports measures beyond the end; `steps` are those of the file, if all are valid. A run
/// may end within its program, but not without a warning.
pub(super) fn check(file: &File, steps: Option<&[Step]>, report: &mut Report) {
    let Some(run) = file.run.given().and_then(|run| run.duration.at()) else { return };
    if let Some(least) = steps.map(least_program)
        && run.value < least * (1.0 - ROUNDING)
    {
        let message =
            format!("the run ends after {} s, within its program, which takes {least:.4} s at least", run.value);
        report.warning(run.span, message, "moves are judged as far as they are recorded");
    }
    if let Some(from) = file.measure.given().and_then(|measure| measure.from.at())
        && from.value >= run.value
    {
        report.error(from.span, format!("the run is over by then: it lasts {} s", run.value), "");
    }
}

/// Shortest duration of the program (s).
fn least_program(steps: &[Step]) -> f64 {
    let (mut end, mut position) = (0.0, 0.0);
    for (k, step) in steps.iter().enumerate() {
        let step = match step {
            Step::Wait(length) => {
                end += length;
                continue;
            }
            Step::Move(step) => step,
        };
        let from = position;
        let generator = &step.request.generator;
        match (generator.distance(), step.positioning) {
            (Some(target), Positioning::Absolute) => position = target,
            (Some(distance), Positioning::Relative) => position += distance,
            (None, _) => {}
        }
        let aborted_after = match steps.get(k + 1) {
            Some(Step::Move(next)) => next.aborts_after,
            _ => None,
        };
        end += aborted_after.or(step.request.duration).unwrap_or_else(|| match generator {
            Generator::PointToPoint(asked) => least_move(&asked.limits, position - from),
            // Only the planner knows the effect of a start in motion, or of its jerk.
            Generator::Replanning(_) | Generator::Rockwell(_) => step.hold,
            Generator::Table(table) => {
                table.knots.last().map_or(0.0, |last| last.t) - table.knots.first().map_or(0.0, |first| first.t)
            }
        });
    }
    end
}

/// Shortest duration of a move over `distance` (s).
fn least_move(limits: &Limits, distance: f64) -> f64 {
    let (Limits { velocity, acceleration, .. }, distance) = (*limits, distance.abs());
    if velocity * velocity <= acceleration * distance {
        distance / velocity + velocity / acceleration
    } else {
        2.0 * (distance / acceleration).sqrt()
    }
}
