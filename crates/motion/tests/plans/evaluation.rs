//! The set-point at any time, against the segments that the plan publishes.
use crate::requests::{Random, request, sweep_size};
use servobench_base::Setpoint;
use servobench_motion::{Limits, Order, Peaks, Profile};

const LIMITS: Limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };

fn values(s: Setpoint) -> [f64; 5] {
    [s.x, s.v, s.a, s.j, s.s]
}

fn peaks(plan: &Profile) -> [f64; 5] {
    let Peaks { velocity, acceleration, jerk, snap } = plan.peaks();
    [plan.distance().abs(), velocity, acceleration, jerk, snap]
}

fn sampled_plans(seed: u64) -> impl Iterator<Item = Profile> {
    let mut random = Random::seeded(seed);
    std::iter::repeat_with(move || request(&mut random))
        .filter_map(|r| Profile::plan_sampled(r.order, r.distance, &r.limits, r.sample_time).ok())
}

/// Each derivative is the slope of the one below it, and the highest is the value of the segment: by Simpson's rule over
/// a part of a segment, which is exact for the cubic that a velocity of order 4 is.
#[test]
fn every_derivative_is_the_slope_of_the_one_below() {
    let mut random = Random::seeded(5);
    for plan in sampled_plans(50).take(sweep_size() / 20) {
        let n = plan.order().derivative();
        let peaks = peaks(&plan);
        for segment in plan.segments() {
            let (p, q) = (random.unit(), random.unit());
            let [t0, t1] = [p.min(q), p.max(q)].map(|part| segment.start + part * segment.length);
            let (start, middle, end) = (plan.at(t0), plan.at(f64::midpoint(t0, t1)), plan.at(t1));
            let (start, middle, end) = (values(start), values(middle), values(end));
            for k in 0..n {
                let area = (t1 - t0) * (start[k + 1] + 4.0 * middle[k + 1] + end[k + 1]) / 6.0;
                // Values round at 16 ulp of their peak; times at 2 ulp of the duration.
                let above = if k + 1 < n { peaks[k + 1] } else { plan.amplitude().abs() };
                let tolerance = f64::EPSILON * (16.0 * peaks[k] + 4.0 * above * plan.duration());
                let error = (end[k] - start[k] - area).abs();
                assert!(error <= tolerance, "{plan:?}\nderivative {k} from {t0} to {t1}: {error:e} > {tolerance:e}");
            }
            assert_eq!(middle[n].to_bits(), segment.value.to_bits(), "{plan:?} at {}", f64::midpoint(t0, t1));
            assert!(middle[n + 1..].iter().all(|value| *value == 0.0));
        }
    }
}

/// Keeping a piece as long as it applies gives the set-points of a look-up at every instant, bit for bit: at
/// every switching instant, at the floats beside it, within the tolerance of it and anywhere; and no piece ends early.
#[test]
fn a_piece_holds_exactly_as_long_as_it_is_the_one() {
    let mut random = Random::seeded(7);
    for plan in sampled_plans(65).take(sweep_size() / 20) {
        let edges = plan.segments().flat_map(|segment| [segment.start, segment.start + 0.5 * segment.length]);
        let edges: Vec<f64> = edges.chain([plan.duration()]).collect();
        let rounding = 5.0 * f64::EPSILON * plan.duration();
        let beside = edges.iter().flat_map(|t| [*t, t.next_up(), t.next_down(), t + rounding, t - rounding]);
        let mut times: Vec<f64> = beside.chain((0..20).map(|_| random.unit() * plan.duration())).collect();
        times.sort_by(f64::total_cmp);
        let (mut piece, mut looked_up) = (plan.piece(-1.0), 0);
        for t in times {
            if !piece.holds(t) {
                piece = plan.piece(t);
                looked_up += 1;
            }
            assert_eq!(values(piece.at(t)).map(f64::to_bits), values(plan.at(t)).map(f64::to_bits), "{plan:?} at {t}");
        }
        // One for each segment, one more where the middle of the move cuts one in two, and the rest at the end.
        assert!(looked_up <= plan.segments().count() + 2, "{plan:?}: {looked_up}");
    }
}

#[test]
fn no_instant_exceeds_a_peak_or_leaves_the_way() {
    let mut random = Random::seeded(6);
    for plan in sampled_plans(60).take(sweep_size() / 20) {
        let peaks = peaks(&plan);
        let edges: Vec<f64> = plan.segments().map(|segment| segment.start).collect();
        let anywhere: Vec<f64> = (0..20).map(|_| random.unit() * plan.duration()).collect();
        for t in edges.into_iter().chain(anywhere) {
            let set_point = values(plan.at(t));
            for k in 0..=plan.order().derivative() {
                // A peak is a sum of up to seven terms, each rounded once or twice.
                assert!(set_point[k].abs() <= peaks[k] * (1.0 + 16.0 * f64::EPSILON), "{plan:?} at {t}: {set_point:?}");
            }
            let part = set_point[0] / plan.distance();
            assert!((0.0..=1.0).contains(&part), "{plan:?} at {t}: {part}");
        }
    }
}

/// 1000 s into a program, times differ by an ulp of 1000 s depending on their computation.
#[test]
fn a_switching_instant_is_hit_however_the_time_was_rounded() {
    let plan = Profile::plan_sampled(Order::Fourth, 0.3, &LIMITS, 1.0 / 3000.0).unwrap();
    let total = plan.samples().unwrap().total();
    let mut expected = Vec::new();
    for segment in plan.segments() {
        let count = (segment.length * 3000.0).round();
        expected.extend((0..).take_while(|k| f64::from(*k) < count).map(|_| segment.value));
    }
    assert_eq!(expected.len() as u64, total);
    for (k, snap) in expected.iter().enumerate() {
        let k = k as f64;
        let offset = 1000.0 + k / 3000.0 - 1000.0;
        for t in [k / 3000.0, k * (1.0 / 3000.0), offset] {
            assert_eq!(plan.at(t).s.to_bits(), snap.to_bits(), "sample {k} at {t}");
        }
    }
    assert_eq!(plan.at(total as f64 / 3000.0), Setpoint::at_rest(0.3));
}

#[test]
fn at_rest_before_and_after_for_ever() {
    for order in [Order::Second, Order::Third, Order::Fourth] {
        let plan = Profile::plan(order, -0.1, &LIMITS).unwrap();
        for t in [f64::NEG_INFINITY, -1.0, -1e-9, f64::NAN] {
            assert_eq!(plan.at(t), Setpoint::at_rest(0.0), "{t}");
        }
        assert_eq!(values(plan.at(0.0))[order.derivative()].to_bits(), plan.amplitude().to_bits());
        for t in [plan.duration(), 1e9, f64::INFINITY] {
            assert_eq!(plan.at(t), Setpoint::at_rest(-0.1), "{t}");
        }
    }
}

#[test]
fn the_end_is_approached_from_one_side_without_a_step() {
    let plan = Profile::plan(Order::Fourth, 0.7, &LIMITS).unwrap();
    let mut last = plan.at(0.0);
    for k in 1..=100_000 {
        let next = plan.at(plan.duration() * f64::from(k) / 100_000.0);
        assert!(next.x >= last.x && next.v >= 0.0 && next.x <= 0.7, "{k}: {next:?}");
        last = next;
    }
    assert_eq!(last, Setpoint::at_rest(0.7));
}
