//! Long distances: held values are held, and nothing drifts.
use crate::random::{Random, sweep_size};
use crate::request::{Request, jump};
use servobench_base::Setpoint;
use servobench_motion::Order;
use servobench_motion::online::{DirectionalLimits, Effort, Sides, Target, Transition};

/// Velocity, acceleration, jerk and snap of axes as they are.
const AXES: [[f64; 4]; 4] =
    [[1.0, 5.0, 50.0, 1000.0], [0.1, 2.0, 100.0, 1e4], [0.01, 1.0, 50.0, 5e3], [0.001, 1.0, 100.0, 1e4]];

/// 100 s to a day.
const TIMES: [f64; 5] = [100.0, 1000.0, 3600.0, 36_000.0, 86_400.0];

/// Relative to the distance, whose rounding is that of positions: four numbers are added up, of which the cruise is nearly all.
const ROUNDING: f64 = 1e-12;

/// Checks `planned` against its target, its limits, and its own list of segments; returns the jump at its end relative to the distance.
fn check(request: &Request, planned: &Transition) -> f64 {
    let Request { order, from, limits, .. } = request;
    let end = planned.at(planned.duration());
    let way = (end.x - from.x).abs() + planned.duration() * f64::EPSILON * limits.velocity.above;
    let context = || format!("{request:?}: {planned:?}");
    let [x, v, a, j] = jump(planned);
    let Sides { below, above } = limits.velocity;
    assert!(x <= ROUNDING * way, "{x} of {way} {}", context());
    assert!(v <= ROUNDING * (below + above), "{v} {}", context());
    let Sides { below, above } = limits.acceleration;
    assert!(*order == Order::Second || a <= ROUNDING * (below + above), "{a} {}", context());
    assert!(*order < Order::Fourth || j <= ROUNDING * limits.jerk, "{j} {}", context());
    // Executing the list comes to the same end.
    let mut state = Setpoint { s: 0.0, ..*from };
    let mut listed = 0.0;
    for segment in planned.segments() {
        let at = planned.at(segment.start);
        let excess = (at.v - limits.velocity.above).max(-limits.velocity.below - at.v) / limits.velocity.above;
        assert!(excess <= planned.excess() + ROUNDING, "{excess} {}", context());
        // Its states are those of the plan except for rounding, and its held values are the same.
        state = Setpoint { x: state.x, ..at };
        state = state.after(segment.length);
        listed += segment.length;
    }
    assert!((state.x - end.x).abs() <= ROUNDING * way, "{} {}", state.x - end.x, context());
    assert!((listed - planned.duration()).abs() <= ROUNDING * listed, "{listed} {}", context());
    x / way
}

#[test]
fn a_day_of_cruising_ends_where_it_should() {
    let mut random = Random::seeded(11);
    let starts = sweep_size(100_000) / 1000;
    for order in [Order::Second, Order::Third, Order::Fourth] {
        for [v, a, jerk, snap] in AXES {
            for time in TIMES {
                let mut worst = 0.0_f64;
                for k in 0..starts {
                    let limits = DirectionalLimits {
                        velocity: Sides { below: v * (0.7 + 0.3 * random.unit()), above: v },
                        acceleration: Sides { below: a * (0.7 + 0.3 * random.unit()), above: a },
                        jerk,
                        snap,
                    };
                    let from = match k % 3 {
                        0 => Setpoint { v: v * random.signed(), a: a * random.signed(), ..Setpoint::default() },
                        1 => Setpoint { v: v * random.signed(), j: jerk * random.signed(), ..Setpoint::default() },
                        _ => Setpoint::default(),
                    };
                    let x = v * time * (1.0 + 0.1 * random.signed()) * random.signed().signum();
                    let passing = if random.unit() < 0.5 { 0.0 } else { limits.velocity.below * random.signed() };
                    let request = Request { order, from, target: Target::Position { x, v: passing }, limits };
                    for effort in [Effort::Fast, Effort::Refined] {
                        worst = worst.max(check(&request, &request.plan(effort)));
                    }
                }
                println!("{order:?}, {v} m/s, {time} s: {worst:.1e} of the way at most");
            }
        }
    }
}

/// Paths on which a residue of the jerk was integrated: 0.216 mm after an hour, 6 cm after 60 km.
#[test]
fn cruises_that_drifted() {
    for line in [
        "4 P 0 0.0004684556180070023 -0.2562225674026245 0 3.93192793915462 0 0.001 0.001 1 1 100 10000.0",
        "4 P 0 0 0 0 6.0379358278235806e4 0 1.2423240801765095e2 8.214032789040915e1 6.170800428322001e4 \
         1.5439161503958252e4 4.844109520608935e7 5.1918518750781775e8",
    ] {
        let request = Request::parse(line);
        check(&request, &request.plan(Effort::Fast));
    }
}

/// A hold of the acceleration lasts as long with a velocity limit that is never reached: x = a·t²/4 to rest.
#[test]
fn a_day_of_acceleration_ends_where_it_should() {
    for time in TIMES {
        let limits = DirectionalLimits {
            velocity: Sides::both(1e9),
            acceleration: Sides { below: 0.3, above: 0.7 },
            jerk: 50.0,
            snap: 1000.0,
        };
        for order in [Order::Second, Order::Third, Order::Fourth] {
            let from = Setpoint { v: 0.1, a: 0.23, j: -3.1, ..Setpoint::default() };
            for v in [0.0, 7.3] {
                let target = Target::Position { x: 0.21 * time * time, v };
                let request = Request { order, from, target, limits };
                check(&request, &request.plan(Effort::Fast));
            }
        }
    }
}
