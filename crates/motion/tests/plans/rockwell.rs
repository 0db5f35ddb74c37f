//! Rockwell's Motion Axis Move.
use crate::requests::{Random, request, sweep_size};
use servobench_motion::rockwell::{Jerk, MaximumJerk, Move, Shape};
use servobench_motion::{Limits, Order, Profile};

/// 100 mm at 200 mm/s, accelerated and decelerated with 100 000 mm/s², in m.
fn printed(shape: Shape) -> Move {
    Move { distance: 0.1, speed: 0.2, acceleration: 100.0, deceleration: 100.0, shape }
}

fn s_curve(jerk: Jerk) -> Shape {
    Shape::SCurve { acceleration: jerk, deceleration: jerk }
}

/// Oracle: the printed times and jerks, 2.00 / 4.00 / 2.2857 ms and 5e7 / 3.5e8 mm/s³; the distances are half the speed
/// times the length, 0.2 / 0.4 / 0.22857 mm, and not those printed.
#[test]
fn the_printed_examples() {
    // The trapezoid of the drawing: the axis' jerk so large that its 2 ms are 2 ms to 1e-13.
    let sharp = MaximumJerk { acceleration: 1e18, deceleration: 1e18 };
    let mild = MaximumJerk { acceleration: 1e9, deceleration: 1e9 };
    for (shape, maximum, time, jerk) in [
        (Shape::Trapezoid, sharp, 2e-3, 1e18),
        (s_curve(Jerk::PercentOfTime(100.0)), mild, 4e-3, 5e4),
        (s_curve(Jerk::PercentOfTime(25.0)), mild, 16e-3 / 7.0, 3.5e5),
        (s_curve(Jerk::Value(5e4)), mild, 4e-3, 5e4),
        (s_curve(Jerk::PercentOfMaximum(0.005)), mild, 4e-3, 5e4),
        // 25 % of 16/7 ms, half at either end: 2/7 ms. Of a second no more than half of the ramp counts, which is 100 %.
        (s_curve(Jerk::Time(2e-3 / 7.0)), mild, 16e-3 / 7.0, 3.5e5),
        (s_curve(Jerk::Time(1.0)), mild, 4e-3, 5e4),
        // A master at 360 degrees per second.
        (s_curve(Jerk::MasterUnits { way: 0.72 / 7.0, speed: 360.0 }), mild, 16e-3 / 7.0, 3.5e5),
    ] {
        let way = printed(shape).plan(&maximum).unwrap();
        let mut cruise = way.segments().filter(|segment| segment.length > 0.1);
        let cruise = cruise.next().unwrap();
        assert!((cruise.start / time - 1.0).abs() < 1e-12, "{shape:?}: {}", cruise.start);
        assert!((way.at(cruise.start).x / (0.1 * time) - 1.0).abs() < 1e-12, "{shape:?}: {:?}", way.at(cruise.start));
        assert!((way.segments().next().unwrap().value / jerk - 1.0).abs() < 1e-12, "{shape:?}");
        // 100 mm less twice half a ramp's way, at speed.
        assert!((way.duration() / (0.5 + time) - 1.0).abs() < 1e-12, "{shape:?}: {}", way.duration());
    }
}

/// Oracle: with the same acceleration and deceleration, and the same jerk, it is the jerk-limited profile.
#[test]
fn a_symmetric_move_is_the_profile_of_order_3() {
    let mut random = Random::seeded(46);
    for _ in 0..sweep_size() / 4 {
        let request = request(&mut random);
        let Limits { velocity, acceleration, jerk, .. } = request.limits;
        let Ok(profile) = Profile::plan(Order::Third, request.distance, &request.limits) else { continue };
        let maximum = MaximumJerk { acceleration: jerk, deceleration: jerk };
        let made = Move {
            distance: request.distance,
            speed: velocity,
            acceleration,
            deceleration: acceleration,
            shape: Shape::Trapezoid,
        };
        let way = made.plan(&maximum).unwrap();
        let ratio = way.duration() / profile.duration();
        assert!((ratio - 1.0).abs() < 1e-12, "{request:?}: {ratio}");
    }
}

/// The end is met by the polynomials themselves, whatever the sides of the move.
#[test]
fn it_ends_where_it_is_to_end_and_keeps_its_operands() {
    let mut random = Random::seeded(47);
    for _ in 0..sweep_size() / 4 {
        let (up, down) = (request(&mut random), request(&mut random));
        let shape = match random.index(3) {
            0 => Shape::Trapezoid,
            1 => s_curve(Jerk::PercentOfTime(1.0 + 99.0 * random.unit())),
            _ => Shape::SCurve {
                acceleration: Jerk::PercentOfMaximum(1.0 + 99.0 * random.unit()),
                deceleration: Jerk::Value(down.limits.jerk),
            },
        };
        let made = Move {
            distance: up.distance,
            speed: up.limits.velocity,
            acceleration: up.limits.acceleration,
            deceleration: down.limits.acceleration,
            shape,
        };
        let way = made.plan(&MaximumJerk { acceleration: up.limits.jerk, deceleration: down.limits.jerk }).unwrap();
        let shortest = way.segments().map(|segment| segment.length).fold(f64::INFINITY, f64::min);
        if shortest < 1e-6 * way.duration() {
            // Its end cannot be told from the floats beside it.
            continue;
        }
        let before = way.at(way.duration().next_down());
        // Seven segments, whose lengths round at the size of the duration.
        assert!((before.x / made.distance - 1.0).abs() < 1e-11, "{made:?}: {before:?}");
        let peak = way.segments().map(|segment| way.at(segment.start).v.abs()).fold(0.0, f64::max);
        assert!(peak <= made.speed * (1.0 + 1e-11), "{made:?}: {peak}");
        // And one float of time before the end.
        let late = before.a.abs() * f64::EPSILON * way.duration();
        assert!(before.v.abs() <= 1e-11 * peak + late, "{made:?}: {before:?}");
    }
}

#[test]
fn wrong_operands_are_refused_by_name() {
    let maximum = MaximumJerk { acceleration: 1e3, deceleration: 1e3 };
    let said = |made: Move| made.plan(&maximum).unwrap_err().to_string();
    let good = printed(Shape::Trapezoid);
    assert_eq!(said(Move { speed: 0.0, ..good }), "`speed` must be finite and positive, got 0");
    assert_eq!(said(Move { deceleration: f64::NAN, ..good }), "`deceleration` must be finite and positive, got NaN");
    assert_eq!(said(Move { distance: f64::INFINITY, ..good }), "`distance` must be finite, got inf");
    let percent = Move { shape: s_curve(Jerk::PercentOfTime(101.0)), ..good };
    assert_eq!(said(percent), "`jerk_percent_of_time` must be above 0 % and at most 100 %, got 101");
    assert_eq!(Move { distance: 0.0, ..good }.plan(&maximum).unwrap().duration().to_bits(), 0);
}

/// Found by the fuzz target: a speed 1e42 times the one that is reached, from which the search did not get down.
#[test]
fn the_speed_that_was_asked_for_may_be_far_away() {
    let jerks = Shape::SCurve { acceleration: Jerk::Value(1e-30), deceleration: Jerk::Value(1e-3) };
    let request = Move { speed: 1e30, distance: -1e-3, ..printed(jerks) };
    let way = request.plan(&MaximumJerk { acceleration: 1.0, deceleration: 1.0 }).unwrap();
    // The four jerks alone: v = (distance/(1/√J1 + 1/√J2))^(2/3).
    let peak = (1e-3 / (1e15 + 1e3_f64.sqrt())).powf(2.0 / 3.0);
    let reached = way.segments().map(|segment| way.at(segment.start).v.abs()).fold(0.0, f64::max);
    assert!((reached / peak - 1.0).abs() < 1e-14, "{reached:e} {peak:e}");
    let before = way.at(way.duration().next_down()).x;
    assert!((before / -1e-3 - 1.0).abs() < 1e-12, "{before}");
}
