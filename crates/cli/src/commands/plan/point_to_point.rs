//! A move from rest to rest.
use super::arguments::Arguments;
use crate::args::PlanArgs;
use crate::console::say;
use servobench_motion::{Limits, Order};
use servobench_planner::{Generator, Grid, Method, PointToPoint};
use servobench_scenario::Derivative;

pub(super) fn generator(args: &PlanArgs, arguments: &mut Arguments<'_>) -> Option<Generator> {
    let distance = arguments.needed_axis("distance", Derivative::Position, "how far the move goes, as \"1 m\"");
    let (order, limits) = order_and_limits(args, arguments);
    arguments.take("method");
    let method = args.method.unwrap_or_default();
    let grid = grid(args, method, arguments);
    Some(Generator::PointToPoint(PointToPoint { distance: distance?, order: order?, limits: limits?, method, grid }))
}

/// Order, and the limits that it uses.
pub(super) fn order_and_limits(args: &PlanArgs, arguments: &mut Arguments<'_>) -> (Option<Order>, Option<Limits>) {
    arguments.take("order");
    let order = args.order.and_then(Order::from_derivative);
    if order.is_none() {
        arguments.missing("order", "2 trapezoid, 3 jerk-limited, 4 snap-limited");
    }
    let mut needed = |name, derivative, from: usize, example: &str| {
        let is_used = order.is_none_or(|order| order.derivative() >= from);
        let is_needed = is_used && (order.is_some() || from <= 2);
        if is_needed && !arguments.is_given(name) {
            let of_order = order.map_or_else(String::new, |order| format!(" of order {}", order.derivative()));
            arguments.missing(name, &format!("a move{of_order} needs its limit, as \"{example}\""));
        }
        if !is_used && arguments.is_given(name) {
            say(&format!("--{name} is not used by a move of order {}\n", order.map_or(0, Order::derivative)));
        }
        let value = arguments.axis(name, derivative);
        if is_used { value } else { Some(f64::INFINITY) }
    };
    let velocity = needed("velocity", Derivative::Velocity, 1, "1 m/s");
    let acceleration = needed("acceleration", Derivative::Acceleration, 2, "5 m/s2");
    let jerk = needed("jerk", Derivative::Jerk, 3, "50 m/s3");
    let snap = needed("snap", Derivative::Snap, 4, "1000 m/s4");
    let limits = || Some(Limits { velocity: velocity?, acceleration: acceleration?, jerk: jerk?, snap: snap? });
    (order, limits())
}

/// How the move is sampled, if it is and that is right.
fn grid(args: &PlanArgs, method: Method, arguments: &mut Arguments<'_>) -> Option<Grid> {
    let sampled = ["sampling", "execution"].into_iter().filter(|name| arguments.take(name).is_some());
    let sampled: Vec<&str> = sampled.collect();
    if method == Method::Optimal && args.sampling.is_some() {
        arguments.mistake(
            "--sampling is for --method published: the shortest move has the fewest samples of all; leave it out",
        );
    }
    if !arguments.is_given("sample-time") {
        for name in sampled {
            arguments.missing("sample-time", &format!("--{name} needs one, as \"1 ms\""));
        }
        return None;
    }
    let sample_time = arguments.time("sample-time")?;
    let (sampling, execution) = (args.sampling.unwrap_or_default(), args.execution.unwrap_or_default());
    Some(Grid { sample_time, sampling, execution })
}
