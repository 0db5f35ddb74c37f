//! Positions of a plan beyond its ends, and sample instants of a shaped plan.
use servobench_base::Setpoint;
use servobench_motion::online::{DirectionalLimits, Effort, Target};
use servobench_motion::shape::Shaper;
use servobench_motion::{Limits, Order, PlanError};
use servobench_planner::{Filter, Generator, Grid, Method, PointToPoint, Replanning, Request, Shaping};

const LIMITS: Limits = Limits { velocity: 1.0, acceleration: 2.0, jerk: 20.0, snap: 400.0 };

/// Oracle: a thousand set-points a second.
#[test]
fn the_positions_of_a_move_that_turns_round_are_beyond_its_target() -> Result<(), PlanError> {
    for order in [Order::Second, Order::Third, Order::Fourth] {
        let from = Setpoint { v: 0.9, ..Setpoint::default() };
        let (target, limits) = (Target::Position { x: 0.1, v: 0.0 }, DirectionalLimits::from(LIMITS));
        let replanning = Replanning { from, target, order, limits, effort: Effort::Fast };
        let plan = Request::new(Generator::Replanning(replanning)).plan()?;
        let reached = plan.positions();
        let sampled = (0..5000).map(|k| plan.at(f64::from(k) * 1e-3).x).fold(0.0, f64::max);
        // Next to the turn x is flat: a/2 times the square of half a millisecond.
        assert!(reached.highest >= sampled && reached.highest - sampled < 3e-7, "{reached:?} {sampled}");
        assert!(reached.highest > 0.2 && reached.lowest == 0.0, "{reached:?}");
    }
    Ok(())
}

/// Regression: such a move lasted 551.667 ms, with rows 0.552 ms apart.
#[test]
fn a_sampled_move_behind_a_shaper_stays_on_its_grid() -> Result<(), PlanError> {
    let limits = Limits { acceleration: 5.0, jerk: 500.0, ..LIMITS };
    let (order, method, grid) = (Order::Third, Method::Published, Some(Grid::new(1e-3)));
    let generator = Generator::PointToPoint(PointToPoint { distance: 0.3, order, limits, method, grid });
    let shapers = vec![Shaping { shaper: Shaper::Zv, frequency: 12.0, damping: 0.0 }];
    let plan = Request { filter: Filter { shapers, averages: None }, ..Request::new(generator) }.plan()?;
    for time in plan.spans().map(|span| span.start).chain([plan.duration()]) {
        let samples = time / 1e-3;
        assert!((samples - samples.round()).abs() < 1e-6, "{samples}");
    }
    Ok(())
}
