//! Transitions from any state.
use crate::{is_finite, refused};
use servobench_base::Setpoint;
use servobench_fuzz::{Number, ValueGenerator, check, fuzz};
use servobench_motion::online::{DirectionalLimits, Effort, RampLimits, Sides, Target, Transition};
use servobench_motion::{Order, PlanError};

#[derive(Debug)]
struct Request {
    order: Order,
    effort: Effort,
    from: Setpoint,
    target: Target,
    limits: DirectionalLimits,
}

fn requests() -> impl ValueGenerator<Output = Request> {
    let (number, magnitude) = (Number::any(), Number::magnitude());
    (0..3_usize, 0..8_u8, 0..6_u8, [number; 6], [magnitude; 6]).map_gen(
        |(order, effort, kind, [x, v, a, j, to_x, to_v], [v_below, v_above, a_below, a_above, jerk, snap])| Request {
            order: crate::ORDERS[order],
            effort: if effort == 0 { Effort::Refined } else { Effort::Fast },
            // A drive is at rest, or somewhere on its way.
            from: if kind == 0 { Setpoint::at_rest(x) } else { Setpoint { x, v, a, j, s: 0.0 } },
            target: match kind {
                1 => Target::Velocity(to_v.max(-v_below).min(v_above)),
                2 => Target::Velocity(to_v),
                3 => Target::Position { x: to_x, v: to_v },
                4 => Target::Position { x: to_x, v: to_v.max(-v_below).min(v_above) },
                _ => Target::Position { x: to_x, v: 0.0 },
            },
            limits: DirectionalLimits {
                velocity: Sides { below: v_below, above: v_above },
                acceleration: Sides { below: a_below, above: a_above },
                jerk,
                snap,
            },
        },
    )
}

#[test]
fn transitions() {
    fuzz(check!(), 10_000, requests(), |request| {
        let Request { order, effort, from, target, limits } = request;
        holds(request, &Transition::plan(*order, from, target, limits, *effort));
    });
}

#[test]
fn transitions_by_ramps() {
    fuzz(check!(), 10_000, requests(), |request| {
        let Request { order, effort, from, target, limits } = request;
        let DirectionalLimits { velocity, acceleration, jerk, snap } = *limits;
        let Sides { above: acceleration, below: deceleration } = acceleration;
        let limits = RampLimits { velocity, acceleration, deceleration, jerk, snap };
        holds(request, &Transition::plan_ramps(*order, from, target, &limits, *effort));
    });
}

fn holds(request: &Request, planned: &Result<Transition, PlanError>) {
    let way = match planned {
        Ok(way) => way,
        Err(error) => return refused(*error, 0),
    };
    assert!(way.duration() >= 0.0 && way.duration().is_finite(), "{way:?}");
    assert!(way.excess() >= 0.0 && way.excess().is_finite(), "{way:?}");
    let end = way.at(way.duration());
    match request.target {
        Target::Position { x, v } => assert_eq!(end, Setpoint { v, ..Setpoint::at_rest(x) }, "{way:?}"),
        Target::Velocity(v) => assert_eq!(end, Setpoint { v, ..Setpoint::at_rest(end.x) }, "{way:?}"),
    }
    let edges = way.segments().flat_map(|s| [s.start, s.start.next_down(), s.start + s.length / 2.0]);
    for t in edges.chain([0.0, -1.0, f64::NAN, way.duration().next_down(), way.duration()]) {
        assert!(is_finite(way.at(t)), "at {t:e}: {:?} of {way:?}", way.at(t));
    }
}
