//! Peaks, cruises, and binding limits.
use super::*;

/// The spans are contiguous and reproduce the plan; so every value lies within the peaks. 1e-9: differences of positions that belong to
/// anchors at different times.
#[test]
fn spans_are_the_plan_and_peaks_bound_it() {
    for plan in all() {
        let (mut end, peaks) = (0.0, plan.peaks());
        for span in plan.spans() {
            assert!((span.start - end).abs() <= 1e-12 * plan.duration(), "{} after {end} of {plan:?}", span.start);
            end = span.start + span.length;
            for part in 0..8 {
                let since = span.length * f64::from(part) / 8.0;
                let (mine, its) = (values(span.after(since)), values(plan.at(span.start + since)));
                for (k, (mine, its)) in mine.into_iter().zip(its).enumerate().take(plan.order()) {
                    let scale = if k == 0 { 1.0 } else { peaks[k - 1].highest.max(-peaks[k - 1].lowest) };
                    assert!((mine - its).abs() <= 1e-9 * scale, "derivative {k} at {since} of {span:?}: {mine} {its}");
                    if k > 0 {
                        let Peak { lowest, highest } = peaks[k - 1];
                        assert!(
                            (lowest - 1e-9 * scale..=highest + 1e-9 * scale).contains(&its),
                            "{k}: {its} {peaks:?}"
                        );
                    }
                }
            }
        }
        assert!((end - plan.duration()).abs() <= 1e-12 * plan.duration(), "{end} of {plan:?}");
    }
}

/// Oracle: the closed forms of the profile.
#[test]
fn peaks_and_cruise_of_a_profile_are_its_closed_forms() {
    for (distance, method) in [(1.0, Method::Published), (0.05, Method::Published), (-0.05, Method::Optimal)] {
        let profile = match method {
            Method::Published => Profile::plan(Order::Fourth, distance, &LIMITS).unwrap(),
            Method::Optimal => Profile::plan_optimal(Order::Fourth, distance, &LIMITS).unwrap(),
        };
        let known = profile.peaks();
        let plan = plan(point_to_point(distance, method));
        for (peak, known) in plan.peaks().into_iter().zip([known.velocity, known.acceleration, known.jerk, known.snap])
        {
            let largest = peak.highest.max(-peak.lowest);
            assert!((largest / known - 1.0).abs() < 1e-9, "{largest} {known}");
        }
        let bits = |values: [f64; 4]| values.map(f64::to_bits);
        assert_eq!(bits(plan.largest()), bits([known.velocity, known.acceleration, known.jerk, known.snap]));
    }
}

/// A shaper of two impulses leaves the part of the cruise that both impulses share.
#[test]
fn the_cruise_is_the_longest_part_at_constant_velocity() {
    let shaper = shaping(Shaper::Zv, 0.02);
    let request = |shapers| Request {
        filter: Filter { shapers, averages: None },
        ..Request::new(point_to_point(1.0, Method::Published))
    };
    let (start, length) = request(Vec::new()).plan().unwrap().cruise();
    assert!((start - 0.35).abs() < 1e-12 && (length - 0.65).abs() < 1e-12, "{start} {length}");
    let (start, length) = request(vec![shaper]).plan().unwrap().cruise();
    let delay = shaper.impulses().unwrap().duration();
    assert!((start - 0.35 - delay).abs() < 1e-12 && (length - 0.65 + delay).abs() < 1e-12, "{start} {length}");
    let (_, length) = plan(Generator::Replanning(replanning())).cruise();
    assert!(length > 0.0, "a cruise at the limit");
}

/// Lambrechts' move, with dwells of 0.05 s except the cruise, meets its limits at the times in his figure.
#[test]
fn bindings_are_where_the_published_figure_shows_them() {
    let plan = plan(point_to_point(1.0, Method::Published));
    let of = |derivative| -> Vec<(f64, f64, f64)> {
        let of = |found: &Binding| found.derivative == derivative;
        plan.bindings().into_iter().filter(of).map(|found| (found.start, found.length, found.value)).collect()
    };
    let close = |found: Vec<(f64, f64, f64)>, expected: &[(f64, f64, f64)]| {
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for (one, other) in found.iter().zip(expected) {
            assert!((one.0 - other.0).abs() < 1e-9 && (one.1 - other.1).abs() < 1e-9, "{found:?}");
            assert!((one.2 - other.2).abs() < 1e-9 * other.2.abs(), "{found:?}");
        }
    };
    close(of(1), &[(0.35, 0.65, 1.0)]);
    close(of(2), &[(0.15, 0.05, 5.0), (1.15, 0.05, -5.0)]);
    close(of(3), &[(0.05, 0.05, 50.0), (0.25, 0.05, -50.0), (1.05, 0.05, -50.0), (1.25, 0.05, 50.0)]);
    assert_eq!(of(4).len(), 8);
}

/// From the jerk limit on one side straight to that on the other: in between it is at neither.
#[test]
fn a_way_from_limit_to_limit_is_no_binding() {
    let limits = DirectionalLimits::from(LIMITS);
    let (target, order, effort) = (Target::Velocity(0.5), Order::Fourth, Effort::Fast);
    let plan = plan(Generator::Replanning(Replanning { from: Setpoint::default(), target, order, limits, effort }));
    let jerks: Vec<Binding> = plan.bindings().into_iter().filter(|found| found.derivative == 3).collect();
    // 50 ms of snap up to the limit, and then 100 ms down to the limit of the other side.
    let [high, low] = &jerks[..] else { panic!("{jerks:?}") };
    assert!(high.value > 0.0 && low.value < 0.0 && (high.start - 0.05).abs() < 1e-12, "{jerks:?}");
    assert!((low.start - high.start - high.length - 0.1).abs() < 1e-12, "{jerks:?}");
}

/// The velocity limit may be met for an instant: an optimum that touches it.
#[test]
fn a_touched_limit_is_a_binding_of_no_length() {
    let limits = Limits { velocity: 0.3, ..LIMITS };
    let request = |distance| {
        let order = Order::Fourth;
        Generator::PointToPoint(PointToPoint { distance, order, limits, method: Method::Optimal, grid: None })
    };
    let touching = (1..60).map(|k| f64::from(k) * 2e-3).find_map(|distance| {
        let plan = plan(request(distance));
        plan.bindings()
            .into_iter()
            .find(|found| found.derivative == 1 && found.length == 0.0)
            .map(|found| (plan, found))
    });
    let (plan, found) = touching.expect("a distance at which the limit is touched");
    assert!((found.start - plan.duration() / 2.0).abs() < 1e-9 && (found.value - 0.3).abs() < 1e-9, "{found:?}");
}
