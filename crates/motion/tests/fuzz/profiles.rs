//! Moves from rest to rest.
use crate::{ORDERS, is_finite, refused};
use servobench_base::Setpoint;
use servobench_fuzz::{Number, ValueGenerator, check, fuzz};
use servobench_motion::sampled::Cascade;
use servobench_motion::{Limits, Order, Profile};

#[derive(Debug)]
struct Request {
    order: Order,
    distance: f64,
    limits: Limits,
    sample_time: f64,
    /// Time to look at, as it is and as a part of the duration.
    t: f64,
    /// Duration to stretch to, as it is and as a part of the duration.
    longer: f64,
}

fn requests() -> impl ValueGenerator<Output = Request> {
    let (number, magnitude) = (Number::any(), Number::magnitude());
    (0..3_usize, number, [magnitude; 4], magnitude, number, magnitude).map_gen(
        |(order, distance, [velocity, acceleration, jerk, snap], sample_time, t, longer)| Request {
            order: ORDERS[order],
            distance,
            limits: Limits { velocity, acceleration, jerk, snap },
            sample_time,
            t,
            longer,
        },
    )
}

fn holds(plan: &Profile, request: &Request) {
    let (duration, distance) = (plan.duration(), request.distance);
    assert!(duration >= 0.0 && duration.is_finite(), "{plan:?}");
    for t in [duration, duration.next_up(), f64::MAX, f64::INFINITY] {
        assert_eq!(plan.at(t), Setpoint::at_rest(distance + 0.0), "at {t:e} of {plan:?}");
    }
    let segments: Vec<_> = plan.segments().collect();
    assert_eq!(segments.is_empty(), distance == 0.0, "{plan:?}");
    let edges = segments.iter().flat_map(|s| [s.start, s.start.next_down(), s.start + s.length / 2.0]);
    for t in [request.t, request.t * duration, duration.next_down(), 0.5 * duration].into_iter().chain(edges) {
        let at = plan.at(t);
        assert!(is_finite(at) && at.x.abs() <= distance.abs(), "at {t:e}: {at:?} of {plan:?}");
    }
    let (peaks, limits) = (plan.peaks(), request.limits);
    for (k, (peak, limit)) in [
        (peaks.velocity, limits.velocity),
        (peaks.acceleration, limits.acceleration),
        (peaks.jerk, limits.jerk),
        (peaks.snap, limits.snap),
    ]
    .into_iter()
    .enumerate()
    {
        // Some roundings of a product of four.
        assert!(k >= plan.order().derivative() || peak <= limit * (1.0 + 1e-13), "{peak} {limit} of {plan:?}");
    }
    assert!(plan.cruise() >= 0.0 && plan.times().is_none_or(|times| times.t_a >= 0.0), "{plan:?}");
}

/// The cascade is at rest on the distance after the last sample.
fn cascades(plan: &Profile) {
    let Some(samples) = plan.samples().filter(|samples| samples.total() <= 2_000) else { return };
    let mut cascade = Cascade::at_rest(plan.order(), 0.0, samples.time).unwrap();
    let count = cascade.along(plan.runs()).inspect(|at| assert!(is_finite(*at), "{at:?} of {plan:?}")).count();
    assert_eq!(count as u64, samples.total());
    // The rounding of the velocity, over all samples.
    let reach = plan.distance().abs() + plan.peaks().velocity * plan.duration();
    let off = (cascade.state().x - plan.distance()).abs();
    assert!(off <= 1e-12 * reach, "{off:e} of {plan:?}");
}

#[test]
fn moves() {
    fuzz(check!(), 20_000, requests(), |request| {
        let Request { order, distance, limits, sample_time, longer, .. } = *request;
        let plans = [
            Profile::plan(order, distance, &limits),
            Profile::plan_optimal(order, distance, &limits),
            Profile::plan_sampled(order, distance, &limits, sample_time),
            Profile::plan_fewest(order, distance, &limits, sample_time),
        ];
        for plan in plans {
            match plan {
                Ok(plan) => {
                    holds(&plan, request);
                    cascades(&plan);
                    for duration in [longer, longer * plan.duration()] {
                        match plan.stretched_to(duration) {
                            Ok(stretched) => {
                                holds(&stretched, request);
                                cascades(&stretched);
                                assert!(stretched.duration() >= plan.duration() * (1.0 - 1e-15), "{stretched:?}");
                            }
                            Err(error) => refused(error, 0),
                        }
                    }
                }
                Err(error) => refused(error, 0),
            }
        }
        if let (Ok(published), Ok(optimal)) = (&plans[0], &plans[1]) {
            // Two sums of ten roundings.
            assert!(optimal.duration() <= published.duration() * (1.0 + 1e-14), "{published:?} {optimal:?}");
        }
    });
}

#[test]
fn what_is_not_positive() {
    fuzz(check!(), 5_000, Number::any(), |value| {
        let (limits, wrong) = (Limits { velocity: 1.0, acceleration: 1.0, jerk: 1.0, snap: 1.0 }, -value.abs());
        for limits in [
            Limits { velocity: wrong, ..limits },
            Limits { acceleration: wrong, ..limits },
            Limits { jerk: wrong, ..limits },
            Limits { snap: wrong, ..limits },
        ] {
            assert!(Profile::plan(Order::Fourth, 1.0, &limits).is_err(), "{limits:?}");
        }
        assert!(Profile::plan_sampled(Order::Fourth, 1.0, &limits, wrong).is_err(), "{wrong}");
    });
}
