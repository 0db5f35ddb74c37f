//! Sampled moves of any shape.
use crate::{ORDERS, is_finite, refused};
use servobench_base::Setpoint;
use servobench_fuzz::{Number, ValueGenerator, check, fuzz};
use servobench_motion::sampled::{Cascade, Execution, Shortest};
use servobench_motion::{Limits, Order, PlanError, Profile};

#[derive(Debug)]
struct Request {
    order: Order,
    distance: f64,
    limits: Limits,
    /// Approximate number of samples by moving averages; too many for a test are left out.
    samples: f64,
    /// Time of the check, absolute and as a share of the duration.
    t: f64,
}

fn requests() -> impl ValueGenerator<Output = Request> {
    let (number, magnitude) = (Number::any(), Number::magnitude());
    (0..3_usize, number, [magnitude; 4], 1..400_u32, number).map_gen(
        |(order, distance, [velocity, acceleration, jerk, snap], samples, t)| Request {
            order: ORDERS[order],
            distance,
            limits: Limits { velocity, acceleration, jerk, snap },
            samples: f64::from(samples),
            t,
        },
    )
}

/// The move, in samples of a share of the continuous duration.
fn planned(request: &Request) -> Result<Shortest, PlanError> {
    let Request { order, distance, limits, samples, .. } = *request;
    let duration = Profile::plan_optimal(order, distance, &limits)?.duration();
    Shortest::plan(order, distance, &limits, if duration > 0.0 { duration / samples } else { 1e-3 })
}

fn holds(plan: &Shortest, request: &Request) {
    let (duration, distance) = (plan.duration(), request.distance);
    let boxes = Profile::plan_fewest(plan.order(), distance, &request.limits, plan.sample_time()).unwrap();
    let most = boxes.samples().map_or(0, |samples| samples.total());
    assert!(plan.at_least() <= plan.samples() && plan.samples() <= most, "{plan:?}");
    for t in [duration, duration.next_up(), f64::MAX, f64::INFINITY] {
        assert_eq!(plan.at(t), Setpoint::at_rest(distance + 0.0), "at {t:e} of {plan:?}");
    }
    for t in [request.t, request.t * duration, duration.next_down(), 0.5 * duration] {
        assert!(is_finite(plan.at(t)), "at {t:e} of {plan:?}");
    }
    let Limits { velocity, acceleration, jerk, snap } = request.limits;
    for execution in [Execution::ForwardEuler, Execution::ExactHold] {
        let peaks = plan.peaks_by(execution);
        for (peak, limit) in
            [(peaks.velocity, velocity), (peaks.acceleration, acceleration), (peaks.jerk, jerk), (peaks.snap, snap)]
                .into_iter()
                .take(plan.order().derivative())
        {
            // Tolerance of the program for a limit, and the integration of some hundred runs.
            assert!(peak <= limit * (1.0 + 1e-10), "{execution:?}: {peak} {limit} of {plan:?}");
        }
    }
    let mut cascade = Cascade::at_rest(plan.order(), 0.0, plan.sample_time()).unwrap();
    let count = cascade.along(plan.runs()).inspect(|at| assert!(is_finite(*at), "{at:?} of {plan:?}")).count();
    assert_eq!(count as u64, plan.samples());
    // The rounding of the velocity, over all samples.
    let reach = distance.abs() + plan.peaks().velocity * duration;
    let off = (cascade.state().x - distance).abs();
    assert!(off <= 1e-10 * reach, "{off:e} of {plan:?}");
}

/// Found by libFuzzer: a cruise of 358 samples behind pulses of one, over which the rounding of the snap grew to 1.6e-10 of the
/// velocity.
#[test]
fn a_long_cruise_behind_short_pulses_keeps_its_limit() {
    let limits = Limits { velocity: 1.0, acceleration: 1.0, jerk: 1.0, snap: 1.0 };
    let request = Request { order: Order::Fourth, distance: -1e30, limits, samples: 358.0, t: -1.0 };
    holds(&planned(&request).unwrap(), &request);
}

#[test]
fn sampled_moves() {
    fuzz(check!(), 5_000, requests(), |request| match planned(request) {
        Ok(plan) => holds(&plan, request),
        Err(error) => refused(error, 0),
    });
}
