//! Moves as points, and the deviation of the trajectory through them.
use servobench_base::Setpoint;
use servobench_motion::online::{DirectionalLimits, Effort, Sides, Target};
use servobench_motion::sampled::Execution;
use servobench_motion::{Limits, Order};
use servobench_planner::{
    Generator, Grid, Method, Plan, PointMove, PointTimes, PointToPoint, Replanning, Request, Sampling,
};

const LIMITS: Limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };

fn plan(order: Order, distance: f64, grid: Option<Grid>) -> Plan {
    let asked = PointToPoint { distance, order, limits: LIMITS, method: Method::Published, grid };
    Request::new(Generator::PointToPoint(asked)).plan().unwrap()
}

/// The deviation found by dense sampling of the move and of the trajectory through its points.
fn seen(plan: &Plan, points: &PointMove) -> f64 {
    let end = plan.duration().max(points.way.duration());
    (0..=200_000)
        .map(|k| end * f64::from(k) / 200_000.0)
        .fold(0.0, |most, t| most.max((plan.at(t).x - points.way.at(t).x).abs()))
}

/// Oracle: the error of the cubic through the ends of an interval h of constant fourth derivative s with the velocities there,
/// s/24·τ²(h − τ)², which is s·h⁴/384 in the middle. At order 4 snap is 1000 m/s⁴ over intervals of 50 ms; 10 ms fit into them.
#[test]
fn at_constant_snap_the_deviation_is_that_of_the_cubic() {
    let plan = plan(Order::Fourth, 1.0, None);
    let points = plan.in_points(PointTimes::every(0.01)).unwrap();
    let expected = 1000.0 * 0.01_f64.powi(4) / 384.0;
    assert!((points.deviation.distance / expected - 1.0).abs() < 1e-6, "{:?}", points.deviation);
    assert_eq!((points.knots.len(), points.knots[7].t.to_bits()), (136, 0.07_f64.to_bits()));
    // It is the same in the middle of each interval at the peak of snap.
    let place = points.deviation.time / 0.01;
    assert!((place.fract() - 0.5).abs() < 1e-4, "{:?}", points.deviation);
}

/// Oracle: at order 3 each segment is a cubic; points at its ends leave only rounding of positions of 1 m.
#[test]
fn where_points_are_at_the_ends_of_segments_the_way_is_the_move() {
    // 0.1 s of jerk, 0.1 s of acceleration, 0.7 s of cruise.
    let plan = plan(Order::Third, 1.0, None);
    for spacing in [0.1, 0.05, 0.01] {
        let points = plan.in_points(PointTimes::every(spacing)).unwrap();
        assert!(points.deviation.distance < 1e-14, "{spacing}: {:?}", points.deviation);
        assert!((points.way.duration() - 1.3).abs() < 1e-12);
    }
    let between = plan.in_points(PointTimes::every(0.03)).unwrap();
    assert!(between.deviation.distance > 1e-6, "{:?}", between.deviation);
}

/// Oracle: 200 000 samples. Between two of them, 7 µs apart, the distance changes by at most the difference of velocities, which
/// is that of the accelerations (below 10 m/s²) over an interval: far below a thousandth of the result.
#[test]
fn the_deviation_is_what_is_seen() {
    let euler = Grid { sample_time: 4e-3, sampling: Sampling::Published, execution: Execution::ForwardEuler };
    for (order, distance, grid) in [
        (Order::Second, 0.37, None),
        (Order::Third, 0.0123, None),
        (Order::Third, -0.37, None),
        (Order::Fourth, 0.37, None),
        (Order::Fourth, 0.2, Some(euler)),
    ] {
        let plan = plan(order, distance, grid);
        for spacing in [0.004, 0.0137, 0.05, 0.255, 3.0] {
            let points = plan.in_points(PointTimes::every(spacing)).unwrap();
            let (found, seen) = (points.deviation.distance, seen(&plan, &points));
            assert!(
                found >= seen - 1e-12 && found <= seen * 1.001 + 1e-9,
                "{order:?} {distance} {spacing}: {found} {seen}"
            );
        }
    }
}

/// The last point is at the first whole millisecond at which the move is at rest, if the others are at whole ones.
#[test]
fn the_last_point_ends_the_move() {
    let plan = plan(Order::Third, 0.3712, None);
    let duration = plan.duration();
    assert!((duration * 1e3).fract() > 1e-3, "{duration}");
    let last = |spacing: f64| *plan.in_points(PointTimes::every(spacing)).unwrap().knots.last().unwrap();
    assert_eq!(last(0.008).t.to_bits(), ((duration * 1e3).ceil() / 1e3).to_bits());
    assert_eq!(last(0.0083).t.to_bits(), duration.to_bits());
    for spacing in [0.008, 0.0083] {
        assert_eq!((last(spacing).x.to_bits(), last(spacing).v), (0.3712_f64.to_bits(), Some(0.0)));
    }
    // Equal times throughout, for drives with a single time for all points.
    let equal = plan.in_points(PointTimes { spacing: 0.008, unit: 0.008 }).unwrap();
    for pair in equal.knots.windows(2) {
        assert!((pair[1].t - pair[0].t - 0.008).abs() < 1e-12);
    }
}

/// A move that ends in motion has its last point at its end.
#[test]
fn a_move_that_ends_in_motion_has_its_last_point_there() {
    let limits = DirectionalLimits {
        velocity: Sides::both(1.0),
        acceleration: Sides::both(5.0),
        jerk: 50.0,
        snap: f64::INFINITY,
    };
    let (from, target) = (Setpoint { v: 0.2, ..Setpoint::default() }, Target::Position { x: 0.3, v: 0.5 });
    let asked = Replanning { from, target, order: Order::Third, limits, effort: Effort::Fast };
    let plan = Request::new(Generator::Replanning(asked)).plan().unwrap();
    let points = plan.in_points(PointTimes::every(0.01)).unwrap();
    let (first, last) = (points.knots[0], *points.knots.last().unwrap());
    assert_eq!((first.x, first.v), (0.0, Some(0.2)));
    assert!(
        (last.t - plan.duration()).abs() == 0.0 && (last.v.unwrap() - 0.5).abs() < 1e-9 && (last.x - 0.3).abs() < 1e-9
    );
}

/// The longest spacing keeps the requested deviation, and a longer one does not.
#[test]
fn the_fewest_points_keep_the_deviation() {
    let plan = plan(Order::Fourth, 0.37, None);
    let (times, points) = plan.in_fewest_points(1e-6).unwrap();
    assert!(points.deviation.distance <= 1e-6 && times.spacing > 2e-3, "{times:?}");
    for milliseconds in 1..=255 {
        let spacing = f64::from(milliseconds) / 1e3;
        if spacing > times.spacing {
            assert!(plan.in_points(PointTimes::every(spacing)).unwrap().deviation.distance > 1e-6, "{spacing}");
        }
    }
    let refused = plan.in_fewest_points(1e-15).unwrap_err().to_string();
    assert!(refused.contains("allowed_deviation") && refused.contains("every millisecond"), "{refused}");
    assert!(plan.in_fewest_points(0.0).is_err() && plan.in_fewest_points(f64::NAN).is_err());
}

#[test]
fn odd_times_and_moves() {
    let plan = plan(Order::Third, 1.0, None);
    for spacing in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-9] {
        let refused = plan.in_points(PointTimes::every(spacing)).map(|points| points.knots.len());
        assert!(refused.is_err_and(|error| error.to_string().contains("point_time")), "{spacing}");
    }
    // Longer than the move: its two ends.
    assert_eq!(plan.in_points(PointTimes::every(1e6)).unwrap().knots.len(), 2);
    // A move without distance rests for a millisecond, so that it is a table.
    let still = self::plan(Order::Third, 0.0, None).in_points(PointTimes::every(0.01)).unwrap();
    assert_eq!((still.knots.len(), still.knots[1].t, still.deviation.distance), (2, 1e-3, 0.0));
    assert!(self::plan(Order::Third, 0.0, None).in_points(PointTimes::every(0.0101)).is_err());
}
