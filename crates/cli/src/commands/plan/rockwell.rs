//! A move by the operands of Rockwell's axis move.
use super::arguments::Arguments;
use crate::args::PlanArgs;
use servobench_motion::rockwell::{Jerk, MaximumJerk, Move, Shape, ShapeKind};
use servobench_planner::{Generator, Rockwell};
use servobench_scenario::Derivative;

/// The ways to say the jerk of a ramp: value, percent of time, percent of the maximum.
const UP: [&str; 3] = ["jerk", "jerk-percent-of-time", "jerk-percent-of-maximum"];
const DOWN: [&str; 3] =
    ["deceleration-jerk", "deceleration-jerk-percent-of-time", "deceleration-jerk-percent-of-maximum"];

pub(super) fn generator(args: &PlanArgs, arguments: &mut Arguments<'_>) -> Option<Generator> {
    let distance = arguments.needed_axis("distance", Derivative::Position, "how far the move goes, as \"100 mm\"");
    let speed = arguments.needed_axis("velocity", Derivative::Velocity, "the speed of the move, as \"0.2 m/s\"");
    let why = "a Rockwell move needs it, as \"10 m/s2\"";
    let acceleration = arguments.needed_axis("acceleration", Derivative::Acceleration, why);
    let deceleration = if arguments.is_given("deceleration") {
        arguments.axis("deceleration", Derivative::Acceleration)
    } else {
        acceleration
    };
    let said = UP.iter().chain(&DOWN).find(|flag| arguments.is_given(flag)).copied();
    arguments.take("shape");
    let shape = args.shape.unwrap_or(if said.is_some() { ShapeKind::SCurve } else { ShapeKind::Trapezoid });
    let (shape, needs_maximum) = match shape {
        ShapeKind::Trapezoid => {
            if let Some(said) = said {
                arguments.mistake(format!(
                    "--{said} is for --shape s-curve: a trapezoid takes all of --maximum-jerk; leave one of them out"
                ));
            }
            for flag in UP.into_iter().chain(DOWN) {
                arguments.take(flag);
            }
            (Some(Shape::Trapezoid), Some("a trapezoid takes it, as \"1000 m/s3\""))
        }
        ShapeKind::SCurve => {
            if !UP.iter().any(|flag| arguments.is_given(flag)) {
                arguments
                    .missing("jerk", "or --jerk-percent-of-time, or --jerk-percent-of-maximum: an S-curve needs one");
            }
            let acceleration = jerk(UP, arguments);
            let has_own = DOWN.iter().any(|flag| arguments.is_given(flag));
            let deceleration = if has_own { jerk(DOWN, arguments) } else { acceleration };
            let is_part = |jerk| matches!(jerk, Some(Jerk::PercentOfMaximum(_)));
            let needs_maximum = (is_part(acceleration) || is_part(deceleration))
                .then_some("a percentage of it is asked for; give it as \"1000 m/s3\"");
            let both = || Some(Shape::SCurve { acceleration: acceleration?, deceleration: deceleration? });
            (both(), needs_maximum)
        }
    };
    let maximum = match needs_maximum {
        Some(why) => arguments.needed_axis("maximum-jerk", Derivative::Jerk, why),
        None => Some(f64::INFINITY),
    }?;
    let operands = Move {
        distance: distance?,
        speed: speed?,
        acceleration: acceleration?,
        deceleration: deceleration?,
        shape: shape?,
    };
    let maximum = MaximumJerk { acceleration: maximum, deceleration: maximum };
    Some(Generator::Rockwell(Rockwell { operands, maximum }))
}

/// The jerk of a ramp in the way that is given.
fn jerk([value, of_time, of_maximum]: [&'static str; 3], arguments: &mut Arguments<'_>) -> Option<Jerk> {
    if arguments.is_given(value) {
        arguments.axis(value, Derivative::Jerk).map(Jerk::Value)
    } else if arguments.is_given(of_time) {
        arguments.percent(of_time).map(Jerk::PercentOfTime)
    } else {
        arguments.percent(of_maximum).map(Jerk::PercentOfMaximum)
    }
}
