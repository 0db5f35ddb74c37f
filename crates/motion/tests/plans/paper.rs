//! The printed equations (4)–(49), one by one, as the second planner.
//!
//! Pietrusewicz, Waszczuk & Kubicki, Applied Sciences 9 (2019). Names as printed; misprints corrected as noted. The one
//! deliberate difference: (3) rounds up with a tolerance, since `ceil` of a rounded whole number is one too many.
use crate::requests::{Random, request, sweep_size};
use servobench_motion::{Limits, Order, Profile, Times};

/// A request whose rounding depends on more than the precision of the printed formulas.
struct Undecided;

/// Times t_d, t_j, t_a, t_v (s) and the snap dd9; continuous for a sample time of zero.
fn paper(x: f64, limits: &Limits, ts: f64) -> Result<([f64; 4], f64), Undecided> {
    let Limits { velocity: v, acceleration: a, jerk: j, snap: d } = *limits;
    // (3)
    let up = |t: f64| {
        let n = t / ts;
        let off = (n - n.round()).abs();
        if ts == 0.0 {
            Ok(t.max(0.0))
        } else if off < 1e-7 {
            Ok(ts * n.round().max(0.0))
        } else if off < 1e-4 {
            Err(Undecided)
        } else {
            Ok(ts * n.ceil().max(0.0))
        }
    };
    // The conditions (7), (12), (17), (26), (31), (41) with equality up to rounding.
    let within = |peak: f64, bound: f64| peak <= bound * (1.0 + 1e-12);

    // Even a tiny t_d counts.
    let up_to_one = |t: f64| if t < 0.5 * ts { Ok(ts) } else { up(t) };

    // (4)–(6); the bar on d is missing in print, and the bracket of (6) stacks [T; x/(8T⁴)].
    let mut td = up_to_one((x / (8.0 * d)).powf(0.25))?;
    let mut dd = x / (8.0 * td.powi(4));
    if !within(2.0 * dd * td.powi(3), v) {
        // (9)–(11), [T; v/(2T³)]
        td = up_to_one((v / (2.0 * d)).cbrt())?;
        dd = v / (2.0 * td.powi(3));
    }
    if !within(dd * td * td, a) {
        // (14)–(16), [T; a/T²]
        td = up_to_one((a / d).sqrt())?;
        dd = a / (td * td);
    }
    if !within(dd * td, j) {
        // (19)–(21); (20) lacks the division by d.
        td = up_to_one(j / d)?;
        dd = j / td;
    }
    let dd3 = dd;

    // (23) with D = √(P³ + Q²) and R = ∛(−Q + D).
    let p = -td * td / 9.0;
    let q = -td.powi(3) / 27.0 - x / (4.0 * dd3 * td);
    let root = (p.powi(3) + q * q).max(0.0).sqrt();
    let r = (-q + root).cbrt();
    let mut tj = up(r - p / r - 5.0 / 3.0 * td)?;
    // (25)
    dd = x / (2.0 * td * (4.0 * td.powi(3) + tj * (8.0 * td * td + tj * (5.0 * td + tj))));
    if !within(td * dd * (2.0 * td * td + tj * (3.0 * td + tj)), v) {
        // (28)–(30)
        tj = up((0.25 * td * td + v / (dd3 * td)).sqrt() - 1.5 * td)?;
        dd = v / (td * (2.0 * td * td + tj * (3.0 * td + tj)));
    }
    if !within(dd * td * (td + tj), a) {
        // (33)–(35)
        tj = up(a / (dd3 * td) - td)?;
        dd = a / (td * (td + tj));
    }
    let dd6 = dd;

    // (37) with c3 inside the bracket.
    let c1 = td * (td + tj);
    let c2 = 3.0 * td * (2.0 * td * td + tj * (3.0 * td + tj));
    let c3 = 2.0 * td * (td * (4.0 * td * td + tj * (8.0 * td + 5.0 * tj)) + tj.powi(3));
    // (38)–(40)
    let mut ta = up((-c2 + (c2 * c2 - 4.0 * c1 * (c3 - x / dd6)).max(0.0).sqrt()) / (2.0 * c1))?;
    dd = x / (ta * (c1 * ta + c2) + c3);
    let v_shape = |ta: f64| td * (td * (2.0 * td + 3.0 * tj + ta) + tj * (tj + ta));
    if !within(dd * v_shape(ta), v) {
        // (43)–(45)
        ta = up((td * (td * (-2.0 * td - 3.0 * tj) - tj * tj) + v / dd6) / c1)?;
        dd = v / v_shape(ta);
    }

    // (47)–(49) with |t_v| below rounding as zero, and the braces of (49) around the whole last factor.
    let rest = x - dd * (ta * (c1 * ta + c2) + c3);
    let tv = up(if rest.abs() < 1e-13 * x { 0.0 } else { rest / v })?;
    Ok(([td, tj, ta, tv], x / (ta * (c1 * ta + c2) + c3 + tv * v_shape(ta))))
}

fn times(plan: &Profile) -> [f64; 4] {
    let Times { t_d, t_j, t_a, t_v } = plan.times().unwrap();
    [t_d.unwrap(), t_j.unwrap(), t_a, t_v]
}

#[test]
fn the_sampled_plan_is_that_of_the_printed_equations() {
    let mut random = Random::seeded(49);
    let (mut compared, mut undecided) = (0, 0);
    while compared < sweep_size() / 5 {
        let request = request(&mut random);
        let Ok(plan) = Profile::plan_sampled(Order::Fourth, request.distance, &request.limits, request.sample_time)
        else {
            continue;
        };
        // (23) and (38) cancel: with more samples their rounding is no longer small against a sample.
        if plan.samples().unwrap().total() > 100_000 {
            continue;
        }
        let Ok((expected, snap)) = paper(request.distance.abs(), &request.limits, request.sample_time) else {
            undecided += 1;
            continue;
        };
        for (found, expected) in times(&plan).into_iter().zip(expected) {
            let counts = [found, expected].map(|t| (t / request.sample_time).round());
            assert_eq!(counts[0].to_bits(), counts[1].to_bits(), "{request:?}: {:?} {expected:?}", times(&plan));
        }
        assert!((plan.amplitude().abs() / snap - 1.0).abs() < 1e-12, "{request:?}: {} {snap}", plan.amplitude());
        compared += 1;
    }
    assert!(undecided * 50 < compared, "{undecided} of {compared} not compared");
}

#[test]
fn the_continuous_plan_is_that_of_the_printed_equations() {
    let mut random = Random::seeded(490);
    for _ in 0..sweep_size() / 5 {
        let request = request(&mut random);
        let plan = Profile::plan(Order::Fourth, request.distance, &request.limits).unwrap();
        let Ok((expected, _)) = paper(request.distance.abs(), &request.limits, 0.0) else { unreachable!() };
        let duration = 8.0 * expected[0] + 4.0 * expected[1] + 2.0 * expected[2] + expected[3];
        // (23) and (38) lose the digits by which t_j and t_a are smaller than the averages that contain them.
        assert!((plan.duration() / duration - 1.0).abs() < 1e-12, "{request:?}: {} {duration}", plan.duration());
        assert!((times(&plan)[0] / expected[0] - 1.0).abs() < 1e-14, "{request:?}");
    }
}

/// Failure of the literal `ceil`: a snap-only move. x/(8·d·Ts⁴) = 937 500 lies between 31⁴ and 32⁴, hence
/// 32 samples of t_d and no dwell; but (23) and (38) leave t_j and t_a of some 1e-17 s, and `ceil` makes a sample of
/// each, four and two times over, and one more of t_v.
#[test]
fn a_dwell_of_rounding_noise_does_not_become_a_sample() {
    let limits = Limits { velocity: 4.0, acceleration: 40.0, jerk: 150.0, snap: 1000.0 };
    let plan = Profile::plan_sampled(Order::Fourth, 0.12, &limits, 0.002).unwrap();
    assert_eq!(plan.samples().unwrap().boxes, [32, 32, 64, 128]);
    assert_eq!(plan.samples().unwrap().total(), 256, "the literal equations take 263");
}

/// Likewise t_d = j/d = 2.1 ms at 0.1 ms: the quotient is 21.000000000000004 in `f64`.
#[test]
fn a_whole_number_missed_by_one_rounding_is_that_whole_number() {
    assert_eq!((2.1_f64 / 1000.0 / 1e-4).ceil().to_bits(), 22.0_f64.to_bits());
    let limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 2.1, snap: 1000.0 };
    let plan = Profile::plan_sampled(Order::Fourth, 1.0, &limits, 1e-4).unwrap();
    assert_eq!(plan.samples().unwrap().boxes[0], 21);
}
