//! The shortest move of order 4.
use crate::requests::{Random, request, sweep_size};
use servobench_base::Setpoint;
use servobench_motion::{Limits, Order, Profile};

/// Oracle: with the snap alone limited the shortest move takes (384·x/d)^¼, that of moving averages (512·x/d)^¼.
#[test]
fn with_snap_alone_it_takes_the_fourth_root_of_384() {
    let mut random = Random::seeded(384);
    for _ in 0..1000 {
        let (distance, snap) = (10.0_f64.powf(12.0 * random.unit() - 6.0), 10.0_f64.powf(12.0 * random.unit() - 6.0));
        let limits = Limits { snap, ..Limits::UNLIMITED };
        let optimal = Profile::plan_optimal(Order::Fourth, distance, &limits).unwrap();
        // Four roundings of the fourth root, some ten of the sum.
        assert!((optimal.duration() / (384.0 * distance / snap).powf(0.25) - 1.0).abs() < 4e-15, "{distance} {snap}");
        let published = Profile::plan(Order::Fourth, distance, &limits).unwrap();
        assert!((published.duration() / (512.0 * distance / snap).powf(0.25) - 1.0).abs() < 4e-15, "{distance} {snap}");
    }
}

/// Never longer than the published one, never beyond a limit, continuous in the middle, and exactly at the distance in the end.
#[test]
fn it_is_never_longer_and_keeps_the_limits() {
    let mut random = Random::seeded(4);
    let (mut gained, mut cruising) = (0.0_f64, 0);
    for _ in 0..sweep_size() {
        let request = request(&mut random);
        let (distance, limits) = (request.distance, request.limits);
        let Ok(published) = Profile::plan(Order::Fourth, distance, &limits) else { continue };
        let optimal = Profile::plan_optimal(Order::Fourth, distance, &limits).unwrap();
        let gain = 1.0 - optimal.duration() / published.duration();
        gained = gained.max(gain);
        cruising += u32::from(optimal.cruise() > 0.0);
        assert!(gain > -1e-14 && gain < 0.07457 + 1e-5, "{request:?}: {gain}");
        let peaks = optimal.peaks();
        for (peak, limit) in [
            (peaks.velocity, limits.velocity),
            (peaks.acceleration, limits.acceleration),
            (peaks.jerk, limits.jerk),
            (peaks.snap, limits.snap),
        ] {
            assert!(peak <= limit * (1.0 + 1e-13), "{request:?}: {peak} {limit}");
        }
        let half = 0.5 * optimal.duration();
        let [before, after] = [half * (1.0 - 1e-15), half].map(|t| optimal.at(t));
        // Four steps of integration, and a time that is rounded to 1e-15 of the duration.
        let duration = optimal.duration();
        for (one, two, peak, above) in [
            (before.x, after.x, distance.abs(), peaks.velocity),
            (before.v, after.v, peaks.velocity, peaks.acceleration),
            (before.a, after.a, peaks.acceleration, peaks.jerk),
        ] {
            let tolerance = 8.0 * f64::EPSILON * (peak + above * duration);
            assert!((one - two).abs() <= tolerance, "{request:?}: {before:?} {after:?}");
        }
        for k in 0..=64 {
            let at = optimal.at(optimal.duration() * f64::from(k) / 64.0);
            for (value, peak) in
                [(at.v, peaks.velocity), (at.a, peaks.acceleration), (at.j, peaks.jerk), (at.s, peaks.snap)]
            {
                assert!(value.abs() <= peak * (1.0 + 1e-13), "{request:?}: {at:?} {peaks:?}");
            }
        }
        let end = optimal.at(optimal.duration());
        assert_eq!(end.x.to_bits(), (distance + 0.0).to_bits(), "{request:?}");
    }
    assert!(gained > 0.05 && cruising > 0, "{gained} {cruising}");
}

/// Oracle: half moves assembled from their segments. Each is the shortest for the velocity and the distance that it
/// reaches in the middle, so that a plan with these has to find it again.
#[test]
fn moves_that_touch_the_velocity_limit_are_found_again() {
    let mut random = Random::seeded(12);
    let mut furthest = 0.0_f64;
    for _ in 0..20_000 {
        let (peak, jerk) = (10.0_f64.powf(2.0 * random.unit() - 1.0), 10.0_f64.powf(2.0 * random.unit() - 1.0));
        let end = random.unit() * jerk.min((2.0 * peak).sqrt());
        let hold = if random.index(2) == 0 { 0.0 } else { peak.sqrt() * random.unit() };
        let acceleration = if hold > 0.0 { peak } else { peak * (1.0 + random.unit()) };
        // Up to the jerk `most`, held for `held`, and down to zero: the acceleration gains most·(most + held).
        let swell = |gained: f64| {
            let most = jerk.min(gained.sqrt());
            (most, gained / most - most)
        };
        let ((up, up_held), (down, down_held)) = (swell(peak), swell(peak + 0.5 * end * end));
        let segments =
            [(1.0, up), (0.0, up_held), (-1.0, up), (0.0, hold), (-1.0, down), (0.0, down_held), (1.0, down - end)];
        let mut middle = Setpoint::default();
        for (s, length) in segments {
            middle = Setpoint { s, ..middle }.after(length);
        }
        let duration = 2.0 * segments.iter().map(|(_, length)| length).sum::<f64>();
        let limits = Limits { velocity: middle.v, acceleration, jerk, snap: 1.0 };
        let plan = Profile::plan_optimal(Order::Fourth, 2.0 * middle.x, &limits).unwrap();
        furthest = furthest.max((plan.duration() / duration - 1.0).abs());
        furthest = furthest.max((plan.peaks().velocity / middle.v - 1.0).abs());
    }
    // Some forty roundings of seven segments, and the position in the middle to 4 ulp; seen: 2.2e-15.
    assert!(furthest < 1e-14, "{furthest:e}");
}
