//! The forward-Euler cascade, against the four sums written out and against the exact hold.
use crate::requests::{Random, request, sweep_size};
use servobench_base::Setpoint;
use servobench_motion::sampled::{Cascade, Run};
use servobench_motion::{Limits, Order, PlanError, Profile};

const LIMITS: Limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
const ORDERS: [Order; 3] = [Order::Second, Order::Third, Order::Fourth];

fn values(s: Setpoint) -> [f64; 5] {
    [s.x, s.v, s.a, s.j, s.s]
}

/// Oracle: whole numbers. With Ts = 1 and a whole amplitude every sum of the cascade is exact in `f64`; it ends at the product of
/// the lengths, at sample N and not before, after a standstill of n − 1 samples.
#[test]
fn it_lands_on_the_product_of_the_boxes_at_sample_n_exactly() {
    for boxes in [vec![3, 5], vec![2, 3, 7], vec![1, 1, 2, 4], vec![3, 4, 8, 20], vec![5, 5, 10, 20]] {
        let order = ORDERS[boxes.len() - 2];
        let n = order.derivative();
        let product: f64 = boxes.iter().map(|length| f64::from(*length)).product();
        let peak = |skip: usize| boxes.iter().rev().skip(skip).map(|length| f64::from(*length)).product::<f64>();
        // With these limits the lengths are the fewest, since each binds.
        let limits =
            Limits { velocity: peak(1), acceleration: peak(2), jerk: peak(3), snap: if n == 4 { 1.0 } else { 9.0 } };
        let plan = Profile::plan_fewest(order, product, &limits, 1.0).unwrap();
        let total: i32 = boxes.iter().sum();
        assert_eq!(plan.samples().unwrap().total(), u64::try_from(total).unwrap(), "{boxes:?}");
        let runs: Vec<Run> = plan.runs().collect();
        let (mut state, mut cascade) = ([0.0; 5], Cascade::at_rest(order, 0.0, 1.0).unwrap());
        let mut passed = 0;
        for run in &runs {
            for _ in 0..run.count {
                state[n] = run.value;
                assert_eq!(
                    values(cascade.step(run.value)).map(f64::to_bits),
                    state.map(f64::to_bits),
                    "{boxes:?} at {passed}"
                );
                assert_eq!(state[0] == 0.0, passed < n, "{boxes:?}: stands still at {passed}");
                assert!(state[0] < product, "{boxes:?}: there at {passed}");
                for m in 0..n {
                    state[m] += state[m + 1];
                }
                passed += 1;
            }
        }
        assert_eq!(i32::try_from(passed).unwrap(), total);
        assert_eq!(cascade.state(), Setpoint::at_rest(product), "{boxes:?}");
        // The closed form from run to run gives the same.
        let mut along = Cascade::at_rest(order, 0.0, 1.0).unwrap();
        assert_eq!(along.along(runs.iter().copied()).count(), passed);
        assert_eq!(along.state(), Setpoint::at_rest(product), "{boxes:?}");
    }
}

/// Oracle: the exact hold. In the cruise the cascade is behind it by (n − 1)/2 samples of velocity.
#[test]
fn it_lags_by_half_a_sample_for_each_integrator_but_one() {
    let ts = 1e-3;
    for (order, lag) in ORDERS.into_iter().zip([0.5, 1.0, 1.5]) {
        for distance in [1.0, -2.0] {
            let plan = Profile::plan_fewest(order, distance, &LIMITS, ts).unwrap();
            let mut cascade = Cascade::at_rest(order, 0.0, ts).unwrap();
            // The middle of the cruise.
            let sample = plan.samples().unwrap().total() / 2;
            let at = cascade.along(plan.runs()).nth(usize::try_from(sample).unwrap()).unwrap();
            let exact = plan.at(sample as f64 * ts);
            // Some twenty roundings of a position of a metre.
            assert!((exact.x - at.x - lag * ts * exact.v).abs() < 1e-14, "{order:?}: {exact:?} {at:?}");
            assert!((exact.v - at.v).abs() < 1e-14 && at.a.abs() < 1e-12, "{order:?}: {at:?}");
        }
    }
}

/// Random requests land at the distance and stay, by every planner and execution.
#[test]
fn every_sampled_plan_lands() {
    let mut random = Random::seeded(72);
    let mut tried = 0;
    while tried < sweep_size() / 20 {
        let request = request(&mut random);
        let plans = [Profile::plan_sampled, Profile::plan_fewest]
            .map(|plan| plan(request.order, request.distance, &request.limits, request.sample_time));
        for plan in plans.into_iter().flatten().filter(|plan| plan.samples().unwrap().total() < 3000) {
            tried += 1;
            let (total, ts) = (plan.samples().unwrap().total(), plan.samples().unwrap().time);
            assert_eq!(plan.runs().map(|run| run.count).sum::<u64>(), total, "{request:?}");
            let mut cascade = Cascade::at_rest(request.order, 0.0, ts).unwrap();
            let peaks = plan.peaks();
            let n = request.order.derivative();
            for (time, at) in cascade.along(plan.runs()).enumerate() {
                let exact = plan.at(time as f64 * ts);
                assert_eq!(values(at)[n].to_bits(), values(exact)[n].to_bits(), "{request:?} at {time}");
                // Fifteen runs, whose polynomials round at the size of the whole move.
                assert!(at.v.abs() <= peaks.velocity * (1.0 + 1e-9), "{request:?} at {time}: {at:?}");
            }
            let error = cascade.state().x / plan.distance() - 1.0;
            assert!(error.abs() < 1e-9, "{request:?}: {error:e}");
            cascade.settle(plan.distance());
            for _ in 0..10 {
                assert_eq!(cascade.step(0.0), Setpoint::at_rest(plan.distance()), "{request:?}: at rest for ever");
            }
        }
    }
}

#[test]
fn a_sample_time_that_is_none_is_refused() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let e = Cascade::at_rest(Order::Fourth, 0.0, bad).unwrap_err();
        assert!(matches!(e, PlanError::Parameter(_)) && e.to_string().contains("sample_time"), "{e}");
    }
    assert_eq!(
        Profile::plan(Order::Fourth, 1.0, &LIMITS).unwrap().runs().count(),
        0,
        "a continuous plan has no samples"
    );
}
