//! Published numbers and textbook formulas.
use crate::requests::{Random, request, sweep_size};
use servobench_base::Setpoint;
use servobench_motion::{Limits, Order, Profile, Times};

/// Lambrechts' motor–load example: 1 m under these limits.
const LAMBRECHTS: Limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 4.0 * f64::EPSILON * b.abs()
}

#[test]
fn lambrechts_one_metre() {
    for sample_time in [None, Some(1e-3)] {
        let plan = |order| match sample_time {
            None => Profile::plan(order, 1.0, &LAMBRECHTS).unwrap(),
            Some(ts) => Profile::plan_sampled(order, 1.0, &LAMBRECHTS, ts).unwrap(),
        };
        let third = plan(Order::Third);
        assert!(close(third.duration(), 1.30), "{}", third.duration());
        let fourth = plan(Order::Fourth);
        assert!(close(fourth.duration(), 1.35), "{}", fourth.duration());
        let Times { t_d, t_j, t_a, t_v } = fourth.times().unwrap();
        for (found, published) in [(t_d.unwrap(), 0.05), (t_j.unwrap(), 0.05), (t_a, 0.05), (t_v, 0.65)] {
            assert!((found - published).abs() < 1e-15, "{found} {published}");
        }
        assert!(close(fourth.amplitude(), 1000.0));
        let peaks = fourth.peaks();
        assert!(close(peaks.velocity, 1.0) && close(peaks.acceleration, 5.0) && close(peaks.jerk, 50.0));
        assert_eq!(fourth.segments().count(), 15);
    }
}

#[test]
fn one_bound_alone() {
    for x in [1e-9, 3.7e-4, 1.0, 25.0] {
        let snap_only = Limits { snap: 1000.0, ..Limits::UNLIMITED };
        let t = Profile::plan(Order::Fourth, x, &snap_only).unwrap().duration();
        assert!(close(t, (512.0 * x / 1000.0).powf(0.25)), "{t}");
        let jerk_only = Limits { jerk: 50.0, ..Limits::UNLIMITED };
        let t = Profile::plan(Order::Third, x, &jerk_only).unwrap().duration();
        assert!(close(t, (32.0 * x / 50.0).cbrt()), "{t}");
        let acceleration_only = Limits { acceleration: 5.0, ..Limits::UNLIMITED };
        let bang_bang = Profile::plan(Order::Second, x, &acceleration_only).unwrap();
        assert!(close(bang_bang.duration(), (4.0 * x / 5.0).sqrt()));
        assert_eq!(bang_bang.segments().count(), 2, "no cruise");
        assert!(bang_bang.peaks().jerk.is_infinite());
    }
}

/// Time-optimal order 3 from Biagiotti & Melchiorri, *Trajectory Planning for Automatic Machines and Robots*, §3.4:
/// double S with zero end velocities.
fn double_s(x: f64, limits: &Limits) -> f64 {
    let Limits { velocity: v, acceleration: a, jerk: j, .. } = *limits;
    let ramp = |t_j: f64| if v * j < a * a { 2.0 * t_j } else { t_j + v / a };
    let t_j = if v * j < a * a { (v / j).sqrt() } else { a / j };
    let t_ramp = ramp(t_j);
    let t_v = x / v - t_ramp;
    if t_v >= 0.0 {
        return 2.0 * t_ramp + t_v;
    }
    // The velocity is not reached; neither is the acceleration, if its ramps do not fit.
    let t_j = a / j;
    let t_ramp = (a * a / j + (a.powi(4) / (j * j) + 4.0 * a * x).sqrt()) / (2.0 * a);
    2.0 * if t_ramp < 2.0 * t_j { 2.0 * (x / (2.0 * j)).cbrt() } else { t_ramp }
}

#[test]
fn order_three_is_time_optimal() {
    let mut random = Random::seeded(3);
    for _ in 0..sweep_size() {
        let request = request(&mut random);
        let t = Profile::plan(Order::Third, request.distance, &request.limits).unwrap().duration();
        let optimal = double_s(request.distance.abs(), &request.limits);
        // A handful of roundings, and dwells below 1e-12 that the plan drops.
        assert!((t / optimal - 1.0).abs() < 2e-12, "{request:?}: {t} {optimal}");
    }
}

/// Rockwell `ControlLogix` example: 100 mm, 200 mm/s, 100 m/s², jerk by J = (A²/V)·(200/% − 1): acceleration takes
/// 2.00 ms as a trapezoid, 4.00 ms at 100 % and 2.2857 ms at 25 % of time.
#[test]
fn rockwell_jerk_by_percent_of_time() {
    let (v, a) = (0.2, 100.0);
    let jerk = |percent: f64| a * a / v * (200.0 / percent - 1.0);
    assert!(close(jerk(100.0), 5e4) && close(jerk(25.0), 3.5e5));
    let limits = |jerk| Limits { velocity: v, acceleration: a, jerk, snap: f64::INFINITY };
    let ramp = |plan: Profile| (plan.duration() - plan.cruise()) / 2.0;
    let trapezoid = Profile::plan(Order::Second, 0.1, &limits(f64::INFINITY)).unwrap();
    assert!((ramp(trapezoid) - 2e-3).abs() < 1e-15);
    assert!((trapezoid.at(2e-3).x - 0.2e-3).abs() < 1e-15, "distance of the ramp: 0.2 mm");
    for (percent, seconds, distance) in [(100.0, 4e-3, 0.4e-3), (25.0, 16e-3 / 7.0, 0.2e-3 * 8.0 / 7.0)] {
        let plan = Profile::plan(Order::Third, 0.1, &limits(jerk(percent))).unwrap();
        assert!((ramp(plan) - seconds).abs() < 1e-15, "{percent} %: {}", ramp(plan));
        assert!((plan.at(seconds).x - distance).abs() < 1e-15, "{percent} %");
    }
}

#[test]
fn the_way_back_is_the_mirror_image_to_the_bit() {
    let mut random = Random::seeded(8);
    for _ in 0..2_000 {
        let request = request(&mut random);
        let plan = |sign: f64| Profile::plan(request.order, sign * request.distance, &request.limits).unwrap();
        let (there, back) = (plan(1.0), plan(-1.0));
        assert_eq!(there.duration().to_bits(), back.duration().to_bits());
        for _ in 0..20 {
            let t = random.unit() * there.duration();
            let Setpoint { x, v, a, j, s } = back.at(t);
            assert_eq!(there.at(t), Setpoint { x: -x, v: -v, a: -a, j: -j, s: -s });
        }
    }
}

#[test]
fn zero_distance_is_a_move_of_no_time() {
    for order in [Order::Second, Order::Third, Order::Fourth] {
        for distance in [0.0, -0.0] {
            let sampled = Profile::plan_sampled(order, distance, &LAMBRECHTS, 1e-3).unwrap();
            assert_eq!(sampled.samples().unwrap().total(), 0);
            for plan in [Profile::plan(order, distance, &LAMBRECHTS).unwrap(), sampled] {
                assert_eq!(plan.duration().to_bits(), 0.0_f64.to_bits());
                assert_eq!((plan.segments().count(), plan.peaks().velocity.to_bits()), (0, 0));
                assert_eq!(plan.at(0.0), Setpoint::at_rest(0.0));
                assert_eq!(plan.distance().to_bits(), 0.0_f64.to_bits(), "nobody wants to read -0 m");
            }
        }
    }
}

/// A dwell that is only rounding of the request would be a segment too many; one of 1e-10 of its box is real.
#[test]
fn dwells_of_rounding_noise_are_dropped_and_no_others() {
    let mut random = Random::seeded(10);
    for _ in 0..1_000 {
        let request = request(&mut random);
        let x = request.distance;
        let snap_only = Limits { snap: request.limits.snap, ..Limits::UNLIMITED };
        assert_eq!(Profile::plan(Order::Fourth, x, &snap_only).unwrap().segments().count(), 8);
        let jerk_only = Limits { jerk: request.limits.jerk, ..Limits::UNLIMITED };
        assert_eq!(Profile::plan(Order::Third, x, &jerk_only).unwrap().segments().count(), 4);
        // a = √(v·j) and x = 2v·√(v/j): every limit is just reached, for no time at all.
        let Limits { velocity: v, jerk: j, .. } = request.limits;
        let exact = Limits { acceleration: (v * j).sqrt(), ..request.limits };
        let plan = Profile::plan(Order::Third, 2.0 * v * (v / j).sqrt(), &exact).unwrap();
        assert_eq!(plan.segments().count(), 4, "{exact:?}");
    }
    let limits = Limits { velocity: 1.0, acceleration: 1.0, ..Limits::UNLIMITED };
    let t_v = Profile::plan(Order::Second, 1.0 + 1e-10, &limits).unwrap().cruise();
    // An ulp of 1 s.
    assert!((t_v - 1e-10).abs() < 3e-16, "{t_v}");
}

/// One count of a 1 nm encoder at 1 ms: the shortest profile of each order, one amplitude per sample.
#[test]
fn one_encoder_count_takes_the_fewest_samples_of_its_shape() {
    for (order, boxes) in [(Order::Second, [1, 1, 0, 0]), (Order::Third, [1, 1, 2, 0]), (Order::Fourth, [1, 1, 2, 4])] {
        let plan = Profile::plan_sampled(order, 1e-9, &LAMBRECHTS, 1e-3).unwrap();
        assert_eq!(plan.samples().unwrap().boxes, boxes);
        assert_eq!(plan.at(plan.duration()), Setpoint::at_rest(1e-9));
    }
}

/// Limits ten decades apart on one axis, where the parts of the profile are ten decades apart too.
#[test]
fn ten_decades_between_limits() {
    let limits = Limits { velocity: 1e-5, acceleration: 1e5, jerk: 1e8, snap: 1e12 };
    let plan = Profile::plan(Order::Fourth, 1e3, &limits).unwrap();
    // The velocity is reached within t_d = ∛(v/2d) without dwells, then it is a cruise of x/v.
    let t_d = (1e-5_f64 / 2e12).cbrt();
    assert!(close(plan.times().unwrap().t_d.unwrap(), t_d));
    assert!(close(plan.duration(), 1e3 / 1e-5 + 4.0 * t_d));
    let slow = Limits { velocity: 1e5, acceleration: 1e-5, jerk: 1e5, snap: 1e5 };
    let plan = Profile::plan(Order::Fourth, 1.0, &slow).unwrap();
    // The acceleration is reached in √(a/d) each way and then held: T3² ≈ x/a.
    assert!((plan.duration() / (4.0 / 1e-5_f64).sqrt() - 1.0).abs() < 1e-6, "{}", plan.duration());
    assert!(plan.peaks().acceleration <= 1e-5 * (1.0 + 1e-12));
}
