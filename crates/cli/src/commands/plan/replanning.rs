//! A move from a state of motion.
use super::arguments::Arguments;
use super::point_to_point::order_and_limits;
use crate::args::PlanArgs;
use servobench_base::Setpoint;
use servobench_motion::online::{DirectionalLimits, Sides, Target};
use servobench_planner::{Generator, Replanning};
use servobench_scenario::Derivative;

/// What only a move from a state of motion has.
const FLAGS: [&str; 9] = [
    "start-velocity",
    "start-acceleration",
    "start-jerk",
    "start-position",
    "end-velocity",
    "to-velocity",
    "negative-velocity",
    "negative-acceleration",
    "online",
];

/// Whether such a move is asked for.
pub(super) fn is_meant(arguments: &Arguments<'_>) -> bool {
    FLAGS.iter().any(|flag| arguments.is_given(flag))
}

pub(super) fn generator(args: &PlanArgs, arguments: &mut Arguments<'_>) -> Option<Generator> {
    let said = FLAGS.into_iter().find(|flag| arguments.is_given(flag)).unwrap_or("online");
    for flag in ["method", "sampling", "execution"] {
        if arguments.take(flag).is_some() {
            arguments.mistake(format!("--{flag} is for a move from rest to rest: leave it out, or leave out --{said}"));
        }
    }
    let distance = if arguments.is_given("to-velocity") {
        None
    } else {
        let why = "how far the move goes, as \"1 m\"; or go to a velocity by --to-velocity";
        Some(arguments.needed_axis("distance", Derivative::Position, why))
    };
    let velocity = arguments.axis("to-velocity", Derivative::Velocity);
    let (order, limits) = order_and_limits(args, arguments);
    for (flag, quantity, lowest) in [("start-acceleration", "acceleration", 3), ("start-jerk", "jerk", 4)] {
        if let Some(own) = args.order.filter(|own| *own < lowest)
            && arguments.is_given(flag)
        {
            arguments.mistake(format!(
                "--{flag} is not used by a move of order {own}, whose {quantity} may jump: leave it out, or choose --order \
                 {lowest}"
            ));
        }
    }
    let mut start = |name, derivative| {
        if arguments.is_given(name) { arguments.axis(name, derivative) } else { Some(0.0) }
    };
    let x = start("start-position", Derivative::Position);
    let v = start("start-velocity", Derivative::Velocity);
    let a = start("start-acceleration", Derivative::Acceleration);
    let j = start("start-jerk", Derivative::Jerk);
    let end_velocity = start("end-velocity", Derivative::Velocity);
    let negative_velocity = arguments.magnitude("negative-velocity", Derivative::Velocity);
    let negative_acceleration = arguments.magnitude("negative-acceleration", Derivative::Acceleration);
    arguments.take("online");
    let effort = args.online.unwrap_or_default();
    let limits = limits?;
    let sides = |above: f64, below: Option<f64>| Sides { above, below: below.unwrap_or(above) };
    let limits = DirectionalLimits {
        velocity: sides(limits.velocity, negative_velocity),
        acceleration: sides(limits.acceleration, negative_acceleration),
        jerk: limits.jerk,
        snap: limits.snap,
    };
    let from = Setpoint { x: x?, v: v?, a: a?, j: j?, s: 0.0 };
    let target = match distance {
        Some(distance) => Target::Position { x: from.x + distance?, v: end_velocity? },
        None => Target::Velocity(velocity?),
    };
    Some(Generator::Replanning(Replanning { from, target, order: order?, limits, effort }))
}
