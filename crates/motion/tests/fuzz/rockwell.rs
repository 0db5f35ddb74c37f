//! The axis move.
use crate::{is_finite, refused};
use servobench_base::Setpoint;
use servobench_fuzz::{Number, ValueGenerator, check, fuzz};
use servobench_motion::rockwell::{Jerk, MaximumJerk, Move, Shape};

fn jerk() -> impl ValueGenerator<Output = Jerk> {
    (0..3_u8, Number::magnitude()).map_gen(|(kind, value)| match kind {
        0 => Jerk::Value(value),
        1 => Jerk::PercentOfMaximum(value),
        _ => Jerk::PercentOfTime(value),
    })
}

fn moves() -> impl ValueGenerator<Output = (Move, MaximumJerk)> {
    let shape = (0..3_u8, jerk(), jerk()).map_gen(|(kind, acceleration, deceleration)| match kind {
        0 => Shape::Trapezoid,
        _ => Shape::SCurve { acceleration, deceleration },
    });
    (Number::any(), [Number::magnitude(); 5], shape).map_gen(|(distance, magnitudes, shape)| {
        let [speed, acceleration, deceleration, up, down] = magnitudes;
        (
            Move { distance, speed, acceleration, deceleration, shape },
            MaximumJerk { acceleration: up, deceleration: down },
        )
    })
}

#[test]
fn axis_moves() {
    fuzz(check!(), 20_000, moves(), |(request, maximum)| {
        let plan = match request.plan(maximum) {
            Ok(plan) => plan,
            Err(error) => return refused(error, 0),
        };
        assert!(plan.duration() >= 0.0 && plan.duration().is_finite(), "{plan:?}");
        assert_eq!(plan.at(plan.duration()), Setpoint::at_rest(request.distance + 0.0));
        let end = plan.at(plan.duration().next_down());
        // Seven segments of up to the whole distance each, and an inner root where there is no cruise.
        assert!((end.x - request.distance).abs() <= 1e-12 * request.distance.abs(), "{end:?} of {plan:?}");
        for segment in plan.segments() {
            for t in [segment.start, segment.start + segment.length / 2.0, segment.start.next_down()] {
                let at = plan.at(t);
                assert!(is_finite(at), "at {t:e}: {at:?} of {plan:?}");
                assert!(at.v.abs() <= request.speed * (1.0 + 1e-12), "at {t:e}: {at:?} of {plan:?}");
                let most = request.acceleration.max(request.deceleration);
                assert!(at.a.abs() <= most * (1.0 + 1e-12), "at {t:e}: {at:?} of {plan:?}");
            }
        }
    });
}
